/* A state is a scene (states.yaml) with some of its values changed, moved for a time, and then the
 * system of one step. States of one motion differ in that step alone. */
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

#define HIGH "cloths[0].transform={translate: [0, 0.62, 0]}"
#define ROD  "obstacles=[{capsule: {from: [-0.6, 0.6, 0.01], to: [0.6, 0.6, -0.01], radius: 0.005}}]"

/* seconds: how long it moves, in steps of 8 ms; 0: not at all; quick: four of them, or whole. What
 * is folded hangs over a rod, and its halves have swung against each other. */
static const struct motion {
    const char *name;
    double seconds;
    const char *sets[4];
} MOTIONS[] = {
    {"reference", 0, {0}},
    {"large", 0, {"cloths[0].mesh.grid.nx=400", "cloths[0].mesh.grid.ny=400"}},
    {"million", 0, {"cloths[0].mesh.grid.nx=1000", "cloths[0].mesh.grid.ny=1000"}},
    {"hanging", 0.4, {0}},
    {"falling", 0.08, {FREE, "cloths[0].transform.translate=[0, 3, 0]"}},
    {"crumpled", 0.64, {FREE, PLACE}},
    {"landed", 0.64, {FREE, PLACE, TOUCH}},
    {"folded", 0.64, {FREE, HIGH, TOUCH, ROD}},
    {"irregular", 0.16, {"cloths[0].transform={translate: [0, 0.5, 0]}"}},
    {"dress",
     0.16,
     {"materials.cloth={density: 0.2, stretch: 2000, damping: {stiffness: 0.01}}",
      "cloths[0].pins=[{vertices: [0, 200]}]",
      "cloths[0].transform={scale: 0.01, translate: [0, 5, 0]}"}},
};
enum { N_MOTIONS = sizeof MOTIONS / sizeof *MOTIONS };

/* The step: its h in ms, and whether there are bend springs. count: iterations. */
static const struct spec {
    const char *name, *motion;
    int h;
    bool bend;
    uint32_t count;
} SPECS[] = {
    {"sheet_150", "reference", 1, false, 400},   {"sheet_400", "large", 1, false, 100},
    {"hanging_h1", "hanging", 1, false, 50},     {"hanging_h8_bend", "hanging", 8, true, 50},
    {"hanging_h20", "hanging", 20, false, 50},   {"falling_h1_bend", "falling", 1, true, 50},
    {"falling_h8", "falling", 8, false, 50},     {"falling_h20_bend", "falling", 20, true, 50},
    {"crumpled_h1", "crumpled", 1, false, 50},   {"crumpled_h8_bend", "crumpled", 8, true, 50},
    {"crumpled_h20", "crumpled", 20, false, 50}, {"irregular_h1_bend", "irregular", 1, true, 50},
    {"irregular_h8", "irregular", 8, false, 50}, {"irregular_h20_bend", "irregular", 20, true, 50},
    {"dress_h1", "dress", 1, false, 50},         {"dress_h8_bend", "dress", 8, true, 50},
    {"dress_h20", "dress", 20, false, 50},       {"landed_h1", "landed", 1, false, 0},
    {"landed_h8_bend", "landed", 8, true, 0},    {"landed_h20", "landed", 20, false, 0},
    {"folded_h1", "folded", 1, false, 0},        {"folded_h8_bend", "folded", 8, true, 0},
    {"folded_h20", "folded", 20, false, 0},      {"large_h1", "large", 1, false, 0},
    {"large_h8", "large", 8, false, 0},          {"large_h20", "large", 20, false, 0},
    {"million_h1", "million", 1, false, 0},      {"million_h8", "million", 8, false, 0},
    {"million_h20", "million", 20, false, 0},
};
enum {
    N_SPECS = sizeof SPECS / sizeof *SPECS,
    FIRST_MET = 2,
    FIRST_LANDED = 17,
    FIRST_FOLDED = 20,
    FIRST_LARGE = 23,
    FIRST_MILLION = 26
};

/* From one spec to before another. */
static void list_names(int first, int end, const char **name)
{
    for (int i = first; i < end; i++)
        *name++ = SPECS[i].name;
    *name = NULL;
}

const char *const *states_all(void)
{
    static const char *name[N_SPECS + 1];
    list_names(0, FIRST_LANDED, name);
    return name;
}

const char *const *states_small(void)
{
    static const char *name[N_SPECS + 1];
    list_names(0, FIRST_LARGE, name);
    return name;
}

const char *const *states_met(void)
{
    return states_all() + FIRST_MET;
}

const char *const *states_landed(void)
{
    static const char *name[N_SPECS + 1];
    list_names(FIRST_LANDED, FIRST_FOLDED, name);
    return name;
}

const char *const *states_folded(void)
{
    static const char *name[N_SPECS + 1];
    list_names(FIRST_FOLDED, FIRST_LARGE, name);
    return name;
}

const char *const *states_large(void)
{
    static const char *name[N_SPECS + 1];
    list_names(FIRST_LARGE, FIRST_MILLION, name);
    return name;
}

const char *const *states_million(void)
{
    static const char *name[N_SPECS + 1];
    list_names(FIRST_MILLION, N_SPECS, name);
    return name;
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

int states_plan_make(struct states_plan *plan, const char *name, bool quick)
{
    enum { QUICK_COUNT = 20 };
    const double h = 0.008;
    const struct spec *spec = SPECS;
    const struct motion *motion = MOTIONS;
    while (spec < SPECS + N_SPECS && strcmp(spec->name, name) != 0)
        spec++;
    if (spec == SPECS + N_SPECS)
        return serve_fail("there is no state %s", name);
    while (strcmp(motion->name, spec->motion) != 0)
        motion++;
    *plan = (struct states_plan){.moved = motion->name,
                                 .count = quick ? QUICK_COUNT : spec->count,
                                 .moves = motion->seconds > 0,
                                 .solved_here = spec >= SPECS + FIRST_LANDED};
    const bool few = !plan->moves || (quick && !is_folded(motion));
    const double seconds = few ? 4 * h : motion->seconds;
    int code =
        read_model(&plan->model, motion, quick, 0.001 * spec->h, 0.001 * spec->h, spec->bend);
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
