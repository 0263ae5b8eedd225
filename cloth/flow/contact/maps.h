#ifndef CLOTH_FLOW_CONTACT_MAPS_H
#define CLOTH_FLOW_CONTACT_MAPS_H

#include "cloth/flow/state/state.h"

#include "cloth/contact/image.h"

/* Maps of the bodies that are met by maps (cloth/contact/image.h), in the field `maps`. Each of the
 * first blocks has a strip of every map, in the order of the obstacles. Every rank draws all
 * strips, so maps are never sent. A kernel that meets obstacles declares ALL(maps). */

/* The number of blocks with strips, and the bytes of a block's; 0: no body is met by maps.
 * Local. */
uint32_t flow_map_strips(const struct flow *flow);
size_t flow_map_bytes(const struct flow *flow, uint32_t block);

/* In a body: the maps of an obstacle; zero for one without maps. maps: the body's ALL(maps). */
void flow_map_open(const struct flow *flow, uint32_t obstacle, const duite_param *maps,
                   struct contact_image *image);

/* Forks the drawing of the maps, if bodies (contact_bodies_move) have changed. from: s, the begin
 * of the step that ends now. Collective; returns what the runtime does. */
int flow_maps_draw(struct flow_state *state, double from);

#endif
