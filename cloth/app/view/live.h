#ifndef CLOTH_APP_VIEW_LIVE_H
#define CLOTH_APP_VIEW_LIVE_H

#include "cloth/view/show.h"

/* duite-view --connect: frames of a run that goes on, by its live view. Local. */

/* Draws the newest frame into a PNG file, or waits for one, at most so many seconds. wish->folder:
 * HOST:PORT. Errors: CLOTH_E_IO, none came; those of live_follow, view_show_open and of drawing. */
int view_live_picture(const struct view_wish *wish, const char *png, double seconds,
                      struct cloth_error *error);

/* Shows them in a window, which opens when the first one comes, until it is closed: the end of a
 * run and the start of the next are waited for. Standard error says first what it waits for.
 * Errors: as above, but for the first; CLOTH_E_LIBRARY, this build opens no windows. */
int view_live_window(const struct view_wish *wish, struct cloth_error *error);

#endif
