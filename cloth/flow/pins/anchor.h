#ifndef CLOTH_FLOW_PINS_ANCHOR_H
#define CLOTH_FLOW_PINS_ANCHOR_H

#include "cloth/model/model.h"

/* A vertex that follows a body with frames: a point of a triangle of the body, and where the vertex
 * is from there in the triangle's own axes. Both go with the triangle. */
struct flow_anchor {
    uint32_t obstacle, corner[3]; /* that is the body; vertices of it */
    double weight[3], offset[3];  /* sum 1; m */
};

/* Finds the anchor of a vertex at x (m) when a run starts. It is the nearest point of the body, of
 * equals that of the first facet. place: the body's vertices at the start, by flow_anchor_places.
 * Local. */
void flow_anchor_places(const struct model *model, uint32_t obstacle, phys_vec *place);
void flow_anchor_find(const struct model *model, uint32_t obstacle, const phys_vec *place,
                      const phys_vec *x, struct flow_anchor *anchor);

/* The place of the vertex at a time, s. Local. */
void flow_anchor_place(const struct model *model, const struct flow_anchor *anchor, double time,
                       phys_vec *to);

#endif
