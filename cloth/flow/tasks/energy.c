/* Energies are of the state that the tasks forked so far leave, and change nothing of it. */
#include "cloth/flow/tasks/tasks.h"

#include <math.h>
#include <stddef.h>

/* By symplectic Euler x moved with v: it is the velocity half a step before. With that at x the
 * energy is off by the square of h only. */
static int fork_level(struct flow_state *state, struct flow_args args)
{
    const int code =
        flow_fork_all(state, &flow_force, args, FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(f)),
                      FLOW_NOTHING, FLOW_RIM(rim_x), FLOW_RIM(rim_v));
    return code ? code
                : flow_fork_all(state, &flow_level, args, FLOW_OBJECTS(FLOW_AT(v), FLOW_AT(f)),
                                FLOW_NOTHING, FLOW_NO_RIM, FLOW_NO_RIM);
}

int flow_energies(struct flow_state *state, struct flow_args args, duite_object sums)
{
    const bool apart = state->flow->model->integrator == MODEL_SYMPLECTIC_EULER;
    int code = duite_set(state->rt, sums, NULL);
    if (!code && apart)
        code = fork_level(state, args);
    for (args.block = 0; args.block < state->flow->tables.n_blocks && !code; args.block++) {
        const struct flow_objects *o = state->block + args.block;
        code = flow_fork(state, &flow_energy, &args, 3,
                         (duite_object[]){o->x, apart ? o->f : o->v, sums}, FLOW_RIM(rim_x),
                         FLOW_NO_RIM);
    }
    return code;
}
