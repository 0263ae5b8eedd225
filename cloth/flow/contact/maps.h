#ifndef CLOTH_FLOW_CONTACT_MAPS_H
#define CLOTH_FLOW_CONTACT_MAPS_H

#include "cloth/flow/state/state.h"

#include "cloth/contact/image.h"

/* Maps of the bodies that are met by maps (cloth/contact/image.h), in the field `maps`. Each of the
 * first blocks has a strip of every map, in the order of the obstacles. Every rank draws all
 * strips, so maps are never sent. A kernel that meets obstacles declares ALL(maps). */

/* How many blocks have strips, and bytes of them; 0: no body is met by maps. Local. */
uint32_t flow_map_strips(const struct flow *flow);
size_t flow_map_bytes(const struct flow *flow, uint32_t block);

/* In a body: the maps of an obstacle; zero for one that is not met by any. maps: what the body has
 * of ALL(maps). */
void flow_map_open(const struct flow *flow, uint32_t obstacle, const duite_param *maps,
                   struct contact_image *image);

/* Forks what draws them as the bodies are now (contact_bodies_move), unless they are as they were.
 * from: s, when the step begins whose end that is. Collective; returns what the runtime does. */
int flow_maps_draw(struct flow_state *state, double from);

#endif
