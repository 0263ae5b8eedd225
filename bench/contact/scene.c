/* A scene of cloth/scenes, run as duite-cloth runs it; its frames are kept and looked at when the
 * clock has stopped. One run tells several numbers; each is told once, then there is another run.
 */
#include "bench/contact/contact.h"

#include "bench/cg/cg.h"
#include "bench/sets.h"
#include "bench/tasks/tasks.h"
#include "bench/temporary.h"
#include "cloth/app/check/intersections.h"
#include "cloth/scene/scene.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Scenes ---- */

/* A mesh that turned.awk makes for a scene: its shape, the scene's key that names its file, and its
 * divisions. */
struct turned {
    const char *shape, *key;
    int n, quick_n;
};
static const struct turned TUBE = {"tube", "cloths[0].mesh.file", 360, 24};
static const struct turned CONE = {"cone", "obstacles[0].body.obj", 40, 12};
static const struct turned BOWL = {"bowl", "obstacles[0].body.obj", 64, 64};

/* s: where the part ends that is run; with --quick its grids are of so many vertices. */
static const struct part {
    const char *name;
    double end, quick_end;
    int cloths, nx, ny;
    const char *file; /* in contact/peers; NULL: the scene of this name in cloth/scenes */
    const struct turned *mesh;
    const char *set;
} PARTS[] = {{"sheet", 0.48, 0.01, 1, 20, 20, NULL, NULL, ""},
             {"sphere", 0.6, 0.16, 1, 20, 20, NULL, NULL, ""},
             {"stack", 0.2, 0.1, 5, 12, 12, NULL, NULL, ""},
             {"twist", 1.5, 0.1, 1, 21, 7, NULL, NULL, ""},
             {"peers_drape", 1, 0.1, 5, 16, 16, "drape", NULL, ""},
             {"peers_curtain", 1, 0.01, 15, 8, 8, "curtain", NULL, ""},
             {"peers_twist", 0.4, 0.04, 0, 0, 0, "twist", &TUBE, ""},
             {"peers_needle", 0.5, 0.01, 5, 16, 16, "needle", &CONE, ""},
             {"peers_stack", 0.2, 0.01, 10, 12, 12, "stack", NULL, ""},
             {"peers_ribbon", 0.5, 0.01, 25, 2, 20, "ribbon", &BOWL, ""},
             {"peers_layers", 0.1, 0.02, 50, 6, 6, "layers", NULL, ""},
             {"ring", 0.45, 0.02, 1, 12, 12, "ring", NULL, ""},
             {"pinch", 10, 1.1, 1, 11, 11, "pinch", NULL, ""},
             {"pinch_h1", 10, 1.1, 1, 11, 11, "pinch", NULL, "time.h=0.001"},
             {"pinch_h10", 10, 1.1, 1, 11, 11, "pinch", NULL, "time.h=0.01"},
             {"cross", 0.015, 0.005, 2, 8, 8, "cross", NULL, ""},
             {"cross_still", 0.015, 0.005, 2, 8, 8, "cross", NULL, "cloths[0].velocity=[0, 0, 0]"}};
enum { N_PARTS = sizeof PARTS / sizeof *PARTS };

static void make_small(struct sets *sets, const struct part *part)
{
    for (int i = 0; i < part->cloths; i++) {
        add_set(sets, "cloths[%d].mesh.grid.nx=%d", i, part->nx);
        add_set(sets, "cloths[%d].mesh.grid.ny=%d", i, part->ny);
    }
    add_set(sets, "grain=60");
}

/* The mesh in a folder that goes again when the scene is read. */
static int make_turned(struct sets *sets, const struct turned *mesh, bool quick, const char *folder)
{
    char command[3 * TEMPORARY_PATH];
    if (!mesh)
        return 0;
    snprintf(command, sizeof command, "awk -v shape=%s -v n=%d -f '%s/turned.awk' > '%s/%s.obj'",
             mesh->shape, quick ? mesh->quick_n : mesh->n, BENCH_PEERS, folder, mesh->shape);
    add_set(sets, "%s='%s/%s.obj'", mesh->key, folder, mesh->shape);
    return system(command) ? serve_fail("no mesh: %s", command) : 0;
}

static int read_part(struct model *model, const struct part *part, struct sets *sets)
{
    struct cloth_error error = {0};
    char path[TEMPORARY_PATH];
    snprintf(path, sizeof path, "%s/%s.yaml", part->file ? BENCH_PEERS : BENCH_SCENES,
             part->file ? part->file : part->name);
    return scene_read(model, path, sets->n, sets->set, &error) ? serve_fail("%s", error.text) : 0;
}

int contact_scene_read(struct model *model, const char *name, const char *self, bool quick)
{
    struct sets sets = {0};
    const struct part *part = PARTS;
    char folder[TEMPORARY_PATH];
    while (part < PARTS + N_PARTS && strcmp(part->name, name) != 0)
        part++;
    if (part == PARTS + N_PARTS)
        return serve_fail("there is no scene %s", name);
    if (quick)
        make_small(&sets, part);
    add_set(&sets, "time.end=%.17g", quick ? part->quick_end : part->end);
    if (*self)
        add_set(&sets, "contact={mode: certified, self: %s}", self);
    add_set(&sets, "%s", part->set);
    if (temporary_make(NULL, "duite-mesh", folder))
        return 1;
    int code = make_turned(&sets, part->mesh, quick, folder);
    if (!code)
        code = read_part(model, part, &sets);
    temporary_remove(folder);
    return code;
}

/* ---- Frames ---- */

static const double EARLY = 1; /* s: what is pressed rests */

struct frame {
    double time, *position;
};

struct film {
    struct frame *frame;
    size_t n, room, n_vertices;
    double force,
        force_early; /* N: upwards, on the obstacle of the last probe; NAN: there is none */
};

static int keep(void *context, uint64_t frame, double time, const double *position,
                struct cloth_error *error)
{
    struct film *film = context;
    const size_t bytes = 3 * film->n_vertices * sizeof *position;
    (void)frame;
    if (film->n == film->room) {
        const size_t room = 2 * film->room + 8;
        struct frame *grown = realloc(film->frame, room * sizeof *grown);
        if (!grown)
            return cloth_fail(error, CLOTH_E_MEMORY, "no memory for frames");
        film->frame = grown;
        film->room = room;
    }
    double *copy = malloc(bytes + 1);
    if (!copy)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for a frame");
    film->frame[film->n++] = (struct frame){time, memcpy(copy, position, bytes)};
    return 0;
}

/* The columns of a probe of an obstacle are the last three of a row. */
static int keep_force(void *context, uint64_t step, double time, size_t n, const double *values,
                      struct cloth_error *error)
{
    struct film *film = context;
    (void)step, (void)error;
    film->force = n < 3 ? NAN : values[n - 2];
    if (isnan(film->force_early) && time > EARLY)
        film->force_early = film->force;
    return 0;
}

static void free_film(struct film *film)
{
    for (size_t i = 0; i < film->n; i++)
        free(film->frame[i].position);
    free(film->frame);
    *film = (struct film){0};
}

/* The most in a frame, of the state and as frames are written. */
static int look(const struct film *film, const struct model *model, double *most)
{
    struct cloth_error error = {0};
    struct intersections *all = NULL;
    struct intersections_found found = {0};
    const struct intersections_setup of = {.apart = &model->contact.apart, .found = &found};
    int code = intersections_of(&all, model, of, &error);
    for (size_t i = 0; i < film->n && !code; i++)
        for (int written = 0; written < 2 && !code; written++)
            code = intersections_frame(all, i, film->frame[i].time, film->frame[i].position,
                                       written, &error);
    if (!code)
        *most = (double)(found.pairs + found.with_shapes);
    intersections_close(&all);
    return code ? serve_fail("%s", error.text) : 0;
}

/* ---- A run ---- */

enum {
    WALL,
    FRAME,
    STEP,
    INTERSECTIONS,
    CONTACTS,
    SOLVES,
    ITERATIONS,
    HALVED,
    CUTS,
    QUERIES,
    PAIRS,
    PINCHES,
    FORCE,
    FORCE_EARLY,
    MOVED,
    MEMORY,
    WHATS
};
static const char *const WHAT[WHATS] = {
    "wall", "frame",   "step",  "intersections", "contacts", "solves",      "iterations", "halved",
    "cuts", "queries", "pairs", "pinches",       "force",    "force_early", "moved",      "memory"};

/* The figures of the run with these settings; NAN: those that were asked for already. */
struct told {
    char settings[160];
    double value[WHATS];
    uint64_t hash; /* of its end; 0: there was no run yet */
};

static double per_step(const struct flow_report *report, uint64_t n)
{
    return (double)n / (double)report->steps;
}

static void tell(struct told *told, const struct flow_report *report, double fps)
{
    told->value[WALL] = report->wall_seconds;
    told->value[FRAME] = report->wall_seconds / (report->simulated_seconds * fps);
    told->value[STEP] = report->wall_seconds / (double)report->steps;
    told->value[CONTACTS] = (double)report->contacts;
    told->value[SOLVES] = per_step(report, report->steps + report->steps_halved +
                                               report->steps_retaken + report->contact_solves);
    told->value[ITERATIONS] = per_step(report, report->cg_iterations_total);
    told->value[HALVED] = (double)report->steps_halved;
    told->value[CUTS] = (double)report->contact_cuts;
    told->value[QUERIES] = per_step(report, report->contact_queries);
    told->value[PAIRS] = per_step(report, report->contact_pairs);
    told->value[MEMORY] = (double)serve_most_bytes();
    told->value[PINCHES] = (double)report->contact_pinches;
    told->value[MOVED] = (double)(report->counters.delegated + report->counters.migrated);
}

static int check(struct told *told, const struct flow_report *report)
{
    if (told->hash && told->hash != report->state_hash)
        return serve_fail("wrong answer: it ends at %016" PRIx64 ", not at %016" PRIx64
                          " as the run before",
                          report->state_hash, told->hash);
    told->hash = report->state_hash;
    return 0;
}

static int start(struct serve_request *request, struct flow *flow, duite **rt)
{
    char scheduler[40], balance[40];
    duite_options options = duite_options_default();
    serve_word(request, "scheduler", scheduler, sizeof scheduler);
    serve_word(request, "balance", balance, sizeof balance);
    options.kernels = flow_kernels();
    options.context = flow;
    options.threads = (unsigned)serve_number(request, "threads");
    options.scheduler = duite_scheduler_find(scheduler);
    options.balance = duite_balancer_find(balance);
    return tasks_code(duite_start(rt, &options));
}

static int run_model(struct serve_request *request, const struct model *model, struct film *film,
                     struct flow_report *report)
{
    const struct flow_output output = {.context = film, .frame = keep, .row = keep_force};
    struct cloth_error error = {0};
    struct flow *flow = NULL;
    duite *rt = NULL;
    int code = cg_make_flow(model, &flow);
    if (!code)
        code = start(request, flow, &rt);
    if (!code && flow_run(flow, rt, &output, NULL, report, &error))
        code = serve_fail("%s", error.text);
    if (rt && duite_stop(&rt) && !code)
        code = tasks_code(1);
    flow_free(flow);
    return code;
}

static int run(struct serve_request *request, struct told *told)
{
    struct model model = {0};
    struct flow_report report = {0};
    struct film film = {.force = NAN, .force_early = NAN};
    char name[20], self[8];
    const bool quick = serve_number(request, "quick") != 0;
    serve_word(request, "name", name, sizeof name);
    serve_word(request, "self", self, sizeof self);
    int code = contact_scene_read(&model, name, self, quick);
    for (uint32_t c = 0; c < model.n_cloths && !code; c++)
        film.n_vertices += model.cloths[c].mesh.n_vertices;
    if (!code)
        code = run_model(request, &model, &film, &report);
    if (!code)
        code = check(told, &report);
    if (!code) {
        tell(told, &report, model.fps);
        told->value[FORCE] = film.force;
        told->value[FORCE_EARLY] = film.force_early;
        code = look(&film, &model, told->value + INTERSECTIONS);
    }
    free_film(&film);
    model_free(&model);
    return code;
}

/* The run with the settings of a request, all but what is asked for; NULL: there is no room. */
static struct told *find(const char *text)
{
    static struct told all[32];
    const char *what = strstr(text, " what=");
    const int length = what ? (int)(what - text) : (int)strlen(text);
    for (struct told *told = all; told < all + sizeof all / sizeof *all; told++) {
        if (!*told->settings) {
            snprintf(told->settings, sizeof told->settings, "%.*s", length, text);
            for (int i = 0; i < WHATS; i++)
                told->value[i] = NAN;
        }
        if ((int)strlen(told->settings) == length && !strncmp(told->settings, text, (size_t)length))
            return told;
    }
    return NULL;
}

static int scene(void *context, struct serve_request *request, double *value)
{
    char word[20];
    int what = 0;
    struct told *told = find(request->text);
    (void)context;
    serve_word(request, "what", word, sizeof word);
    while (what < WHATS && strcmp(WHAT[what], word) != 0)
        what++;
    if (!told || what == WHATS)
        return serve_fail("what=%s is not told of a run, or there are too many", word);
    const int code = isnan(told->value[what]) ? run(request, told) : 0;
    *value = told->value[what];
    told->value[what] = NAN;
    return code;
}

const struct serve_run contact_scene_runs[] = {{"scene", scene}, {0}};
