/* Drawing sees a run's newest frame as a folder of one frame. When another scene comes, the old
 * show ends first: it points into memory that the follower is about to free. */
#include "config.h"

#include "cloth/app/view/live.h"

#include "cloth/app/view/frames.h"
#include "cloth/live/live.h"
#include "cloth/view/window.h"

#include <stdio.h>
#include <string.h>

struct live {
    struct live_follower *follower;
    const struct view_wish *wish;
    struct view_show *show;           /* NULL: no frame has come */
    uint32_t n_vertices, n_triangles; /* of it */
};

/* The camera of a run of the same cloth is kept. */
static int open_show(struct live *live, struct cloth_error *error)
{
    struct view_sight sight = {.orbit = {0}};
    const bool before = live->show;
    if (before) {
        sight = live->show->sight;
        view_show_undraw(live->show);
        view_show_close(live->show);
        live->show = NULL;
    }
    struct output_cache *cache = live_follow_cache(live->follower);
    const uint32_t n_vertices = cache->mesh.n_vertices, n_triangles = cache->mesh.n_triangles;
    const bool same = n_vertices == live->n_vertices && n_triangles == live->n_triangles;
    live->n_vertices = n_vertices;
    live->n_triangles = n_triangles;
    const int code = view_show_open(&live->show, cache, live->wish, error);
    if (!code && before && same)
        live->show->sight = sight;
    return code;
}

/* Waits for news, and reads the frame. */
static int live_look(struct live *live, double seconds, bool *fresh, struct cloth_error *error)
{
    enum live_news news;
    int code = live_follow(live->follower, seconds, &news, error);
    if (!code && news == LIVE_NEW_SCENE)
        code = open_show(live, error);
    *fresh = !code && news != LIVE_NOTHING;
    if (*fresh)
        code = view_show_frame(live->show, 0, error);
    if (*fresh && !code)
        view_show_follow(live->show);
    return code;
}

static void close_live(struct live *live)
{
    view_show_close(live->show);
    live_follow_close(&live->follower);
}

/* ---- A picture ---- */

static int fail_late(struct live *live, double seconds, struct cloth_error *error)
{
    bool waits;
    return cloth_fail(error, CLOTH_E_IO,
                      "no frame came within %g s: %s; is duite-cloth --live running there, and the "
                      "port forwarded if it is on another host?",
                      seconds, live_follow_state(live->follower, &waits));
}

int view_live_picture(const struct view_wish *wish, const char *png, double seconds,
                      struct cloth_error *error)
{
    struct live live = {.wish = wish};
    bool fresh = false;
    int code = live_follow_open(&live.follower, wish->folder, error);
    code = code ? code : live_look(&live, seconds, &fresh, error);
    if (!code && !fresh)
        code = fail_late(&live, seconds, error);
    code = code ? code : view_frames_draw(live.show, png, error);
    close_live(&live);
    return code;
}

/* ---- A window ---- */

#ifdef HAVE_WINDOW
static int look_again(struct view_live *view, struct cloth_error *error)
{
    struct live *live = view->context;
    const int code = live_look(live, 0, &view->fresh, error);
    view->show = live->show;
    view->line = live_follow_state(live->follower, &view->waits);
    view->frame = live_follow_frame(live->follower);
    return code;
}

/* Says how it stands whenever that changes. */
static int wait_for_first(struct live *live, struct cloth_error *error)
{
    char said[500] = "";
    bool fresh = false, waits;
    int code = 0;
    while (!code && !fresh) {
        code = live_look(live, 0.2, &fresh, error);
        const char *line = live_follow_state(live->follower, &waits);
        if (!code && !fresh && strcmp(line, said) != 0)
            fprintf(stderr, "duite-view: %s\n", line);
        snprintf(said, sizeof said, "%s", line);
    }
    return code;
}

int view_live_window(const struct view_wish *wish, struct cloth_error *error)
{
    struct live live = {.wish = wish};
    struct view_live view = {.context = &live, .look = look_again};
    int code = live_follow_open(&live.follower, wish->folder, error);
    code = code ? code : wait_for_first(&live, error);
    view.show = live.show;
    view.line = code ? "" : live_follow_state(live.follower, &view.waits);
    code = code ? code : view_window_live(&view, error);
    close_live(&live);
    return code;
}
#else
int view_live_window(const struct view_wish *wish, struct cloth_error *error)
{
    (void)wish;
    return cloth_fail(error, CLOTH_E_LIBRARY, "this build opens no windows");
}
#endif
