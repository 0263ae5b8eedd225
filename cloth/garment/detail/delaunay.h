#ifndef CLOTH_GARMENT_DETAIL_DELAUNAY_H
#define CLOTH_GARMENT_DETAIL_DELAUNAY_H

#include "cloth/base/memory.h"
#include "cloth/base/vector.h"

#include <stdbool.h>
#include <stdint.h>

/* A triangulation in the plane whose boundary edges are fixed: a constrained Delaunay triangulation
 * but between a change and the delaunay_legalise after it. Triangles are counterclockwise, so none
 * has an area of 0 or less. All is computed with + - * / and sqrt alone, in an order that the input
 * decides: the same bits everywhere. Local functions. */

enum { DELAUNAY_BOX = 4 }; /* the first vertices: corners of a box around all others */
#define DELAUNAY_NONE UINT32_MAX

struct delaunay_triangle {
    uint32_t vertex[3];  /* vertex[0] of one that was taken out is DELAUNAY_NONE */
    uint32_t beside[3];  /* the triangle across the edge that is opposite vertex i; DELAUNAY_NONE */
    unsigned char fixed; /* bit i: that edge is one of the boundary */
};

/* A change that can be undone. */
struct delaunay_change {
    uint32_t triangle, vertex; /* one of them is DELAUNAY_NONE */
    struct delaunay_triangle before;
    double place[2];
    uint32_t at;
};

struct delaunay {
    uint32_t n_fixed;   /* vertices that stay: the box and the boundary */
    uint32_t n, room;   /* vertices */
    double (*place)[2]; /* a vertex, any unit */
    uint32_t *at;       /* a triangle of each vertex; DELAUNAY_NONE: it was taken out */
    uint32_t n_triangles, triangle_room;
    struct delaunay_triangle *triangle;
    uint32_t last;             /* where the next search starts */
    struct cloth_list suspect; /* edges that may be not Delaunay: triangle * 3 + i */
    bool logs;                 /* whether changes are kept */
    struct cloth_list changes; /* struct delaunay_change */
    bool failed;               /* memory ran out: `suspect` or `changes` are not whole */
};

/* A box of two triangles around all places from low to high, with room for so many vertices beside
 * its corners. delaunay_free frees it, also after an error. Error: CLOTH_E_MEMORY. */
int delaunay_make(struct delaunay *plane, const double low[2], const double high[2], uint32_t room,
                  struct cloth_error *error);
void delaunay_free(struct delaunay *plane);

/* Adds a vertex, and restores Delaunay. `near`: a triangle to search from. Returns the vertex;
 * DELAUNAY_NONE if the place is outside, on a vertex, on a fixed edge, or if there is no room. */
uint32_t delaunay_insert(struct delaunay *plane, const double place[2], uint32_t near);

/* Makes the edge from a to b one of the boundary. false: a vertex or another such edge is in the
 * way. */
bool delaunay_fix(struct delaunay *plane, uint32_t a, uint32_t b);

/* Takes out all that is outside the boundary, the box too, and gives what is left new numbers: the
 * vertices keep their order, and the first of the boundary becomes 0. */
void delaunay_carve(struct delaunay *plane);

/* Gives vertices and triangles new numbers, without those that were taken out. */
void delaunay_pack(struct delaunay *plane);

/* Moves a vertex that is not fixed to the vertex `to` beside it, and takes it out. false: some
 * triangle would turn over; nothing has changed then. Delaunay is to be restored. */
bool delaunay_merge(struct delaunay *plane, uint32_t vertex, uint32_t to);

/* Flips edges until all that are suspected, and those that they lead to, are Delaunay or fixed. */
void delaunay_legalise(struct delaunay *plane);
void delaunay_suspect(struct delaunay *plane, uint32_t triangle); /* its three edges */

/* The triangles around a vertex, counterclockwise, into around[0 .. most - 1]; of a vertex of the
 * boundary from one of its edges to the other. Returns how many; 0 if there are more than `most`,
 * or if the vertex was taken out. */
uint32_t delaunay_around(const struct delaunay *plane, uint32_t vertex, uint32_t most,
                         uint32_t *around);

/* Which corner of a triangle a vertex is: 0, 1 or 2. */
static inline int delaunay_corner(const struct delaunay_triangle *triangle, uint32_t vertex)
{
    return triangle->vertex[0] == vertex ? 0 : triangle->vertex[1] == vertex ? 1 : 2;
}
/* The corner that comes so many places after a vertex, counterclockwise. */
static inline uint32_t delaunay_after(const struct delaunay_triangle *triangle, uint32_t vertex,
                                      int places)
{
    return triangle->vertex[(delaunay_corner(triangle, vertex) + places) % 3];
}

/* The cosine of the least angle of a, b, c: 0.5 of the best, 1 of a needle; 2 if it is turned over.
 */
double delaunay_sharpness(const double a[2], const double b[2], const double c[2]);
double delaunay_sharpness_of(const struct delaunay *plane, uint32_t triangle);

/* Changes from here on can be undone, until it is decided whether they stay, which is returned. */
void delaunay_log(struct delaunay *plane);
bool delaunay_decide(struct delaunay *plane, bool stay);
/* Before a vertex is moved. */
void delaunay_log_vertex(struct delaunay *plane, uint32_t vertex);

/* ---- Parts ---- */

/* A triangle counts as flat if twice its area is below this
 * part of its longest edge's square: far above rounding, far below what a panel has. */
#define DELAUNAY_FLAT 1e-9

/* Writes a triangle, and that its corners have it. */
void delaunay_put(struct delaunay *plane, uint32_t triangle, struct delaunay_triangle value);
/* The neighbour of a triangle (which may be DELAUNAY_NONE) is another one now. */
void delaunay_put_beside(struct delaunay *plane, uint32_t triangle, uint32_t before, uint32_t now);
void delaunay_take_triangle(struct delaunay *plane, uint32_t triangle);
/* There must be room. New ones have to be put. */
uint32_t delaunay_new_triangle(struct delaunay *plane);

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
/* That at the edge opposite corner i of a triangle, which is no edge of the hull. Inline, as flips,
 * which take most of the time, are refused by the corners alone. */
static inline struct delaunay_quad delaunay_quad_at(const struct delaunay *plane, uint32_t triangle,
                                                    int i)
{
    const struct delaunay_triangle one = plane->triangle[triangle];
    const struct delaunay_triangle two = plane->triangle[one.beside[i]];
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    const int j = two.beside[0] == triangle ? 0 : two.beside[1] == triangle ? 1 : 2;
    const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    return (struct delaunay_quad){
        one.beside[i],
        j,
        {one.vertex[i], one.vertex[i1], two.vertex[j], one.vertex[i2]},
        {one.beside[i2], two.beside[j1], two.beside[j2], one.beside[i1]},
        {one.fixed >> i2 & 1, two.fixed >> j1 & 1, two.fixed >> j2 & 1, one.fixed >> i1 & 1}};
}

/* True if the other diagonal makes two triangles that are not turned over. */
bool delaunay_may_flip(const struct delaunay *plane, const struct delaunay_quad *quad);

/* Flips the edge that is opposite corner i of a triangle; not of a fixed edge or one of the hull.
 */
void delaunay_flip(struct delaunay *plane, uint32_t triangle, int i);

#endif
