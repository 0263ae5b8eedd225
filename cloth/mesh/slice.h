#ifndef CLOTH_MESH_SLICE_H
#define CLOTH_MESH_SLICE_H

#include "cloth/base/error.h"

#include <stdbool.h>
#include <stdint.h>

/* The lines in which a plane cuts a mesh of triangles. A vertex in the plane counts as above it, so
 * that each triangle is cut in one segment or not at all. Local functions. */
struct slice_mesh {
    uint32_t n_triangles;
    const double (*x)[3]; /* of each vertex, m */
    const uint32_t (*triangle)[3];
};

struct slice_end {
    double place[3]; /* m */
    uint64_t edge;   /* of the mesh: its lower vertex times 2^32, and the other */
    double part;     /* of the edge, from its lower vertex on */
    bool open;       /* no other segment ends here */
};

struct slice_segment {
    struct slice_end end[2];
    double length; /* m */
};

struct slice {
    uint32_t n;
    struct slice_segment *segment;
    uint32_t *set; /* n: segments that hang together (base/sets.h) */
};

/* Cuts a mesh by the plane of places whose product with the normal is the level. The slice is to be
 * freed, also after an error. Error: CLOTH_E_MEMORY. */
int slice_make(struct slice *slice, const struct slice_mesh *mesh, const double normal[3],
               double level, struct cloth_error *error);
void slice_free(struct slice *slice);

/* The convex hull of n points, counterclockwise, in their place. *corners: how many it has. Error:
 * CLOTH_E_MEMORY. */
int slice_hull(double (*point)[2], uint32_t n, uint32_t *corners, struct cloth_error *error);

/* The length around a convex polygon, m; whether a point is inside of it, or on it. */
double slice_around(const double (*hull)[2], uint32_t n);
bool slice_inside(const double (*hull)[2], uint32_t n, const double point[2]);

#endif
