#ifndef CLOTH_CONTACT_SKIN_TABLE_H
#define CLOTH_CONTACT_SKIN_TABLE_H

#include "cloth/contact/body.h"
#include "cloth/contact/skin.h"

/* Shared by the files of skins: the layout of tables and boxes in memory. Boxes are floats, rounded
 * outwards, four at a time, one a lane. */

typedef float contact_lanes __attribute__((vector_size(16)));

/* m; low > high in lanes that hold nothing. */
struct contact_boxes {
    contact_lanes low[3], high[3];
};

/* A leaf of the tree: triangles, those of their features that the skin has, and their corners, each
 * once. Each list begins at the number given. Its boxes are in groups of four, from `group` on: the
 * triangles, then the vertices, then the edges, each kind in groups of its own. */
struct contact_leaf {
    uint32_t triangle, vertex, edge, point, group;
    uint32_t n_triangles, n_vertices, n_edges, n_points;
};
enum {
    CONTACT_SKIN_LEAF = 8,
    CONTACT_SKIN_POINTS = 3 * CONTACT_SKIN_LEAF
}; /* triangles at most; points */

/* The border of a part's triangles, if it is one closed line without repeated points. Points are in
 * the sense of the triangles' corners. n 0: there is no such line, or no room for it, or the part
 * is a leaf. */
struct contact_loop {
    uint32_t first, n;
};

/* The index of the loop of a child; or of all triangles, for a node beyond the last. */
PHYS_INLINE uint32_t contact_loop_at(const struct contact_skin *skin, uint32_t node, uint32_t lane)
{
    return node < skin->n_nodes ? 4 * node + lane : 4 * skin->n_nodes;
}

/* Groups of four that n boxes take. */
PHYS_INLINE uint32_t contact_groups(uint32_t n)
{
    return (n + 3) / 4;
}

/* Those of the vertices and of the edges of a leaf begin there. */
PHYS_INLINE uint32_t contact_vertex_group(const struct contact_leaf *leaf)
{
    return leaf->group + contact_groups(leaf->n_triangles);
}
PHYS_INLINE uint32_t contact_edge_group(const struct contact_leaf *leaf)
{
    return contact_vertex_group(leaf) + contact_groups(leaf->n_vertices);
}

/* A table begins with this; its arrays follow, each at so many bytes from here. */
struct contact_skin_head {
    uint64_t bytes;
    uint32_t n_points, n_triangles, n_edges, n_vertices, n_nodes, n_leaves;
    uint64_t corner, edge, beside, vertex, number, id, joined, block, row, cloth, held, child, leaf;
    uint64_t around, triangle_bits, edge_bits, vertex_bits;
    uint64_t loop, along, n_along; /* n_along: there is room for */
    uint32_t ids[2];
};

/* The boxes of a step begin with this. */
struct contact_boxes_head {
    double low[3], high[3]; /* m, in the room */
    double way[3];          /* m, of the frame */
    uint64_t bytes, nodes, slopes, groups, points;
    uint64_t ways; /* by leaf: a box around the ways of its points */
    uint64_t
        moved; /* n_nodes bytes: bit k: child k has a feature that moved; then those of points */
    uint32_t n_moved;
};
void contact_boxes_lay(const struct contact_skin *skin, struct contact_boxes_head *head);

/* Bounds of the triangles of four parts over the step: the hull of their unit normals, and the
 * least altitude (m; 0: unknown). Three times of the step bound them (skin_refit.c). */
struct contact_slopes {
    struct contact_boxes normal;
    contact_lanes altitude;
};

/* A box of one point, from which other boxes are made. */
struct contact_point_box {
    contact_lanes low, high;
};

/* Boxes and slopes of the four children of each node; boxes of features, by group. */
PHYS_INLINE const struct contact_boxes *contact_boxes_nodes(const void *boxes)
{
    const struct contact_boxes_head *head = boxes;
    return (const void *)((const char *)boxes + head->nodes);
}
PHYS_INLINE const struct contact_slopes *contact_boxes_slopes(const void *boxes)
{
    const struct contact_boxes_head *head = boxes;
    return (const void *)((const char *)boxes + head->slopes);
}
PHYS_INLINE const struct contact_boxes *contact_boxes_groups(const void *boxes)
{
    const struct contact_boxes_head *head = boxes;
    return (const void *)((const char *)boxes + head->groups);
}

PHYS_INLINE const struct contact_point_box *contact_boxes_ways(const void *boxes)
{
    const struct contact_boxes_head *head = boxes;
    return (const void *)((const char *)boxes + head->ways);
}

/* Fills loops and points along them of a table whose nodes, leaves and corners are there. Error:
 * CLOTH_E_MEMORY. */
int contact_loops_make(const struct contact_skin *skin, uint64_t room, struct contact_loop *loop,
                       uint32_t *along, struct cloth_error *error);

/* A child of a node; of node CONTACT_ALL, all triangles. */
enum { CONTACT_ALL = INT32_MAX };
struct contact_part {
    uint32_t node, lane;
};

/* Features of a leaf, a bit each. */
struct contact_features {
    uint32_t vertices, triangles, edges;
};

/* Heights of a leaf's points along a direction, m, at the begin and at the end of a step. */
struct contact_heights {
    double low[2], high[2];
    double at[2][CONTACT_SKIN_POINTS] __attribute__((aligned(32)));
};

/* Two leaves as seen along the normals of the first. */
struct contact_slab {
    uint32_t node, lane; /* the first leaf is that child */
    bool is;             /* its normals have a middle, n */
    bool above;          /* the first leaf is above the second */
    phys_vec n;          /* of length 1 */
    double most;         /* m: features farther away are out of reach */
    double apart;        /* m: how far the second leaf is at least, in the whole step */
    double begin;        /* m: the same where it begins */
    struct contact_heights of[2];
};
/* The distance, m, beyond which features are surely out of a reach (m). */
double contact_slab_most(const struct contact_side *a, const struct contact_side *b, double reach);

/* The widening of boxes, m. */
struct contact_widening {
    contact_lanes below[3], above[3];
};

/* Two skins whose leaves are met. */
struct contact_leaves {
    const struct contact_side *side[2];
    const struct contact_boxes *node[2], *group[2];
    struct contact_widening by, back;  /* of boxes of the first, of the second */
    bool self;                         /* both are one */
    struct contact_slab slab;          /* of the first leaf that was met last */
    const struct contact_leaf *ridged; /* the first leaf that was asked for its ridges last, */
    uint32_t ridges;                   /* and these */
    double parts; /* m: leaves that stay farther apart are parted; -INFINITY: all are */
};

/* Features of a first leaf that meet some of a second: a bit each, and those by each. */
struct contact_met {
    uint32_t is, bits[CONTACT_SKIN_POINTS];
};
/* Vertices meet triangles, and triangles vertices. */
struct contact_met_leaf {
    struct contact_met vertices, triangles, edges;
    bool parted;
    uint32_t ridges[2]; /* edges of each that may press others, a bit each */
};
/* Those of some edges of a leaf, a bit each, that may have a ridge in some direction. y: by point,
 * m. (skin_ridge.c) */
uint32_t contact_ridges_of(const struct contact_skin *skin, const struct contact_leaf *leaf,
                           const phys_vec *y, uint32_t bits);

/* Finds the features of two leaves that may be near to each other. False: the leaves are out of
 * reach in the whole step. The second is for a leaf with itself: its vertices, and each two edges
 * once. (skin_leaves.c) */
bool contact_leaves_meet(struct contact_leaves *leaves, struct contact_part a,
                         struct contact_part b, struct contact_met_leaf *to);
void contact_leaf_meets_itself(struct contact_leaves *leaves, struct contact_part part,
                               struct contact_met_leaf *to);

/* A part of a skin in a step. */
struct contact_patch {
    const struct contact_side *side;
    const struct contact_loop *loop;
    struct contact_point_box normal; /* hull of normals */
    float altitude;
};
/* True if normals and border prove (skin_flat.c) that features without a common point never come
 * nearer than reach (m) in the step. They are of one patch or of two; b may be NULL. */
bool contact_patches_flat(const struct contact_patch *a, const struct contact_patch *b,
                          double reach);

#endif
