#ifndef CLOTH_APP_VIEW_FRAMES_H
#define CLOTH_APP_VIEW_FRAMES_H

#include "cloth/view/show.h"

/* The frames of a folder in a film, and their form. Local. */
struct view_frames {
    const char *path;
    int width, height;
    double fps;
    uint64_t first, last; /* there are these */
};

/* Draws them into the film; says on a terminal how far it is. Errors: of view_film_open and of
 * drawing. */
int view_frames_film(struct view_show *show, const struct view_frames *frames,
                     struct cloth_error *error);

#endif
