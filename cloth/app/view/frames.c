/* Frames of a folder, one after the other, into a film. */
#include "cloth/app/view/frames.h"

#include "cloth/view/film.h"

#include <stdio.h>
#include <unistd.h>

static int film_frame(struct view_show *show, struct view_film *film, uint64_t frame,
                      const struct view_frames *frames, struct cloth_error *error)
{
    struct view_picture picture = {frames->width, frames->height, NULL};
    int code = view_show_frame(show, frame, error);
    code = code ? code : view_show_picture(show, &picture, error);
    code = code ? code : view_film_add(film, &picture, error);
    view_picture_free(&picture);
    return code;
}

static int film_frames(struct view_show *show, struct view_film *film,
                       const struct view_frames *frames, struct cloth_error *error)
{
    const bool seen = isatty(STDERR_FILENO);
    const uintmax_t n = frames->last - frames->first + 1;
    int code = 0;
    for (uint64_t i = 0; i < n && !code; i++) {
        if (seen)
            fprintf(stderr, "\r%s: %ju of %ju frames ", frames->path, (uintmax_t)i, n);
        code = film_frame(show, film, frames->first + i, frames, error);
    }
    if (seen)
        fprintf(stderr, "\r\033[K");
    return code;
}

int view_frames_film(struct view_show *show, const struct view_frames *frames,
                     struct cloth_error *error)
{
    struct view_context *context = NULL;
    struct view_film *film = NULL;
    int code = view_context_open(&context, error);
    if (!code)
        code =
            view_film_open(&film, frames->path, frames->width, frames->height, frames->fps, error);
    code = code ? code : film_frames(show, film, frames, error);
    const int closed = view_film_close(&film, !code, error);
    view_show_undraw(show);
    view_context_close(context);
    return code ? code : closed;
}
