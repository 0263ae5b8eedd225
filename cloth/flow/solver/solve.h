#ifndef CLOTH_FLOW_SOLVER_SOLVE_H
#define CLOTH_FLOW_SOLVER_SOLVE_H

#include "cloth/flow/state/state.h"

/* The system of a step and its solve, as a step forks them. Collective unless they say local; they
 * return the runtime's code. */

/* Forks the system of an implicit Euler step, linearised at its begin: right side f, matrix a. */
int flow_assemble(struct flow_state *state);
/* Records a round of the solve: when objects are made, and when ties need another. */
int flow_cg_record(struct flow_state *state);
/* Fork the begin of a solve for dv, which reads f and a; its iterations; both, without a guess. */
int flow_cg_start(struct flow_state *state);
int flow_cg_iterate(struct flow_state *state);
int flow_cg(struct flow_state *state);

/* The halos that a solve reads. The first takes their memory, a part of flow_memory_take. The
 * second finds the objects and makes packed halos, when the other objects are made; the next get
 * returns a failure. The last forks the tasks that pack a block's packed halos, for even passes (0)
 * or odd ones (1). */
void flow_halo_take(struct flow_state *state);
void flow_halo_make(struct flow_state *state); /* flow_run_begin does */
int flow_halo_pack(struct flow_state *state, uint32_t block, int to);

/* The preconditioner of a run (pattern.c): its parts and patches; then, on all ranks, that and the
 * pattern of the coarse factor, if there is one, in memory of the flow. The last frees it. The
 * first and the last are local. */
void flow_preconditioner_choose(struct flow *flow, uint32_t n_blocks);
int flow_preconditioner_prepare(struct flow_state *state);
void flow_preconditioner_free(struct flow *flow);
/* Forks the coarse space, if there is one: once a run, or in each step if the solve is filtered. */
int flow_coarse_initialise(struct flow_state *state);

#endif
