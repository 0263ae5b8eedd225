/* A model owns all that its pointers reach; a zeroed model owns nothing. */
#include "cloth/model/model.h"

#include "cloth/base/memory.h"
#include "cloth/base/sets.h"
#include "cloth/physics/limit.h"
#include "cloth/solve/patches.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

static void free_pick(struct model_pick *pick)
{
    free(pick->vertices);
    free(pick->place);
}

static void free_pairs(struct model_pairs *pairs)
{
    for (int end = 0; end < 2; end++) {
        free(pairs->end[end].vertices);
        free(pairs->end[end].edges);
        free(pairs->end[end].at);
    }
    free(pairs->place);
}

void model_start_at(struct model_cloth *cloth, double *start)
{
    for (uint32_t i = 0; i < cloth->n_starts; i++)
        free_pick(&cloth->starts[i].pick);
    free(cloth->starts);
    free(cloth->start);
    cloth->starts = NULL;
    cloth->n_starts = 0;
    cloth->start = start;
}

static void free_seams(struct model_seams *seams)
{
    for (uint32_t s = 0; s < seams->n; s++) {
        free(seams->seam[s].side[0].panel);
        free(seams->seam[s].side[1].panel);
        free(seams->seam[s].pair);
    }
    free(seams->seam);
    for (uint32_t i = 0; i < seams->n_some && seams->some; i++)
        free(seams->some[i].number);
    free(seams->some);
    free(seams->reversed);
}

static void free_cloth(struct model_cloth *cloth)
{
    free_seams(&cloth->seams);
    for (uint32_t i = 0; i < cloth->n_pins; i++) {
        free_pick(&cloth->pins[i].pick);
        free(cloth->pins[i].weight);
    }
    for (uint32_t i = 0; i < cloth->n_loads; i++) {
        free_pick(&cloth->loads[i].pick);
        free(cloth->loads[i].edges);
    }
    for (uint32_t i = 0; i < cloth->n_masses; i++)
        free_pick(&cloth->masses[i].pick);
    model_start_at(cloth, NULL);
    for (uint32_t i = 0; i < cloth->n_folds; i++) {
        free(cloth->folds[i].vertices);
        free(cloth->folds[i].place);
    }
    for (uint32_t i = 0; i < cloth->n_bands; i++)
        free_pick(&cloth->bands[i].pick);
    free(cloth->bands);
    for (uint32_t i = 0; i < cloth->n_borders; i++) {
        free(cloth->borders[i].panel);
        free(cloth->borders[i].vertices);
    }
    free(cloth->borders);
    free(cloth->folds);
    free(cloth->masses);
    free(cloth->region);
    free(cloth->mask);
    free(cloth->grain);
    free(cloth->grain_mask);
    free(cloth->pins);
    free(cloth->loads);
    free(cloth->name);
    free(cloth->place);
    free(cloth->mesh_place);
    free(cloth->velocity_place);
    if (cloth->rest)
        free(cloth->rest->position);
    free(cloth->rest);
    mesh_free(&cloth->mesh);
}

void model_free(struct model *model)
{
    for (uint32_t i = 0; i < model->n_materials; i++)
        free(model->materials[i].name);
    for (uint32_t i = 0; i < model->n_cloths; i++)
        free_cloth(&model->cloths[i]);
    for (uint32_t i = 0; i < model->n_probes; i++) {
        free(model->probes[i].name);
        free_pick(&model->probes[i].pick);
    }
    for (uint32_t i = 0; i < model->n_joints; i++)
        free_pairs(&model->joints[i].pairs);
    for (uint32_t i = 0; i < model->n_welds; i++)
        free_pairs(&model->welds[i].pairs);
    for (uint32_t i = 0; i < model->n_phases; i++) {
        free(model->phases[i].name);
        free(model->phases[i].place);
    }
    free(model->settings);
    free(model->phases);
    free(model->joints);
    free(model->welds);
    free(model->probes);
    free(model->motions);
    free(model->keys);
    free(model->sliders);
    free(model->curves);
    free(model->curve_keys);
    free(model->materials);
    free(model->cloths);
    for (uint32_t i = 0; i < model->n_obstacles && model->obstacle_names; i++)
        free(model->obstacle_names[i]);
    free(model->obstacle_names);
    free(model->obstacles);
    free(model->contact.pairs);
    free(model->contact.apart.end);
    free(model->contact.apart.apart);
    free(model->contact.apart.joined);
    free(model->bodies.memory);
    for (uint32_t i = 0; i < model->n_files; i++)
        free(model->files[i]);
    free(model->files);
    for (uint32_t i = 0; i < model->n_warnings; i++)
        free(model->warnings[i]);
    free(model->warnings);
    free(model->name);
    free(model->h_place);
    free(model->hdf5_place);
    free(model->fps_place);
    *model = (struct model){0};
}

#define NAME_OF(number, word, ...) {#word, number},
#define ROW_OF(number, word, ...)  [number] = {.name = #word, __VA_ARGS__},
const struct model_word model_integrators[] = {MODEL_ALL_INTEGRATORS(NAME_OF){0}};
const struct model_scheme model_schemes[] = {MODEL_ALL_INTEGRATORS(ROW_OF)};

#define PRECONDITIONERS(X)                                                                         \
    X(MODEL_PLAIN, "none", SOLVE_IDENTITY, false)                                                  \
    X(MODEL_JACOBI, "jacobi", SOLVE_JACOBI, false)                                                 \
    X(MODEL_IC0, "ic0", SOLVE_IC0, false)                                                          \
    X(MODEL_COARSE, "coarse", SOLVE_JACOBI, true)                                                  \
    X(MODEL_IC0_COARSE, "ic0_coarse", SOLVE_IC0, true)
#define WORD_OF(number, word, ...)  {word, number},
#define PARTS_OF(number, word, ...) [number] = {__VA_ARGS__},
const struct model_word model_preconditioners[] = {PRECONDITIONERS(WORD_OF){0}};
const struct model_conditioner model_conditioners[] = {PRECONDITIONERS(PARTS_OF)};

bool model_has_material(const struct model_cloth *cloth, uint32_t material)
{
    bool found = cloth->material == material;
    for (uint32_t i = 0; i < cloth->n_regions; i++)
        found = found || cloth->region[i] == material;
    return found;
}

void model_parts(const struct model *model, uint32_t material, bool *triangles, bool *edges)
{
    *triangles = *edges = false;
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        const bool has = model_has_material(cloth, material);
        *triangles = *triangles || (has && cloth->mesh.n_triangles);
        *edges = *edges || (has && cloth->mesh.n_bare_edges);
    }
}

/* The common value of two that differ by rounding at most, of cells at other places; else NAN. */
static double common(double a, double b)
{
    return fabs(a - b) <= 1e-9 * fabs(a) ? a : NAN;
}

struct mesh_elastic model_elastic(const struct model *model, uint32_t material)
{
    const struct model_material *m = model->materials + material;
    struct mesh_elastic all = {NAN, NAN, NAN, NAN};
    uint32_t n = 0;
    if (m->model == MODEL_TRIANGLES)
        return (struct mesh_elastic){m->stretch, model_weft(m), m->shear, m->poisson};
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        if (!model_has_material(model->cloths + c, material) || !model->cloths[c].mesh.n_triangles)
            continue;
        const struct mesh_moduli moduli = model_moduli(m);
        const struct mesh_elastic one = mesh_elastic_of(model_rest(model->cloths + c), &moduli);
        if (!n++)
            all = one;
        all = (struct mesh_elastic){common(all.warp, one.warp), common(all.weft, one.weft),
                                    common(all.shear, one.shear), common(all.poisson, one.poisson)};
    }
    return all;
}

void model_name_seam(const struct model_cloth *cloth, uint32_t seam, char text[MODEL_SEAM_NAME])
{
    const struct model_seam *of = cloth->seams.seam + seam;
    snprintf(text, MODEL_SEAM_NAME,
             "seam %u of cloth '%.60s' (edge %u of panel '%.60s', edge %u of panel '%.60s')", seam,
             cloth->name, of->side[0].edge, of->side[0].panel, of->side[1].edge, of->side[1].panel);
}

int model_fail(const char *place, struct cloth_error *error, const char *format, ...)
{
    char text[900];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    return cloth_fail(error, CLOTH_E_INPUT, "%s%s%s", place ? place : "", place ? ": " : "", text);
}

static bool key_differs(const struct phys_key *a, const struct phys_key *b)
{
    bool differs = false;
    for (int i = 0; i < 3; i++)
        differs = differs || a->translate[i] != b->translate[i];
    for (int i = 0; i < 4; i++)
        differs = differs || a->rotate[i] != b->rotate[i];
    return differs;
}

/* True if the model's n keys from `first` on move anything after a time. */
static bool keys_move(const struct model *model, uint32_t first, uint32_t n, double time)
{
    bool moves = false;
    for (uint32_t i = 1; i < n; i++) {
        const struct phys_key *key = model->keys + first + i;
        moves = moves || (key->time > time && key_differs(key, key - 1));
    }
    return moves;
}

static bool obstacles_move_after(const struct model *model, double time)
{
    bool moves = false;
    for (uint32_t i = 0; i < model->n_obstacles; i++)
        moves = moves || keys_move(model, model->obstacles[i].first, model->obstacles[i].n, time) ||
                contact_body_moves_after(
                    contact_bodies_at(&model->bodies, model->obstacles[i].body), time);
    return moves;
}

bool model_obstacles_move(const struct model *model)
{
    return obstacles_move_after(model, -INFINITY);
}

bool model_moves_after(const struct model *model, double time)
{
    bool moves = obstacles_move_after(model, time);
    for (uint32_t i = 0; i < model->n_motions; i++)
        moves = moves || keys_move(model, model->motions[i].first, model->motions[i].n, time);
    return moves;
}

bool model_is_guarded(const struct model *model)
{
    const double *wind = model->air.wind;
    const bool blown = model_has_air(model) && (wind[0] != 0 || wind[1] != 0 || wind[2] != 0);
    bool pressed = false;
    for (uint32_t c = 0; c < model->n_cloths; c++)
        pressed = pressed || model->cloths[c].pressure != 0;
    return model_is_implicit(model) && model->energy_growth > 0 && !blown && !pressed &&
           !model->n_motions && !model->n_curves && !model->n_pulled &&
           !model_obstacles_move(model);
}

uint32_t model_patches(const struct model *model, uint32_t n_blocks)
{
    enum { LEAST_VERTICES = 100 };
    const uint64_t all = n_blocks;
    uint32_t n = model->patches ? model->patches : SOLVE_MAX_PATCHES;
    if (!model_conditioners[model->preconditioner].coarse)
        return 1;
    while (!model->patches && n > 1 && model->grain / n < LEAST_VERTICES)
        n /= 2;
    /* Half of them in one factor are better than all of them by groups, a quarter is not. */
    const bool halved = n * all > MODEL_ONE_FACTOR && n / 2 * all <= MODEL_ONE_FACTOR;
    return halved && n > 1 && !model->patches ? n / 2 : n;
}

uint32_t model_usual_grain(uint32_t n_vertices)
{
    enum { BLOCKS = MODEL_ONE_FACTOR / SOLVE_MAX_PATCHES, LEAST = 1000, MOST = 4000 };
    const uint32_t grain = n_vertices / BLOCKS;
    return grain < LEAST ? LEAST : grain > MOST ? MOST : grain;
}

double model_curve_at(const struct model *model, uint32_t curve, double time)
{
    if (!curve)
        return 1;
    const struct model_curve *c = model->curves + curve - 1;
    return c->n ? phys_curve_at(c->n, model->curve_keys + c->first, time)
                : phys_sine(c->frequency * time + c->phase);
}

struct phys_air model_air_at(const struct model *model, double time)
{
    const double curve = model_curve_at(model, model->wind_curve, time);
    struct phys_air air = model->air;
    for (int i = 0; i < 3; i++) {
        air.turbulence.way[i] = air.wind[i] * time;
        air.wind[i] *= curve;
    }
    return air;
}

double model_curve_max(const struct model *model, uint32_t curve)
{
    double max = 0;
    if (!curve || !model->curves[curve - 1].n)
        return 1;
    const struct model_curve *c = model->curves + curve - 1;
    for (uint32_t i = 0; i < c->n; i++)
        max = fmax(max, fabs(model->curve_keys[c->first + i].factor));
    return max;
}

double model_curve_end(const struct model *model, uint32_t curve)
{
    if (!curve)
        return 0;
    const struct model_curve *c = model->curves + curve - 1;
    return c->n ? model->curve_keys[c->first + c->n - 1].time : INFINITY;
}

/* Gives each vertex of all cloths the lowest vertex that it is welded to. NULL: no memory. */
static uint32_t *model_find_welded(const struct model *model, struct cloth_error *error)
{
    const uint32_t n = model_first(model, model->n_cloths);
    uint32_t *same = cloth_alloc(n, sizeof *same, error);
    if (!same)
        return NULL;
    cloth_sets_start(same, n);
    for (uint32_t w = 0; w < model->n_welds; w++) {
        const struct model_end *end = model->welds[w].pairs.end;
        for (uint32_t i = 0; i < end[0].n; i++) {
            const uint32_t a = model_first(model, end[0].cloth) + end[0].vertices[i];
            const uint32_t b = model_first(model, end[1].cloth) + end[1].vertices[i];
            cloth_sets_join(same, a, b);
        }
    }
    for (uint32_t v = 0; v < n; v++)
        same[v] = cloth_sets_root(same, v);
    return same;
}

int model_soup(const struct model *model, struct contact_soup *soup, struct cloth_error *error)
{
    *soup = (struct contact_soup){0};
    const struct mesh **mesh = cloth_alloc(model->n_cloths, sizeof *mesh, error);
    uint32_t *same = mesh ? model_find_welded(model, error) : NULL;
    for (uint32_t i = 0; i < model->n_cloths && same; i++)
        mesh[i] = &model->cloths[i].mesh;
    const int code = same ? contact_soup_make(soup, model->n_cloths, mesh, same, model->n_obstacles,
                                              model->obstacles, &model->bodies, error)
                          : CLOTH_E_MEMORY;
    free(mesh);
    return code;
}
