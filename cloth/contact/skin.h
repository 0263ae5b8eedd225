#ifndef CLOTH_CONTACT_SKIN_H
#define CLOTH_CONTACT_SKIN_H

#include "cloth/base/error.h"
#include "cloth/contact/pair.h"
#include "cloth/physics/vec.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Skins: the triangles of a block of cloth, with a tree of boxes. The constant part is a table, one
 * block of memory without pointers, as a body is. The boxes are another block, made in every step:
 * they hold features over the whole step, moving straight from x to y.
 *
 * The whole cloth has one skin a block. Each triangle is in one of them. Each vertex and each edge
 * of the whole cloth is a *feature* of one skin that has a triangle with it. So one pair of skins
 * finds each pair of a vertex and a triangle, or of two edges. Points are those that corners of the
 * skin's triangles are at; all positions are by point. The same vertex has the same id in all
 * skins. Vertices that are sewn to each other, but not yet at one place, have ids of their own and
 * one number `joined`: features that share it do not meet. All functions are local. */

/* Values of `beside`: there is no triangle; the triangle is of another skin. */
#define CONTACT_NO_POINT  UINT32_MAX
#define CONTACT_FAR_POINT (UINT32_MAX - 1)

/* A table opened; it points into the table. A skin that is only measured has the first four
 * members. */
struct contact_skin {
    uint32_t n_points, n_triangles;
    uint32_t n_edges, n_vertices; /* features */
    const uint32_t (*corner)[3];  /* n_triangles: points */
    const uint32_t (*edge)[2];    /* n_edges: points */
    const uint32_t (*beside)[2];  /* n_edges: the third points of triangles with the edge; those in
                                   * the skin come first */
    const uint32_t *vertex;       /* n_vertices: points */
    const uint32_t *number;       /* n_triangles: which one of the source's it is */
    const uint32_t *id;           /* n_points */
    const uint32_t *joined; /* n_points: the id of one of those that it is sewn to, or its own */
    uint32_t ids[2];        /* the least and the largest of both; least > largest: no points */
    const uint32_t *block, *row; /* n_points: whose row each is, */
    const uint32_t *cloth;       /* of which cloth; of several the lowest vertex says it, */
    const unsigned char *held;   /* 1: a pin holds it, where it is or as it moves it */
    uint32_t n_nodes, n_leaves;
    const uint32_t (*child)[4]; /* n_nodes: a node, or CONTACT_IS_LEAF with a leaf */
    const struct contact_leaf *leaf;
    const uint32_t *around; /* points of leaves */
    /* by triangle, edge and vertex: bit k: point k of the leaf is its corner */
    const uint32_t *triangle_bits, *edge_bits, *vertex_bits;
    const struct contact_loop *loop; /* 4 n_nodes + 1: of the children of nodes; of all */
    const uint32_t *along;           /* points of loops */
};

/* The source of a skin. x (m), the cloth's first positions, groups triangles that are near each
 * other, now and later. stands, by triangle: bit k: this skin has the vertex at corner k as a
 * feature, by this triangle; bit 3 + k: the edge from corner k to the next one. shared: bit k:
 * other triangles, here or in another skin, have that edge, too. */
struct contact_skin_source {
    uint32_t n_points, n_triangles;
    const uint32_t (*corner)[3];         /* n_triangles */
    const unsigned char *stands;         /* n_triangles */
    const unsigned char *shared;         /* n_triangles; NULL: others are here alone */
    const uint32_t *id;                  /* n_points */
    const uint32_t *joined;              /* n_points; NULL: the ids */
    const uint32_t *block, *row, *cloth; /* n_points; of bodies NULL: all 0 */
    const unsigned char *held;           /* n_points */
    const phys_vec *x;                   /* n_points */
};

/* Bytes of a table, and of the boxes of a step; both depend on the four counts alone. The memory is
 * aligned to CONTACT_ALIGN. */
size_t contact_skin_bytes(const struct contact_skin *skin);
size_t contact_boxes_bytes(const struct contact_skin *skin);

/* Makes a table, whose features are those that `stands` says: writes every byte of it. Error:
 * CLOTH_E_MEMORY. */
int contact_skin_make(const struct contact_skin_source *from, void *table,
                      struct cloth_error *error);
struct contact_skin contact_skin_open(const void *table);

/* Makes the boxes of a step in which points move straight from x to y (m, finite, by point). They
 * are in a frame that moves by `way` (m), such as the skin's mean motion. */
void contact_refit(const struct contact_skin *skin, const phys_vec *x, const phys_vec *y,
                   const phys_vec *way, void *boxes);

/* Which points moved since the boxes before: n_points bytes, 1 or 0, which contact_refit leaves
 * alone. contact_moved_mark counts them, then marks points beside them, and the parts of the skin
 * that have marked points. (skin_moved.c) */
unsigned char *contact_moved_points(const struct contact_skin *skin, const void *boxes);
void contact_moved_mark(const struct contact_skin *skin, void *boxes);
uint32_t contact_moved_n(const void *boxes);

/* The box around x and y of all points, in the room, m; low > high: there are no points. */
void contact_boxes_root(const void *boxes, double low[3], double high[3]);

/* Some leaves of the skin's tree that follow each other: their triangles, their vertices, and the
 * points at all of these. There are so many bunches; some may have nothing. (skin_bunch.c) */
struct contact_bunch {
    uint32_t triangle, vertex; /* the first ones */
    uint32_t n_triangles, n_vertices, n_points;
    const uint32_t *point;
};
uint32_t contact_bunches(const struct contact_skin *skin);
void contact_bunch_of(const struct contact_skin *skin, uint32_t number, struct contact_bunch *to);
/* The box, m, around a bunch with points that go from x to y, and on by as much again. */
void contact_bunch_box(const struct contact_bunch *bunch, const phys_vec *x, const phys_vec *y,
                       double low[3], double high[3]);

/* Two features that may be near to each other, by their numbers in their skins. kind: CONTACT_VT: a
 * vertex of the first skin, a triangle of the second; CONTACT_TV: a triangle of the first, a vertex
 * of the second; CONTACT_EE. */
enum { CONTACT_TV = CONTACT_EE + 1 };
struct contact_candidate {
    uint32_t kind, of[2];
    bool parted;  /* they surely stay apart by more than struct contact_side says */
    bool presses; /* false: two edges of which one has no ridge; struct contact_side asks for it */
};

/* One of two skins that are met, its positions by point. */
struct contact_side {
    const struct contact_skin *skin;
    const void *boxes; /* of x and y */
    const phys_vec *x, *y;
    /* The first side's: */
    double flat;  /* m: features of one flat part of both skins need to be visited only if they are
                   * nearer than this; 0: than the reach */
    bool ridges;  /* edges that are parted need to be visited only if both have a ridge */
    double parts; /* m: pairs that surely stay farther apart, along the direction in which they are
                   * closest when the step begins, may count as parted; -INFINITY: all do; 0: none
                   * does */
};

/* True if a surface has a ridge at an edge, towards where the unit normal points: it goes down on
 * both sides, at a border of the cloth on one. An edge between two skins is judged by one side. y:
 * by point, m. (skin_ridge.c) */
bool contact_is_ridge(const struct contact_skin *skin, const phys_vec *y, uint32_t edge,
                      const phys_vec *normal);

/* Takes n candidates, at most CONTACT_BATCH of them. */
enum { CONTACT_BATCH = 256 };
typedef void contact_visit(void *to, uint32_t n, const struct contact_candidate *candidate);

/* Visits all pairs of features that are nearer than reach (m) at any time of the step, and others
 * whose boxes are. Pairs that share a number `joined` are none. Each pair comes once. Their order
 * depends on tables, boxes and reach alone. A side with itself (a and b have the same skin): pairs
 * within it, of the kinds CONTACT_VT and CONTACT_EE. */
void contact_query(const struct contact_side *a, const struct contact_side *b, double reach,
                   contact_visit *visit, void *to);

/* The same of pairs with a marked point (contact_moved_mark); also visits others of their leaves.
 * rests: b has none, whatever its boxes say. */
void contact_query_moved(const struct contact_side *a, const struct contact_side *b, bool rests,
                         double reach, contact_visit *visit, void *to);

/* The four points of a candidate of two skins, in the order of enum contact_pair, which is
 * returned. side[k]: 0 or 1, which of the two skins point[k] is of. */
enum contact_pair contact_candidate_corners(const struct contact_skin *a,
                                            const struct contact_skin *b,
                                            const struct contact_candidate *candidate,
                                            uint32_t point[4], unsigned char side[4]);

#endif
