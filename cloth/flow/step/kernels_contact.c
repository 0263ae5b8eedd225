/* Guides and contact in the solve. A row that a guide holds is filtered by it. A vertex that lies
 * on an obstacle, or comes to it in the step by the velocity it has, is held along the normal by
 * the filter of the solve. Before the forces its velocity along the normal is made the one that
 * ends the step on the surface, so that they and the right side see it (b - A z of Ascher &
 * Boxerman 2003, with the change z made beforehand, as for pins). One that lies there is let go
 * when the forces on it pull it off. */
#include "cloth/contact/meet.h"
#include "cloth/flow/step/guides.h"

/* Whether a row can leave an obstacle with the normal *way, which becomes the way along which it
 * does.
 */
static bool can_leave(struct flow_pins *pins, uint32_t row, phys_vec *way)
{
    const phys_vec *filter = flow_pins_filter(pins, row);
    return pins->table->free[row] != 0 && (!filter || flow_guide_way(filter, way));
}

/* Gives rows the velocity that ends the step on the obstacle. */
static void touch_obstacle(const duite_call *call, const struct flow_table *t,
                           const struct contact_shape *obstacle, const phys_vec *x, phys_vec *v)
{
    struct contact_pose pose;
    struct flow_pins pins;
    flow_obstacle_pose(call, obstacle, &pose);
    flow_pins_begin(call, t, &pins);
    for (uint32_t i = 0; i < t->n; i++) {
        struct contact_hit hit;
        double speed, due;
        contact_ahead(obstacle, &pose, x + i, &hit);
        phys_vec way = hit.normal;
        if (can_leave(&pins, i, &way) &&
            contact_meet(&hit, flow_args_of(call)->h, v + i, &speed, &due))
            v[i] += (due - speed) * way;
    }
}

static int touch(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const struct model *model = flow_of(call)->model;
    const phys_vec *x = duite_in(call, 1, phys_vec);
    phys_vec *v = duite_out(call, 2, phys_vec);
    for (uint32_t p = 0; p < model->n_obstacles; p++)
        touch_obstacle(call, t, model->obstacles + p, x, v);
    flow_write_rim(t, v, duite_out(call, 3, phys_vec));
    return 0;
}
FLOW_TIMED(touch, FLOW_COLLIDE)
const duite_kernel flow_touch = {.name = "touch",
                                 .body = touch_timed,
                                 .access = {DUITE_R, DUITE_R, DUITE_RW, DUITE_W},
                                 .args_size = sizeof(struct flow_args)};

/* Holds the rows that an obstacle holds. */
static void hold_rows(const duite_call *call, const struct flow_table *t,
                      const struct contact_shape *obstacle, phys_vec *filter)
{
    const phys_vec *x = duite_in(call, 1, phys_vec), *v = duite_in(call, 2, phys_vec);
    const phys_vec *f = duite_in(call, 3, phys_vec);
    struct contact_pose pose;
    struct flow_pins pins;
    flow_obstacle_pose(call, obstacle, &pose);
    flow_pins_begin(call, t, &pins);
    for (uint32_t i = 0; i < t->n; i++) {
        struct contact_hit hit;
        double speed, due;
        contact_ahead(obstacle, &pose, x + i, &hit);
        phys_vec way = hit.normal;
        if (!can_leave(&pins, i, &way))
            continue;
        const enum contact_meeting how =
            contact_meet(&hit, flow_args_of(call)->h, v + i, &speed, &due);
        if (how == CONTACT_LANDS || (how == CONTACT_LIES && phys_dot(f + i, &way) <= 0))
            solve_hold(&hit.normal, filter + i);
    }
}

/* The program's part. */
static int filter_own(const duite_call *call, const struct flow_table *t, phys_vec *filter)
{
    const struct flow_filter *own = &flow_of(call)->filter;
    const struct flow_rows rows = {.n = t->n,
                                   .vertex = t->vertex,
                                   .x = duite_in(call, 1, phys_vec),
                                   .v = duite_in(call, 2, phys_vec),
                                   .time = flow_args_of(call)->time,
                                   .h = flow_args_of(call)->h,
                                   .filter = filter};
    if (!own->rows)
        return duite_fail(call, FLOW_NO_FILTER,
                          "the model has a filter of the program's own, but this rank was given no "
                          "function; call flow_filter_by on every rank");
    own->rows(own->context, &rows);
    return 0;
}

static int contact(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const struct model *model = flow_of(call)->model;
    phys_vec *filter = duite_out(call, 4, phys_vec);
    struct flow_pins pins;
    struct flow_guide guide;
    flow_pins_begin(call, t, &pins);
    for (uint32_t i = 0; i < t->n; i++)
        filter[i] = (phys_vec){0, 0, 0, 1};
    for (uint32_t i = 0; i < t->n_guided; i++) {
        flow_pins_guide(&pins, i, &guide);
        filter[t->guided[i][0]] = guide.filter;
    }
    for (uint32_t p = 0; model_solves_contact(model) && p < model->n_obstacles; p++)
        hold_rows(call, t, model->obstacles + p, filter);
    return model->own_filter ? filter_own(call, t, filter) : 0;
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
    for (uint32_t i = 0; i < t->n; i++) {
        solve_filter(filter + i, b + i);
        solve_filter(filter + i, b + i); /* once leaves a rounding of what it takes away */
    }
    memcpy(duite_out(call, 3, phys_vec) + flow_diagonal_rows(t), filter, t->n * sizeof *filter);
    return 0;
}
FLOW_TIMED(hold, FLOW_COLLIDE)
const duite_kernel flow_hold = {.name = "hold",
                                .body = hold_timed,
                                .access = {DUITE_R, DUITE_R, DUITE_RW, DUITE_RW},
                                .args_size = sizeof(struct flow_args)};
