#ifndef CLOTH_FLOW_OBSERVE_OBSERVE_H
#define CLOTH_FLOW_OBSERVE_OBSERVE_H

#include "cloth/flow/state/state.h"

/* The observation of a run: nothing here changes the state. Collective; they return what the
 * runtime does. */

/* Forks the watching of the state at the end of the step under way, or at the start. */
int flow_watch(struct flow_state *state);
/* Forks the force of contact in the step that was accepted last, if anything reports it; before the
 * next step begins. */
int flow_contact_watch(struct flow_state *state);
/* Forks its row of the table of probes. */
int flow_probes_row(struct flow_state *state);
/* The first forks the distances between partners of pulled seams at the end of the step under way,
 * or at the start. The second takes them into the report when the step is accepted. Without pulled
 * seams they do nothing. */
int flow_seams_fork(struct flow_state *state);
int flow_seams_find(struct flow_state *state);
/* FLOW_UNSEWN, with the reason: which seams are open most. */
int flow_seams_fail(struct flow_state *state);
/* Reports the watched values if probes are wanted, and finds if the run rests; when the step is
 * accepted, and for the start. */
int flow_watched(struct flow_state *state);
/* Forks the frames whose nearest step end is known. The last step, accepted, went from tick `from`
 * to grid.now. */
int flow_frames(struct flow_state *state, uint64_t from);
/* Forks a frame of the state at grid.now, where the run ends, unless the last frame shows it. */
int flow_frame_last(struct flow_state *state);

/* Forks the task that hands the last step's system to the program. */
int flow_system(struct flow_state *state);

/* Fills the parts of the report that need the whole state, when no task runs. */
int flow_finish(struct flow_state *state);
/* The number of frames written, from rank 0 to all. */
int flow_last_frame(struct flow_state *state);

/* Forks the search of the largest stretch of the current positions. */
int flow_stretch_fork(struct flow_state *state);
/* Gets the stretch found. */
int flow_stretch_get(struct flow_state *state, double *stretch);

#endif
