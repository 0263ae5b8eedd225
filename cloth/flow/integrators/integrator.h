#ifndef CLOTH_FLOW_INTEGRATORS_INTEGRATOR_H
#define CLOTH_FLOW_INTEGRATORS_INTEGRATOR_H

#include "cloth/flow/tasks.h"

/* An integrator: its part of a step. A new one is a file and a row of flow_integrators. */
struct flow_integrator {
    /* Forks what of a step leaves x and v as they are; NULL: nothing. */
    int (*begin)(struct flow_state *state);
    /* Forks the rest, which ends with the new x and v and their rims; contact comes after it. */
    int (*end)(struct flow_state *state);
};

/* By enum model_integrator. */
extern const struct flow_integrator flow_integrators[];

/* Both ends of a step by implicit Euler or BDF2 (implicit.c), and by an explicit integrator
 * (explicit.c). They return what the runtime does. */
int flow_implicit_euler_begin(struct flow_state *state);
int flow_implicit_euler_end(struct flow_state *state);
int flow_bdf2_end(struct flow_state *state);
int flow_explicit_euler_end(struct flow_state *state);
int flow_verlet_begin(struct flow_state *state);
int flow_verlet_end(struct flow_state *state);
int flow_runge_end(struct flow_state *state);

#endif
