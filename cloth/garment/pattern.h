#ifndef CLOTH_GARMENT_PATTERN_H
#define CLOTH_GARMENT_PATTERN_H

#include "cloth/base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A sewing pattern: flat panels, which of their edges are stitched, and where each panel is around
 * the body. docs/garments.md has the file format. Lengths are in metres, whatever the file's unit.
 */

enum garment_curve {
    GARMENT_STRAIGHT,
    GARMENT_QUADRATIC,
    GARMENT_CUBIC,
    GARMENT_CIRCLE,
    GARMENT_POLYLINE
};

struct garment_edge {
    uint32_t end[2]; /* corners: where it begins and ends */
    enum garment_curve curve;
    double control[2][2]; /* m: of a Bezier curve, one or two */
    double radius;        /* m, of an arc */
    bool large;           /* the arc is longer than half a circle */
    bool right;           /* the arc is on the right of the straight way from begin to end */
    uint32_t n_points;    /* of a polyline, between its ends */
    double (*point)[2];   /* m: n_points */
};

struct garment_panel {
    char *name;
    uint32_t n_corners, n_edges;
    double (*corner)[2]; /* m, x and y in the panel's plane */
    struct garment_edge *edge;
    double rotate[3];    /* degrees about x, then y, then z; those axes stay where they are */
    double translate[3]; /* m, after the rotation */
    bool warp_up;        /* the warp runs along y, else along x */
};

struct garment_side { /* an edge of a panel */
    uint32_t panel, edge;
};

/* Knife pleats of a stitch: its longer edge is folded onto the other one. */
struct garment_pleats {
    uint32_t count; /* 0: none */
    double depth;   /* m: of each, so that it takes twice as much of the longer edge */
    int side;       /* which one is the longer edge */
};

struct garment_stitch {
    struct garment_side side[2];
    struct garment_pleats pleats;
    bool right_wrong; /* both edges begin at the same end of the seam, even if the other end is
                       * nearer */
};

/* A zeroed one is empty. All arrays belong to it. */
struct garment_pattern {
    uint32_t n_panels, n_stitches;
    struct garment_panel *panel;
    struct garment_stitch *stitch;
};

void garment_pattern_free(struct garment_pattern *pattern);

/* The choices for a DXF file. Zeroed, or NULL in its place: the usual. */
struct garment_choice {
    const char *size; /* NULL: the sample size, or the only one */
    bool notches;     /* edges end at notches, too */
};

/* Reads a DXF file in the profile of AAMA or ASTM (docs/garments.md): the pieces of one size. Each
 * stands with its grain line upright, the middle of the box around it at the origin. The caller
 * frees the pattern, also after an error. Errors: CLOTH_E_INPUT, with file and line where there is
 * one; CLOTH_E_IO, CLOTH_E_MEMORY. Local. */
int garment_read_dxf(struct garment_pattern *pattern, const char *path,
                     const struct garment_choice *choice, struct cloth_error *error);

/* Checks that it can be sewn from flat cloth. The edges of each panel, in order, are a closed loop
 * through every corner once. Each has a length, and no arc has too small a radius. No edge meets
 * another or itself, and none is stitched twice or to itself. Panels are 1 mm to 100 m large. The
 * messages of CLOTH_E_INPUT name panel and edge, counted from 0. Other error: CLOTH_E_MEMORY.
 * Numbers of corners, panels and edges must be in range, and coordinates finite. Local. */
int garment_pattern_check(const struct garment_pattern *pattern, struct cloth_error *error);

/* True if the size of its largest panel is hardly meant, less than 5 cm or more than 4 m; text then
 * is a sentence about it. Local. */
bool garment_pattern_unusual(const struct garment_pattern *pattern, char *text, size_t size);

/* The length of an edge, m. Local. */
double garment_edge_length(const struct garment_panel *panel, uint32_t edge);

/* The area of a panel, m^2: below 0 if its loop is clockwise, so that its front is on the side of
 * -z. Local. */
double garment_panel_area(const struct garment_panel *panel);

#endif
