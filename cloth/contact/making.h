#ifndef CLOTH_CONTACT_MAKING_H
#define CLOTH_CONTACT_MAKING_H

#include "cloth/contact/body.h"

/* Shared by the two files that make a body: body_check.c checks and orients the mesh; body_make.c
 * makes the body. */

/* An edge of a triangle: from corner `edge` to the next one. */
struct contact_making_side {
    uint64_t ends; /* the lower vertex above the higher one: equal for both sides of an edge */
    uint32_t triangle, edge;
    bool rises; /* from the lower vertex to the higher one */
};

/* A body that is being made. By number of the triangle: corners, normals, boxes, neighbours. */
struct contact_making {
    const struct mesh *mesh;
    const struct contact_frames *frames; /* NULL: none */
    uint32_t n;
    uint32_t (*corner)[3], (*neighbour)[3];
    phys_vec *normal, *low, *high;
    struct contact_making_side *side; /* 3 n */
    uint32_t *order, *place;          /* of the tree; where in it a triangle is */
    struct cloth_error *error;
};

static inline void contact_load(const struct contact_making *making, uint32_t vertex, phys_vec *x)
{
    const double *from = making->mesh->position + 3 * (size_t)vertex;
    *x = (phys_vec){from[0], from[1], from[2], 0};
}

static inline void contact_cross(const phys_vec *a, const phys_vec *b, phys_vec *product)
{
    const phys_vec u = *a, v = *b;
    *product = (phys_vec){u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                          u[0] * v[1] - u[1] * v[0], 0};
}

/* The angle between two vectors of any length, rad; 0 if one has none. It uses + - * / and sqrt
 * alone, so that its bits are the same everywhere. */
double contact_angle(const phys_vec *a, const phys_vec *b);

/* Checks that there are triangles, but not too many, and that no vertex is too far away; called
 * before allocation. */
int contact_body_check_vertices(const struct contact_making *making);
/* Fills the values of the triangles and joins them; turns a body round that is inside out. Errors:
 * as of contact_bodies_add. Local. */
int contact_body_check(struct contact_making *making, bool *turned);

#endif
