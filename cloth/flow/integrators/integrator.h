#ifndef CLOTH_FLOW_INTEGRATORS_INTEGRATOR_H
#define CLOTH_FLOW_INTEGRATORS_INTEGRATOR_H

#include "cloth/flow/state/state.h"

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

/* ---- Of explicit steps ---- */

/* Whether its explicit steps leave the state before them as what is kept; then, what makes that the
 * state again. */
bool flow_explicit_keeps(const struct model *model);
void flow_explicit_restore(struct flow_state *state);

/* ---- Of implicit steps ---- */

/* Whether the step under way is by BDF2, and not by implicit Euler as the first one is. */
bool flow_implicit_is_second(const struct flow_state *state);
/* When the status of a step is known: adds what its Newton steps noted. Then, when it is accepted
 * or not: what the next step may build on, and the report. */
void flow_implicit_status(const struct flow_state *state, double status[FLOW_STATUS]);
void flow_implicit_settle(struct flow_state *state, bool accepted,
                          const double status[FLOW_STATUS]);

#endif
