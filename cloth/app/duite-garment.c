/* The command line of the mesher of sewing patterns: reads the options, runs the mesher, prints the
 * result. */
#include "config.h"

#include "cloth/app/cli.h"
#include "cloth/garment/garment.h"
#include "cloth/garment/girth.h"
#include "cloth/garment/own/own.h"
#include "cloth/mesh/mesh.h"
#include "cloth/output/garment.h"
#include "cloth/scene/pattern.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

const char *argp_program_version = "duite-garment " PACKAGE_VERSION;

struct options {
    const char *pattern, *output, *seams;
    struct garment_fineness fineness;
    bool quiet;
    const char *body;    /* that wears it; NULL: none */
    const char *written; /* where the pattern goes; NULL: nowhere */

    const struct garment_own *own; /* in place of a pattern */
    const struct garment_own *listed;
    struct garment_choice choice;          /* the size of an own garment, too */
    const char *measure[GARMENT_MEASURES]; /* NAME=VALUE */
    int n_measures;
};

/* ---- The command line ---- */

static bool read_vertices(const char *text, void *to, struct argp_state *state)
{
    struct options *options = to;
    char *end = NULL;
    (void)state;
    errno = 0;
    const unsigned long n = strtoul(text, &end, 10);
    options->fineness.vertices = (uint32_t)n;
    return *text >= '0' && *text <= '9' && !*end && !errno && n >= 3 && n <= UINT32_MAX;
}

static const struct garment_own *read_garment(const char *text, struct argp_state *state)
{
    const struct garment_own *own = garment_own_find(text);
    if (!own)
        argp_error(state, "there is no own garment `%s'; there are %s", text, garment_own_words);
    return own;
}

static bool read_own(const char *text, void *to, struct argp_state *state)
{
    ((struct options *)to)->own = read_garment(text, state);
    return true;
}

static bool read_listed(const char *text, void *to, struct argp_state *state)
{
    ((struct options *)to)->listed = read_garment(text, state);
    return true;
}

static bool read_size(const char *text, void *to, struct argp_state *state)
{
    (void)state;
    ((struct options *)to)->choice.size = text;
    return *text;
}

static bool read_measure(const char *text, void *to, struct argp_state *state)
{
    struct options *options = to;
    if (options->n_measures == GARMENT_MEASURES)
        argp_error(state, "no garment has so many measures: `%s' is one too many", text);
    options->measure[options->n_measures++] = text;
    return true;
}

#define TO(member) offsetof(struct options, member)
static const struct cli_option OPTIONS[] = {
    {"edge", 'e', "METRES", "Make triangles with edges of about this length", CLI_ABOVE_0,
     TO(fineness.edge), "a length above 0 in metres", NULL, 0},
    {"vertices", 'n', "N", "Make about N vertices in all panels together", CLI_OTHER, 0,
     "a number from 3 on", read_vertices, 0},
    {"output", 'o', "FILE", "Write the mesh to FILE, a Wavefront OBJ", CLI_FILE, TO(output), NULL,
     NULL, 0},
    {"seams", 256, "FILE",
     "Write the seams to FILE, as JSON (GARMENT.seams.json of an output GARMENT.obj)", CLI_FILE,
     TO(seams), NULL, NULL, 0},
    {"own", 257, "GARMENT",
     "Make one of the own garments in place of PATTERN: tshirt, trousers or skirt", CLI_OTHER, 0,
     NULL, read_own, 0},
    {"size", 258, "SIZE",
     "The size of an own garment: XS, S, M, L or XL (M); of a DXF file (its sample size)",
     CLI_OTHER, 0, "a size", read_size, 0},
    {"notches", 263, NULL,
     "Let edges of a DXF file's panels end at notches, too, so stitches can begin there", CLI_FLAG,
     TO(choice.notches), NULL, NULL, 0},
    {"measure", 259, "NAME=VALUE",
     "A measure of an own garment that differs from its size's; once for each", CLI_OTHER, 0, NULL,
     read_measure, 0},
    {"measures", 260, "GARMENT", "List the measures of an own garment, and end", CLI_OTHER, 0, NULL,
     read_listed, 0},
    {"write-pattern", 261, "FILE", "Write the pattern to FILE, as JSON", CLI_FILE, TO(written),
     NULL, NULL, 0},
    {"body", 262, "FILE", "Warn if the garment is too small for the body in FILE, an OBJ in metres",
     CLI_FILE, TO(body), NULL, NULL, 0},
    {"quiet", 'q', NULL, "No summary", CLI_FLAG, TO(quiet), NULL, NULL, 0}};

static void garment_cli_finish(void *to, struct argp_state *state)
{
    const struct options *options = to;
    if (options->listed)
        return;
    if (!options->pattern && !options->own)
        argp_error(state, "say which pattern to mesh: PATTERN or --own GARMENT");
    if (options->pattern && options->own)
        argp_error(state, "a pattern and --own exclude each other: `%s' is one too many",
                   options->pattern);
    if (options->own && options->choice.notches)
        argp_error(state, "--notches is of a DXF file; own garments have none");
    if (!options->own && options->n_measures)
        argp_error(state, "--measure needs --own GARMENT");
    if (options->own && options->choice.size && garment_size_find(options->choice.size) < 0)
        argp_error(state, "--size takes one of %s, not `%s'", garment_size_words,
                   options->choice.size);
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

static const struct cli CLI = {
    .arguments = "PATTERN\n--own GARMENT",
    .about =
        "Makes the mesh of a garment from the sewing pattern PATTERN, a JSON or DXF file, or from "
        "measures: panels, and which vertices are sewn together.",
    .option = OPTIONS,
    .n_options = sizeof OPTIONS / sizeof *OPTIONS,
    .marks = CLI_NONE,
    .argument = TO(pattern),
    .one = "one pattern at a time",
    .finish = garment_cli_finish};

/* ---- Files ---- */

/* Both names of one plain file, or of none that is there yet. */
static bool same_file(const char *a, const char *b)
{
    struct stat one, two;
    if (stat(a, &one) == 0 && stat(b, &two) == 0)
        return S_ISREG(one.st_mode) && one.st_dev == two.st_dev && one.st_ino == two.st_ino;
    return strcmp(a, b) == 0;
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
    int code = options->own
                   ? CLOTH_OK
                   : scene_read_pattern(pattern, options->pattern, &options->choice, error);
    if (!options->own && !code && garment_pattern_unusual(pattern, unusual, sizeof unusual))
        fprintf(stderr, "duite-garment: warning: %s: %s\n", options->pattern, unusual);
    if (!options->own)
        return code;
    garment_own_size(options->own,
                     garment_size_find(options->choice.size ? options->choice.size : "M"), value);
    for (int i = 0; i < options->n_measures && !code; i++)
        code = set_measure(options->own, options->measure[i], value, error);
    return code ? code : garment_own_make(pattern, options->own, value, error);
}

/* Says on standard error if the garment is too small for the body. */
static int compare_body(const struct garment *garment, const char *path, struct cloth_error *error)
{
    struct mesh mesh = {0};
    struct girth_worst worst = {0};
    const struct slice_mesh own = {garment->n_triangles, (const double(*)[3])garment->position,
                                   (const uint32_t(*)[3])garment->triangle};
    struct girth_seam *seam = calloc(garment->n_seams + (size_t)1, sizeof *seam);
    int code = seam ? mesh_read_surface(&mesh, path, error)
                    : cloth_fail(error, CLOTH_E_MEMORY, "no memory for seams");
    if (code == CLOTH_E_IO)
        code = error->code = CLOTH_E_INPUT; /* there is no such file */
    for (uint32_t s = 0; s < garment->n_seams && !code; s++)
        seam[s] = (struct girth_seam){garment->seam[s].n_pairs,
                                      (const uint32_t(*)[2])garment->seam[s].pair};
    const struct slice_mesh body = {mesh.n_triangles, (const double(*)[3])mesh.position,
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
    char *seams = options->seams    ? strdup(options->seams)
                  : options->output ? cli_beside(options->output, ".seams.json")
                                    : NULL;
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
    garment_own_size(own, garment_size_find("M"), value);
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
    struct options options = {0};
    struct cloth_error error = {0};
    cli_read(&CLI, argc, argv, &options);
    if (options.listed)
        list_measures(options.listed);
    else
        garment_cli_run(&options, &error);
    return cli_end("duite-garment", &error);
}
