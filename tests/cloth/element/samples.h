#ifndef TESTS_CLOTH_ELEMENT_SAMPLES_H
#define TESTS_CLOTH_ELEMENT_SAMPLES_H

#include "cloth/element/cloths.h"
#include "tests/cloth/physics/elements.h"
#include "tests/support/unit.h"

#include <math.h>
#include <string.h>

/* Elements of each kind, of cloths that have some of each, as lists that a test calls the functions
 * of the kind on. A new kind gives a material of them its keys. */

/* ---- Cloths ---- */

enum { COLUMNS = 4, ROWS = 3, VERTICES = COLUMNS * ROWS, CLOTHS = 3 };

static struct model_material material[CLOTHS] = {
    {.density = 1,
     .model = MODEL_TRIANGLES,
     .stretch = 20,
     .weft_excess = -5,
     .shear = 8,
     .poisson = 0.3,
     .stiffening = {{{0.02, 0.1}, {0.05}}, {{40, -10}, {15}}},
     .bending = MODEL_HINGES,
     .rigidity = {1, 2},
     .damping_stiffness = 0.02,
     .limit_strain = 0.05,
     .limit_stiffness = 30},
    {.density = 1, .stretch = 20, .bending = MODEL_QUADRATIC, .rigidity = {2, 1}},
    {.density = 1, .stretch = 20, .limit_strain = 0.02, .limit_stiffness = 30},
};

/* Triangles with hinges; springs that bend by the quadratic energy; springs of a grid's cells. */
struct scene {
    struct model model;
    struct model_cloth cloth[CLOTHS];
    struct element_cloths cloths;
};

/* An uneven sheet, of bumps so high. */
static inline void make_uneven(struct mesh *mesh, double bumps)
{
    double x[3 * VERTICES];
    uint32_t triangle[6 * (COLUMNS - 1) * (ROWS - 1)], n = 0;
    for (int v = 0; v < VERTICES; v++) {
        x[3 * v] = v % COLUMNS + 0.1 * (v * 5 % 3);
        x[3 * v + 1] = bumps * (v * 3 % 5);
        x[3 * v + 2] = v / COLUMNS + 0.1 * (v * 7 % 4);
    }
    for (uint32_t j = 0; j + 1 < ROWS; j++)
        for (uint32_t i = 0; i + 1 < COLUMNS; i++) {
            const uint32_t v = j * COLUMNS + i, w = v + COLUMNS;
            const uint32_t corner[6] = {v, v + 1, w + 1, w + 1, w, v};
            memcpy(triangle + n, corner, sizeof corner);
            n += 6;
        }
    ck_assert_int_eq(mesh_inline(mesh, VERTICES, x, 0, NULL, n / 3, triangle, NULL), 0);
}

static inline void make_scene(struct scene *s)
{
    memset(s, 0, sizeof *s);
    for (uint32_t c = 0; c < CLOTHS; c++) {
        s->cloth[c] = (struct model_cloth){.name = (char[]){"cloth"}, .material = c, .pressure = 7};
        if (c < 2)
            make_uneven(&s->cloth[c].mesh,
                        c == 0 ? 0.1 : 0); /* quadratic bending has a flat rest shape */
        else
            UNIT_FINE(mesh_grid(&s->cloth[c].mesh, COLUMNS - 1, ROWS - 1, COLUMNS, ROWS,
                                MESH_ALTERNATE, &error));
    }
    s->model = (struct model){
        .n_materials = CLOTHS,
        .materials = material,
        .n_cloths = CLOTHS,
        .cloths = s->cloth,
        .format = SOLVE_HALF,
        .h = 0.01,
        .air = {.density = 1.2, .wind = {1, 2, -3}, .normal = 1.2, .tangent = 0.1},
    };
    UNIT_FINE(element_cloths_make(&s->cloths, &s->model, &error));
}

static inline void free_scene(struct scene *s)
{
    element_cloths_free(&s->cloths);
    for (uint32_t c = 0; c < CLOTHS; c++)
        mesh_free(&s->cloth[c].mesh);
}

/* ---- Lists ---- */

enum { MAX = ELEMENTS_MAX };

/* The elements of one kind in a cloth. */
struct sample {
    const struct scene *scene;
    uint32_t kind, cloth;
    struct element element[MAX];
    struct phys_air air;
    struct phys_elements list;
    uint32_t corner[MAX][4];
    phys_vec vector[MAX], material[64];
    double number[PHYS_NUMBERS][MAX];
};

static inline void collect(void *to, const struct element *element)
{
    struct sample *s = to;
    if (element->kind != s->kind || element->cloth != s->cloth)
        return;
    ck_assert_uint_lt(s->list.n, MAX);
    s->element[s->list.n++] = *element;
}

/* Corners are the vertices of the cloth or, apart, rows that no two elements share. */
static inline void take(struct sample *s, const struct scene *scene, uint32_t kind, uint32_t cloth,
                        bool apart)
{
    const struct element_kind *k = element_kinds[kind];
    *s = (struct sample){.scene = scene, .kind = kind, .cloth = cloth};
    s->air = model_air_at(&scene->model, 0.5);
    s->list = (struct phys_elements){
        .corner = s->corner, .vector = s->vector, .material = (void *)s->material};
    ck_assert_uint_le(CLOTHS * k->material_bytes, sizeof s->material);
    element_materials(k, &scene->model, s->material);
    for (int i = 0; i < PHYS_NUMBERS; i++)
        s->list.number[i] = s->number[i];
    element_each(&scene->cloths, collect, s);
    for (uint32_t e = 0; e < s->list.n; e++) {
        const struct element *element = s->element + e;
        ck_assert_uint_le(element->corners, k->corners);
        for (uint32_t i = 0; i < 4; i++)
            s->corner[e][i] = i >= element->corners ? PHYS_NO_CORNER
                              : apart               ? 4 * e + i
                                                    : element->corner[i];
        if (k->pack)
            k->pack(&scene->cloths, element, &s->list, e);
    }
}

/* The rest shape of the sample's cloth. */
static inline void start(struct elements_state *state, const struct sample *s)
{
    const double *x = s->scene->cloth[s->cloth].mesh.position;
    *state = (struct elements_state){.n = VERTICES};
    for (int v = 0; v < VERTICES; v++)
        state->x[v] = (phys_vec){x[3 * v], x[3 * v + 1], x[3 * v + 2], 0};
}

static inline const struct element_kind *kind_of(const struct sample *s)
{
    return element_kinds[s->kind];
}

static inline double energy(const void *of, const struct phys_sight *sight)
{
    const struct sample *s = of;
    return kind_of(s)->energy(&s->list, sight);
}
static inline void force(const void *of, const struct phys_sight *sight, phys_vec *f)
{
    const struct sample *s = of;
    kind_of(s)->force(&s->list, &s->air, sight, f);
}
static inline void stiffness(const void *of, int full, double scale, const struct phys_sight *sight,
                             phys_vec *y)
{
    const struct sample *s = of;
    const struct phys_step step = {sqrt(scale), full};
    struct phys_pair pair[ELEMENT_PAIRS * MAX];
    if (kind_of(s)->stiffness)
        kind_of(s)->stiffness(&s->list, full, scale, sight, y);
    else
        kind_of(s)->system(&s->list, 0, s->list.n, &step, 0, sight, NULL, y, pair);
}
/* In two parts, neither a multiple of 4. */
static inline void matrix(const void *of, const struct phys_step *step,
                          const struct phys_sight *sight, struct phys_pair *pair)
{
    const struct sample *s = of;
    const size_t n = s->list.n, middle = n < 5 ? 1 : 5;
    kind_of(s)->matrix(&s->list, 0, middle, step, sight, NULL, pair);
    kind_of(s)->matrix(&s->list, middle, n, step, sight, NULL, pair + kind_of(s)->pairs * middle);
}

static inline struct elements model_of(const struct sample *s)
{
    static const int pair[ELEMENT_PAIRS][2] = {{0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}};
    return (struct elements){s,
                             s->list.n,
                             kind_of(s)->pairs,
                             (const uint32_t(*)[4])s->corner,
                             pair,
                             energy,
                             force,
                             stiffness,
                             matrix};
}

/* Calls a check of one sample for each cloth that has elements of kind _i; there is one. */
static inline void each_sample(uint32_t kind, bool apart, void (*check)(const struct sample *))
{
    struct scene scene;
    uint32_t n = 0;
    make_scene(&scene);
    for (uint32_t c = 0; c < CLOTHS; c++) {
        struct sample sample;
        take(&sample, &scene, kind, c, apart);
        ck_assert_int_eq(sample.list.n > 0,
                         element_kinds[kind]->has(&scene.model, scene.cloth + c));
        n += sample.list.n > 0;
        if (sample.list.n)
            check(&sample);
    }
    ck_assert_msg(n, "no cloth of this test has %s", element_kinds[kind]->name);
    free_scene(&scene);
}

#endif
