#ifndef CLOTH_CONTACT_BODY_H
#define CLOTH_CONTACT_BODY_H

#include "cloth/base/error.h"
#include "cloth/mesh/mesh.h"
#include "cloth/physics/vec.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bodies: closed triangle meshes that cloth meets. All bodies of a scene lie in one block of
 * memory, one after the other, each with all that closest points need. A block holds no pointers:
 * a copy of its bytes, at an address of the same alignment, is as good. */

enum { CONTACT_ALIGN = 64, CONTACT_LEAF = 4 };

/* m: beyond it there is no cloth either. */
#define CONTACT_BODY_BOUND 1e6

/* A body begins with this; its arrays follow, each at so many bytes from here. */
struct contact_body {
    uint64_t bytes; /* of all of it, a multiple of CONTACT_ALIGN */
    uint32_t n_vertices, n_triangles, n_nodes;
    uint32_t n_frames; /* 0: it keeps its shape, and has neither velocities nor frames */
    uint64_t vertices, vertex_normals, facets, facet_normals, nodes, velocities, frames;
    double low[3], high[3]; /* m: the box around it */
    double near;            /* m: nearer than this a direction to its surface is but rounding */
    double first, rate;     /* s, frames a second: frame k is at first + k / rate */
};

/* The places of a body's n_vertices in each of n frames, m: what changes its shape. Between frames
 * vertices move straight; before the first and after the last one they rest. */
struct contact_frames {
    uint32_t n;
    double first, rate;       /* as of a body */
    const double (*place)[3]; /* n x n_vertices */
};

/* A triangle, in the order of the tree: counterclockwise as seen from outside. */
struct contact_facet {
    uint32_t corner[3];
    uint32_t number;       /* in the mesh */
    uint32_t neighbour[3]; /* facets at the edges: corners 0 1, 1 2, 2 0 */
};

/* Four parts of a body with the boxes around them (m), rounded outwards; low > high: no part. */
struct contact_node {
    float low[3][4], high[3][4];
    uint32_t child[4]; /* a node; or, with CONTACT_IS_LEAF, facets: the first of contact_leaf_n */
} __attribute__((aligned(CONTACT_ALIGN)));
#define CONTACT_IS_LEAF UINT32_C(0x80000000)
PHYS_INLINE uint32_t contact_leaf_n(uint32_t child)
{
    return (child >> 29 & 3) + 1;
}
PHYS_INLINE uint32_t contact_leaf_first(uint32_t child)
{
    return child & UINT32_C(0x1fffffff);
}

/* Positions, m; pseudo-normals of length 1, of vertices those weighted by angle. */
PHYS_INLINE const phys_vec *contact_body_vertices(const struct contact_body *body)
{
    return (const void *)((const char *)body + body->vertices);
}
PHYS_INLINE const phys_vec *contact_body_normals(const struct contact_body *body)
{
    return (const void *)((const char *)body + body->vertex_normals);
}
PHYS_INLINE const struct contact_facet *contact_body_facets(const struct contact_body *body)
{
    return (const void *)((const char *)body + body->facets);
}
PHYS_INLINE const phys_vec *contact_facet_normals(const struct contact_body *body)
{
    return (const void *)((const char *)body + body->facet_normals);
}
/* m/s, of the vertices of a body with frames. */
PHYS_INLINE const phys_vec *contact_body_velocities(const struct contact_body *body)
{
    return (const void *)((const char *)body + body->velocities);
}
PHYS_INLINE const struct contact_node *contact_body_nodes(const struct contact_body *body)
{
    return (const void *)((const char *)body + body->nodes);
}

/* All bodies of a scene. `memory` is aligned to CONTACT_ALIGN, its owner's to be freed; a zeroed
 * one has none. */
struct contact_bodies {
    void *memory;
    uint64_t bytes, room; /* of what is there; there is room for */
    uint32_t n;
};

/* Appends a body of the triangles of a mesh, m; its other parts are not read. *turned: the mesh was
 * inside out, and the body has its triangles turned round. Errors: CLOTH_E_INPUT for a mesh without
 * triangles, or with one without area, or two that lie on each other. Also if it is not closed, not
 * oriented, holds no room, or has a part that is inside out and no hole. Errors name vertices and
 * triangles from 1, as OBJ files do. CLOTH_E_MEMORY. An error leaves the bodies unchanged.
 * Local. */
int contact_bodies_add(struct contact_bodies *bodies, const struct mesh *mesh, bool *turned,
                       struct cloth_error *error);

/* The same for a body with frames; the mesh says how triangles join, and is where the frames are at
 * time 0. CLOTH_E_INPUT also for a vertex of a frame that is too far away. */
int contact_bodies_add_frames(struct contact_bodies *bodies, const struct mesh *mesh,
                              const struct contact_frames *frames, bool *turned,
                              struct cloth_error *error);

/* Moves bodies with frames to the end of a step between two times, s, with the velocities of its
 * chords. Call it before the step's tasks; the bodies must not be in use. */
void contact_bodies_move(const struct contact_bodies *bodies, double from, double to);

/* The places, m, of the vertices, or of one vertex, of a body with frames at a time, s. The last
 * one is true if a body, or NULL, has frames that are not over by then. */
void contact_body_places(const struct contact_body *body, double time, phys_vec *x);
void contact_body_vertex_place(const struct contact_body *body, double time, uint32_t vertex,
                               phys_vec *x);
bool contact_body_moves_after(const struct contact_body *body, double time);

/* Puts the vertices of a body without frames, of a number from 1, at x, m. For viewers of a run.
 * The body must not be in use. */
void contact_body_place(const struct contact_bodies *bodies, uint32_t number, const double (*x)[3]);

/* That of a number, from 1; NULL for 0. */
const struct contact_body *contact_bodies_at(const struct contact_bodies *bodies, uint32_t number);

/* A copy of the body's vertices and triangles, in the order of the mesh that it was made of; to be
 * freed in any case. CLOTH_E_MEMORY. */
int contact_body_mesh(const struct contact_body *body, struct mesh *mesh,
                      struct cloth_error *error);

/* contact_tree_build sorts `order`, the n numbers of triangles, as the tree has them, and makes
 * contact_tree_nodes nodes. low, high: the boxes of the triangles by number. Nodes are divided at
 * medians of the boxes' middles along the longest axis; of equal ones, the lower number is
 * first. */
uint32_t contact_tree_nodes(uint32_t n_triangles);
uint32_t contact_tree_part(uint32_t n_triangles, int i); /* where part i of a node begins; 4: n */
int contact_tree_build(uint32_t n, uint32_t *order, const phys_vec *low, const phys_vec *high,
                       struct contact_node *nodes, struct cloth_error *error);
/* Fits its boxes to triangles that moved. x: of vertices, m. */
void contact_tree_refit(uint32_t n_nodes, const struct contact_facet *facet, const phys_vec *x,
                        struct contact_node *nodes);

#endif
