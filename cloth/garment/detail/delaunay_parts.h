#ifndef CLOTH_GARMENT_DETAIL_DELAUNAY_PARTS_H
#define CLOTH_GARMENT_DETAIL_DELAUNAY_PARTS_H

#include "cloth/garment/detail/delaunay.h"

/* What the files of delaunay.h share. A triangle counts as flat if twice its area is below this
 * part of its longest edge's square: far above rounding, far below what a panel has. */
#define DELAUNAY_FLAT 1e-9

/* Writes a triangle, and that its corners have it. */
void delaunay_put(struct delaunay *plane, uint32_t triangle, struct delaunay_triangle value);
/* What was beside a triangle (which may be DELAUNAY_NONE) is another one now. */
void delaunay_put_beside(struct delaunay *plane, uint32_t triangle, uint32_t before, uint32_t now);
void delaunay_take_triangle(struct delaunay *plane, uint32_t triangle);
void delaunay_take_vertex(struct delaunay *plane, uint32_t vertex);
/* There must be room. What is new has to be put. */
uint32_t delaunay_new_triangle(struct delaunay *plane);
uint32_t delaunay_new_vertex(struct delaunay *plane, const double place[2]);

/* The two triangles at an edge as one quadrilateral, counterclockwise: its corner 0 is the one of
 * the triangle that is opposite the edge, the edge joins corners 1 and 3. Side k is from corner k
 * to the one after it. */
struct delaunay_quad {
    uint32_t other;     /* the triangle on the other side of the edge, */
    int other_side;     /* and which of its corners is opposite the edge */
    uint32_t corner[4]; /* vertices */
    uint32_t beside[4]; /* the triangles beyond the sides */
    unsigned fixed[4];  /* 1: the side is fixed */
};
/* That at the edge opposite corner i of a triangle, which is no edge of the hull. */
struct delaunay_quad delaunay_quad_at(const struct delaunay *plane, uint32_t triangle, int i);

/* Whether the other diagonal makes two triangles that are not turned over. */
bool delaunay_may_flip(const struct delaunay *plane, const struct delaunay_quad *quad);

/* Flips the edge that is opposite corner i of a triangle; not of a fixed edge or one of the hull.
 */
void delaunay_flip(struct delaunay *plane, uint32_t triangle, int i);

#endif
