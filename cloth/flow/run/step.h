#ifndef CLOTH_FLOW_RUN_STEP_H
#define CLOTH_FLOW_RUN_STEP_H

#include "cloth/flow/state/state.h"

/* A step: its stages and its settling. Collective; they return what the runtime does. */

/* Arguments of tasks of the step under way. */
struct flow_step_args flow_attempt_args(const struct flow_state *state);
/* True if no shorter step is possible: what fails in it ends the run. Local. */
static inline bool flow_attempt_is_last(const struct flow_state *state)
{
    return state->attempt.length == 1 || !state->flow->model->halving;
}
/* Steps are judged by their stretch. */
static inline bool flow_is_judged(const struct model *model)
{
    return model->stretch_growth > 0 || model->stretch_limit > 0;
}
/* Fork the stages of the step under way (step.c): its begin, which leaves x and v as they are,
 * unless velocities change before the forces; the rest. */
int flow_step_begin(struct flow_state *state);
int flow_step_end(struct flow_state *state);
/* Forks the stages of the step under way, from the restored state, up to the one that certifies
 * it. */
int flow_step_again(struct flow_state *state);
/* True if velocities change before the forces: such a step waits until the one before it is
 * accepted. */
bool flow_step_is_driven(const struct model *model);
/* Forks a whole step of length h, which is not judged and whose solve has no guess. */
int flow_step(struct flow_state *state);
/* All steps from the start on, with their frames; ends early if a stop was agreed. */
int flow_steps(struct flow_state *state);
/* True if this rank is asked to stop. Local. */
bool flow_stop_is_asked(const struct flow *flow);
/* Forks the tasks that note in the step's status if a rank is asked to stop. */
int flow_status_fork(struct flow_state *state);

/* Forks the tasks that give springs and elements their shape at rest at the end of the step under
 * way (elements/resize.c). */
int flow_resize(struct flow_state *state);

/* Fork the tasks that move the pins of a step: before its forces, and after x has moved. */
int flow_pins_prescribe_velocity(struct flow_state *state);
int flow_pins_prescribe_position(struct flow_state *state);

/* Forks the velocity correction of the step under way, whose positions and velocities are there
 * (correct.c). The first call records its round. */
int flow_correct(struct flow_state *state);

/* Fork the filter of rows in the solve (contact/project.c). The first makes it from x and v. The
 * second puts it on the right side and in the matrix. */
int flow_contact_filter(struct flow_state *state, struct flow_step_args args);
int flow_contact_constrain(struct flow_state *state);

#endif
