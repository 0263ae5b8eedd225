#ifndef CLOTH_VIEW_LEGEND_H
#define CLOTH_VIEW_LEGEND_H

#include "cloth/view/colour.h"
#include "cloth/view/view.h"

/* The legend of a picture's colours, in its upper right corner: a scale with round numbers and
 * their unit, or the numbers of parts. Its size follows the picture's. */

struct view_legend {
    enum view_colour by; /* VIEW_COLOUR_CLOTH: there is nothing to say */
    struct view_scale scale;
    uint32_t n_parts;
    const unsigned char *hue; /* n_parts; not owned */
};

/* Onto a picture. Without cairo at build time it changes nothing. Error: CLOTH_E_MEMORY,
 * CLOTH_E_LIBRARY. */
int view_legend_lay(const struct view_legend *legend, struct view_picture *picture,
                    struct cloth_error *error);

/* Paints with cairo, on a surface of a picture's size; `cairo`: its cairo_t. */
void view_legend_paint(const struct view_legend *legend, void *cairo, int width, int height);

#endif
