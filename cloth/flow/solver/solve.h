#ifndef CLOTH_FLOW_SOLVER_SOLVE_H
#define CLOTH_FLOW_SOLVER_SOLVE_H

#include "cloth/flow/state/state.h"

/* The system of a step and its solve, as a step forks them. Collective, but for what is local;
 * they return what the runtime does. */

/* Forks what makes the system of a step of implicit Euler, linearised where it begins: its right
 * side f, its matrix a. */
int flow_assemble(struct flow_state *state);
/* Records a round of the solve: when objects are made, and when ties ask for another. */
int flow_cg_record(struct flow_state *state);
/* Forks what a solve for dv begins with, which reads f and a; then its iterations; both, without a
 * guess. */
int flow_cg_start(struct flow_state *state);
int flow_cg_iterate(struct flow_state *state);
int flow_cg(struct flow_state *state);

/* What a solve reads of neighbours. The first two take and free its memory, as parts of
 * flow_memory_take and flow_memory_free. The third finds the objects and makes packed halos, when
 * the other objects are made; the next get returns a failure. The last forks the tasks that pack
 * the packed halos of a block, for even passes (0) or odd ones (1). */
void flow_halo_take(struct flow_state *state);
void flow_halo_free(struct flow_state *state);
void flow_halo_make(struct flow_state *state); /* flow_run_begin does */
int flow_halo_pack(struct flow_state *state, uint32_t block, int to);

/* Decides on the preconditioner of a run, the model's, and on patches. Local. */
void flow_preconditioner_choose(struct flow *flow, uint32_t n_blocks);
/* That once more on all ranks, and the pattern of the coarse factor, if there is one. */
int flow_preconditioner_prepare(struct flow_state *state);
/* Local. */
void flow_preconditioner_free(struct flow *flow);
/* Forks what the coarse space is, if there is one: once a run, or where the solve is filtered in
 * each step. */
int flow_coarse_initialise(struct flow_state *state);

#endif
