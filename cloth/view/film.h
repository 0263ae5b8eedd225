#ifndef CLOTH_VIEW_FILM_H
#define CLOTH_VIEW_FILM_H

#include "cloth/view/view.h"

#include <stdbool.h>

/* Films: pictures go raw through a pipe to the program ffmpeg, which encodes them by x264 while the
 * next one is drawn. Local functions. */

struct view_film;

/* Begins a film of pictures of that size, shown at `fps` pictures a second. The file is written
 * under another name and renamed when it is whole. *film: to be closed in any case. Errors:
 * CLOTH_E_INPUT, an odd width or height, which x264 does not take; CLOTH_E_LIBRARY where there is
 * no ffmpeg; CLOTH_E_IO, CLOTH_E_MEMORY. */
int view_film_open(struct view_film **film, const char *path, int width, int height, double fps,
                   struct cloth_error *error);
/* Errors: CLOTH_E_IO, ffmpeg has stopped: its message. */
int view_film_add(struct view_film *film, const struct view_picture *picture,
                  struct cloth_error *error);
/* Waits until the file is whole; *film becomes NULL. Unless `whole` is asked for, nothing is left
 * of it, and there is no error. Error: as of view_film_add. */
int view_film_close(struct view_film **film, bool whole, struct cloth_error *error);

#endif
