#ifndef CLOTH_MANNEQUIN_DETAIL_SURFACE_H
#define CLOTH_MANNEQUIN_DETAIL_SURFACE_H

#include "cloth/mannequin/detail/figure.h"

/* The mesh of half a figure, x >= 0, while it is made. Its boundary lies in the middle plane x = 0:
 * there its mirror image joins. */
struct surface {
    uint32_t n, room; /* vertices */
    double (*x)[3];   /* m */
    bool *middle;     /* on the boundary: x is 0 and remains so */
    uint32_t m, space;
    uint32_t (*triangle)[3]; /* counterclockwise as seen from outside */
};

/* Its edges, each once; triangle[1] is UINT32_MAX on the boundary. */
struct surface_edge {
    uint32_t end[2]; /* the lower one first */
    uint32_t triangle[2];
};
struct surface_edges {
    uint32_t n;
    struct surface_edge *edge;
    uint32_t *first; /* n + 1 vertices: of the edges whose lower end it is */
};

/* The triangles at each vertex v: fan[first[v]] .. fan[first[v + 1] - 1]. */
struct surface_fans {
    uint32_t *first, *fan;
};

/* Marches over a lattice of tetrahedra with edges of `cell` and more, m: the surface is empty
 * before. Errors of all: CLOTH_E_MEMORY; the caller frees in any case. */
int surface_march(struct surface *surface, const struct figure *figure, double cell,
                  struct cloth_error *error);

int surface_edges_find(struct surface_edges *edges, const struct surface *surface,
                       struct cloth_error *error);
void surface_edges_free(struct surface_edges *edges);
int surface_fans_find(struct surface_fans *fans, const struct surface *surface,
                      struct cloth_error *error);
void surface_fans_free(struct surface_fans *fans);

/* One pass each of a remesher: splits edges longer than 4/3 of what figure_edge says for `edge`,
 * collapses those shorter than 4/5 of it, turns edges where vertices then have nearer to six
 * neighbours, and moves vertices towards the middle of their neighbours, and onto the figure. No
 * two changes of a pass touch the same triangle. */
int surface_split(struct surface *surface, const struct figure *figure, double edge,
                  struct cloth_error *error);
int surface_collapse(struct surface *surface, const struct figure *figure, double edge,
                     struct cloth_error *error);
int surface_turn(struct surface *surface, struct cloth_error *error);
int surface_smooth(struct surface *surface, const struct figure *figure, struct cloth_error *error);

/* Moves a surface that is near it onto the figure. */
void surface_project(struct surface *surface, const struct figure *figure);

/* The length of the section of a measure, of both halves; 0: there is none. */
int surface_girth(const struct surface *surface, const struct figure *figure, uint32_t measure,
                  double *girth, struct cloth_error *error);

/* A new vertex or triangle at the end, not initialised; UINT32_MAX and an error: no memory. */
uint32_t surface_add_vertex(struct surface *surface, struct cloth_error *error);
uint32_t surface_add_triangle(struct surface *surface, struct cloth_error *error);
void surface_free(struct surface *surface);

#endif
