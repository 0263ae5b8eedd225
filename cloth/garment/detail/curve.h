#ifndef CLOTH_GARMENT_DETAIL_CURVE_H
#define CLOTH_GARMENT_DETAIL_CURVE_H

#include "cloth/garment/pattern.h"

/* An edge of a panel as a curve over its length. Local functions. */

enum { CURVE_PARTS = 64 };

struct curve {
    enum garment_curve kind;
    double point[4][2];             /* m: begin, controls, end */
    double centre[2];               /* m, of an arc */
    double turns;                   /* of an arc, above 0 is counterclockwise */
    uint32_t n_points;              /* of a polyline, between begin and end: */
    const double (*points)[2];      /* those of the panel */
    double length;                  /* m */
    double before[CURVE_PARTS + 1]; /* m: the length of a Bezier curve up to t = k / CURVE_PARTS */
};

void curve_make(struct curve *curve, const struct garment_panel *panel, uint32_t edge);

/* Where the curve is at a parameter from 0 to 1; of a polyline, a part of its length. */
void curve_at(const struct curve *curve, double t, double place[2]);

/* Where it is at a part of its length, from 0 to 1. */
void curve_at_length(const struct curve *curve, double part, double place[2]);

/* How much it turns in all, radians; by CURVE_PARTS chords. */
double curve_turning(const struct curve *curve);

/* A closed loop of places that is divided into edges: edge e goes from place start[e] to place
 * start[e + 1], the last one to the first place. */
struct meet_loop {
    uint32_t n_edges;
    const uint32_t *start;    /* n_edges + 1 */
    const double (*place)[2]; /* start[n_edges] */
};

/* Sets *found if two parts of the loop that are not neighbours come nearer than `near` to each
 * other, or two neighbours fold back on each other. edge[0] <= edge[1] are the first such edges in
 * their order. Error: CLOTH_E_MEMORY. Local. */
int meet_find(const struct meet_loop *loop, double near, bool *found, uint32_t edge[2],
              struct cloth_error *error);

#endif
