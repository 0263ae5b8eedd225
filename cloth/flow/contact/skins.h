#ifndef CLOTH_FLOW_CONTACT_SKINS_H
#define CLOTH_FLOW_CONTACT_SKINS_H

#include "cloth/flow/state/state.h"

/* The skins of all blocks in a step (cloth/flow/contact/skin.h), of runs that find contacts.
 * Functions of the main program. Collective; they return what the runtime does. */

/* Forks the keeping of the halos of x, beside flow_keep: kept_halo_x becomes halo_x. */
int flow_skins_keep(struct flow_state *state);

/* Forks the tasks that make `skin_x`, the present x of the points, twice, and `skin_boxes` of
 * them. */
int flow_skins_place(struct flow_state *state);

/* Forks the tasks that make `skin_x`, first kept_x and then x of each block's skin points, and
 * `skin_boxes`, the boxes of the way between (contact_refit). */
int flow_skins_refit(struct flow_state *state);

#endif
