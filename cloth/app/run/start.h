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

/* With certified contact: finds that nothing goes through anything, where the run starts and in
 * frame 0, which is in floats, nor welded partners on the straight way to their weld, by
 * start_welds. apart: pairs that do not meet. Errors: CLOTH_E_INPUT, the first pairs or vertices
 * named; CLOTH_E_MEMORY. */
int start_check(const struct model *model, const struct flow *flow,
                const struct contact_apart *apart, const char *scene, struct cloth_error *error);

/* Proves, for welded seams, that partners go through nothing on their way. Otherwise a weld could
 * pull seams through cloth or obstacles between them, though the states before and after are both
 * free. Runs that untangle their start move cloth anyway and are not checked. Errors as above. */
int start_welds(const struct model *model, const struct flow *flow,
                const struct contact_apart *apart, const char *scene, struct cloth_error *error);

#endif
