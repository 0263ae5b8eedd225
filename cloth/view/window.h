#ifndef CLOTH_VIEW_WINDOW_H
#define CLOTH_VIEW_WINDOW_H

#include "cloth/view/show.h"

/* Frames that come while they are looked at, from a run, in the place of those of a folder. */
struct view_live {
    struct view_show *show; /* of a cache of one frame, the newest */
    bool fresh;             /* the frame, or the show, is another one than before; it was read */
    bool waits;             /* nothing is to come for now */
    const char *line;       /* how it stands, as a sentence */
    uint64_t frame;         /* of the run */
    /* Takes the newest frame, without waiting. The context of OpenGL is current. */
    int (*look)(struct view_live *live, struct cloth_error *error);
    void *context;
};

/* Shows the frames of a folder in a window until it is closed: mouse and keys as its help (key h)
 * says. It begins at `frame`, in the show's wished size; the cache's rate is that of playing.
 * Pictures that key s asks for go to duite-view-FRAME.png in the current folder, and are named on
 * standard output. Local; on the main thread. Errors: CLOTH_E_LIBRARY, no display or no OpenGL 3.3,
 * with a way out; those of view_show_frame. */
int view_window(struct view_show *show, uint64_t frame, struct cloth_error *error);
/* The same of frames that come: the camera follows them until somebody moves it. */
int view_window_live(struct view_live *live, struct cloth_error *error);

#endif
