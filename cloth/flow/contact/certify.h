#ifndef CLOTH_FLOW_CONTACT_CERTIFY_H
#define CLOTH_FLOW_CONTACT_CERTIFY_H

#include "cloth/flow/state/state.h"

/* Certified contact, as a step uses it. Collective unless they say local; they return the runtime's
 * code. */

/* Finds the contacts of a run's start. FLOW_TANGLED, with the reason, where cloth touches. */
int flow_contact_start(struct flow_state *state);
/* Gives the solve of the step under way the contacts that the step begins with. */
int flow_contact_begin(struct flow_state *state);
/* When x and v are moved: certifies the step, solves it again or cuts it, and finds the contacts of
 * the next one. */
int flow_contact_settle(struct flow_state *state);
/* True if no shorter step is possible: contact that cuts too much of the step then ends the run.
 * Local. */
bool flow_contact_is_last(const struct flow_state *state);
/* The first adds the cost of the step's other solves, and the number of vertices cut, to its
 * status. The second is told if the step was accepted or given up. Local. */
void flow_contact_status(const struct flow_state *state, double status[FLOW_STATUS]);
void flow_contact_settled(struct flow_state *state, bool accepted);

/* Memory, a part of flow_memory_take; objects that are no fields. */
void flow_contact_take(struct flow_state *state);
void flow_contact_free(struct flow_state *state);
int flow_contact_free_objects(struct flow_state *state);

#endif
