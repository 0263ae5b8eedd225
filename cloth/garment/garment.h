#ifndef CLOTH_GARMENT_GARMENT_H
#define CLOTH_GARMENT_GARMENT_H

#include "cloth/base/memory.h"
#include "cloth/garment/pattern.h"

/* The mesh of all panels of a pattern, not sewn yet: no vertex belongs to two panels. Every bit is
 * the same with any compiler and processor: all is made of + - * / and sqrt. */

/* One panel of it. Its boundary vertices come first, in the order of the pattern's edges: edge e
 * has first + start[e] .. first + start[e + 1]; the last edge ends with `first` again. */
struct garment_piece {
    uint32_t first, n_vertices;
    uint32_t first_triangle, n_triangles;
    uint32_t *start; /* n_edges + 1 */
};

/* A stitch of it: vertices that belong together, from the begin of side 0's edge on. */
struct garment_seam {
    uint32_t n_pairs;
    uint32_t (*pair)[2]; /* the vertices of both sides; in pleats one of the shorter edge is of
                          * several */
    bool reversed;       /* side 1 runs from its end to its begin */
    bool unsure;         /* the panels' fronts alone say so, or the distances contradict */
    double distance[2];  /* m, mean over the pairs if both run alike, and if one is reversed */
};

struct garment {
    uint32_t n_vertices, n_triangles, n_pieces, n_seams;
    double (*position)[3];       /* m, as the pattern places the panels */
    double (*uv)[2];             /* m, in the panel's plane as seen from its front: for a clockwise
                                  * panel u is -x; turned where the warp runs along y */
    uint32_t (*triangle)[3];     /* counterclockwise as seen from the front */
    struct garment_piece *piece; /* a panel, in their order */
    struct garment_seam *seam;   /* a stitch, in their order */
    unsigned char *excused;      /* a triangle: it is at a corner of a panel below 30 degrees, which
                                  * no mesh can better */
    double edge;                 /* m: of inner triangles */
    struct cloth_pool memory;
};

/* One of the two is given, the other is 0. */
struct garment_fineness {
    double edge;       /* m: how long edges are to be */
    uint32_t vertices; /* how many vertices are to be there in all */
};

/* Makes the mesh of a pattern that garment_pattern_check passed. Both edges of a stitch have
 * equally many vertices, at equal parts of their lengths, but where it has pleats. Where the
 * boundary is too coarse for good triangles, its divisions are shorter. The mesh belongs to the
 * caller (garment_free), also after an error. Errors: CLOTH_E_INPUT for a fineness that is not
 * positive and finite, more than 2^27 vertices, or a panel that cannot be meshed; CLOTH_E_MEMORY.
 * Local. */
int garment_make(struct garment *garment, const struct garment_pattern *pattern,
                 const struct garment_fineness *fineness, struct cloth_error *error);
void garment_free(struct garment *garment);

/* About how many vertices edges of a length, m > 0, give. Local. */
double garment_vertices(const struct garment_pattern *pattern, double edge);

/* The least angle of the triangles that are not excused, degrees (60 of none); *below: how many of
 * them have one below 30 degrees. The one figure here that may differ in its last bit. Local. */
double garment_least_angle(const struct garment *garment, uint32_t *below);

#endif
