/* The command line of the viewer: reads the options, runs the view, prints errors. */
#include "config.h"

#include "cloth/app/cli.h"
#include "cloth/app/run/options.h"
#include "cloth/app/view/frames.h"
#include "cloth/app/view/live.h"
#include "cloth/app/view/start.h"
#include "cloth/live/live.h"
#include "cloth/output/files/files.h"
#include "cloth/view/window.h"
#include "tools/chart/chart.h"
#include "tools/trace/read.h"

#include <duite.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *argp_program_version = "duite-view " PACKAGE_VERSION;

enum { EXIT_INTERSECTS = 4 }; /* as duite-cloth has it */

/* Marks of options that are given: one of frames, of numbered frames, of the rate of films, of the
 * chart; the size; the seconds to wait; from which frame to which. */
enum { FRAMED = 1, NUMBERED = 2, FILMED = 4, CHARTED = 8, SIZED = 16, WAITS = 32, RANGED = 64 };

struct options {
    struct view_wish wish;
    const char *folder, *png, *mp4, *export;
    uint64_t frame, first, last; /* VIEW_LAST_FRAME: the last one */
    double fps;                  /* of a film; 0: of the folder */
    bool check_intersections;
    const char *host; /* HOST:PORT of a run that goes on; NULL: none */
    double seconds;   /* that a picture waits for its frame */
    const char *trace, *svg;
    struct chart_options chart; /* of the trace */
    unsigned given;
};

/* ---- The command line ---- */

static bool read_frame(const char *text, void *to, struct argp_state *state)
{
    uint64_t *frame = &((struct options *)to)->frame;
    char *end = NULL;
    (void)state;
    errno = 0;
    *frame = strcmp(text, "last") == 0 ? VIEW_LAST_FRAME : strtoull(text, &end, 10);
    return !end || (*text >= '0' && *text <= '9' && !errno && !*end && *frame <= INT64_MAX);
}

static bool read_frames(const char *text, void *to, struct argp_state *state)
{
    struct options *options = to;
    (void)state;
    options->first = 0;
    options->last = VIEW_LAST_FRAME;
    return options_range(text, &options->first, &options->last);
}

static bool read_export(const char *text, void *to, struct argp_state *state)
{
    (void)state;
    ((struct options *)to)->export = text;
    return view_frames_can_export(text);
}

static bool read_fps(const char *text, void *to, struct argp_state *state)
{
    double *fps = &((struct options *)to)->fps;
    (void)state;
    return cli_above_0(text, fps) && *fps >= 0.1 && *fps <= 1000;
}

static bool read_picture_size(const char *text, void *to, struct argp_state *state)
{
    struct view_wish *wish = &((struct options *)to)->wish;
    int end = 0;
    (void)state;
    return sscanf(text, "%5dx%5d%n", &wish->width, &wish->height, &end) == 2 && !text[end] &&
           wish->width >= 1 && wish->height >= 1;
}

static bool read_camera(const char *text, void *to, struct argp_state *state)
{
    struct view_wish *wish = &((struct options *)to)->wish;
    int end = 0;
    (void)state;
    if (sscanf(text, "%lf,%lf%n", &wish->azimuth, &wish->elevation, &end) != 2)
        return false;
    text += end;
    wish->zoom = 1;
    if (*text && (sscanf(text, ",%lf%n", &wish->zoom, &end) != 1 || text[end]))
        return false;
    return isfinite(wish->azimuth) && fabs(wish->elevation) <= 89 && wish->zoom > 0 &&
           wish->zoom <= 1000;
}

static bool read_colour(const char *text, void *to, struct argp_state *state)
{
    const char *wrong = view_colouring_parse(text, &((struct options *)to)->wish.colouring);
    if (wrong)
        argp_error(state, "--colour %s, not `%s'", wrong, text);
    return true;
}

static bool read_host(const char *text, void *to, struct argp_state *state)
{
    (void)state;
    ((struct options *)to)->host = text;
    return live_is_host(text);
}

static bool read_wait(const char *text, void *to, struct argp_state *state)
{
    double *seconds = &((struct options *)to)->seconds;
    (void)state;
    return cli_above_0(text, seconds) && *seconds <= 1e6;
}

static bool read_window(const char *text, void *to, struct argp_state *state)
{
    (void)state;
    return chart_window_parse(text, &((struct options *)to)->chart);
}

#define TO(member) offsetof(struct options, member)
static const struct cli_option OPTIONS[] = {
    {"png", 'o', "FILE", "Write a picture to FILE", CLI_FILE, TO(png), NULL, NULL, 0},
    {"frame", 'f', "N",
     "Frame of a picture, or the first one of a window, counted from 0, or `last' (the default)",
     CLI_OTHER, 0, "a number from 0 or `last'", read_frame, FRAMED | NUMBERED},
    {"mp4", 'm', "FILE", "Write a film to FILE, encoded by ffmpeg", CLI_FILE, TO(mp4), NULL, NULL,
     0},
    {"export", 'x', "FILE",
     "Write frames for other programs to FILE: all of --frames as .usda (USD) or .abc (Alembic), "
     "or one --frame as .glb (glTF) or .obj",
     CLI_OTHER, 0, "a FILE that ends in .usda, .usd, .abc, .glb or .obj", read_export, 0},
    {"frames", 'n', "A:B",
     "Frames of the film, of USD, of Alembic or of the check, from A to B; either may be left out "
     "(all)",
     CLI_OTHER, 0, "A:B, A up to B, such as 0:24, 10: or :24", read_frames, RANGED},
    {"fps", 'r', "RATE", "Frames a second of the film (those of the scene: its own time)",
     CLI_OTHER, 0, "a rate from 0.1 to 1000 frames a second", read_fps, FILMED},
    {"size", 's', "WxH",
     "Pixels of a picture, film or window (1280x720; of a chart 1280, and as high as its rows)",
     CLI_OTHER, 0, "WIDTHxHEIGHT, such as 1280x720", read_picture_size, SIZED},
    {"camera", 'c', "AZIMUTH,ELEVATION[,ZOOM]",
     "Where to look from, in degrees: 0,0 is from +z, 90,0 from +x (32,20,1)", CLI_OTHER, 0,
     "AZIMUTH,ELEVATION[,ZOOM], the elevation within +-89 and the zoom above 0 and up to 1000",
     read_camera, FRAMED},
    {"colour", 'k', "WORD[,[MIN:]MAX]",
     "Colour the cloth by block, rank, strain (m/m), stress (N/m), contact (N) or as cloth; the "
     "numbers on a scale from MIN (0) to MAX (the largest of all frames)",
     CLI_OTHER, 0, NULL, read_colour, FRAMED | NUMBERED},
    {"wireframe", 'e', NULL, "Draw the edges of the cloth's triangles, too", CLI_FLAG,
     TO(wish.wire), NULL, NULL, FRAMED},
    {"connect", 'l', "HOST:PORT",
     "Show the newest frame of a run that goes on: duite-cloth --live PORT; no DIR then", CLI_OTHER,
     0, "HOST:PORT, such as localhost:5555", read_host, 0},
    {"wait", 'a', "SECONDS", "How long --connect with --png waits for a frame (10)", CLI_OTHER, 0,
     "seconds, above 0 and at most 1e6", read_wait, WAITS},
    {"trace", 't', "FILE",
     "Draw the Gantt chart of a run from the trace that duite-cloth --trace wrote; no DIR then",
     CLI_FILE, TO(trace), NULL, NULL, 0},
    {"svg", 'v', "FILE", "Write the chart of --trace to FILE as SVG", CLI_FILE, TO(svg), NULL, NULL,
     CHARTED},
    {"window", 'w', "FROM:TO",
     "Seconds that the chart of --trace shows, or percent of the run (all)", CLI_OTHER, 0,
     "FROM:TO in seconds, such as 0.1:0.2, or in percent of the run, such as 50%:51%", read_window,
     CHARTED},
    {"check-intersections", 'i', NULL,
     "Look in all frames, or --frames, exactly, for triangles that go through each other or "
     "through obstacles",
     CLI_FLAG, TO(check_intersections), NULL, NULL, 0}};

static bool opens_window(const struct options *options)
{
    return !options->trace && !options->png && !options->mp4 && !options->export &&
           !options->check_intersections;
}

static void check_live(const struct options *options, struct argp_state *state)
{
    const char *lacks = live_lacks();
    if (!options->host && options->given & WAITS)
        argp_error(state, "--wait is of --connect HOST:PORT");
    if (!options->host)
        return;
    if (lacks)
        argp_error(state, "--connect: %s", lacks);
    if (options->folder || options->trace || options->mp4 || options->export ||
        options->check_intersections || options->given & NUMBERED)
        argp_error(state,
                   "--connect shows the newest frame of a run: no folder, trace, number of a "
                   "frame, film, export, colour or check goes with it");
}

/* Refuses options that lack their partner. */
static void check_together(void *to, struct argp_state *state)
{
    const struct options *options = to;
    check_live(options, state);
    if (!options->trace && options->given & CHARTED)
        argp_error(state, "--svg and --window are of charts: --trace FILE");
    if (options->trace && (options->folder || options->given & FRAMED || options->mp4 ||
                           options->export || options->check_intersections))
        argp_error(state, "--trace draws a chart of a run: no folder, frame, film, export, camera, "
                          "colour or check goes with it");
    if (options->given & FILMED && !options->mp4)
        argp_error(state, "--fps is of films: --mp4 FILE");
    if (options->given & RANGED && !options->mp4 && !options->check_intersections &&
        !(options->export && view_frames_exports_many(options->export)))
        argp_error(
            state,
            "--frames is of films, of USD, of Alembic and of the check: --mp4 FILE, --export "
            "FILE.usda or FILE.abc, or --check-intersections");
    if (options->trace && !options->png && !options->svg)
        argp_error(state, "say where the chart goes: --svg FILE or --png FILE");
    if (!options->trace && !options->host && !options->folder)
        argp_error(state, "say which folder of frames or scene to show, or --connect HOST:PORT");
#ifndef HAVE_WINDOW
    if (opens_window(options))
        argp_error(state, "this build opens no windows: say where the picture goes by --png FILE, "
                          "or --mp4 FILE");
#endif
}

static const struct cli CLI = {
    .arguments = "DIR\nSCENE.yaml\n--connect HOST:PORT\n--trace FILE",
    .about = "Shows a simulated cloth in a window, makes a picture or a film of it, writes it for "
             "other programs, or checks all frames; DIR is what duite-cloth --output wrote. Or "
             "shows the start of a scene, with its pins and seams; a run that goes on; or the "
             "Gantt chart of one.",
    .option = OPTIONS,
    .n_options = sizeof OPTIONS / sizeof *OPTIONS,
    .marks = TO(given),
    .argument = TO(folder),
    .one = "one folder at a time",
    .finish = check_together};

/* ---- Frames of a folder ---- */

/* Standard output says it where there are none. */
static int check_frames(struct output_cache *cache, const struct options *options, bool *bad,
                        struct cloth_error *error)
{
    const struct view_frames frames = {.first = options->first, .last = options->last};
    struct intersections_found found = {0};
    const int code = view_frames_check(cache, options->folder, &frames, &found, error);
    if (code)
        return code;
    if (!found.bad)
        printf("no intersections in %ju frames\n", (uintmax_t)found.frames);
    intersections_say(&found, "duite-view");
    *bad = found.bad > 0;
    return CLOTH_OK;
}

static int show_frames(struct view_show *show, const struct options *options,
                       struct cloth_error *error)
{
    const struct view_frames film = {.path = options->mp4,
                                     .fps = options->fps > 0 ? options->fps : show->cache->fps,
                                     .first = options->first,
                                     .last = options->last};
    int code = CLOTH_OK;
    if (options->png)
        code = view_frames_picture(show, options->frame, options->png, error);
    if (!code && options->mp4)
        code = view_frames_film(show, &film, error);
    if (!code && opens_window(options))
        code = view_frames_window(show, options->frame, error);
    return code;
}

/* A scene that has not run has one frame, with marks that are no cloth. */
static int open_start(struct output_cache *cache, const struct options *options, const char *path,
                      struct cloth_error *error)
{
    if (options->mp4 || options->export || options->check_intersections)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s has not run: it has no film, no export and no frames to check; "
                          "duite-cloth --output DIR makes them",
                          options->folder);
    return view_start_open(cache, path ? path : options->folder, error);
}

static int show_folder(struct options *options, bool *bad, struct cloth_error *error)
{
    struct output_cache cache = {0};
    struct view_show *show = NULL;
    char *path;
    int code = view_start_is_scene(options->folder, &path)
                   ? open_start(&cache, options, path, error)
                   : output_cache_open(&cache, options->folder, error);
    if (!code && (options->png || options->mp4 || opens_window(options))) {
        code = view_frames_open(&show, &cache, &options->wish, error);
        code = code ? code : show_frames(show, options, error);
        view_show_close(show);
    }
    if (!code && options->export) {
        const struct view_frames frames = {
            .path = options->export, .first = options->first, .last = options->last};
        code = view_frames_export(&cache, options->folder, &frames, options->frame, error);
    }
    if (!code && options->check_intersections)
        code = check_frames(&cache, options, bad, error);
    output_cache_close(&cache);
    free(path);
    return code;
}

/* ---- The chart of a run ---- */

typedef int chart_write(const struct trace_run *run, const struct chart_options *options,
                        FILE *file);
struct chart {
    const struct trace_run *run;
    const struct chart_options *options;
    chart_write *write;
    struct cloth_error *error;
};

static int fill_chart(FILE *file, const void *what)
{
    const struct chart *chart = what;
    const int code = chart->write(chart->run, chart->options, file);
    return code ? cloth_fail(chart->error,
                             code == DUITE_E_ARGUMENT ? CLOTH_E_INPUT : CLOTH_E_LIBRARY, "%s",
                             duite_message())
                : CLOTH_OK;
}

static int draw_trace(struct options *options, struct cloth_error *error)
{
    struct trace_run *run;
    if (options->given & SIZED) {
        options->chart.width = options->wish.width;
        options->chart.height = options->wish.height;
    }
    if (trace_read(&run, options->trace, false))
        return cloth_fail(error, CLOTH_E_INPUT, "%s", duite_message());
    struct chart svg = {run, &options->chart, chart_write_svg, error};
    struct chart png = {run, &options->chart, chart_write_png, error};
    int code = options->svg ? output_replace_file(options->svg, fill_chart, &svg, error) : CLOTH_OK;
    if (!code && options->png)
        code = output_replace_file(options->png, fill_chart, &png, error);
    trace_run_free(run);
    return code;
}

static int show_live(const struct options *options, struct cloth_error *error)
{
    return options->png ? view_live_picture(&options->wish, options->png, options->seconds, error)
                        : view_live_window(&options->wish, error);
}

int main(int argc, char **argv)
{
    struct options options = {
        .frame = VIEW_LAST_FRAME,
        .last = VIEW_LAST_FRAME,
        .chart = chart_options_default(),
        .seconds = 10,
        .wish = {.width = 1280, .height = 720, .azimuth = 32, .elevation = 20, .zoom = 1}};
    struct cloth_error error = {0};
    bool bad = false;
    cli_read(&CLI, argc, argv, &options);
    options.wish.folder = options.host ? options.host : options.folder;
    if (options.trace)
        draw_trace(&options, &error);
    else if (options.host)
        show_live(&options, &error);
    else
        show_folder(&options, &bad, &error);
    const int code = cli_end("duite-view", &error);
    return code || !bad ? code : EXIT_INTERSECTS;
}
