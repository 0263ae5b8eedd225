#ifndef CLOTH_MANNEQUIN_DETAIL_FIGURE_H
#define CLOTH_MANNEQUIN_DETAIL_FIGURE_H

#include "cloth/mannequin/mannequin.h"

#include <stdbool.h>

/* The figure as a smooth union of parts, in metres of a figure of MANNEQUIN_HEIGHT. A part is swept
 * along a straight axis. Its sections are ovals: in front of the axis and behind it half of an
 * ellipse each, of one width. Middle and widths are smooth curves along the axis (cubic between
 * stations, by Catmull and Rom's tangents), and both ends are rounded. */

enum { FIGURE_STATIONS = 14, FIGURE_PARTS = 8, FIGURE_VALUES = 5 };

/* Values: the middle, aside and to the front; half the width aside, to the front, to the back. */
struct figure_station {
    double t; /* along the axis */
    double value[FIGURE_VALUES], slope[FIGURE_VALUES];
};

struct figure_part {
    double origin[3], axis[3], side[3], front[3];
    uint32_t n;
    struct figure_station station[FIGURE_STATIONS];
    double cap[2];          /* how far the rounded ends reach beyond the first and last station */
    double square;          /* how much fuller than an ellipse sections are on their diagonals */
    double blend;           /* within this distance it melts into the parts before it */
    bool paired;            /* its mirror image is there, too */
    double low[3], high[3]; /* a box that has all of it */
};

struct figure {
    uint32_t n;
    struct figure_part part[FIGURE_PARTS];
};

/* The parts for factors on the girths: 1 gives about those of the table. */
void figure_make(struct figure *figure, const double factor[MANNEQUIN_GIRTHS]);

/* Where a point is. Mirror images are alike. */
struct figure_near {
    double distance; /* about that from the surface, m, below 0 inside */
    uint32_t part;   /* the number of the nearest part, */
    double least;    /* m: half its least width there */
};
struct figure_near figure_near(const struct figure *figure, const double x[3]);

/* The distance alone, with its gradient (m/m). */
double figure_gradient(const struct figure *figure, const double x[3], double gradient[3]);

/* How long edges are to be near a point, m, where they are at most `edge`. */
double figure_edge(const struct figure *figure, const double x[3], double edge);

/* Parts that move as one: bones, those of the left side; the chest has neck and head, too. */
enum figure_bone {
    FIGURE_PELVIS,
    FIGURE_CHEST,
    FIGURE_UPPER_ARM,
    FIGURE_FOREARM,
    FIGURE_THIGH,
    FIGURE_SHIN,
    FIGURE_FOOT,
    FIGURE_BONES
};

/* The bone in the part that is nearest to a point. */
enum figure_bone figure_bone(const struct figure *figure, const double x[3]);

/* The joint at which a bone but the pelvis hangs on the one before, m. */
void figure_joint(const struct figure *figure, enum figure_bone bone, double joint[3]);

/* Where a girth is taken: a point inside the section, and its normal. */
void figure_section(const struct figure *figure, uint32_t measure, double point[3],
                    double normal[3]);

#endif
