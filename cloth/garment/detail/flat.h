#ifndef CLOTH_GARMENT_DETAIL_FLAT_H
#define CLOTH_GARMENT_DETAIL_FLAT_H

#include "cloth/garment/detail/delaunay.h"

/* The mesh of one panel in its plane. */

/* A closed loop of places, counterclockwise, each as far from the next as the mesh is to be fine
 * there. */
struct flat_loop {
    uint32_t n;
    const double (*place)[2];   /* m */
    const unsigned char *sharp; /* a place: whether the mesher is not to be blamed for the angles of
                                 * triangles that have this vertex */
};

/* Fills the loop with triangles whose edges are about `edge` m long. Vertex i < loop->n is place i
 * of it, and no edge of the loop is divided. delaunay_free frees the plane, also after an error.
 * *crossing: where the loop cannot be the boundary, since its edge from that place meets another;
 * DELAUNAY_NONE otherwise. Errors: CLOTH_E_INPUT for that and for edges that are too short,
 * CLOTH_E_MEMORY. Local. */
int flat_make(struct delaunay *plane, const struct flat_loop *loop, double edge, uint32_t *crossing,
              struct cloth_error *error);

/* Moves the inner vertices near the boundary to the middle of their neighbours, some times. */
void flat_smooth(struct delaunay *plane, struct cloth_error *error);

/* Adds inner vertices where a triangle is poor, that is, has an angle below 20 degrees: from a fine
 * boundary on triangles become larger step by step. Returns whether any was poor; if none was, it
 * changes nothing. sharp: of the boundary's vertices. */
bool flat_refine(struct delaunay *plane, const unsigned char *sharp);

/* The centre of the circle through a triangle's corners. */
void flat_centre(const struct delaunay *plane, uint32_t triangle, double centre[2]);

/* Makes triangles better that have an angle below what the aim is: moves, adds and takes out
 * vertices nearby, and keeps what makes the worst of them better. sharp: of the boundary's
 * vertices. */
void flat_improve(struct delaunay *plane, const unsigned char *sharp);

/* Whether a triangle is not to be blamed: one of its vertices is sharp. */
bool flat_excused(const struct delaunay *plane, uint32_t n_sharp, const unsigned char *sharp,
                  uint32_t triangle);

#endif
