/* A state is a scene (states.yaml) with some of its values changed, moved for a time, and then the
 * system of one step. States of one motion differ in that step alone; all of them stand with it. */
#include "bench/cg/cg.h"

#include "bench/measure.h"
#include "bench/sets.h"
#include "cloth/scene/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { IRREGULAR_SIDE = 187, QUICK_SIDE = 16, QUICK_FOLDED_SIDE = 32 };

#define PLACE "cloths[0].transform={rotate: [0.87, 0.4, 0.25, 0.1], translate: [0, 0.62, 0]}"
#define FREE  "cloths[0].pins=[]"
#define TOUCH "contact={mode: certified, self: on, thickness: 0.002, friction: 0.3}"

#define SIDE(n) "cloths[0].mesh.grid.nx=" #n, "cloths[0].mesh.grid.ny=" #n
#define HIGH    "cloths[0].transform={translate: [0, 0.62, 0]}"
#define ROD     "obstacles=[{capsule: {from: [-0.6, 0.6, 0.01], to: [0.6, 0.6, -0.01], radius: 0.005}}]"

/* seconds: how long it moves, in steps of 8 ms; 0: not at all; quick: four of them, or whole. A
 * folded sheet hangs over a rod, and its halves have swung against each other. count: iterations
 * whose answers its states keep; 0: they are made without. A state's name tells its step, in ms
 * (else 1 ms), and whether there are bend springs. */
static const struct motion {
    const char *name;
    double seconds;
    uint32_t count;
    const char *sets[4];
    const char *state[4];
} MOTIONS[] = {
    {"sheet_150", 0, 400, {0}, {"sheet_150"}},
    {"sheet_400", 0, 100, {SIDE(400)}, {"sheet_400"}},
    {"hanging", 0.4, 50, {0}, {"hanging_h1", "hanging_h8_bend", "hanging_h20"}},
    {"falling",
     0.08,
     50,
     {FREE, "cloths[0].transform.translate=[0, 3, 0]"},
     {"falling_h1_bend", "falling_h8", "falling_h20_bend"}},
    {"crumpled", 0.64, 50, {FREE, PLACE}, {"crumpled_h1", "crumpled_h8_bend", "crumpled_h20"}},
    {"irregular",
     0.16,
     50,
     {"cloths[0].transform={translate: [0, 0.5, 0]}"},
     {"irregular_h1_bend", "irregular_h8", "irregular_h20_bend"}},
    {"dress",
     0.16,
     50,
     {"materials.cloth={density: 0.2, stretch: 2000, damping: {stiffness: 0.01}}",
      "cloths[0].pins=[{vertices: [0, 200]}]",
      "cloths[0].transform={scale: 0.01, translate: [0, 5, 0]}"},
     {"dress_h1", "dress_h8_bend", "dress_h20"}},
    {"landed", 0.64, 0, {FREE, PLACE, TOUCH}, {"landed_h1", "landed_h8_bend", "landed_h20"}},
    {"folded", 0.64, 0, {FREE, HIGH, TOUCH, ROD}, {"folded_h1", "folded_h8_bend", "folded_h20"}},
    {"large", 0, 0, {SIDE(400)}, {"large_h1", "large_h8", "large_h20"}},
    {"million", 0, 0, {SIDE(1000)}, {"million_h1", "million_h8", "million_h20"}},
};
enum { MOST_STATES = 3 * STATES_MOTIONS };
_Static_assert(sizeof MOTIONS == STATES_MOTIONS * sizeof *MOTIONS, "what cg.h says");

/* Those of the motions before this one. */
static const char *const *list_before(const char *motion, const char **name)
{
    const char **next = name;
    for (const struct motion *m = MOTIONS; strcmp(m->name, motion) != 0; m++)
        for (int i = 0; m->state[i]; i++)
            *next++ = m->state[i];
    *next = NULL;
    return name;
}

const char *const *states_all(void)
{
    static const char *name[MOST_STATES + 1];
    return list_before("landed", name);
}

const char *const *states_small(void)
{
    static const char *name[MOST_STATES + 1];
    return list_before("large", name);
}

const char *const *states_met(void)
{
    return states_all() + 2; /* but the two sheets that stand still */
}

const char *const *states_of(const char *motion)
{
    const struct motion *m = MOTIONS;
    while (strcmp(m->name, motion) != 0)
        m++;
    return m->state;
}

const char *states_missing(const char *name)
{
    return strncmp(name, "dress", 5) || !access(BENCH_DRESS, R_OK)
               ? NULL
               : "its mesh, ../shared/data/meshes/dress-v17k-f34k.obj beside the sources, is "
                 "missing";
}

/* ---- Meshes ---- */

static double between(uint64_t *seed, double from, double to)
{
    return from + (to - from) * (double)measure_random(seed, 1u << 30) / (1u << 30);
}

/* A square whose vertices are shaken off a grid, each cell cut along either diagonal. */
static int write_irregular(const char *path, uint32_t side)
{
    uint64_t seed = 1;
    FILE *file = fopen(path, "w");
    for (uint32_t j = 0; file && j < side; j++)
        for (uint32_t i = 0; i < side; i++) {
            const double edge = 1.0 / (side - 1);
            const double x = i == 0 || i == side - 1 ? 0 : between(&seed, -0.35, 0.35);
            const double z = j == 0 || j == side - 1 ? 0 : between(&seed, -0.35, 0.35);
            fprintf(file, "v %.17g 0 %.17g\n", edge * (i + x) - 0.5, edge * (j + z) - 0.5);
        }
    for (uint32_t j = 0; file && j + 1 < side; j++)
        for (uint32_t i = 0; i + 1 < side; i++) {
            const uint32_t a = j * side + i + 1, b = a + 1, c = a + side, d = c + 1;
            if (measure_random(&seed, 2))
                fprintf(file, "f %u %u %u\nf %u %u %u\n", a, c, d, a, d, b);
            else
                fprintf(file, "f %u %u %u\nf %u %u %u\n", a, c, b, b, c, d);
        }
    if (!file || fclose(file))
        return serve_fail("%s cannot be written", path);
    return 0;
}

/* The set that names the mesh file, where the motion has one. */
static int mesh_set(const char *motion, bool quick, char *set)
{
    char path[4200];
    const char *folder = getenv(STATE_FOLDER);
    *set = '\0';
    if (!strcmp(motion, "dress") && !quick)
        snprintf(set, SET_LENGTH, "cloths[0].mesh={file: '%s'}", BENCH_DRESS);
    if (strcmp(motion, "irregular") != 0)
        return 0;
    snprintf(path, sizeof path, "%s/irregular.obj", folder ? folder : ".");
    snprintf(set, SET_LENGTH, "cloths[0].mesh={file: '%s'}", path);
    return write_irregular(path, quick ? QUICK_SIDE : IRREGULAR_SIDE);
}

/* ---- Models ---- */

static bool is_folded(const struct motion *motion)
{
    return !strcmp(motion->name, "folded");
}

static int read_model(struct model *model, const struct motion *motion, bool quick, double h,
                      double end, bool bend)
{
    struct cloth_error error = {0};
    struct sets *sets = calloc(1, sizeof *sets);
    char mesh[SET_LENGTH];
    int code = sets ? mesh_set(motion->name, quick, mesh) : serve_no_memory();
    if (!code) {
        add_set(sets, "%s", mesh);
        for (int i = 0; i < 4 && motion->sets[i]; i++)
            add_set(sets, "%s", motion->sets[i]);
        add_set(sets, "time.h=%.17g", h);
        add_set(sets, "time.end=%.17g", end);
        if (bend)
            add_set(sets, "materials.cloth.bend=5");
        if (quick && !*mesh) {
            const int side = is_folded(motion) ? QUICK_FOLDED_SIDE : QUICK_SIDE;
            add_set(sets, "cloths[0].mesh.grid.nx=%d", side);
            add_set(sets, "cloths[0].mesh.grid.ny=%d", side);
        }
        if (quick && is_folded(motion)) /* of long edges: halves stay farther apart */
            add_set(sets, "contact.thickness=0.02");
        if (quick)
            add_set(sets, "grain=40");
        if (end > h)
            add_set(sets, "solver={stop: {relative: 0.01}}"); /* the motion: it need not be exact */
        if (scene_read(model, BENCH_STATES_SCENE, sets->n, sets->set, &error))
            code = serve_fail("%s", error.text);
    }
    free(sets);
    return code;
}

/* NULL: there is no such state. */
static const struct motion *motion_of(const char *state)
{
    for (const struct motion *m = MOTIONS; m < MOTIONS + STATES_MOTIONS; m++)
        for (int i = 0; m->state[i]; i++)
            if (!strcmp(m->state[i], state))
                return m;
    return NULL;
}

int states_plan_make(struct states_plan *plan, const char *name, bool quick)
{
    enum { QUICK_COUNT = 20 };
    const double h = 0.008;
    const double own_h = 0.001 * fmax(state_step(name), 1);
    const struct motion *motion = motion_of(name);
    if (!motion)
        return serve_fail("there is no state %s", name);
    *plan = (struct states_plan){.moved = motion->name,
                                 .count = quick ? QUICK_COUNT : motion->count,
                                 .moves = motion->seconds > 0,
                                 .solved_here = !motion->count};
    const bool few = !plan->moves || (quick && !is_folded(motion));
    const double seconds = few ? 4 * h : motion->seconds;
    int code = read_model(&plan->model, motion, quick, own_h, own_h, strstr(name, "_bend"));
    if (!code)
        code = read_model(&plan->motion, motion, quick, h, seconds, true);
    if (code)
        states_plan_free(plan);
    return code;
}

void states_plan_free(struct states_plan *plan)
{
    model_free(&plan->model);
    model_free(&plan->motion);
    *plan = (struct states_plan){0};
}

int states_start(struct model *model, const double *x, const double *v)
{
    struct model_cloth *cloth = model->cloths;
    const size_t n = cloth->mesh.n_vertices;
    cloth->start = malloc((n + 1) * 6 * sizeof *cloth->start);
    if (!cloth->start)
        return serve_no_memory();
    for (size_t i = 0; i < n; i++) {
        memcpy(cloth->start + 6 * i, x + 3 * i, 3 * sizeof *x);
        memcpy(cloth->start + 6 * i + 3, v + 3 * i, 3 * sizeof *v);
    }
    return 0;
}

int states_wave(struct model *model)
{
    const struct mesh *mesh = &model->cloths->mesh;
    const size_t n = mesh->n_vertices;
    uint64_t seed = 1;
    double *x = calloc(n + 1, 6 * sizeof *x), *v = x ? x + 3 * n : NULL;
    if (!x)
        return serve_no_memory();
    for (size_t i = 0; i < n; i++) {
        const double *at = mesh->position + 3 * i;
        const double velocity[3] = {0.1 * sin(5 * at[2]), 0.2 * cos(6 * at[0]), 0.1 * at[0]};
        memcpy(x + 3 * i, at, 3 * sizeof *at);
        memcpy(v + 3 * i, velocity, sizeof velocity);
        x[3 * i + 1] += 0.01 * sin(9 * at[0]) * cos(7 * at[2]) + between(&seed, -1e-4, 1e-4);
    }
    const int code = states_start(model, x, v);
    free(x);
    return code;
}
