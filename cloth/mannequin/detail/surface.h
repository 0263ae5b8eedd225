#ifndef CLOTH_MANNEQUIN_DETAIL_SURFACE_H
#define CLOTH_MANNEQUIN_DETAIL_SURFACE_H

#include "cloth/base/memory.h"
#include "cloth/mannequin/detail/figure.h"
#include "cloth/mannequin/pose.h"

/* The mesh of half a figure, x >= 0, while it is made. Its boundary lies in the middle plane x = 0:
 * there its mirror image joins. */
struct surface {
    const struct figure *figure;
    struct cloth_error *error; /* the first one, lack of memory; after it nothing is done */
    uint32_t n, m;             /* vertices, triangles */
    double (*x)[3];            /* n, m */
    bool *middle;              /* n: on the boundary: x is 0 and remains so */
    uint32_t (*triangle)[3];   /* m: counterclockwise as seen from outside */
    struct cloth_list places, middles, triangles; /* room for the three, in surface.c alone */
};

/* Its edges, each once, and the triangles at each vertex. */
struct surface_edge {
    uint32_t end[2];      /* the lower one first */
    uint32_t triangle[2]; /* the second one is UINT32_MAX on the boundary */
};
struct surface_links {
    uint32_t n_edges;
    struct surface_edge *edge;
    uint32_t *first_edge;  /* n + 1: of the edges whose lower end a vertex is */
    uint32_t *first, *fan; /* triangles at vertex v: fan[first[v]] .. fan[first[v + 1] - 1] */
    struct cloth_pool memory;
};

/* Marches over a lattice of tetrahedra with edges of `cell` and more, m: the surface is empty
 * before. */
void surface_march(struct surface *surface, double cell);

/* False after an error; the pool is to be freed in any case. */
bool surface_links_find(struct surface_links *links, const struct surface *surface);

/* One pass each of a remesher: splits edges longer than 4/3 of what figure_edge says for `edge`,
 * collapses those shorter than 4/5 of it, turns edges where vertices then have nearer to six
 * neighbours, and moves vertices towards the middle of their neighbours, and onto the figure. No
 * two changes of a pass touch the same triangle. */
void surface_split(struct surface *surface, double edge);
void surface_collapse(struct surface *surface, double edge);
void surface_turn(struct surface *surface);
void surface_smooth(struct surface *surface);

/* Moves a surface that is near it onto the figure. */
void surface_project(struct surface *surface);

/* Adds a vertex, m, and returns its number, UINT32_MAX after an error; and a triangle. */
uint32_t surface_add_vertex(struct surface *surface, const double x[3], bool middle);
void surface_add_triangle(struct surface *surface, const uint32_t corner[3]);
void surface_free(struct surface *surface);

/* Makes the rig of a figure's whole mesh, whose first half->n vertices are those of the half. Each
 * vertex belongs to the bone of its part, then weights are smoothed along the surface. low: the
 * height in the half where the mesh is 0; scale: by which heights are multiplied, and lengths
 * aside. The error is that of the half. */
void rig_make(struct mannequin_rig *rig, const struct mesh *mesh, const struct surface *half,
              double edge, double low, const double scale[2]);

#endif
