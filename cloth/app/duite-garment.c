/* The command line of the mesher of sewing patterns: reads the options, runs the mesher, prints the
 * result. */
#include "config.h"

#include "cloth/garment/garment.h"
#include "cloth/garment/girth.h"
#include "cloth/garment/own/own.h"
#include "cloth/mesh/mesh.h"
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

enum { SEAMS = 256, OWN, SIZE, MEASURE, MEASURES, WRITE_PATTERN, BODY };
enum { SIZE_M = 2 };

struct options {
    const char *pattern, *output, *seams;
    struct garment_fineness fineness;
    bool quiet;
    const char *body;    /* that wears it; NULL: none */
    const char *written; /* where the pattern goes; NULL: nowhere */

    const struct garment_own *own; /* in place of a pattern */
    const struct garment_own *listed;
    int size;                              /* -1: it is not given */
    const char *measure[GARMENT_MEASURES]; /* NAME=VALUE */
    int n_measures;
};

static const struct argp_option OPTIONS[] = {
    {"edge", 'e', "METRES", 0, "Make triangles with edges of about this length", 0},
    {"vertices", 'n', "N", 0, "Make about N vertices in all panels together", 0},
    {"output", 'o', "FILE", 0, "Write the mesh to FILE, a Wavefront OBJ", 0},
    {"seams", SEAMS, "FILE", 0,
     "Write the seams to FILE, as JSON (GARMENT.seams.json of an output GARMENT.obj)", 0},
    {"own", OWN, "GARMENT", 0,
     "Make one of the own garments in place of PATTERN: tshirt, trousers or skirt", 0},
    {"size", SIZE, "SIZE", 0, "The size of an own garment: XS, S, M, L or XL (M)", 0},
    {"measure", MEASURE, "NAME=VALUE", 0,
     "A measure of an own garment that differs from its size's; once for each", 0},
    {"measures", MEASURES, "GARMENT", 0, "List the measures of an own garment, and end", 0},
    {"write-pattern", WRITE_PATTERN, "FILE", 0, "Write the pattern to FILE, as JSON", 0},
    {"body", BODY, "FILE", 0,
     "Warn if the garment is too small for the body in FILE, an OBJ in metres", 0},
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

static void garment_cli_finish(const struct options *options, struct argp_state *state)
{
    if (options->listed)
        return;
    if (!options->pattern && !options->own)
        argp_error(state, "say which pattern to mesh: PATTERN or --own GARMENT");
    if (options->pattern && options->own)
        argp_error(state, "a pattern and --own exclude each other: `%s' is one too many",
                   options->pattern);
    if (!options->own && (options->size >= 0 || options->n_measures))
        argp_error(state, "--size and --measure need --own GARMENT");
    if (!options->output && !options->written)
        argp_error(state, "say where the mesh goes: --output FILE");
    if (!options->output && options->body)
        argp_error(state, "--body needs --output FILE: the mesh is compared with it");
    if (!options->output && options->seams)
        argp_error(state, "--seams needs --output FILE: seams are pairs of the mesh's vertices");
    if (options->fineness.vertices && options->fineness.edge > 0)
        argp_error(state, "--edge and --vertices are two ways to say how fine: take one");
    if (options->output && !options->fineness.vertices && !(options->fineness.edge > 0))
        argp_error(state, "say how fine: --edge METRES or --vertices N");
}

static const struct garment_own *parse_garment(const char *arg, struct argp_state *state)
{
    const struct garment_own *own = garment_own_find(arg);
    if (!own)
        argp_error(state, "there is no own garment `%s'; there are %s", arg, garment_own_words);
    return own;
}

/* The options of own garments. */
static error_t parse_own(int key, const char *arg, struct argp_state *state)
{
    struct options *options = state->input;
    switch (key) {
    case OWN:
        options->own = parse_garment(arg, state);
        return 0;
    case MEASURES:
        options->listed = parse_garment(arg, state);
        return 0;
    case SIZE:
        options->size = garment_size_find(arg);
        if (options->size < 0)
            argp_error(state, "--size takes one of %s, not `%s'", garment_size_words, arg);
        return 0;
    case MEASURE:
        if (options->n_measures == GARMENT_MEASURES)
            argp_error(state, "no garment has so many measures: `%s' is one too many", arg);
        options->measure[options->n_measures++] = arg;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static error_t garment_cli_parse(int key, char *arg, struct argp_state *state)
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
    case WRITE_PATTERN:
        if (!*arg)
            argp_error(state, "--write-pattern takes the name of a file");
        options->written = arg;
        return 0;
    case BODY:
        if (!*arg)
            argp_error(state, "--body takes the name of a file");
        options->body = arg;
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
        garment_cli_finish(options, state);
        return 0;
    default:
        return parse_own(key, arg, state);
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
    const char *const file[] = {options->written, options->output, seams};
    for (int i = 0; i < 3; i++)
        if (file[i] && options->pattern && same_file(file[i], options->pattern))
            return cloth_fail(error, CLOTH_E_INPUT, "the output would replace the pattern %s",
                              options->pattern);
    if (options->output && same_file(options->output, seams))
        return cloth_fail(error, CLOTH_E_INPUT, "mesh and seams cannot be the same file: %s",
                          seams);
    if (options->written && options->output &&
        (same_file(options->written, options->output) || same_file(options->written, seams)))
        return cloth_fail(error, CLOTH_E_INPUT, "mesh and pattern cannot be the same file: %s",
                          options->written);
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

static void garment_cli_warn(const struct garment *garment)
{
    uint32_t n = 0;
    for (uint32_t s = 0; s < garment->n_seams; s++)
        if (garment->seam[s].unsure)
            fprintf(stderr,
                    n++ ? " %u"
                        : "duite-garment: warning: these seams may be sewn the "
                          "wrong way round: %u",
                    s);
    if (n)
        fputs("; how far partners are from each other does not tell, or contradicts other seams, "
              "so the fronts of the panels decide; seams.reversed of a scene turns a seam\n",
              stderr);
}

static void garment_cli_say(const struct garment *garment, const struct garment_pattern *pattern)
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

/* NAME=VALUE, among the measures of a garment. */
static int set_measure(const struct garment_own *own, const char *text, double *value,
                       struct cloth_error *error)
{
    const char *equals = strchr(text, '=');
    char *name = equals ? strndup(text, (size_t)(equals - text)) : NULL, *end = NULL;
    if (equals && !name)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for a name");
    const int i = name ? garment_own_measure(own, name) : -1;
    free(name);
    if (!equals)
        return cloth_fail(error, CLOTH_E_INPUT, "--measure takes NAME=VALUE, not `%s'", text);
    if (i < 0)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "`%s': a %s has no such measure; --measures %s lists them", text,
                          own->name, own->name);
    value[i] = strtod(equals + 1, &end);
    if (end == equals + 1 || *end || !isfinite(value[i]))
        return cloth_fail(error, CLOTH_E_INPUT, "`%s': the value is not a number", text);
    return CLOTH_OK;
}

static int garment_cli_take_pattern(struct garment_pattern *pattern, const struct options *options,
                                    struct cloth_error *error)
{
    double value[GARMENT_MEASURES];
    char unusual[200];
    int code = options->own ? CLOTH_OK : scene_read_pattern(pattern, options->pattern, error);
    if (!options->own && !code && garment_pattern_unusual(pattern, unusual, sizeof unusual))
        fprintf(stderr, "duite-garment: warning: %s: %s\n", options->pattern, unusual);
    if (!options->own)
        return code;
    garment_own_size(options->own, options->size < 0 ? SIZE_M : options->size, value);
    for (int i = 0; i < options->n_measures && !code; i++)
        code = set_measure(options->own, options->measure[i], value, error);
    return code ? code : garment_own_make(pattern, options->own, value, error);
}

/* Says on standard error if the garment is too small for the body. */
static int compare_body(const struct garment *garment, const char *path, struct cloth_error *error)
{
    struct mesh mesh = {0};
    struct girth_worst worst = {0};
    const struct girth_mesh own = {garment->n_triangles, (const double(*)[3])garment->position,
                                   (const uint32_t(*)[3])garment->triangle};
    struct girth_seam *seam = calloc(garment->n_seams + (size_t)1, sizeof *seam);
    int code = seam ? mesh_read_surface(&mesh, path, error)
                    : cloth_fail(error, CLOTH_E_MEMORY, "no memory for seams");
    code = code == CLOTH_E_IO ? CLOTH_E_INPUT : code; /* there is no such file */
    for (uint32_t s = 0; s < garment->n_seams && !code; s++)
        seam[s] = (struct girth_seam){garment->seam[s].n_pairs,
                                      (const uint32_t(*)[2])garment->seam[s].pair};
    const struct girth_mesh body = {mesh.n_triangles, (const double(*)[3])mesh.position,
                                    (const uint32_t(*)[3])mesh.triangle};
    if (!code)
        code = girth_compare(&worst, &own, garment->n_seams, seam, &body, error);
    if (!code && girth_too_small(&worst))
        fprintf(stderr,
                "duite-garment: warning: the garment is too small for the body: at y = %.3g m its "
                "girth is %.3g m, the body's %.3g m\n",
                worst.y, worst.garment, worst.body);
    mesh_free(&mesh);
    free(seam);
    return code;
}

static int write_mesh(const struct options *options, const char *seams,
                      const struct garment_pattern *pattern, struct cloth_error *error)
{
    struct garment garment = {0};
    int code = garment_make(&garment, pattern, &options->fineness, error);
    code = code ? code : output_garment_obj(options->output, &garment, pattern, error);
    code = code ? code : output_garment_seams(seams, &garment, pattern, error);
    if (!code && options->body)
        code = compare_body(&garment, options->body, error);
    if (!code)
        garment_cli_warn(&garment);
    if (!code && !options->quiet)
        garment_cli_say(&garment, pattern);
    garment_free(&garment);
    return code;
}

static int garment_cli_run(const struct options *options, struct cloth_error *error)
{
    struct garment_pattern pattern = {0};
    char *seams = options->output ? seams_path(options) : NULL;
    int code = options->output && !seams ? cloth_fail(error, CLOTH_E_MEMORY, "no memory for a name")
                                         : garment_cli_take_pattern(&pattern, options, error);
    code = code ? code : check_paths(options, seams, error);
    if (!code && options->written)
        code = output_pattern(options->written, &pattern, error);
    if (!code && options->output)
        code = write_mesh(options, seams, &pattern, error);
    garment_pattern_free(&pattern);
    free(seams);
    return code;
}

static void list_measures(const struct garment_own *own)
{
    double value[GARMENT_MEASURES];
    garment_own_size(own, SIZE_M, value);
    printf("%s: %s. Measures in metres, of size M, and how much more the next size has\n",
           own->name, own->about);
    for (int i = 0; own->measure[i].name; i++) {
        const struct garment_measure *measure = &own->measure[i];
        printf("  %-10s %5g, %g more, %g to %g: %s\n", measure->name, value[i], measure->step,
               measure->least, measure->most, measure->about);
    }
}

int main(int argc, char **argv)
{
    static const struct argp argp = {OPTIONS,
                                     garment_cli_parse,
                                     "PATTERN\n--own GARMENT",
                                     "Makes the mesh of a garment from the sewing pattern PATTERN, "
                                     "a JSON file, or from measures: panels, and which vertices "
                                     "are sewn together.",
                                     NULL,
                                     NULL,
                                     NULL};
    struct options options = {.size = -1};
    struct cloth_error error = {0};
    int code = CLOTH_OK;
    argp_err_exit_status = 2;
    argp_parse(&argp, argc, argv, 0, NULL, &options);
    if (options.listed)
        list_measures(options.listed);
    else
        code = garment_cli_run(&options, &error);
    if (!code && (fflush(stdout) != 0 || ferror(stdout)))
        code =
            cloth_fail(&error, CLOTH_E_IO, "cannot write to standard output: %s", strerror(errno));
    if (code)
        fprintf(stderr, "duite-garment: %s\n", error.text);
    return code ? code == CLOTH_E_INPUT ? 2 : 1 : 0;
}
