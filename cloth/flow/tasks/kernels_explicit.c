/* Stages of explicit steps (cloth/physics/stage.h). A body writes the rows of its own block only;
 * whoever moves a row writes the rim that neighbours read. */
#include "cloth/flow/tasks/guides.h"

#include "cloth/physics/stage.h"

#define ARGS sizeof(struct flow_args)

/* A step by either Euler, of the forces: x by the old v, or by the new one. */
static int move(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const bool ahead = flow_of(call)->model->integrator == MODEL_SYMPLECTIC_EULER;
    phys_vec *x = duite_out(call, 2, phys_vec), *v = duite_out(call, 3, phys_vec);
    const int well = phys_euler(t->n, flow_args_of(call)->h, ahead, FLOW_BOUND, t->mass, t->free,
                                duite_in(call, 1, phys_vec), x, v);
    flow_write_rim(t, x, duite_out(call, 4, phys_vec));
    flow_write_rim(t, v, duite_out(call, 5, phys_vec));
    if (well)
        return 0;
    const int code = flow_check(call, t, ahead ? v : x, ahead ? "velocity" : "position", 6);
    return code ? code : flow_check(call, t, ahead ? x : v, ahead ? "position" : "velocity", 6);
}
FLOW_TIMED(move, FLOW_VELOCITY)
const duite_kernel flow_move = {
    .name = "move",
    .body = move_timed,
    .access = {DUITE_R, DUITE_R, DUITE_RW, DUITE_RW, DUITE_W, DUITE_W, DUITE_CW},
    .args_size = ARGS};

/* v becomes a guess of the velocity at the end of the step, for forces that depend on it. */
static int kick_first(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const double half = 0.5 * flow_args_of(call)->h;
    const phys_vec *f = duite_in(call, 1, phys_vec);
    phys_vec *v = duite_out(call, 2, phys_vec), *middle = duite_out(call, 4, phys_vec);
    phys_kick(t->n, half, 1, t->mass, t->drag, t->free, f, v, middle);
    flow_guides_keep(call, t, v, middle);
    phys_kick(t->n, half, 0, t->mass, t->drag, t->free, f, middle, v);
    flow_guides_keep(call, t, middle, v);
    flow_write_rim(t, v, duite_out(call, 3, phys_vec));
    return 0;
}
FLOW_TIMED(kick_first, FLOW_VELOCITY)
const duite_kernel flow_kick_first = {.name = "kick_first",
                                      .body = kick_first_timed,
                                      .access = {DUITE_R, DUITE_R, DUITE_RW, DUITE_W, DUITE_W},
                                      .args_size = ARGS};

static int kick_second(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const phys_vec *middle = duite_in(call, 2, phys_vec);
    phys_vec *v = duite_out(call, 3, phys_vec);
    phys_kick(t->n, 0.5 * flow_args_of(call)->h, 0, t->mass, t->drag, t->free,
              duite_in(call, 1, phys_vec), middle, v);
    flow_guides_keep(call, t, middle, v);
    flow_write_rim(t, v, duite_out(call, 4, phys_vec));
    return flow_check(call, t, v, "velocity", 5);
}
FLOW_TIMED(kick_second, FLOW_VELOCITY)
const duite_kernel flow_kick_second = {
    .name = "kick_second",
    .body = kick_second_timed,
    .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_W, DUITE_W, DUITE_CW},
    .args_size = ARGS};

static int stage(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    phys_vec *x = duite_out(call, 2, phys_vec), *v = duite_out(call, 3, phys_vec);
    const struct phys_runge runge = {
        .x0 = duite_out(call, 4, phys_vec),
        .v0 = duite_out(call, 5, phys_vec),
        .sum_x = duite_out(call, 6, phys_vec),
        .sum_v = duite_out(call, 7, phys_vec),
    };
    phys_runge_stage(t->n, flow_args_of(call)->h, (int)flow_args_of(call)->stage,
                     duite_in(call, 1, phys_vec), &runge, x, v);
    flow_write_rim(t, x, duite_out(call, 8, phys_vec));
    flow_write_rim(t, v, duite_out(call, 9, phys_vec));
    const int code = flow_check(call, t, x, "position", 10);
    return code ? code : flow_check(call, t, v, "velocity", 10);
}
FLOW_TIMED(stage, FLOW_POSITION)
const duite_kernel flow_runge = {.name = "runge",
                                 .body = stage_timed,
                                 .access = {DUITE_R, DUITE_R, DUITE_RW, DUITE_RW, DUITE_RW,
                                            DUITE_RW, DUITE_RW, DUITE_RW, DUITE_W, DUITE_W,
                                            DUITE_CW},
                                 .args_size = ARGS};
