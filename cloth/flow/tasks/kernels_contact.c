/* Contact in the solve. A vertex that lies on a plane, or comes to it in the step by the velocity
 * it has, is held along the normal by the filter of the solve. Before the forces its velocity along
 * the normal is made the one that ends the step on the plane, so that they and the right side see
 * it (b - A z of Ascher & Boxerman 2003, with the change z made beforehand, as for pins). One that
 * lies there is let go when the forces on it pull it off. */
#include "cloth/flow/tasks/bodies.h"

/* m: so near a vertex lies on a plane. */
static const double ON = 1e-7;

enum meeting { APART, LIES, LANDS };

/* Of a vertex with a plane in a step of h; *speed: along the normal, *due: what it must be. */
static enum meeting meet(const struct model_plane *plane, double h, const phys_vec *x,
                         const phys_vec *v, double *speed, double *due)
{
    const phys_vec origin = {plane->point[0], plane->point[1], plane->point[2], 0};
    const phys_vec up = {plane->normal[0], plane->normal[1], plane->normal[2], 0};
    const phys_vec from = *x - origin;
    const double height = phys_dot(&from, &up);
    *speed = phys_dot(v, &up);
    *due = 0;
    if (height <= ON)
        return *speed <= 0 ? LIES : APART;
    *due = -height / h;
    /* What lands was given just this speed: rounding may leave it a little slower. */
    return *speed <= *due * (1 - 1e-9) ? LANDS : APART;
}

static int touch(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const struct model *model = flow_of(call)->model;
    const phys_vec *x = duite_in(call, 1, phys_vec);
    phys_vec *v = duite_out(call, 2, phys_vec);
    for (uint32_t p = 0; p < model->n_planes; p++) {
        const double *n = model->planes[p].normal;
        const phys_vec up = {n[0], n[1], n[2], 0};
        for (uint32_t i = 0; i < t->n; i++) {
            double speed, due;
            if (t->free[i] != 0 &&
                meet(model->planes + p, flow_args_of(call)->h, x + i, v + i, &speed, &due))
                v[i] += (due - speed) * up;
        }
    }
    flow_write_rim(t, v, duite_out(call, 3, phys_vec));
    return 0;
}
FLOW_TIMED(touch, FLOW_COLLIDE)
const duite_kernel flow_touch = {.name = "touch",
                                 .body = touch_timed,
                                 .access = {DUITE_R, DUITE_R, DUITE_RW, DUITE_W},
                                 .args_size = sizeof(struct flow_args)};

/* Holds a row along one more normal. */
static void hold_along(const phys_vec *up, phys_vec *filter)
{
    const phys_vec d = {(*filter)[0], (*filter)[1], (*filter)[2], 0};
    const phys_vec line = SOLVE_YZX(d) * SOLVE_ZXY(*up) - SOLVE_ZXY(d) * SOLVE_YZX(*up);
    const double square = phys_dot(&line, &line), along = phys_dot(&d, up);
    if ((*filter)[3] > 0 && phys_dot(&d, &d) <= 0)
        *filter = (phys_vec){(*up)[0], (*up)[1], (*up)[2], 1};
    else if ((*filter)[3] > 0 && square > 1e-12)
        *filter = line * (1 / sqrt(square));
    else if ((*filter)[3] <= 0 && along * along > 1e-12)
        *filter = (phys_vec){0};
}

static int contact(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const struct model *model = flow_of(call)->model;
    const phys_vec *x = duite_in(call, 1, phys_vec), *v = duite_in(call, 2, phys_vec);
    const phys_vec *f = duite_in(call, 3, phys_vec);
    phys_vec *filter = duite_out(call, 4, phys_vec);
    for (uint32_t i = 0; i < t->n; i++)
        filter[i] = (phys_vec){0, 0, 0, 1};
    for (uint32_t p = 0; p < model->n_planes; p++) {
        const double *n = model->planes[p].normal;
        const phys_vec up = {n[0], n[1], n[2], 0};
        for (uint32_t i = 0; i < t->n; i++) {
            double speed, due;
            const enum meeting how =
                t->free[i] != 0
                    ? meet(model->planes + p, flow_args_of(call)->h, x + i, v + i, &speed, &due)
                    : APART;
            if (how == LANDS || (how == LIES && phys_dot(f + i, &up) <= 0))
                hold_along(&up, filter + i);
        }
    }
    return 0;
}
FLOW_TIMED(contact, FLOW_COLLIDE)
const duite_kernel flow_contact = {.name = "contact",
                                   .body = contact_timed,
                                   .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_R, DUITE_W},
                                   .args_size = sizeof(struct flow_args)};

/* Filters the right side, and gives the matrix its filter. */
static int hold(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const phys_vec *filter = duite_in(call, 1, phys_vec);
    phys_vec *b = duite_out(call, 2, phys_vec);
    for (uint32_t i = 0; i < t->n; i++)
        solve_filter(filter + i, b + i);
    memcpy(duite_out(call, 3, phys_vec) + flow_diagonal_rows(t), filter, t->n * sizeof *filter);
    return 0;
}
FLOW_TIMED(hold, FLOW_COLLIDE)
const duite_kernel flow_hold = {.name = "hold",
                                .body = hold_timed,
                                .access = {DUITE_R, DUITE_R, DUITE_RW, DUITE_RW},
                                .args_size = sizeof(struct flow_args)};
