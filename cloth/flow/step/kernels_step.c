/* A body writes the rows of its own block only, in an order that the block's table gives; what it
 * needs of neighbours it finds in their rims, one object a neighbour and vector, in slot order. */
#include "cloth/contact/meet.h"
#include "cloth/flow/step/guides.h"
#include "cloth/physics/particle.h"

#include <math.h>
#include <string.h>

#define ARGS sizeof(struct flow_args)

void flow_note_stop(const duite_call *call, size_t i)
{
    const struct flow_progress *progress = flow_of(call)->progress;
    if (progress && progress->stop && progress->stop(progress->context))
        duite_out(call, i, double)[FLOW_STOP] = 1;
}

int flow_check(const duite_call *call, const struct flow_table *t, const phys_vec *y,
               const char *what, size_t i)
{
    const size_t bad = phys_diverged(t->n, FLOW_BOUND, y);
    const struct flow_args *args = flow_args_of(call);
    flow_note_stop(call, i);
    if (bad < t->n)
        duite_out(call, i, double)[FLOW_BEYOND] = 1;
    if (bad == t->n || !args->last)
        return 0;
    return duite_fail(
        call, FLOW_DIVERGED,
        "step %.0f: the %s of vertex %u in block %u is (%g, %g, %g): the run diverged",
        flow_step_number(args->begin), what, t->vertex[bad], args->block, y[bad][0], y[bad][1],
        y[bad][2]);
}

static int initial(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    phys_vec *x = duite_out(call, 1, phys_vec), *v = duite_out(call, 2, phys_vec);
    for (uint32_t i = 0; i < t->n; i++) {
        x[i] = t->position[i];
        v[i] = t->velocity[i];
    }
    flow_write_rim(t, x, duite_out(call, 3, phys_vec));
    flow_write_rim(t, v, duite_out(call, 4, phys_vec));
    return 0;
}
const duite_kernel flow_initial = {.name = "initial",
                                   .body = initial,
                                   .access = {DUITE_R, DUITE_W, DUITE_W, DUITE_W, DUITE_W},
                                   .args_size = ARGS};

/* Adds the forces inside the cloth. */
static void add_inner(const duite_call *call, const struct flow_table *t, size_t rims, phys_vec *f)
{
    const phys_vec *x = duite_in(call, 1, phys_vec), *v = duite_in(call, 2, phys_vec);
    struct phys_springs springs = flow_table_inner(t);
    if (flow_has_elements(t)) {
        const struct phys_sight sight = flow_elements_see(call, t, rims);
        flow_elements_force(call, t, &sight, f);
    }
    if (!t->n_stiff)
        return;
    phys_springs_force(&springs, x, v, f);
    for (uint32_t s = 0; s < t->n_slots; s++) {
        springs = flow_table_cut(t, s);
        phys_springs_force_cut(&springs, x, v, duite_in(call, rims + s, phys_vec),
                               duite_in(call, rims + t->n_slots + s, phys_vec), f);
    }
}

void flow_forces(const duite_call *call, const struct flow_table *t, size_t rims, phys_vec *f)
{
    phys_outside(t->n, t->load, t->drag, duite_in(call, 2, phys_vec), f);
    flow_varying_add(call, t, f);
    add_inner(call, t, rims, f);
}

void flow_forces_free(const duite_call *call, const struct flow_table *t, size_t rims, phys_vec *f)
{
    memcpy(f, t->load, t->n * sizeof *f);
    flow_varying_add(call, t, f);
    add_inner(call, t, rims, f);
}

static int force(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    flow_forces(call, t, 4, duite_out(call, 3, phys_vec));
    return 0;
}
FLOW_TIMED(force, FLOW_FORCE)
const duite_kernel flow_force = {.name = "force",
                                 .body = force_timed,
                                 .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_W},
                                 .variadic = DUITE_R,
                                 .args_size = ARGS};

static int force_free(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    flow_forces_free(call, t, 4, duite_out(call, 3, phys_vec));
    return 0;
}
FLOW_TIMED(force_free, FLOW_FORCE)
const duite_kernel flow_force_free = {.name = "force_free",
                                      .body = force_free_timed,
                                      .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_W},
                                      .variadic = DUITE_R,
                                      .args_size = ARGS};

/* What a filtered solve lost: entries to held rows and rows in contact do not cancel. */
static void sum_rows(size_t n, const phys_vec *r, double sum[3])
{
    for (size_t a = 0; a < n; a++)
        for (int c = 0; c < 3; c++)
            sum[c] += r[a][c];
}

void flow_note_solve(const duite_call *call, const struct flow_table *t,
                     const struct flow_solved *solved, double *status)
{
    const struct solve_scalars *scalars = solved->scalars;
    if (t->matrix.filter)
        sum_rows(t->n, solved->r, status + FLOW_LOST);
    else
        solve_lost(&t->matrix, &t->held, solved->value, solved->b, solved->dv, status + FLOW_LOST);
    const struct solve_norms norms = solve_norms(t->n, t->matrix.diagonal, solved->dv, solved->r);
    status[FLOW_SIZE] = norms.size;
    status[FLOW_RESIDUAL] = norms.bound;
    status[FLOW_FAILED] = scalars->outcome != SOLVE_OK;
    if (flow_args_of(call)->block != 0)
        return;
    const double error = sqrt(solve_scalars_error(scalars, INFINITY)) + sqrt(scalars->drift);
    status[FLOW_ITERATIONS] = solve_scalars_iterations(scalars);
    status[FLOW_ERROR] = error * error;
    status[FLOW_RESTARTS] = scalars->restarts;
}

/* v += dv, and what the solve took and lost of the momentum. A solve that failed in a step that
 * must not leaves no scalars: then this does not run. */
static int velocity_dv(const duite_call *call)
{
    struct flow_table table = flow_table_of(call), *t = &table;
    phys_vec *v = duite_out(call, 5, phys_vec);
    const struct flow_solved solved = {.value = flow_open_matrix(call, t, 2),
                                       .b = duite_in(call, 1, phys_vec),
                                       .dv = duite_in(call, 3, phys_vec),
                                       .r = duite_in(call, 4, phys_vec),
                                       .scalars = duite_in(call, 7, struct solve_scalars)};
    flow_note_solve(call, t, &solved, duite_out(call, 8, double));
    phys_advance(t->n, 1, solved.dv, v);
    flow_write_rim(t, v, duite_out(call, 6, phys_vec));
    return flow_check(call, t, v, "velocity", 8);
}
FLOW_TIMED(velocity_dv, FLOW_VELOCITY)
const duite_kernel flow_velocity_dv = {
    .name = "velocity_implicit",
    .body = velocity_dv_timed,
    .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_R, DUITE_R, DUITE_RW, DUITE_W, DUITE_R, DUITE_CW},
    .args_size = ARGS};

static int position(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    phys_vec *x = duite_out(call, 2, phys_vec);
    phys_advance(t->n, flow_args_of(call)->h, duite_in(call, 1, phys_vec), x);
    flow_write_rim(t, x, duite_out(call, 3, phys_vec));
    return flow_check(call, t, x, "position", 4);
}
FLOW_TIMED(position, FLOW_POSITION)
const duite_kernel flow_position = {.name = "position",
                                    .body = position_timed,
                                    .access = {DUITE_R, DUITE_R, DUITE_RW, DUITE_W, DUITE_CW},
                                    .args_size = ARGS};

/* Rows that a guide holds leave an obstacle along it. Returns how many rows of the block met it. */
static size_t obstacle_meets(const duite_call *call, const struct flow_table *t,
                             const struct contact_shape *obstacle, phys_vec *x, phys_vec *v)
{
    struct contact_pose pose;
    struct contact_hit hit;
    struct flow_pins pins;
    struct flow_guide guide;
    uint32_t from = 0;
    size_t touched = 0;
    flow_obstacle_pose(call, obstacle, &pose);
    flow_pins_begin(call, t, &pins);
    for (uint32_t i = 0; i < t->n_guided; i++) {
        const uint32_t row = t->guided[i][0];
        touched += contact_project(obstacle, &pose, row - from, t->free + from, x + from, v + from);
        from = row + 1;
        contact_closest(obstacle, &pose, 1, x + row, &hit);
        flow_pins_guide(&pins, i, &guide);
        phys_vec way = hit.normal;
        if (flow_guide_way(&guide.filter, &way))
            touched += contact_leave(&hit, &way, x + row, v + row);
    }
    return touched +
           contact_project(obstacle, &pose, t->n - from, t->free + from, x + from, v + from);
}

static int collide(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const struct model *model = flow_of(call)->model;
    phys_vec *x = duite_out(call, 1, phys_vec), *v = duite_out(call, 2, phys_vec);
    double *status = duite_out(call, 5, double);
    for (uint32_t i = 0; i < model->n_obstacles; i++)
        status[FLOW_TOUCHED] += (double)obstacle_meets(call, t, model->obstacles + i, x, v);
    flow_write_rim(t, x, duite_out(call, 3, phys_vec));
    flow_write_rim(t, v, duite_out(call, 4, phys_vec));
    return flow_check(call, t, x, "position", 5);
}
FLOW_TIMED(collide, FLOW_COLLIDE)
const duite_kernel flow_collide = {
    .name = "collide",
    .body = collide_timed,
    .access = {DUITE_R, DUITE_RW, DUITE_RW, DUITE_W, DUITE_W, DUITE_CW},
    .args_size = ARGS};
