#ifndef CLOTH_APP_RUN_START_H
#define CLOTH_APP_RUN_START_H

#include "cloth/flow/run.h"
#include "cloth/untangle/untangle.h"

/* The start of a run with certified contact: nothing may go through anything. Local, on rank 0,
 * which alone has meshes and starts; so results cannot depend on ranks. */

/* Moves the cloths apart if the model asks for it. If anything moved, the model has other starts
 * and *flow is prepared again. says: progress goes to standard error. result: all 0 if the model
 * does not ask. Errors: CLOTH_E_INPUT if cloths cannot be untangled, with the first pairs; of
 * untangle, flow_prepare. */
int start_untangle(struct model *model, struct flow **flow, int ranks, bool says,
                   struct untangle_result *result, struct cloth_error *error);

/* CLOTH_E_INPUT for a start that is not free, the first pairs named. apart: pairs that do not meet.
 */
int start_check(const struct model *model, const struct flow *flow,
                const struct contact_apart *apart, const char *scene, struct cloth_error *error);

#endif
