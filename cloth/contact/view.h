#ifndef CLOTH_CONTACT_VIEW_H
#define CLOTH_CONTACT_VIEW_H

#include "cloth/contact/body.h"

/* The parallel view, along an axis, of a body whose maps cloth meets (image.h). The front is where
 * the coordinate along the axis is larger. Columns lie along the next axis, rows along the one
 * after it (of z: x and y). Pure functions. */

enum {
    CONTACT_STRIPS = 16, /* at most: parts of a map */
    CONTACT_LEAST_RESOLUTION = 16,
    CONTACT_MOST_RESOLUTION = 4096,
    CONTACT_THINNEST = 3 /* in place of an axis: the one along which the body is thinnest */
};

struct contact_view {
    uint32_t axis;          /* 0 1 2: x y z */
    uint32_t width, height; /* pixels; 0: the body has no maps */
    uint32_t rows;          /* of a strip, a power of two; the last strip may have fewer */
    double pitch;           /* m: the side of a pixel */
};

/* The view along an axis whose longest side has so many pixels; one strip. A body with frames fits
 * in all of them, and the thinnest is by the largest sizes that it has. */
void contact_view_make(const struct contact_body *body, uint32_t axis, uint32_t resolution,
                       struct contact_view *view);
/* Cuts it into strips: at most so many, from 1 to CONTACT_STRIPS. */
void contact_view_cut(struct contact_view *view, uint32_t strips);
uint32_t contact_view_strips(const struct contact_view *view);
uint32_t contact_view_rows(const struct contact_view *view, uint32_t strip);

#endif
