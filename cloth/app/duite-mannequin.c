/* The command line of the figure: reads the options, makes the figure, prints the result. */
#include "config.h"

#include "cloth/app/cli.h"
#include "cloth/mannequin/pose.h"
#include "cloth/output/mannequin.h"
#include "cloth/output/output.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *argp_program_version = "duite-mannequin " PACKAGE_VERSION;

static const double MOST_FRAMES = 100000, DEFAULT_FPS = 25;

struct options {
    const char *output;
    struct mannequin mannequin;
    double walk, fps; /* s, 1/s; 0: not given */
    bool quiet;
};

static bool read_figure_measure(const char *text, void *to, struct argp_state *state)
{
    struct options *options = to;
    char *name = (char *)(uintptr_t)text, *value = strchr(name, '=');
    if (!value)
        argp_error(state, "--measure takes a name and a girth, NAME=METRES, not `%s'", text);
    *value++ = 0;
    const uint32_t i = mannequin_find(name);
    if (i == MANNEQUIN_GIRTHS)
        argp_error(state, "there is no measure `%s'; --help lists them", name);
    if (options->mannequin.girth[i] > 0)
        argp_error(state, "the measure %s is given twice", name);
    if (!cli_above_0(value, &options->mannequin.girth[i]))
        argp_error(state, "the measure %s takes a length above 0 in metres, not `%s'", name, value);
    return true;
}

#define TO(member) offsetof(struct options, member)
static const struct cli_option OPTIONS[] = {
    {"height", 'h', "METRES", "Make a figure of this height (1.75)", CLI_ABOVE_0,
     TO(mannequin.height), "a length above 0 in metres", NULL, 0},
    {"measure", 'm', "NAME=METRES",
     "Give it this girth: neck, chest, waist, hip, thigh, knee, calf, ankle, upper_arm, elbow or "
     "wrist; can be given for each",
     CLI_OTHER, 0, NULL, read_figure_measure, 0},
    {"edge", 'e', "METRES", "Make triangles with edges of about this length (0.02)", CLI_ABOVE_0,
     TO(mannequin.edge), "a length above 0 in metres", NULL, 0},
    {"output", 'o', "FILE", "Write the mesh to FILE, a Wavefront OBJ", CLI_FILE, TO(output), NULL,
     NULL, 0},
    {"walk", 'w', "SECONDS",
     "Write so many seconds of a walk on the spot, too, as a PC2 point cache (BODY.pc2 beside "
     "BODY.obj)",
     CLI_ABOVE_0, TO(walk), "seconds above 0", NULL, 0},
    {"fps", 256, "RATE", "Frames a second of the walk (25)", CLI_ABOVE_0, TO(fps), "a rate above 0",
     NULL, 0},
    {"quiet", 'q', NULL, "No summary", CLI_FLAG, TO(quiet), NULL, NULL, 0}};

static void mannequin_cli_finish(void *to, struct argp_state *state)
{
    struct options *options = to;
    if (!options->output)
        argp_error(state, "say where the mesh goes: --output FILE");
    if (options->fps > 0 && !(options->walk > 0))
        argp_error(state, "--fps is of a walk: say how long it is, --walk SECONDS");
    options->fps = options->fps > 0 ? options->fps : DEFAULT_FPS;
    if (!(options->walk * options->fps < MOST_FRAMES))
        argp_error(state, "a walk has fewer than %g frames, not %g", MOST_FRAMES,
                   options->walk * options->fps);
}

static const struct cli CLI = {
    .about = "Makes the closed mesh of a standing figure, made to measure, for garments to be put "
             "on.",
    .option = OPTIONS,
    .n_options = sizeof OPTIONS / sizeof *OPTIONS,
    .marks = CLI_NONE,
    .argument = CLI_NONE,
    .one = "nothing is read",
    .finish = mannequin_cli_finish};

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

static int write_walk(const struct options *options, const struct mannequin_rig *rig,
                      const struct mesh *mesh, struct cloth_error *error)
{
    const struct walking walking = {rig, mesh, options->fps};
    const struct output_shapes shapes = {.n_points = mesh->n_vertices,
                                         .n_frames =
                                             (uint32_t)(options->walk * options->fps + 0.5) + 1,
                                         .place = mannequin_cli_place,
                                         .context = &walking};
    char *path = cli_beside(options->output, ".pc2");
    if (!path)
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
    int code = mannequin_make(&mesh, &rig, &options->mannequin, girth, error);
    code = code ? code : output_mesh_obj(options->output, &mesh, "body", error);
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
    struct options options = {0};
    struct cloth_error error = {0};
    cli_read(&CLI, argc, argv, &options);
    mannequin_cli_run(&options, &error);
    return cli_end("duite-mannequin", &error);
}
