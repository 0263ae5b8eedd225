#ifndef CLOTH_FLOW_OBSERVE_OBSERVE_H
#define CLOTH_FLOW_OBSERVE_OBSERVE_H

#include "cloth/flow/state/state.h"

/* The observation of a run: nothing here changes the state. Collective; they return what the
 * runtime does. */

/* Forks what is watched of the state at the end of the step under way, or at the start. */
int flow_watch(struct flow_state *state);
/* Forks the force of contact in the step that was accepted last, where anything reports it; before
 * the next step begins. */
int flow_contact_watch(struct flow_state *state);
/* Forks its row of the table of probes. */
int flow_probes_row(struct flow_state *state);
/* Forks how far partners of pulled seams are from each other at the end of the step under way, or
 * at the start; takes what it found, when the step is accepted, into the report. Nothing where no
 * seams are pulled. */
int flow_seams_fork(struct flow_state *state);
int flow_seams_find(struct flow_state *state);
/* FLOW_UNSEWN, with the reason: which seams are open most. */
int flow_seams_fail(struct flow_state *state);
/* The same if probes are wanted, and finds whether the run rests: when the step is accepted,
 * and for the start. */
int flow_watched(struct flow_state *state);
/* Forks the frames whose nearest end of a step is known: the last step, accepted, went from tick
 * `from` to grid.now. */
int flow_frames(struct flow_state *state, uint64_t from);
/* Forks a frame of the state at grid.now, where the run ends, unless the last frame shows it. */
int flow_frame_last(struct flow_state *state);

/* Doubles that a block says of its system; forks what hands the system of the last step to the
 * program. */
size_t flow_system_doubles(const struct flow_table *table, size_t room);
int flow_system(struct flow_state *state);

/* Fills the parts of the report that need the whole state, when no task runs. */
int flow_finish(struct flow_state *state);
/* The number of frames written, from rank 0 to all. */
int flow_last_frame(struct flow_state *state);

/* Forks what finds the largest stretch of the current positions. */
int flow_stretch_fork(struct flow_state *state);
/* What it found. */
int flow_stretch_get(struct flow_state *state, double *stretch);

#endif
