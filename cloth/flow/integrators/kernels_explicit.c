/* Stages of explicit steps (cloth/physics/stage.h). A body writes the rows of its own block only;
 * whoever moves a row writes the rim that neighbours read next. x and v are parameters 1 and 2. */
#include "cloth/flow/step/guides.h"

#include "cloth/physics/particle.h"
#include "cloth/physics/stage.h"

#define ARGS sizeof(struct flow_args)

/* Asks memory for what a task comes to when its long loops, which ask for themselves, are done:
 * rows of the neighbours' rims, from parameter `rims` on, and the rims of its own that it writes,
 * parameters own .. end - 1. */
static void fetch_rims(const duite_call *call, const struct flow_table *t, size_t rims, size_t own,
                       size_t end)
{
    enum { ROWS = 2 }; /* a cache line */
    for (; own < end; own++)
        for (uint32_t i = 0; i < t->n_rim; i += ROWS)
            phys_fetch(duite_out(call, own, phys_vec) + i, 0, 1);
    for (uint32_t s = 0; s < t->n_slots; s++) {
        const phys_vec *x = duite_in(call, rims + s, phys_vec);
        const phys_vec *v = duite_in(call, rims + t->n_slots + s, phys_vec);
        for (uint32_t i = t->copies[s]; i < t->copies[s + 1]; i++) {
            phys_fetch(x + t->copy[i], 0, 0);
            phys_fetch(v + t->copy[i], 0, 0);
        }
    }
}

/* ---- Either Euler ---- */

/* Where a step begins is parameters 1 and 2; what it makes is parameters `to`, to + 1, after which
 * come the rims, the status and the neighbours' rims. */
static int euler_to(const duite_call *call, size_t to, size_t rims)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const bool ahead = flow_of(call)->model->integrator == MODEL_SYMPLECTIC_EULER;
    phys_vec *x = duite_out(call, to, phys_vec), *v = duite_out(call, to + 1, phys_vec);
    phys_vec *f = flow_force_room(call);
    fetch_rims(call, t, rims + 3, rims, rims + 2);
    flow_forces(call, t, rims + 3, f);
    flow_part_ends(call, FLOW_FORCE);
    const int well = phys_euler(t->n, flow_args_of(call)->h, ahead, FLOW_BOUND, t->mass, t->free, f,
                                duite_in(call, 1, phys_vec), duite_in(call, 2, phys_vec), x, v);
    flow_write_rim(t, x, duite_out(call, rims, phys_vec));
    flow_write_rim(t, v, duite_out(call, rims + 1, phys_vec));
    if (well)
        return 0;
    const int code = flow_check(call, t, ahead ? v : x, ahead ? "velocity" : "position", rims + 2);
    return code ? code
                : flow_check(call, t, ahead ? x : v, ahead ? "position" : "velocity", rims + 2);
}

static int euler(const duite_call *call)
{
    return euler_to(call, 1, 3);
}
FLOW_TIMED(euler, FLOW_VELOCITY)
const duite_kernel flow_euler = {
    .name = "euler",
    .body = euler_timed,
    .access = {DUITE_R, DUITE_RW, DUITE_RW, DUITE_W, DUITE_W, DUITE_CW},
    .variadic = DUITE_R,
    .args_size = ARGS};

static int beside(const duite_call *call)
{
    return euler_to(call, 3, 5);
}
FLOW_TIMED(beside, FLOW_VELOCITY)
const duite_kernel flow_euler_beside = {
    .name = "euler_beside",
    .body = beside_timed,
    .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_W, DUITE_W, DUITE_W, DUITE_W, DUITE_CW},
    .variadic = DUITE_R,
    .args_size = ARGS};

/* ---- Velocity Verlet ---- */

/* v becomes a guess of the velocity at the end of the step, for forces that depend on it. */
static int verlet_first(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const double h = flow_args_of(call)->h, half = 0.5 * h;
    phys_vec *x = duite_out(call, 1, phys_vec), *v = duite_out(call, 2, phys_vec);
    const phys_vec *f = duite_in(call, 3, phys_vec);
    phys_vec *middle = duite_out(call, 4, phys_vec);
    phys_kick(t->n, half, 1, t->mass, t->drag, t->free, f, v, middle);
    flow_guides_keep(call, t, v, middle);
    phys_kick(t->n, half, 0, t->mass, t->drag, t->free, f, middle, v);
    flow_guides_keep(call, t, middle, v);
    flow_write_rim(t, v, duite_out(call, 6, phys_vec));
    flow_part_ends(call, FLOW_VELOCITY);
    phys_advance(t->n, h, middle, x);
    flow_write_rim(t, x, duite_out(call, 5, phys_vec));
    return flow_check(call, t, x, "position", 7);
}
FLOW_TIMED(verlet_first, FLOW_POSITION)
const duite_kernel flow_verlet_first = {
    .name = "verlet_first",
    .body = verlet_first_timed,
    .access = {DUITE_R, DUITE_RW, DUITE_RW, DUITE_R, DUITE_W, DUITE_W, DUITE_W, DUITE_CW},
    .args_size = ARGS};

static int verlet_second(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const phys_vec *middle = duite_in(call, 4, phys_vec);
    phys_vec *v = duite_out(call, 2, phys_vec), *f = duite_out(call, 3, phys_vec);
    fetch_rims(call, t, 7, 5, 6);
    flow_forces_free(call, t, 7, f);
    flow_part_ends(call, FLOW_FORCE);
    phys_kick(t->n, 0.5 * flow_args_of(call)->h, 0, t->mass, t->drag, t->free, f, middle, v);
    flow_guides_keep(call, t, middle, v);
    flow_write_rim(t, v, duite_out(call, 5, phys_vec));
    return flow_check(call, t, v, "velocity", 6);
}
FLOW_TIMED(verlet_second, FLOW_VELOCITY)
const duite_kernel flow_verlet_second = {
    .name = "verlet_second",
    .body = verlet_second_timed,
    .access = {DUITE_R, DUITE_R, DUITE_RW, DUITE_W, DUITE_R, DUITE_W, DUITE_CW},
    .variadic = DUITE_R,
    .args_size = ARGS};

/* ---- Runge-Kutta ---- */

static int stage(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    phys_vec *x = duite_out(call, 1, phys_vec), *v = duite_out(call, 2, phys_vec);
    phys_vec *a = flow_force_room(call);
    const struct phys_runge runge = {
        .x0 = duite_out(call, 3, phys_vec),
        .v0 = duite_out(call, 4, phys_vec),
        .sum_x = duite_out(call, 5, phys_vec),
        .sum_v = duite_out(call, 6, phys_vec),
    };
    fetch_rims(call, t, 10, 7, 9);
    flow_forces(call, t, 10, a);
    flow_part_ends(call, FLOW_FORCE);
    phys_accelerate(t->n, t->mass, t->free, a);
    flow_guides_filter(call, t, a);
    flow_part_ends(call, FLOW_ACCELERATION);
    phys_runge_stage(t->n, flow_args_of(call)->h, (int)flow_args_of(call)->stage, a, &runge, x, v);
    flow_write_rim(t, x, duite_out(call, 7, phys_vec));
    flow_write_rim(t, v, duite_out(call, 8, phys_vec));
    const int code = flow_check(call, t, x, "position", 9);
    return code ? code : flow_check(call, t, v, "velocity", 9);
}
FLOW_TIMED(stage, FLOW_POSITION)
const duite_kernel flow_runge = {.name = "runge",
                                 .body = stage_timed,
                                 .access = {DUITE_R, DUITE_RW, DUITE_RW, DUITE_RW, DUITE_RW,
                                            DUITE_RW, DUITE_RW, DUITE_W, DUITE_W, DUITE_CW},
                                 .variadic = DUITE_R,
                                 .args_size = ARGS};
