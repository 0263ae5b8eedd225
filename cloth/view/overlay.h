#ifndef CLOTH_VIEW_OVERLAY_H
#define CLOTH_VIEW_OVERLAY_H

#include "cloth/view/legend.h"

#include <epoxy/gl.h>

/* Overlay of a window: the legend, a time line and lines of text. Cairo draws it, OpenGL lays it
 * over the bound framebuffer. The context is current in all functions; one thread. */

struct view_overlay_text {
    double part;             /* of the time line that is behind, 0 .. 1; -1: there is no line */
    const char *status;      /* one line beside the time line; NULL: neither is shown */
    const char *const *help; /* pairs of key and meaning, up to a NULL; NULL: no help */
    const struct view_legend *legend;
};

struct view_overlay {
    GLuint program, array, texture;
};
/* To be freed in any case; zero is no overlay. Error: CLOTH_E_LIBRARY. */
int view_overlay_make(struct view_overlay *overlay, struct cloth_error *error);
int view_overlay_draw(const struct view_overlay *overlay, const struct view_overlay_text *text,
                      int width, int height, struct cloth_error *error);
/* The part of a window's time line at x and y (pixels from the top left corner), 0 .. 1; -1: beside
 * it. Pure. */
double view_overlay_part(double x, double y, int width, int height);
void view_overlay_free(const struct view_overlay *overlay);

#endif
