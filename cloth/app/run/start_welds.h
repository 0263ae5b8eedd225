#ifndef CLOTH_APP_RUN_START_WELDS_H
#define CLOTH_APP_RUN_START_WELDS_H

#include "cloth/flow/run.h"

/* Proves, for a run with certified contact and welded seams, that partners go through nothing on
 * the straight way to their weld. Otherwise a weld could pull seams through cloth or obstacles
 * between them, though the states before and after are both free. Runs that untangle their start
 * move cloth anyway and are not checked. apart: pairs that do not meet. Errors: CLOTH_E_INPUT with
 * the first vertices where it is not proven; CLOTH_E_MEMORY. Local, on rank 0 when the flow is
 * prepared. */
int start_welds(const struct model *model, const struct flow *flow,
                const struct contact_apart *apart, const char *scene, struct cloth_error *error);

#endif
