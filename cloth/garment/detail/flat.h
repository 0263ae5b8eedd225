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

/* The centre of the circle through a triangle's corners. */
void flat_centre(const struct delaunay *plane, uint32_t triangle, double centre[2]);

/* Improves triangles that have an angle below the aim. Moves, adds and takes out vertices nearby,
 * and keeps a change that makes the worst of them better. sharp: of the boundary's vertices. */
void flat_improve(struct delaunay *plane, const unsigned char *sharp);

/* True if a triangle is not to be blamed: one of its vertices is sharp. */
bool flat_excused(const struct delaunay *plane, const unsigned char *sharp, uint32_t triangle);

/* Lists the vertices (double[2]) of equilateral triangles of a given edge length that are inside a
 * closed loop of n places, and not nearer to it than a part of that length: row by row, every other
 * one from right to left. Errors: CLOTH_E_INPUT for more than 2^28 places in the loop's box,
 * CLOTH_E_MEMORY. Local. */
int garment_lattice(uint32_t n, const double (*loop)[2], double edge, struct cloth_list *places,
                    struct cloth_error *error);

#endif
