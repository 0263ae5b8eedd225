/* The command line of the viewer: reads the options, runs the view, prints errors. */
#include "config.h"

#include "cloth/app/check/intersections.h"
#include "cloth/app/view/frames.h"
#include "cloth/app/view/live.h"
#include "cloth/app/view/trace.h"
#include "cloth/output/output.h"
#include "cloth/view/show.h"
#include "cloth/view/window.h"

#include <argp.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

const char *argp_program_version = "duite-view " PACKAGE_VERSION;

enum { LAST_FRAME = -1 };
enum { EXIT_INTERSECTS = 4 }; /* as duite-cloth has it */

struct options {
    struct view_wish wish;
    const char *png, *mp4;
    long long frame;       /* LAST_FRAME: the last, */
    long long first, last; /* so is `last' of a film */
    double fps;            /* of a film; 0: of the folder */
    bool check_intersections;
    struct view_live_wish live; /* of a run that goes on, instead of a folder */
    const char *trace, *svg;
    struct chart_options chart; /* of the trace */
    /* Options given: --size, --window, one of frames, one of folders, one of films. */
    bool sized, windowed, framed, numbered, filmed;
};

static const struct argp_option OPTIONS[] = {
    {"png", 'o', "FILE", 0, "Write a picture to FILE", 0},
    {"frame", 'f', "N", 0,
     "Frame of a picture, or the first one of a window, counted from 0, or `last' (the default)",
     0},
    {"mp4", 'm', "FILE", 0, "Write a film to FILE, encoded by ffmpeg", 0},
    {"frames", 'n', "A:B", 0, "Frames of the film, from A to B; either may be left out (all)", 0},
    {"fps", 'r', "RATE", 0, "Frames a second of the film (those of the scene: its own time)", 0},
    {"size", 's', "WxH", 0,
     "Pixels of a picture, film or window (1280x720; of a chart 1280, and as high as its rows)", 0},
    {"camera", 'c', "AZIMUTH,ELEVATION[,ZOOM]", 0,
     "Where to look from, in degrees: 0,0 is from +z, 90,0 from +x (32,20,1)", 0},
    {"colour", 'k', "WORD[,[MIN:]MAX]", 0,
     "Colour the cloth by block, rank, strain (m/m), stress (N/m), contact (N) or as cloth; the "
     "numbers on a scale from MIN (0) to MAX (the largest of all frames)",
     0},
    {"wireframe", 'e', NULL, 0, "Draw the edges of the cloth's triangles, too", 0},
    {"connect", VIEW_LIVE_CONNECT, "HOST:PORT", 0,
     "Show the newest frame of a run that goes on: duite-cloth --live PORT; no DIR then", 0},
    {"wait", VIEW_LIVE_WAIT, "SECONDS", 0, "How long --connect with --png waits for a frame (10)",
     0},
    {"trace", 't', "FILE", 0,
     "Draw the Gantt chart of a run from the trace that duite-cloth --trace wrote; no DIR then", 0},
    {"svg", 'v', "FILE", 0, "Write the chart of --trace to FILE as SVG", 0},
    {"window", 'w', "FROM:TO", 0,
     "Seconds that the chart of --trace shows, or percent of the run (all)", 0},
    {"check-intersections", 'i', NULL, 0,
     "Look in all frames, exactly, for triangles that go through each other or through obstacles",
     0},
    {0}};

/* A number of a frame, from the text up to *end. */
static int view_cli_parse_number(const char *text, long long *frame, char **end)
{
    errno = 0;
    *frame = strtoll(text, end, 10);
    return *text < '0' || *text > '9' || errno;
}

static int parse_frame(const char *text, struct options *options)
{
    char *end = NULL;
    options->frame = LAST_FRAME;
    return strcmp(text, "last") != 0 &&
           (view_cli_parse_number(text, &options->frame, &end) || *end);
}

/* A:B, where A or B may be left out. */
static int parse_frames(const char *text, struct options *options)
{
    char *end = (char *)(uintptr_t)text;
    options->first = 0;
    options->last = LAST_FRAME;
    if (*text != ':' && view_cli_parse_number(text, &options->first, &end))
        return 1;
    if (*end++ != ':')
        return 1;
    text = end;
    if (*text && (view_cli_parse_number(text, &options->last, &end) || *end))
        return 1;
    return options->last != LAST_FRAME && options->last < options->first;
}

static int parse_fps(const char *text, struct options *options)
{
    char *end = NULL;
    options->fps = strtod(text, &end);
    return end == text || *end || !(options->fps >= 0.1 && options->fps <= 1000);
}

static int parse_size(const char *text, struct view_wish *wish)
{
    int end = 0;
    int n = sscanf(text, "%5dx%5d%n", &wish->width, &wish->height, &end);
    return n != 2 || text[end] || wish->width < 1 || wish->height < 1;
}

static int parse_camera(const char *text, struct view_wish *wish)
{
    int end = 0;
    if (sscanf(text, "%lf,%lf%n", &wish->azimuth, &wish->elevation, &end) != 2)
        return 1;
    text += end;
    wish->zoom = 1;
    if (*text && (sscanf(text, ",%lf%n", &wish->zoom, &end) != 1 || text[end]))
        return 1;
    return !isfinite(wish->azimuth) || !(fabs(wish->elevation) <= 89) ||
           !(wish->zoom > 0 && wish->zoom <= 1000);
}

static bool opens_window(const struct options *options)
{
    return !options->trace && !options->png && !options->mp4 && !options->check_intersections;
}

static void check_live(const struct options *options, struct argp_state *state)
{
    const char *lacks = live_lacks();
    if (!options->live.host && options->live.waits)
        argp_error(state, "--wait is of --connect HOST:PORT");
    if (!options->live.host)
        return;
    if (lacks)
        argp_error(state, "--connect: %s", lacks);
    if (options->wish.folder || options->trace || options->mp4 || options->check_intersections ||
        options->numbered)
        argp_error(state,
                   "--connect shows the newest frame of a run: no folder, trace, number of a "
                   "frame, film, colour or check goes with it");
}

/* Refuses options that lack their partner. */
static void check_together(const struct options *options, struct argp_state *state)
{
    if (!options->trace && (options->svg || options->windowed))
        argp_error(state, "--svg and --window are of charts: --trace FILE");
    if (options->trace &&
        (options->wish.folder || options->framed || options->mp4 || options->check_intersections))
        argp_error(state, "--trace draws a chart of a run: no folder, frame, film, camera, colour "
                          "or check goes with it");
    if (options->filmed && !options->mp4)
        argp_error(state, "--frames and --fps are of films: --mp4 FILE");
    if (options->trace && !options->png && !options->svg)
        argp_error(state, "say where the chart goes: --svg FILE or --png FILE");
    if (!options->trace && !options->live.host && !options->wish.folder)
        argp_error(state, "say which folder of frames to show, or --connect HOST:PORT");
#ifndef HAVE_WINDOW
    if (opens_window(options))
        argp_error(state, "this build opens no windows: say where the picture goes by --png FILE, "
                          "or --mp4 FILE");
#endif
}

static error_t parse_live(int key, char *arg, struct argp_state *state)
{
    struct options *options = state->input;
    const char *wrong = NULL;
    const bool known = view_live_parse(key, arg, &options->live, &wrong);
    if (wrong)
        argp_error(state, "%s, not `%s'", wrong, arg);
    return known ? 0 : ARGP_ERR_UNKNOWN;
}

static error_t parse_chart(int key, char *arg, struct argp_state *state)
{
    struct options *options = state->input;
    switch (key) {
    case 't':
    case 'v':
        if (!*arg)
            argp_error(state, "%s takes the name of a file", key == 't' ? "--trace" : "--svg");
        *(key == 't' ? &options->trace : &options->svg) = arg;
        return 0;
    case 'w':
        options->windowed = true;
        if (!chart_window_parse(arg, &options->chart))
            argp_error(state,
                       "--window takes FROM:TO in seconds, such as 0.1:0.2, or in percent of the "
                       "run, such as 50%%:51%%, not `%s'",
                       arg);
        return 0;
    default:
        return parse_live(key, arg, state);
    }
}

static error_t parse_film(int key, char *arg, struct argp_state *state)
{
    struct options *options = state->input;
    options->filmed |= key == 'n' || key == 'r';
    switch (key) {
    case 'm':
        if (!*arg)
            argp_error(state, "--mp4 takes the name of a file");
        options->mp4 = arg;
        return 0;
    case 'n':
        if (parse_frames(arg, options))
            argp_error(state, "--frames takes A:B, A up to B, such as 0:24, 10: or :24, not `%s'",
                       arg);
        return 0;
    case 'r':
        if (parse_fps(arg, options))
            argp_error(state, "--fps takes a rate from 0.1 to 1000 frames a second, not `%s'", arg);
        return 0;
    default:
        return parse_chart(key, arg, state);
    }
}

static error_t view_cli_parse(int key, char *arg, struct argp_state *state)
{
    struct options *options = state->input;
    const char *wrong;
    options->framed |= key == 'f' || key == 'c' || key == 'k' || key == 'e';
    options->numbered |= key == 'f' || key == 'k';
    options->sized |= key == 's';
    switch (key) {
    case 'o':
        if (!*arg)
            argp_error(state, "--png takes the name of a file");
        options->png = arg;
        return 0;
    case 'f':
        if (parse_frame(arg, options))
            argp_error(state, "--frame takes a number from 0 or `last', not `%s'", arg);
        return 0;
    case 's':
        if (parse_size(arg, &options->wish))
            argp_error(state, "--size takes WIDTHxHEIGHT, such as 1280x720, not `%s'", arg);
        return 0;
    case 'c':
        if (parse_camera(arg, &options->wish))
            argp_error(state,
                       "--camera takes AZIMUTH,ELEVATION[,ZOOM], the elevation within +-89 and "
                       "the zoom above 0 and up to 1000, not `%s'",
                       arg);
        return 0;
    case 'k':
        wrong = view_colouring_parse(arg, &options->wish.colouring);
        if (wrong)
            argp_error(state, "--colour %s, not `%s'", wrong, arg);
        return 0;
    case 'e':
        options->wish.wire = true;
        return 0;
    case 'i':
        options->check_intersections = true;
        return 0;
    case ARGP_KEY_ARG:
        if (options->wish.folder)
            argp_error(state, "one folder at a time: `%s' is one too many", arg);
        options->wish.folder = arg;
        return 0;
    case ARGP_KEY_END:
        check_live(options, state);
        check_together(options, state);
        return 0;
    default:
        return parse_film(key, arg, state);
    }
}

/* The number of a frame that is asked for. */
static int view_cli_find_frame(const struct output_cache *cache, const struct options *options,
                               long long wanted, uint64_t *frame, struct cloth_error *error)
{
    const uint64_t n = cache->n_frames;
    if (n == 0)
        return cloth_fail(error, CLOTH_E_INPUT, "%s has no finished frame", options->wish.folder);
    if (wanted != LAST_FRAME && (uint64_t)wanted >= n)
        return cloth_fail(error, CLOTH_E_INPUT, "%s has %ju frames, 0 to %ju: no frame %lld",
                          options->wish.folder, (uintmax_t)n, (uintmax_t)(n - 1), wanted);
    *frame = wanted == LAST_FRAME ? n - 1 : (uint64_t)wanted;
    return 0;
}

static int write_picture(struct view_show *show, const struct output_cache *cache,
                         const struct options *options, struct cloth_error *error)
{
    struct view_picture picture = {options->wish.width, options->wish.height, NULL};
    struct view_context *context = NULL;
    uint64_t frame = 0;
    int code = view_cli_find_frame(cache, options, options->frame, &frame, error);
    code = code ? code : view_show_frame(show, frame, error);
    code = code ? code : view_context_open(&context, error);
    code = code ? code : view_show_picture(show, &picture, error);
    code = code ? code : view_picture_write(&picture, options->png, error);
    if (!code)
        view_show_say(show);
    view_picture_free(&picture);
    view_show_undraw(show);
    view_context_close(context);
    return code;
}

static int write_film(struct view_show *show, const struct output_cache *cache,
                      const struct options *options, struct cloth_error *error)
{
    struct view_frames frames = {.path = options->mp4,
                                 .width = options->wish.width,
                                 .height = options->wish.height,
                                 .fps = options->fps > 0 ? options->fps : cache->fps};
    int code = view_cli_find_frame(cache, options, options->last, &frames.last, error);
    code = code ? code : view_cli_find_frame(cache, options, options->first, &frames.first, error);
    return code ? code : view_frames_film(show, &frames, error);
}

static int open_window(struct view_show *show, const struct output_cache *cache,
                       const struct options *options, struct cloth_error *error)
{
#ifdef HAVE_WINDOW
    uint64_t frame = 0;
    const int code = view_cli_find_frame(cache, options, options->frame, &frame, error);
    return code ? code : view_window(show, cache, &options->wish, frame, error);
#else
    (void)show, (void)cache, (void)options;
    return cloth_fail(error, CLOTH_E_LIBRARY, "this build opens no windows");
#endif
}

static int show_frames(struct output_cache *cache, const struct options *options,
                       struct cloth_error *error)
{
    struct view_show *show = NULL;
    uint64_t any;
    int code = view_cli_find_frame(cache, options, LAST_FRAME, &any, error);
    code = code ? code : view_show_open(&show, cache, &options->wish, error);
    if (!code && options->png)
        code = write_picture(show, cache, options, error);
    if (!code && options->mp4)
        code = write_film(show, cache, options, error);
    if (!code && opens_window(options))
        code = open_window(show, cache, options, error);
    view_show_close(show);
    return code;
}

/* The exit code if nothing failed. */
static int view_cli_check_frames(struct output_cache *cache, int *exit_code,
                                 struct cloth_error *error)
{
    struct intersections_found found = {0};
    const int code = intersections_of_folder(cache, "duite-view", &found, error);
    if (code)
        return code;
    if (!found.bad)
        printf("no intersections in %ju frames\n", (uintmax_t)found.frames);
    intersections_say(&found, "duite-view");
    *exit_code = found.bad ? EXIT_INTERSECTS : 0;
    return CLOTH_OK;
}

/* Prints the error, returns the exit code. */
static int view_cli_say(int code, const struct cloth_error *error)
{
    if (code)
        fprintf(stderr, "duite-view: %s\n", error->text);
    return code ? code == CLOTH_E_INPUT ? 2 : 1 : 0;
}

static int draw_trace(struct options *options, struct cloth_error *error)
{
    if (options->sized) {
        options->chart.width = options->wish.width;
        options->chart.height = options->wish.height;
    }
    return view_cli_say(
        view_trace(options->trace, &options->chart, options->svg, options->png, error), error);
}

static int show_live(struct options *options, struct cloth_error *error)
{
    options->wish.folder = options->live.host;
    return view_cli_say(
        options->png ? view_live_picture(&options->wish, options->png, options->live.seconds, error)
                     : view_live_window(&options->wish, error),
        error);
}

int main(int argc, char **argv)
{
    static const struct argp argp = {
        OPTIONS,
        view_cli_parse,
        "DIR\n--connect HOST:PORT\n--trace FILE",
        "Shows a simulated cloth in a window, makes a picture or a film of it, or checks all "
        "frames; DIR "
        "is what duite-cloth --output wrote. Or shows a run that goes on, or draws the Gantt chart "
        "of one.",
        NULL,
        NULL,
        NULL};
    struct options options = {
        .frame = LAST_FRAME,
        .last = LAST_FRAME,
        .chart = chart_options_default(),
        .live = {.seconds = 10},
        .wish = {.width = 1280, .height = 720, .azimuth = 32, .elevation = 20, .zoom = 1}};
    argp_err_exit_status = 2;
    argp_parse(&argp, argc, argv, 0, NULL, &options);
    struct cloth_error error = {0};
    struct output_cache cache = {0};
    int exit_code = 0;
    if (options.trace)
        return draw_trace(&options, &error);
    if (options.live.host)
        return show_live(&options, &error);
    int code = output_cache_open(&cache, options.wish.folder, &error);
    if (!code && (options.png || options.mp4 || opens_window(&options)))
        code = show_frames(&cache, &options, &error);
    if (!code && options.check_intersections)
        code = view_cli_check_frames(&cache, &exit_code, &error);
    output_cache_close(&cache);
    return code ? view_cli_say(code, &error) : exit_code;
}
