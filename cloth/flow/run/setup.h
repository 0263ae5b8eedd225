#ifndef CLOTH_FLOW_RUN_SETUP_H
#define CLOTH_FLOW_RUN_SETUP_H

#include "cloth/flow/state/state.h"

/* Takes a run from a source on rank 0 to its first task. */

/* Fills flow->warning; on rank 0, which makes the source. Errors: CLOTH_E_MEMORY. Local. */
int flow_warn(struct flow *flow, struct cloth_error *error);
/* Says a warning, the place before it unless that is NULL; if there is one of the kind, it stays.
 */
void flow_warn_say(struct flow *flow, int kind, const char *place, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Functions of the main program. Collective. They return 0 or what duite returned, which flow_run
 * turns into a sentence. */
/* Takes all steps below: the run is ready for its first task. End it as flow_run does. */
int flow_run_begin(struct flow_state *state);
/* Gives all ranks an object of so many bytes, which a kernel with one GIVEN_W writes on rank 0. */
int flow_broadcast(struct flow_state *state, const struct flow_kernel *kernel, size_t bytes,
                   void *received);
/* Broadcasts the sizes for all later ones (struct flow_head). */
int flow_share_head(struct flow_state *state);
/* Broadcasts the shapes of all blocks; fills flow->tables. */
int flow_share(struct flow_state *state);
/* Brings the tables, made one by one on rank 0, to the ranks that keep their blocks. Objects are
 * made. Rank 0 has freed its source then. */
int flow_distribute(struct flow_state *state);

/* Vertices whose positions or velocities are hashed at once. */
uint32_t flow_hash_part(const struct flow *flow);

/* Takes all memory that a run needs besides its objects. If one rank lacks it, all return
 * FLOW_NO_MEMORY and none has begun. Free it in either case. */
int flow_memory_take(struct flow_state *state);
int flow_memory_agree(struct flow_state *state); /* the same for memory taken since */
void flow_memory_free(struct flow_state *state);

#endif
