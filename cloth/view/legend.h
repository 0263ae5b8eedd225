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

/* --- With cairo alone --- */

struct _cairo; /* cairo_t */

/* Paints on a surface of a picture's size. */
void view_legend_paint(const struct view_legend *legend, struct _cairo *cairo, int width,
                       int height);
/* Letters of a size, pixels: white on a dark rim, so that they are read on any ground. */
void view_letters(struct _cairo *cairo, double size);
/* Writes from x on; y: the base line. */
void view_letters_from(struct _cairo *cairo, double x, double y, const char *text);
/* Pixels that a text is wide. */
double view_letters_width(struct _cairo *cairo, const char *text);

#endif
