#ifndef CLOTH_FLOW_CONTACT_IMAGE_H
#define CLOTH_FLOW_CONTACT_IMAGE_H

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

/* The work of the mode project when x and v have moved. Bodies with frames move in the first, which
 * returns when the step began, s: tasks of the step before are done, since it has been settled. The
 * second forks the tasks that put vertices out of obstacles. (project.c) */
double flow_project_move(struct flow_state *state);
int flow_project(struct flow_state *state);

#endif
