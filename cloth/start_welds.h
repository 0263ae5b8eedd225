#ifndef CLOTH_START_WELDS_H
#define CLOTH_START_WELDS_H

#include "cloth/flow/run.h"

/* Of a run whose contact is certified and whose seams are welded: that partners, on their straight
 * way from where they come from to where they are welded, go through nothing. Without it a weld
 * could pull seams through what lies between them, though the state before and the one after are
 * both free. Runs that untangle their start move cloth anyway and are not asked. apart: what does
 * not meet. Errors: CLOTH_E_INPUT with the first vertices where it is not proven; CLOTH_E_MEMORY.
 * Local, on rank 0 when the flow is prepared. */
int start_welds(const struct model *model, const struct flow *flow,
                const struct contact_apart *apart, const char *scene, struct cloth_error *error);

#endif
