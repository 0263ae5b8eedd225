/* The command line of the viewer: reads what is asked for, hands it on, says what failed. */
#include "config.h"

#include "cloth/intersections.h"
#include "cloth/output/output.h"
#include "cloth/view/view.h"
#include "cloth/view_trace.h"

#include <argp.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

const char *argp_program_version = "duite-view " PACKAGE_VERSION;

enum { LAST_FRAME = -1, FITTED_FRAMES = 100 };
enum { EXIT_INTERSECTS = 4 }; /* as duite-cloth has it */

struct options {
    const char *folder, *png;
    long long frame; /* LAST_FRAME: the last */
    int width, height;
    double azimuth, elevation, zoom;
    bool check_intersections;
    bool contact; /* coloured by its force */
    const char *trace, *svg;
    struct chart_options chart;   /* of the trace */
    bool sized, windowed, framed; /* --size was given; --window; an option of frames */
    double most_force;            /* N: that has the hottest colour; 0: the largest of the frame */
};

static const struct argp_option OPTIONS[] = {
    {"png", 'o', "FILE", 0, "Write a picture to FILE", 0},
    {"frame", 'f', "N", 0, "Frame to show, counted from 0, or `last' (the default)", 0},
    {"size", 's', "WxH", 0,
     "Pixels of the picture (1280x720; of a chart 1280, and as high as its rows)", 0},
    {"camera", 'c', "AZIMUTH,ELEVATION[,ZOOM]", 0,
     "Where to look from, in degrees: 0,0 is from +z, 90,0 from +x (32,20,1)", 0},
    {"colour", 'k', "contact[,MAX]", 0,
     "Colour the cloth by the force of contact on its vertices, up to MAX N (the largest)", 0},
    {"trace", 't', "FILE", 0,
     "Draw the Gantt chart of a run from the trace that duite-cloth --trace wrote; no DIR then", 0},
    {"svg", 'v', "FILE", 0, "Write the chart of --trace to FILE as SVG", 0},
    {"window", 'w', "FROM:TO", 0, "Seconds that the chart of --trace shows (all)", 0},
    {"check-intersections", 'i', NULL, 0,
     "Look in all frames, exactly, for triangles that go through each other or through obstacles",
     0},
    {0}};

static int parse_frame(const char *text, struct options *options)
{
    char *end = NULL;
    options->frame = LAST_FRAME;
    if (strcmp(text, "last") == 0)
        return 0;
    options->frame = strtoll(text, &end, 10);
    return *text < '0' || *text > '9' || *end;
}

static int parse_size(const char *text, struct options *options)
{
    int end = 0;
    int n = sscanf(text, "%5dx%5d%n", &options->width, &options->height, &end);
    return n != 2 || text[end] || options->width < 1 || options->height < 1;
}

static int parse_camera(const char *text, struct options *options)
{
    int end = 0;
    if (sscanf(text, "%lf,%lf%n", &options->azimuth, &options->elevation, &end) != 2)
        return 1;
    text += end;
    options->zoom = 1;
    if (*text && (sscanf(text, ",%lf%n", &options->zoom, &end) != 1 || text[end]))
        return 1;
    return !isfinite(options->azimuth) || !(fabs(options->elevation) <= 89) ||
           !(options->zoom > 0 && options->zoom <= 1000);
}

static int parse_colour(const char *text, struct options *options)
{
    static const char word[] = "contact";
    int end = 0;
    options->contact = true;
    options->most_force = 0;
    if (strncmp(text, word, strlen(word)) != 0)
        return 1;
    text += strlen(word);
    if (*text && (sscanf(text, ",%lf%n", &options->most_force, &end) != 1 || text[end]))
        return 1;
    return *text && !(options->most_force > 0 && isfinite(options->most_force));
}

/* What belongs together. */
static void check_together(const struct options *options, struct argp_state *state)
{
    if (!options->trace && (options->svg || options->windowed))
        argp_error(state, "--svg and --window are of charts: --trace FILE");
    if (options->trace && (options->folder || options->framed || options->check_intersections))
        argp_error(state, "--trace draws a chart of a run: no folder, frame, camera, colour or "
                          "check goes with it");
    if (options->trace && !options->png && !options->svg)
        argp_error(state, "say where the chart goes: --svg FILE or --png FILE");
    if (!options->trace && !options->folder)
        argp_error(state, "say which folder of frames to show");
    if (!options->png && !options->svg && !options->check_intersections)
        argp_error(state, "say where the picture goes: --png FILE");
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
            argp_error(state, "--window takes FROM:TO in seconds, such as 0.1:0.2, not `%s'", arg);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    struct options *options = state->input;
    options->framed |= key == 'f' || key == 'c' || key == 'k';
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
        if (parse_size(arg, options))
            argp_error(state, "--size takes WIDTHxHEIGHT, such as 1280x720, not `%s'", arg);
        return 0;
    case 'c':
        if (parse_camera(arg, options))
            argp_error(state,
                       "--camera takes AZIMUTH,ELEVATION[,ZOOM], the elevation within +-89 and "
                       "the zoom above 0 and up to 1000, not `%s'",
                       arg);
        return 0;
    case 'k':
        if (parse_colour(arg, options))
            argp_error(state, "--colour takes contact[,MAX], MAX above 0 (N), not `%s'", arg);
        return 0;
    case 'i':
        options->check_intersections = true;
        return 0;
    case ARGP_KEY_ARG:
        if (options->folder)
            argp_error(state, "one folder at a time: `%s' is one too many", arg);
        options->folder = arg;
        return 0;
    case ARGP_KEY_END:
        check_together(options, state);
        return 0;
    default:
        return parse_chart(key, arg, state);
    }
}

/* A folder that is shown. */
struct show {
    struct output_cache *cache;
    const struct options *options;
    struct view_obstacles obstacles;
    unsigned char *used; /* a vertex: whether a face or an edge uses it */
    double *position;    /* of the frame read last */
    float *heat;         /* a vertex, 0 .. 1; NULL: the cloth has its own colour */
};

/* Vertices that nothing uses are not to be seen, and neither camera nor light is to look for them:
 * they go where the first used one is. */
static int read_frame(struct show *show, uint64_t frame, struct cloth_error *error)
{
    const size_t n = show->cache->mesh.n_vertices;
    size_t first = 0;
    int code = output_cache_frame(show->cache, frame, show->position, error);
    while (first < n && !show->used[first])
        first++;
    for (size_t v = 0; !code && first < n && v < n; v++)
        if (!show->used[v])
            memcpy(show->position + 3 * v, show->position + 3 * first, 3 * sizeof(double));
    return code;
}

static double length_of(const double *v)
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* How hot the forces of a frame are; says what the hottest is. */
static void find_heat(struct show *show, const double *force)
{
    const size_t n = show->cache->mesh.n_vertices;
    double most = show->options->most_force, largest = 0;
    for (size_t v = 0; v < n; v++)
        largest = fmax(largest, length_of(force + 3 * v));
    most = most > 0 ? most : largest;
    for (size_t v = 0; v < n; v++)
        show->heat[v] = most > 0 ? (float)fmin(length_of(force + 3 * v) / most, 1) : 0;
    printf("the largest force of contact on a vertex is %g N, the hottest colour %g N\n", largest,
           most);
}

static int read_heat(struct show *show, uint64_t frame, struct cloth_error *error)
{
    const uint32_t n = show->cache->mesh.n_vertices;
    double *force = malloc(3 * (size_t)n * sizeof *force);
    show->heat = malloc(n * sizeof *show->heat);
    int code = force && show->heat
                   ? output_forces_read(show->options->folder, n, frame, force, error)
                   : cloth_fail(error, CLOTH_E_MEMORY, "no memory for %u vertices", n);
    if (!code)
        find_heat(show, force);
    free(force);
    return code;
}

static uint64_t fitted_frames(const struct output_cache *cache)
{
    return cache->n_frames < FITTED_FRAMES ? cache->n_frames : FITTED_FRAMES;
}

static uint64_t fitted_frame(const struct output_cache *cache, uint64_t i)
{
    const uint64_t n = fitted_frames(cache);
    return n > 1 ? i * (cache->n_frames - 1) / (n - 1) : 0;
}

/* Where they are in a frame. */
static int place_obstacles(struct show *show, uint64_t frame, struct cloth_error *error)
{
    const int code = output_cache_pose(show->cache, frame, error);
    if (!code)
        view_obstacles_at(&show->obstacles, show->cache->time[frame]);
    return code;
}

/* All frames share one camera: it is fitted to them all, or to a hundred spread evenly over a long
 * run. */
static int fit_camera(struct show *show, struct view_camera *camera, struct cloth_error *error)
{
    const struct options *options = show->options;
    const struct output_cache *cache = show->cache;
    struct view_fit fit;
    view_fit_start(&fit, options->azimuth, options->elevation,
                   (double)options->width / options->height, options->zoom);
    for (uint64_t i = 0; i < fitted_frames(cache); i++) {
        int code = read_frame(show, fitted_frame(cache, i), error);
        if (code)
            return code;
        view_fit_add(&fit, cache->mesh.n_vertices, show->position);
    }
    for (uint64_t i = 0; i < fitted_frames(cache); i++) {
        const int code = place_obstacles(show, fitted_frame(cache, i), error);
        if (code)
            return code;
        view_fit_planes(&fit, show->obstacles.n_planes, (const double(*)[6])show->obstacles.plane);
        view_fit_near(&fit, show->obstacles.n_vertices, (const double(*)[6])show->obstacles.vertex);
    }
    view_fit_camera(&fit, camera);
    return 0;
}

static int draw(const struct show *show, const struct view_camera *camera,
                struct cloth_error *error)
{
    const struct options *options = show->options;
    const struct output_cache *cache = show->cache;
    struct view_shape shape = {.n_vertices = cache->mesh.n_vertices,
                               .n_triangles = cache->mesh.n_triangles,
                               .n_lines = cache->mesh.n_lone_edges,
                               .triangle = cache->mesh.triangle,
                               .line = cache->mesh.lone_edge,
                               .obstacles = &show->obstacles,
                               .n_cloths = cache->apart.n_cloths,
                               .cloth_end = cache->apart.end};
    struct view_picture picture = {options->width, options->height, NULL};
    struct view_context *context = NULL;
    struct view_scene *scene = NULL;
    int code = view_context_open(&context, error);
    code = code ? code : view_scene_new(&scene, &shape, error);
    code = code ? code : view_scene_move(scene, show->position, error);
    if (!code && show->heat)
        view_scene_heat(scene, show->heat);
    code = code ? code : view_picture_draw(&picture, scene, camera, error);
    code = code ? code : view_picture_write(&picture, options->png, error);
    view_picture_free(&picture);
    view_scene_free(scene);
    view_context_close(context);
    return code;
}

static int check_frame(const struct output_cache *cache, const struct options *options,
                       struct cloth_error *error)
{
    uint64_t n = cache->n_frames;
    if (n == 0)
        return cloth_fail(error, CLOTH_E_INPUT, "%s has no finished frame", options->folder);
    if (options->frame != LAST_FRAME && (uint64_t)options->frame >= n)
        return cloth_fail(error, CLOTH_E_INPUT, "%s has %ju frames, 0 to %ju: no frame %lld",
                          options->folder, (uintmax_t)n, (uintmax_t)(n - 1), options->frame);
    return 0;
}

static int show_frame(struct output_cache *cache, const struct options *options,
                      struct cloth_error *error)
{
    int code = check_frame(cache, options, error);
    if (code)
        return code;
    const size_t n = cache->mesh.n_vertices;
    struct show show = {.cache = cache,
                        .options = options,
                        .used = malloc(n),
                        .position = malloc(3 * n * sizeof(double))};
    code = view_obstacles_make(&show.obstacles, cache->n_obstacles, cache->obstacles, cache->keys,
                               &cache->bodies, error);
    if (!code && !(show.used && show.position))
        code = cloth_fail(error, CLOTH_E_MEMORY, "no memory for %zu vertices", n);
    if (!code) {
        const uint64_t frame =
            options->frame == LAST_FRAME ? cache->n_frames - 1 : (uint64_t)options->frame;
        struct view_camera camera;
        mesh_used(&cache->mesh, show.used);
        code = fit_camera(&show, &camera, error);
        code = code ? code : read_frame(&show, frame, error);
        if (!code && options->contact)
            code = read_heat(&show, frame, error);
        code = code ? code : place_obstacles(&show, frame, error);
        code = code ? code : draw(&show, &camera, error);
    }
    view_obstacles_free(&show.obstacles);
    free(show.used);
    free(show.position);
    free(show.heat);
    return code;
}

/* The exit code if nothing failed. */
static int check_frames(struct output_cache *cache, int *exit_code, struct cloth_error *error)
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

static int draw_trace(struct options *options, struct cloth_error *error)
{
    if (options->sized) {
        options->chart.width = options->width;
        options->chart.height = options->height;
    }
    const int code = view_trace(options->trace, &options->chart, options->svg, options->png, error);
    if (code)
        fprintf(stderr, "duite-view: %s\n", error->text);
    return code ? code == CLOTH_E_INPUT ? 2 : 1 : 0;
}

int main(int argc, char **argv)
{
    static const struct argp argp = {OPTIONS,
                                     parse,
                                     "DIR\n--trace FILE",
                                     "Makes a picture of a frame of a simulated cloth, or checks "
                                     "all frames; DIR is what duite-cloth --output wrote. Or draws "
                                     "the Gantt chart of a run.",
                                     NULL,
                                     NULL,
                                     NULL};
    struct options options = {.frame = LAST_FRAME,
                              .chart = chart_options_default(),
                              .width = 1280,
                              .height = 720,
                              .azimuth = 32,
                              .elevation = 20,
                              .zoom = 1};
    argp_err_exit_status = 2;
    argp_parse(&argp, argc, argv, 0, NULL, &options);
    struct cloth_error error = {0};
    struct output_cache cache = {0};
    int exit_code = 0;
    if (options.trace)
        return draw_trace(&options, &error);
    int code = output_cache_open(&cache, options.folder, &error);
    if (!code && options.png)
        code = show_frame(&cache, &options, &error);
    if (!code && options.check_intersections)
        code = check_frames(&cache, &exit_code, &error);
    output_cache_close(&cache);
    if (code)
        fprintf(stderr, "duite-view: %s\n", error.text);
    return code ? code == CLOTH_E_INPUT ? 2 : 1 : exit_code;
}
