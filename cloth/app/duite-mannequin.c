/* The command line of the figure: reads the options, makes the figure, prints the result. */
#include "config.h"

#include "cloth/mannequin/pose.h"
#include "cloth/output/mannequin.h"

#include <argp.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *argp_program_version = "duite-mannequin " PACKAGE_VERSION;

enum { FPS = 256 };
static const double MOST_FRAMES = 100000, DEFAULT_FPS = 25;

struct options {
    const char *output;
    struct mannequin mannequin;
    double walk, fps; /* s, 1/s; 0: not given */
    bool quiet;
};

static const struct argp_option OPTIONS[] = {
    {"height", 'h', "METRES", 0, "Make a figure of this height (1.75)", 0},
    {"measure", 'm', "NAME=METRES", 0,
     "Give it this girth: neck, chest, waist, hip, thigh, knee, calf, ankle, upper_arm, elbow or "
     "wrist; can be given for each",
     0},
    {"edge", 'e', "METRES", 0, "Make triangles with edges of about this length (0.02)", 0},
    {"output", 'o', "FILE", 0, "Write the mesh to FILE, a Wavefront OBJ", 0},
    {"walk", 'w', "SECONDS", 0,
     "Write so many seconds of a walk on the spot, too, as a PC2 point cache (BODY.pc2 beside "
     "BODY.obj)",
     0},
    {"fps", FPS, "RATE", 0, "Frames a second of the walk (25)", 0},
    {"quiet", 'q', NULL, 0, "No summary", 0},
    {0}};

static int parse_length(const char *text, double *length)
{
    char *end = NULL;
    *length = strtod(text, &end);
    return end == text || *end || !(*length > 0) || !isfinite(*length);
}

static void parse_measure(struct options *options, char *arg, struct argp_state *state)
{
    char *value = strchr(arg, '=');
    if (!value)
        argp_error(state, "--measure takes a name and a girth, NAME=METRES, not `%s'", arg);
    *value++ = 0;
    const uint32_t i = mannequin_find(arg);
    if (i == MANNEQUIN_GIRTHS)
        argp_error(state, "there is no measure `%s'; --help lists them", arg);
    if (options->mannequin.girth[i] > 0)
        argp_error(state, "the measure %s is given twice", arg);
    if (parse_length(value, &options->mannequin.girth[i]))
        argp_error(state, "the measure %s takes a length above 0 in metres, not `%s'", arg, value);
}

static void mannequin_cli_finish(struct options *options, struct argp_state *state)
{
    if (!options->output)
        argp_error(state, "say where the mesh goes: --output FILE");
    if (options->fps > 0 && !(options->walk > 0))
        argp_error(state, "--fps is of a walk: say how long it is, --walk SECONDS");
    options->fps = options->fps > 0 ? options->fps : DEFAULT_FPS;
    if (!(options->walk * options->fps < MOST_FRAMES))
        argp_error(state, "a walk has fewer than %g frames, not %g", MOST_FRAMES,
                   options->walk * options->fps);
}

static error_t mannequin_cli_parse(int key, char *arg, struct argp_state *state)
{
    struct options *options = state->input;
    switch (key) {
    case 'h':
        if (parse_length(arg, &options->mannequin.height))
            argp_error(state, "--height takes a length above 0 in metres, not `%s'", arg);
        return 0;
    case 'm':
        parse_measure(options, arg, state);
        return 0;
    case 'e':
        if (parse_length(arg, &options->mannequin.edge))
            argp_error(state, "--edge takes a length above 0 in metres, not `%s'", arg);
        return 0;
    case 'w':
        if (parse_length(arg, &options->walk))
            argp_error(state, "--walk takes seconds above 0, not `%s'", arg);
        return 0;
    case FPS:
        if (parse_length(arg, &options->fps))
            argp_error(state, "--fps takes a rate above 0, not `%s'", arg);
        return 0;
    case 'o':
        if (!*arg)
            argp_error(state, "--output takes the name of a file");
        options->output = arg;
        return 0;
    case 'q':
        options->quiet = true;
        return 0;
    case ARGP_KEY_ARG:
        argp_error(state, "nothing is read: `%s' is one too many", arg);
        return 0;
    case ARGP_KEY_END:
        mannequin_cli_finish(options, state);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static void mannequin_cli_say(const struct mesh *mesh, const double *girth)
{
    double low[3], high[3];
    mesh_box(mesh, low, high);
    for (uint32_t i = 0; i < MANNEQUIN_GIRTHS; i++)
        printf("%s: %.4f m (%s, of a figure of %g m)\n", mannequin_measures[i].name, girth[i],
               mannequin_measures[i].section, MANNEQUIN_HEIGHT);
    printf("%u vertices, %u triangles, %.4g m high\n", mesh->n_vertices, mesh->n_triangles,
           high[1] - low[1]);
}

/* ---- The walk ---- */

struct walking {
    const struct mannequin_rig *rig;
    const struct mesh *mesh;
    double fps;
};

static void mannequin_cli_place(const void *context, uint32_t frame, double (*x)[3])
{
    static const struct mannequin_walk walk = {0};
    const struct walking *walking = context;
    double angle[MANNEQUIN_ANGLES];
    mannequin_walk_at(&walk, frame / walking->fps, angle);
    mannequin_place(walking->rig, walking->mesh, angle, x);
}

/* Beside the mesh, with another ending. */
static int write_walk(const struct options *options, const struct mannequin_rig *rig,
                      const struct mesh *mesh, struct cloth_error *error)
{
    const char *output = options->output;
    const size_t n = strlen(output);
    const int stem = (int)(n > 4 && strcmp(output + n - 4, ".obj") == 0 ? n - 4 : n);
    const struct walking walking = {rig, mesh, options->fps};
    const struct output_shapes shapes = {.n_points = mesh->n_vertices,
                                         .n_frames =
                                             (uint32_t)(options->walk * options->fps + 0.5) + 1,
                                         .place = mannequin_cli_place,
                                         .context = &walking};
    char *path = NULL;
    if (asprintf(&path, "%.*s.pc2", stem, output) < 0)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for a name");
    const int code = output_mannequin_pc2(path, &shapes, error);
    free(path);
    return code;
}

static int mannequin_cli_run(const struct options *options, struct cloth_error *error)
{
    struct mesh mesh = {0};
    struct mannequin_rig rig = {0};
    double girth[MANNEQUIN_GIRTHS];
    int code = mannequin_make_rigged(&mesh, &rig, &options->mannequin, girth, error);
    code = code ? code : output_mannequin_obj(options->output, &mesh, error);
    if (!code && options->walk > 0)
        code = write_walk(options, &rig, &mesh, error);
    if (!code && !options->quiet)
        mannequin_cli_say(&mesh, girth);
    mesh_free(&mesh);
    mannequin_rig_free(&rig);
    return code;
}

int main(int argc, char **argv)
{
    static const struct argp argp = {OPTIONS,
                                     mannequin_cli_parse,
                                     NULL,
                                     "Makes the closed mesh of a standing figure, made to measure, "
                                     "for garments to be put on.",
                                     NULL,
                                     NULL,
                                     NULL};
    struct options options = {0};
    struct cloth_error error = {0};
    argp_err_exit_status = 2;
    argp_parse(&argp, argc, argv, 0, NULL, &options);
    int code = mannequin_cli_run(&options, &error);
    if (!code && (fflush(stdout) != 0 || ferror(stdout)))
        code =
            cloth_fail(&error, CLOTH_E_IO, "cannot write to standard output: %s", strerror(errno));
    if (code)
        fprintf(stderr, "duite-mannequin: %s\n", error.text);
    return code ? code == CLOTH_E_INPUT ? 2 : 1 : 0;
}
