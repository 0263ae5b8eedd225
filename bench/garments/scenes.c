/* Scenes that dress the figure, run by duite-cloth as a user runs them, all phases; what its report
 * says of the run. Intersections are counted in a run of their own, so that no clock sees it. */
#include "bench/garments/garments.h"

#include "bench/program.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    PATH = 4200,
    FOUND = 4 /* what duite-cloth ends with when there are intersections */
};

/* With --quick: a start of sewing, of few vertices. */
#define QUICK_PHASES "--set 'phases=[{name: sew, set: {gravity: [0, 0, 0], time.end: 0.06}}]'"
#define REPULSION    "--set 'contact={mode: repulsion, self: off, thickness: 0.003}'"

static const struct scene {
    const char *name;
    int cloths; /* that have patterns */
} SCENES[] = {{"dressing", 1}, {"jeans", 1}, {"layers", 2}, {"walk", 2}};
enum { N_SCENES = sizeof SCENES / sizeof *SCENES };

static const struct scene *find_scene(const char *name)
{
    for (int i = 0; i < N_SCENES; i++)
        if (!strcmp(SCENES[i].name, name))
            return SCENES + i;
    return NULL;
}

static void scene_path(const char *name, char path[PATH])
{
    snprintf(path, PATH, "%s/%s.yaml", BENCH_SCENES, name);
}

/* ---- Reports ---- */

/* The number behind the key, of its last occurrence in the line; NAN: it is not there. */
static double number_in(const char *line, const char *key)
{
    char quoted[60];
    const char *at = NULL;
    snprintf(quoted, sizeof quoted, "\"%s\": ", key);
    for (const char *next = strstr(line, quoted); next; next = strstr(next + 1, quoted))
        at = next;
    double number;
    return at && sscanf(at + strlen(quoted), "%lf", &number) == 1 ? number : (double)NAN;
}

/* Counts of a run, which are the same on all machines and from run to run. */
static const struct {
    const char *key, *unit, *name;
} COUNTS[] = {{"contact_solves_mean", "solves", "solves_per_step"},
              {"cg_iterations_mean", "iterations", "iterations_per_step"},
              {"steps_halved", "steps", "steps_halved"},
              {"contacts", "contacts", "contacts"},
              {"contact_cuts", "cuts", "cuts"},
              {"contact_pinches", "pairs", "pinches"}};
enum { N_COUNTS = sizeof COUNTS / sizeof *COUNTS };

/* The figures of a run's report, and of its last phase. */
struct told {
    double wall, intersections, shapes; /* s, pairs */
    double last_wall, last_simulated;   /* s */
    double count[N_COUNTS];             /* of all phases */
};

static int read_report(const char *path, struct told *told)
{
    char line[4000];
    FILE *file = fopen(path, "r");
    *told = (struct told){NAN, NAN, NAN, NAN, NAN, {0}};
    while (file && fgets(line, sizeof line, file)) {
        const bool phase = strstr(line, "\"ended\": ") != NULL;
        const double wall = number_in(line, "wall_seconds");
        if (phase) {
            told->last_wall = wall;
            told->last_simulated = number_in(line, "simulated_seconds");
            continue;
        }
        told->wall = isnan(wall) ? told->wall : wall;
        for (int i = 0; i < N_COUNTS; i++) {
            const double count = number_in(line, COUNTS[i].key);
            told->count[i] = isnan(count) ? told->count[i] : count;
        }
        told->intersections = fmin(told->intersections, number_in(line, "intersections"));
        told->shapes = fmin(told->shapes, number_in(line, "intersections_shapes"));
    }
    if (file)
        fclose(file);
    return isnan(told->wall) ? serve_fail("a report cannot be read") : 0;
}

/* ---- Runs ---- */

static void add(char *command, size_t size, const char *text)
{
    const size_t used = strlen(command);
    snprintf(command + used, size - used, " %s", text);
}

static int write_command(struct serve_request *request, const char *what, const char *report,
                         char *command, size_t size)
{
    char name[20], contact[20], scheduler[40], folder[PATH], path[PATH], text[200];
    serve_word(request, "name", name, sizeof name);
    serve_word(request, "contact", contact, sizeof contact);
    serve_word(request, "scheduler", scheduler, sizeof scheduler);
    const struct scene *scene = find_scene(name);
    if (!scene)
        return serve_fail("there is no scene %s", name);
    program_folder(folder, sizeof folder);
    scene_path(name, path);
    snprintf(command, size,
             "'%s/../duite-cloth' '%s' --quiet --threads %u --scheduler %s --report '%s'", folder,
             path, (unsigned)serve_number(request, "threads"), scheduler, report);
    if (!strcmp(contact, "repulsion"))
        add(command, size, REPULSION);
    if (!strcmp(what, "intersections"))
        add(command, size, "--check-intersections");
    for (int i = 0; serve_number(request, "quick") && i < scene->cloths; i++) {
        snprintf(text, sizeof text, "--set 'cloths[%d].mesh.pattern.vertices=%d'", i, 800);
        add(command, size, text);
    }
    if (serve_number(request, "quick"))
        add(command, size, QUICK_PHASES);
    add(command, size, ">&2");
    return 0;
}

/* Runs the scene, and reads what its report tells. */
static int run(struct serve_request *request, const char *what, struct told *told)
{
    char report[] = "/tmp/duite-garment.XXXXXX", command[4 * PATH];
    const int file = mkstemp(report);
    int code = file < 0 ? serve_fail("no file %s", report)
                        : write_command(request, what, report, command, sizeof command);
    const int status = code ? 0 : system(command);
    if (status && !(WIFEXITED(status) && WEXITSTATUS(status) == FOUND))
        code = serve_fail("duite-cloth fails: %.150s", command);
    if (!code)
        code = read_report(report, told);
    if (file >= 0) {
        close(file);
        unlink(report);
    }
    return code;
}

/* wall, frame, intersections, or the key of a count. */
static double value_of(const struct told *told, const char *what)
{
    for (int i = 0; i < N_COUNTS; i++)
        if (!strcmp(what, COUNTS[i].key))
            return told->count[i];
    return !strcmp(what, "wall")    ? told->wall
           : !strcmp(what, "frame") ? told->last_wall / (25 * told->last_simulated)
                                    : told->intersections + told->shapes;
}

/* A count is told of the last run, if it had the same settings: the text up to the word what=. */
static int scene(void *context, struct serve_request *request, double *value)
{
    static char settings[200];
    static struct told told;
    char what[30];
    const char *end = strstr(request->text, " what=");
    const size_t length = end ? (size_t)(end - request->text) : strlen(request->text);
    (void)context;
    serve_word(request, "what", what, sizeof what);
    const bool same = strlen(settings) == length && !strncmp(settings, request->text, length);
    bool counts = false;
    for (int i = 0; i < N_COUNTS; i++)
        counts = counts || !strcmp(what, COUNTS[i].key);
    const int code = same && counts ? 0 : run(request, what, &told);
    snprintf(settings, sizeof settings, "%.*s", code ? 0 : (int)length, request->text);
    *value = value_of(&told, what);
    return code ? code : isnan(*value) ? serve_fail("the report does not tell what=%s", what) : 0;
}

const struct serve_run garments_scene_runs[] = {{"scene", scene}, {0}};

/* ---- Plans ---- */

static struct measure_series *plan_scene(struct measure *measure,
                                         const struct bench_options *options, const char *name,
                                         const char *contact, const char *what)
{
    return measure_series(measure, (struct subject_shape){"duite", 0, options->threads},
                          "scene name=%s contact=%s threads=%u scheduler=%s quick=%d what=%s", name,
                          contact, options->threads, options->scheduler, options->quick, what);
}

static void plan_counts(struct measure *measure, const struct bench_options *options,
                        const char *name)
{
    for (int i = 0; i < N_COUNTS; i++)
        measure_value(measure, plan_scene(measure, options, name, "certified", COUNTS[i].key), 1,
                      COUNTS[i].unit, "%s_%s", name, COUNTS[i].name);
}

static void plan_jeans(struct measure *measure, const struct bench_options *options)
{
    static const char *const contact[] = {"repulsion", "certified"};
    measure->cold = true;
    for (int i = 0; i < 2; i++)
        measure_value(measure, plan_scene(measure, options, "jeans", contact[i], "wall"), 1, "s",
                      "jeans_%s_seconds", contact[i]);
    plan_counts(measure, options, "jeans");
}

const struct bench_case garments_jeans = {
    "jeans",
    "jeans.yaml: trousers of 5,000 vertices are sewn around the figure and draped until they rest, "
    "by repulsion without cloth against cloth and by certified contact; seconds of all phases, "
    "without meshing",
    plan_jeans, garments_scene_runs, 4};

static void plan_walk(struct measure *measure, const struct bench_options *options)
{
    measure->cold = true;
    measure_value(measure, plan_scene(measure, options, "walk", "certified", "frame"), 1, "s",
                  "walk_seconds_per_frame");
    plan_counts(measure, options, "walk");
}

const struct bench_case garments_walk = {
    "walk",
    "walk.yaml, its last phase: T-shirt and jeans of 12,000 vertices together on the figure that "
    "walks; seconds for each 1/25 s, certified contact",
    plan_walk, garments_scene_runs, 2};

static void plan_intersections(struct measure *measure, const struct bench_options *options)
{
    struct measure_metric *metric = measure_metric(measure, "pairs", measure_sum, "intersections");
    const struct measure_series *of[N_SCENES];
    measure->cold = true;
    for (int i = 0; i < N_SCENES; i++)
        of[i] = plan_scene(measure, options, SCENES[i].name, "certified", "intersections");
    metric->of = of[0];
    metric->n = N_SCENES;
}

const struct bench_case garments_intersections = {
    "intersections",
    "pairs of triangles that intersect, the most in a frame of all phases, summed over "
    "dressing.yaml, jeans.yaml, layers.yaml and walk.yaml",
    plan_intersections, garments_scene_runs, 1};
