#ifndef CLOTH_VIEW_LETTERS_H
#define CLOTH_VIEW_LETTERS_H

#include <cairo.h>

/* Text on pictures, by cairo: white on a dark rim, so that it is read on any ground. */

/* Letters of a size, pixels. */
void view_letters(cairo_t *cairo, double size);
/* Writes from x on, or up to it; y: the base line. */
void view_letters_from(cairo_t *cairo, double x, double y, const char *text);
void view_letters_to(cairo_t *cairo, double x, double y, const char *text);
/* Pixels that a text is wide. */
double view_letters_width(cairo_t *cairo, const char *text);

#endif
