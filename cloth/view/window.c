/* A window draws when something has changed, and sleeps otherwise. Callbacks only note wishes; the
 * loop carries them out, so that each failure has one way out. */
#include "cloth/view/window.h"

#include "cloth/view/overlay.h"
#include "cloth/view/pick.h"
#include "cloth/view/player.h"

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static const double SEEN = 2.0;   /* s that the time line stays after the mouse has moved */
static const double ASLEEP = 0.1; /* s between two looks at the clock */
static const double AWAKE = 0.02; /* s between two looks for a frame that comes */
static const double TURN = 180;   /* degrees that a drag across the window's height turns by */

static const char *const HELP[] = {"space",       "play, pause",
                                   "left, right", "a frame back, on (shift: ten)",
                                   "Home, End",   "first, last frame",
                                   "up, down",    "play faster, slower",
                                   "drag",        "turn (left button), move (right button)",
                                   "click",       "name a vertex, with the line of a probe of it",
                                   "wheel",       "zoom",
                                   "r",           "camera as it was",
                                   "c",           "next colours: block, rank, strain, ...",
                                   "w",           "edges of triangles",
                                   "s",           "write a picture, duite-view-FRAME.png",
                                   "h",           "this help",
                                   "q, Esc",      "end",
                                   NULL};

struct window {
    GLFWwindow *glfw;
    struct view_show *show;
    struct view_overlay overlay;
    const char *folder;
    struct view_player player;
    struct view_live *live; /* NULL: a folder */
    double x, y;            /* of the mouse, where it was seen last */
    double moved;           /* s: when that was; -SEEN: never */
    unsigned recolour;      /* how often the next colours were asked for */
    double press[2];        /* where the left button went down */
    char picked[160];       /* the vertex that was named last; empty: none */
    bool wire, help, save, seeking, changed;
};

static struct window *window_of(GLFWwindow *glfw)
{
    return glfwGetWindowUserPointer(glfw);
}

static void on_camera_key(struct window *w, int key)
{
    if (key == GLFW_KEY_R)
        w->show->sight.orbit = w->show->sight.fitted;
    if (key == GLFW_KEY_W)
        w->show->wire = w->wire = !w->wire;
    if (key == GLFW_KEY_C)
        w->recolour++;
    if (key == GLFW_KEY_H || key == GLFW_KEY_F1)
        w->help = !w->help;
    if (key == GLFW_KEY_S)
        w->save = true;
    if (key == GLFW_KEY_Q || key == GLFW_KEY_ESCAPE)
        glfwSetWindowShouldClose(w->glfw, GLFW_TRUE);
}

static void on_key(GLFWwindow *glfw, int key, int scancode, int action, int mods)
{
    struct window *w = window_of(glfw);
    const double now = glfwGetTime();
    const int64_t step = mods & GLFW_MOD_SHIFT ? 10 : 1;
    (void)scancode;
    if (action == GLFW_RELEASE)
        return;
    w->changed = true;
    w->moved = now;
    *w->picked = '\0'; /* another frame may have it elsewhere */
    switch (key) {
    case GLFW_KEY_SPACE:
        view_player_toggle(&w->player, now);
        return;
    case GLFW_KEY_LEFT:
        view_player_step(&w->player, now, -step);
        return;
    case GLFW_KEY_RIGHT:
        view_player_step(&w->player, now, step);
        return;
    case GLFW_KEY_HOME:
        view_player_seek(&w->player, now, 0);
        return;
    case GLFW_KEY_END:
        view_player_seek(&w->player, now, 1);
        return;
    case GLFW_KEY_UP:
        view_player_faster(&w->player, now, 2);
        return;
    case GLFW_KEY_DOWN:
        view_player_faster(&w->player, now, 0.5);
        return;
    default:
        on_camera_key(w, key);
    }
}

static bool seek(struct window *w)
{
    int width, height;
    glfwGetWindowSize(w->glfw, &width, &height);
    const double part = view_overlay_part(w->x, w->y, width, height);
    if (part >= 0)
        view_player_seek(&w->player, glfwGetTime(), part);
    return part >= 0;
}

/* Names the vertex below the mouse: at the line's place, and its probe on standard output. */
static void pick(struct window *w)
{
    const struct view_show *show = w->show;
    const struct output_cache *cache = show->cache;
    struct view_camera camera;
    char probe[160];
    int width, height;
    glfwGetWindowSize(w->glfw, &width, &height);
    view_orbit_camera(&show->sight.orbit, (double)width / height, &camera);
    const uint32_t vertex =
        view_pick(&camera, width, height, &cache->mesh, show->position, w->x, w->y);
    *w->picked = '\0';
    if (vertex == VIEW_PICKED_NONE)
        return;
    const struct view_picked picked =
        view_picked_of(&cache->mesh, cache->apart.n_cloths, cache->apart.end, vertex);
    const double *x = show->position + 3 * (size_t)vertex;
    snprintf(w->picked, sizeof w->picked, "vertex %" PRIu32 "%s%.40s%s%.40s at %.4g, %.4g, %.4g m",
             picked.vertex, picked.cloth ? " of " : "", picked.cloth ? picked.cloth : "",
             picked.panel ? ", " : "", picked.panel ? picked.panel : "", x[0], x[1], x[2]);
    view_picked_probe(&picked, sizeof probe, probe);
    printf("%s\n", probe);
    fflush(stdout);
}

static void on_button(GLFWwindow *glfw, int button, int action, int mods)
{
    const double still = 3; /* pixels: a click that moves less is no drag */
    struct window *w = window_of(glfw);
    (void)mods;
    w->changed = true;
    if (button != GLFW_MOUSE_BUTTON_LEFT)
        return;
    const bool sought = w->seeking;
    w->seeking = action == GLFW_PRESS && seek(w);
    if (action == GLFW_PRESS) {
        w->press[0] = w->x;
        w->press[1] = w->y;
    } else if (!sought && hypot(w->x - w->press[0], w->y - w->press[1]) < still)
        pick(w);
}

static void on_mouse(GLFWwindow *glfw, double x, double y)
{
    struct window *w = window_of(glfw);
    int width, height;
    glfwGetWindowSize(glfw, &width, &height);
    const double right = (x - w->x) / height, up = (w->y - y) / height;
    w->x = x;
    w->y = y;
    w->moved = glfwGetTime();
    w->changed = true;
    if (w->seeking)
        seek(w);
    else if (glfwGetMouseButton(glfw, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS)
        view_orbit_turn(&w->show->sight.orbit, -TURN * right, -TURN * up);
    else if (glfwGetMouseButton(glfw, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS ||
             glfwGetMouseButton(glfw, GLFW_MOUSE_BUTTON_MIDDLE) == GLFW_PRESS)
        view_orbit_pan(&w->show->sight.orbit, right, up);
}

static void on_wheel(GLFWwindow *glfw, double x, double y)
{
    struct window *w = window_of(glfw);
    (void)x;
    view_orbit_zoom(&w->show->sight.orbit, y < 0 ? 1 / 1.1 : 1.1);
    w->changed = true;
}

static void on_change(GLFWwindow *glfw)
{
    window_of(glfw)->changed = true;
}

static int fail_as_glfw(const char *what, struct cloth_error *error)
{
    const char *reason = NULL;
    glfwGetError(&reason);
    return cloth_fail(error, CLOTH_E_LIBRARY,
                      "%s (%s); --png FILE and --mp4 FILE need neither a display nor a window",
                      what, reason ? reason : "no reason given");
}

static int open_glfw(struct window *w, const struct view_wish *wish, struct cloth_error *error)
{
    if (!glfwInit())
        return fail_as_glfw("no window can be opened here", error);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    w->glfw = glfwCreateWindow(wish->width, wish->height, "duite-view", NULL, NULL);
    if (!w->glfw)
        return fail_as_glfw("this display gives no window with OpenGL 3.3", error);
    glfwMakeContextCurrent(w->glfw);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(w->glfw, w);
    glfwSetKeyCallback(w->glfw, on_key);
    glfwSetMouseButtonCallback(w->glfw, on_button);
    glfwSetCursorPosCallback(w->glfw, on_mouse);
    glfwSetScrollCallback(w->glfw, on_wheel);
    glfwSetWindowRefreshCallback(w->glfw, on_change);
    return 0;
}

static void name_frame(const struct window *w, size_t size, char line[size])
{
    if (*w->picked || w->live) {
        snprintf(line, size, "%s", *w->picked ? w->picked : w->live->line);
        return;
    }
    snprintf(line, size, "frame %" PRIu64 " of 0 to %" PRIu64 ", %.4g s, %.4g frames a second",
             w->player.frame, w->player.n_frames - 1, w->show->cache->time[w->player.frame],
             w->player.rate);
}

static void set_title(const struct window *w)
{
    const struct view_orbit *orbit = &w->show->sight.orbit;
    char line[160], title[512];
    name_frame(w, sizeof line, line);
    snprintf(title, sizeof title, "%.200s: %s, --camera=%.3g,%.3g,%.3g (h: help)", w->folder, line,
             orbit->azimuth, orbit->elevation, orbit->zoom);
    glfwSetWindowTitle(w->glfw, title);
}

static bool has_line(const struct window *w, double now)
{
    return w->help || w->player.playing || *w->picked || now - w->moved < SEEN ||
           (w->live && w->live->waits);
}

static int draw_overlay(struct window *w, bool lined, int width, int height,
                        struct cloth_error *error)
{
    const uint64_t last = w->player.n_frames - 1;
    char line[160];
    name_frame(w, sizeof line, line);
    const struct view_overlay_text text = {
        .part = w->live ? -1
                : last  ? (double)w->player.frame / (double)last
                        : 1,
        .status = lined ? line : NULL,
        .help = w->help ? HELP : NULL,
        .legend = &w->show->colours.legend,
    };
    return view_overlay_draw(&w->overlay, &text, width, height, error);
}

static int window_draw(struct window *w, bool lined, struct cloth_error *error)
{
    int width, height;
    glfwGetFramebufferSize(w->glfw, &width, &height);
    if (width <= 0 || height <= 0)
        return 0; /* as an icon */
    int code = view_show_window(w->show, width, height, error);
    if (!code && (lined || w->show->colours.legend.by != VIEW_COLOUR_CLOTH))
        code = draw_overlay(w, lined, width, height, error);
    if (!code && glGetError() != GL_NO_ERROR)
        code = cloth_fail(error, CLOTH_E_LIBRARY, "OpenGL failed to draw the window");
    glfwSwapBuffers(w->glfw);
    set_title(w);
    return code;
}

static int save(struct window *w, struct cloth_error *error)
{
    struct view_picture picture = {.rgb = NULL};
    char name[64];
    snprintf(name, sizeof name, "duite-view-%" PRIu64 ".png",
             w->live ? w->live->frame : w->player.frame);
    glfwGetFramebufferSize(w->glfw, &picture.width, &picture.height);
    int code = view_show_picture(w->show, &picture, error);
    code = code ? code : view_picture_write(&picture, name, error);
    if (!code)
        printf("%s\n", name);
    fflush(stdout);
    view_picture_free(&picture);
    return code;
}

/* Takes the news of a live run. */
static int window_look(struct window *w, struct cloth_error *error)
{
    if (!w->live)
        return 0;
    const bool waited = w->live->waits;
    const int code = w->live->look(w->live, error);
    w->show = w->live->show;
    if (w->live->fresh && !code)
        w->show->wire = w->wire;
    w->changed = w->changed || w->live->fresh || w->live->waits != waited;
    return code;
}

static int window_run(struct window *w, struct cloth_error *error)
{
    uint64_t seen = w->player.frame;
    bool lined = false;
    int code = view_show_frame(w->show, seen, error);
    for (w->changed = true; !code && !glfwWindowShouldClose(w->glfw);
         code = code ? code : window_look(w, error)) {
        const double now = glfwGetTime();
        const uint64_t frame = view_player_at(&w->player, now);
        const bool line = has_line(w, now);
        if (frame != seen)
            code = view_show_frame(w->show, frame, error);
        for (; !code && w->recolour; w->recolour--)
            code = view_show_next_colour(w->show, error);
        if (!code && (w->changed || frame != seen || line != lined)) {
            w->changed = false;
            code = window_draw(w, line, error);
        }
        if (!code && w->save)
            code = save(w, error);
        w->save = false;
        seen = frame;
        lined = line;
        if (w->player.playing)
            glfwPollEvents();
        else
            glfwWaitEventsTimeout(w->live ? AWAKE : ASLEEP);
    }
    return code;
}

static int open_and_run(struct window *w, struct cloth_error *error)
{
    const struct view_wish *wish = w->show->wish;
    w->folder = wish->folder;
    w->wire = wish->wire;
    w->moved = -SEEN;
    int code = open_glfw(w, wish, error);
    code = code ? code : view_overlay_make(&w->overlay, error);
    code = code ? code : window_run(w, error);
    if (w->glfw) {
        view_overlay_free(&w->overlay);
        if (w->show)
            view_show_undraw(w->show);
    }
    glfwTerminate();
    return code;
}

int view_window(struct view_show *show, uint64_t frame, struct cloth_error *error)
{
    struct window w = {.show = show};
    view_player_start(&w.player, show->cache->n_frames, frame, show->cache->fps);
    return open_and_run(&w, error);
}

int view_window_live(struct view_live *live, struct cloth_error *error)
{
    struct window w = {.show = live->show, .live = live};
    view_player_start(&w.player, 1, 0, 1);
    return open_and_run(&w, error);
}
