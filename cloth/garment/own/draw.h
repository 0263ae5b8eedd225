#ifndef CLOTH_GARMENT_OWN_DRAW_H
#define CLOTH_GARMENT_OWN_DRAW_H

#include "cloth/garment/own/own.h"

/* How the own garments draw their panels. A panel is drawn as it is seen from the front of the
 * wearer, on the wearer's left: x goes away from the body's middle, y up. Places on the right are
 * its mirror image; those behind the body are turned round, so that every front looks away from the
 * body. Edges keep the numbers of the drawing, wherever the panel is. Local functions. */

enum { DRAW_CORNERS = 16, DRAW_PANELS = 8, DRAW_STITCHES = 20 };

/* An edge, from its corner to that of the next one; the last one goes to the first corner. */
struct draw_line {
    double corner[2]; /* m, counterclockwise */
    enum garment_curve curve;
    double control[2][2];
    double radius; /* of a small arc, which lies on the right of its chord */
};

struct draw_outline {
    uint32_t n;
    struct draw_line line[DRAW_CORNERS];
};

struct draw_place {
    bool right, back;
    double turn;    /* degrees: how far +x is turned down, along the arm */
    double x, y, z; /* m: where the drawing's origin is; x: away from the body's middle */
};

struct draw {
    const char *name; /* of the garment */
    struct garment_pattern *pattern;
    bool mirrored[DRAW_PANELS];
    struct cloth_error *error;
    int code; /* the first error; after it nothing is done */
};

/* Fails with a sentence about the garment's measures. */
#define DRAW_FAIL(draw, format, ...)                                                               \
    cloth_fail((draw)->error, CLOTH_E_INPUT, "%s: " format, (draw)->name, __VA_ARGS__)

/* Makes a whole panel of its half of x >= 0, whose lines go from the bottom to the top. Lines 0 and
 * n - 1 of the half cross the middle: the corner of line 0 is found here, as the image of that of
 * line 1. Images of the others follow. So of m lines line i has the image m - i. */
void draw_unfold(struct draw_outline *half);

/* The length of a line, m. */
double draw_length(const struct draw_outline *outline, uint32_t line);

/* Where panels start in z, m: before or behind the body, `apart` from each other. */
static inline double draw_apart(bool back, double apart)
{
    return (back ? -0.5 : 0.5) * apart + 0.01;
}

/* Checks that a garment can have this waist above hips of this girth, m. */
int draw_check_waist(struct draw *draw, double waist, double hip);

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
