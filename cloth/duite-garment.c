/* The command line of the mesher of sewing patterns: reads what is asked for, hands it on, says
 * what came of it. */
#include "config.h"

#include "cloth/garment/garment.h"
#include "cloth/output/garment.h"
#include "cloth/scene/pattern.h"

#include <argp.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

const char *argp_program_version = "duite-garment " PACKAGE_VERSION;

enum { SEAMS = 256 };

struct options {
    const char *pattern, *output, *seams;
    struct garment_fineness fineness;
    bool quiet;
};

static const struct argp_option OPTIONS[] = {
    {"edge", 'e', "METRES", 0, "Make triangles with edges of about this length", 0},
    {"vertices", 'n', "N", 0, "Make about N vertices in all panels together", 0},
    {"output", 'o', "FILE", 0, "Write the mesh to FILE, a Wavefront OBJ", 0},
    {"seams", SEAMS, "FILE", 0,
     "Write the seams to FILE, as JSON (GARMENT.seams.json of an output GARMENT.obj)", 0},
    {"quiet", 'q', NULL, 0, "No summary", 0},
    {0}};

static int parse_edge(const char *text, double *edge)
{
    char *end = NULL;
    *edge = strtod(text, &end);
    return end == text || *end || !(*edge > 0) || !isfinite(*edge);
}

static int parse_count(const char *text, uint32_t *count)
{
    char *end = NULL;
    errno = 0;
    const unsigned long n = strtoul(text, &end, 10);
    *count = (uint32_t)n;
    return *text < '0' || *text > '9' || *end || errno || n < 3 || n > UINT32_MAX;
}

static void finish(const struct options *options, struct argp_state *state)
{
    if (!options->pattern)
        argp_error(state, "say which pattern to mesh");
    if (!options->output)
        argp_error(state, "say where the mesh goes: --output FILE");
    if (options->fineness.vertices && options->fineness.edge > 0)
        argp_error(state, "--edge and --vertices are two ways to say how fine: take one");
    if (!options->fineness.vertices && !(options->fineness.edge > 0))
        argp_error(state, "say how fine: --edge METRES or --vertices N");
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    struct options *options = state->input;
    switch (key) {
    case 'e':
        if (parse_edge(arg, &options->fineness.edge))
            argp_error(state, "--edge takes a length above 0 in metres, not `%s'", arg);
        return 0;
    case 'n':
        if (parse_count(arg, &options->fineness.vertices))
            argp_error(state, "--vertices takes a number from 3 on, not `%s'", arg);
        return 0;
    case 'o':
        if (!*arg)
            argp_error(state, "--output takes the name of a file");
        options->output = arg;
        return 0;
    case SEAMS:
        if (!*arg)
            argp_error(state, "--seams takes the name of a file");
        options->seams = arg;
        return 0;
    case 'q':
        options->quiet = true;
        return 0;
    case ARGP_KEY_ARG:
        if (options->pattern)
            argp_error(state, "one pattern at a time: `%s' is one too many", arg);
        options->pattern = arg;
        return 0;
    case ARGP_KEY_END:
        finish(options, state);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

/* Both names of one plain file, or of none that is there yet. */
static bool same_file(const char *a, const char *b)
{
    struct stat one, two;
    if (stat(a, &one) == 0 && stat(b, &two) == 0)
        return S_ISREG(one.st_mode) && one.st_dev == two.st_dev && one.st_ino == two.st_ino;
    return strcmp(a, b) == 0;
}

/* Beside the mesh, with another ending; the caller frees it. */
static char *seams_path(const struct options *options)
{
    const char *output = options->output;
    const size_t n = strlen(output);
    char *path = NULL;
    if (options->seams)
        return strdup(options->seams);
    const int stem = (int)(n > 4 && strcmp(output + n - 4, ".obj") == 0 ? n - 4 : n);
    return asprintf(&path, "%.*s.seams.json", stem, output) < 0 ? NULL : path;
}

static int check_paths(const struct options *options, const char *seams, struct cloth_error *error)
{
    if (same_file(options->output, options->pattern) || same_file(seams, options->pattern))
        return cloth_fail(error, CLOTH_E_INPUT, "the output would replace the pattern %s",
                          options->pattern);
    if (same_file(options->output, seams))
        return cloth_fail(error, CLOTH_E_INPUT, "mesh and seams cannot be the same file: %s",
                          seams);
    return CLOTH_OK;
}

static void say_seam(const struct garment *garment, const struct garment_pattern *pattern,
                     uint32_t s)
{
    const struct garment_side *side = pattern->stitch[s].side;
    const struct garment_panel *one = &pattern->panel[side[0].panel];
    const struct garment_panel *two = &pattern->panel[side[1].panel];
    const struct garment_seam *seam = &garment->seam[s];
    printf(
        "seam %u: edge %u of %s, %.4g m, and edge %u of %s, %.4g m%s: %u pairs, %.4g m apart (%.4g "
        "the other way round)\n",
        s, side[0].edge, one->name, garment_edge_length(one, side[0].edge), side[1].edge, two->name,
        garment_edge_length(two, side[1].edge), seam->reversed ? ", reversed" : "", seam->n_pairs,
        seam->distance[seam->reversed], seam->distance[!seam->reversed]);
}

static void say(const struct garment *garment, const struct garment_pattern *pattern)
{
    uint32_t below;
    const double least = garment_least_angle(garment, &below);
    for (uint32_t p = 0; p < garment->n_pieces; p++)
        printf("panel %s: %u vertices, %u triangles, %.4g m^2\n", pattern->panel[p].name,
               garment->piece[p].n_vertices, garment->piece[p].n_triangles,
               fabs(garment_panel_area(&pattern->panel[p])));
    for (uint32_t s = 0; s < garment->n_seams; s++)
        say_seam(garment, pattern, s);
    printf(
        "%u vertices, %u triangles with edges of %.4g m inside; the least angle is %.1f degrees, "
        "%u are below 30\n",
        garment->n_vertices, garment->n_triangles, garment->edge, least, below);
}

static int run(const struct options *options, const char *seams, struct cloth_error *error)
{
    struct garment_pattern pattern;
    struct garment garment = {0};
    int code = scene_read_pattern(&pattern, options->pattern, error);
    code = code ? code : check_paths(options, seams, error);
    code = code ? code : garment_make(&garment, &pattern, &options->fineness, error);
    code = code ? code : output_garment_obj(options->output, &garment, &pattern, error);
    code = code ? code : output_garment_seams(seams, &garment, &pattern, error);
    if (!code && !options->quiet)
        say(&garment, &pattern);
    garment_free(&garment);
    garment_pattern_free(&pattern);
    return code;
}

int main(int argc, char **argv)
{
    static const struct argp argp = {OPTIONS,
                                     parse,
                                     "PATTERN",
                                     "Makes the mesh of a garment from the sewing pattern PATTERN, "
                                     "a JSON file: panels, and which vertices are sewn together.",
                                     NULL,
                                     NULL,
                                     NULL};
    struct options options = {0};
    struct cloth_error error = {0};
    argp_err_exit_status = 2;
    argp_parse(&argp, argc, argv, 0, NULL, &options);
    char *seams = seams_path(&options);
    int code = seams ? run(&options, seams, &error)
                     : cloth_fail(&error, CLOTH_E_MEMORY, "no memory for a name");
    free(seams);
    if (!code && (fflush(stdout) != 0 || ferror(stdout)))
        code =
            cloth_fail(&error, CLOTH_E_IO, "cannot write to standard output: %s", strerror(errno));
    if (code)
        fprintf(stderr, "duite-garment: %s\n", error.text);
    return code ? code == CLOTH_E_INPUT ? 2 : 1 : 0;
}
