#ifndef CLOTH_GARMENT_DETAIL_MESHING_H
#define CLOTH_GARMENT_DETAIL_MESHING_H

#include "cloth/garment/detail/curve.h"
#include "cloth/garment/detail/delaunay.h"
#include "cloth/garment/garment.h"

/* cos 20 degrees, of delaunay_sharpness: angles below are bad, but at sharper corners of a panel.
 */
#define MESHING_POOR 0.93969262

/* A pattern while it is meshed. Edges of all panels have one numbering: those of panel p begin with
 * first[p]. Local functions. */

struct meshing_panel {
    struct delaunay plane; /* its mesh, in the plane as seen from its front */
    double (*place)[2];    /* m: of its boundary */
    unsigned char *sharp;  /* a vertex of its boundary: the panel's angle there is below 30 degrees
                            */
    uint32_t *start;       /* n_edges + 1: where each edge's vertices begin */
    struct cloth_pool memory; /* of these three */
    bool clockwise, meshed;   /* meshed: by the divisions as they are now */
};

struct meshing_edge {
    struct curve curve;
    uint32_t least;                      /* divisions that its turns need */
    uint32_t partner;                    /* the edge that it is stitched to; UINT32_MAX: none */
    const struct garment_pleats *pleats; /* of its stitch; NULL: none */
    bool folded;                         /* and it is the edge that has them */
    double finer;  /* how much shorter divisions are than those of other edges */
    uint32_t n;    /* divisions */
    double middle; /* parts of the edge's length: how long divisions are in its middle, */
    double end[2]; /* and at its begin and end, where they may be shorter */
    double *part;  /* n + 1: parts of the length up to each; NULL: they are equal */
    struct meshing_divisions {
        uint32_t n;
        double end[2];
    } before; /* the last ones */
};

struct meshing {
    const struct garment_pattern *pattern;
    struct cloth_error *error;   /* the first one; after it nothing is done */
    uint32_t *first;             /* n_panels + 1 */
    struct meshing_edge *edge;   /* first[n_panels] */
    struct meshing_panel *panel; /* n_panels */
    double spacing;              /* m: of inner triangles */
    struct cloth_pool memory;
};

/* error: set by this function and those below; no error before. meshing_free frees it, also after
 * an error. */
void meshing_make(struct meshing *meshing, const struct garment_pattern *pattern,
                  struct cloth_error *error);
void meshing_free(struct meshing *meshing);

/* Divides all edges and meshes all panels by a spacing. Where triangles are bad since the boundary
 * is too coarse for them, it is divided finer, on both sides of a stitch. Where they stay bad, or a
 * panel cannot be meshed, the spacing becomes up to a third finer. */
void meshing_mesh(struct meshing *meshing, double spacing);

/* The divisions of all edges by the spacing and by how much finer they are to be; panels of which
 * any changes are not meshed any more. Beside a short edge divisions are short, and become longer
 * along their edge. Errors: CLOTH_E_INPUT, too many; CLOTH_E_MEMORY. */
void meshing_divide(struct meshing *meshing);

/* ---- Pleats (pleats.c) ---- */

/* Parts of the pitch: a flat part of less is none. */
#define PLEATS_NONE 1e-6

/* How many divisions an edge of a pleated stitch has by the spacing, as a number, since it may be
 * beyond all integers; *first: the part of its length that the first one is. Pure. */
double pleats_count(const struct meshing *meshing, const struct meshing_edge *edge, double *first);
/* Divides it so. Error: CLOTH_E_MEMORY, of the meshing. */
void pleats_divide(const struct meshing *meshing, struct meshing_edge *edge);
/* The division of the shorter edge, of n, on which division k of the longer one lies, of n_folded.
 * Pure. */
uint32_t pleats_place(uint32_t count, uint32_t n_folded, uint32_t n, uint32_t k);

/* ---- Panels and seams ---- */

/* Finds start, place and sharp of a panel by its divisions. False: after an error. */
bool meshing_outline(struct meshing *meshing, uint32_t panel);

/* Pairs the vertices of all stitches of a garment that has its pieces, each in the direction that
 * docs/garments.md says. Error: CLOTH_E_MEMORY. Local. */
int seams_make(struct garment *garment, const struct garment_pattern *pattern,
               struct cloth_error *error);

/* True if a triangle fills a corner, so that two of its edges are the boundary's: shorter divisions
 * leave its shape as it is. Pure. */
bool meshing_is_ear(const struct delaunay *plane, uint32_t triangle);

/* Where two panels are sewn together around a corner, makes their triangles there differ, so that
 * the corner can open. Corners below about 60 degrees, whose halves would be too sharp, may stay as
 * they are. The garment has its pieces and seams. Error: CLOTH_E_MEMORY. Local. */
int corners_open(struct garment *garment, const struct meshing *meshing, struct cloth_error *error);

#endif
