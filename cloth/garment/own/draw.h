#ifndef CLOTH_GARMENT_OWN_DRAW_H
#define CLOTH_GARMENT_OWN_DRAW_H

#include "cloth/garment/own/own.h"

/* How the own garments draw their panels. A panel is drawn as it is seen from the front of the
 * wearer, on the wearer's left: x goes away from the body's middle, y up. Places on the right are
 * its mirror image; those behind the body are turned round, so that every front looks away from the
 * body. Edges keep the numbers of the drawing, wherever the panel is. Local functions. */

enum { DRAW_CORNERS = 16, DRAW_PANELS = 8, DRAW_STITCHES = 20 };

/* An edge, from its corner to the next one. */
struct draw_line {
    enum garment_curve curve;
    double control[2][2];
    double radius; /* of a small arc, which lies on the right of its chord */
};

struct draw_outline {
    uint32_t n;
    double corner[DRAW_CORNERS][2];      /* m, counterclockwise */
    struct draw_line line[DRAW_CORNERS]; /* line i: from corner i to i + 1, the last one to 0 */
};

struct draw_place {
    bool right, back;
    double turn;    /* degrees: how far +x is turned down, along the arm */
    double x, y, z; /* m: where the drawing's origin is; x: away from the body's middle */
};

struct draw {
    struct garment_pattern *pattern;
    bool mirrored[DRAW_PANELS];
    struct cloth_error *error;
    int code; /* the first error; after it nothing is done */
};

/* Adds a corner, and the line from it to the next one. */
void draw_straight(struct draw_outline *outline, double x, double y);
void draw_quadratic(struct draw_outline *outline, double x, double y, double cx, double cy);
void draw_cubic(struct draw_outline *outline, double x, double y, double cx, double cy, double dx,
                double dy);

/* Makes a panel of its half of x >= 0: corners from the bottom to the top. Line 0 becomes the
 * bottom, `bottom`; the half's lines follow, then `top`, in place of the half's last line; then
 * their mirror images. So of n corners line i has the image 2 n - i. */
void draw_unfold(struct draw_outline *outline, const struct draw_line *bottom,
                 const struct draw_line *top);

/* The length of a line, m. */
double draw_length(const struct draw_outline *outline, uint32_t line);

/* Adds a panel to the pattern; returns its number. */
uint32_t draw_panel(struct draw *draw, const char *name, const struct draw_outline *outline,
                    const struct draw_place *place);

/* Stitches two lines of panels. */
void draw_sew(struct draw *draw, uint32_t panel, uint32_t line, uint32_t other,
              uint32_t other_line);

/* The garments; measures are in the order of their tables. */
extern const struct garment_measure draw_tshirt_measures[], draw_trousers_measures[],
    draw_skirt_measures[];
void draw_tshirt(struct draw *draw, const double *value);
void draw_trousers(struct draw *draw, const double *value);
void draw_skirt(struct draw *draw, const double *value);

#endif
