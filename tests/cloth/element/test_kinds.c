/* What holds of every kind of the table, also of the next one: its descriptor is whole, its parts
 * belong together, and elements do not know which others they stand with. The cloths here have
 * elements of each kind; who adds one gives a material of them its keys. */
#include "cloth/element/cloths.h"
#include "cloth/flow/setup/source.h"
#include "tests/cloth/physics/elements.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Descriptors ---- */

/* What is missing in a descriptor, or is too much; NULL: nothing. */
static const char *flaw_of(const struct element_kind *k)
{
    const uint32_t all = k->corners * (k->corners - 1) / 2;
    if (!k->name || !k->name[0])
        return "name";
    if (k->part >= ELEMENT_PARTS || k->corners < 2 || k->corners > ELEMENT_CORNERS)
        return "part and corners";
    if (k->pairs != 0 && k->pairs != all)
        return "pairs: all or none";
    if (k->vectors > 1 || k->numbers > ELEMENT_NUMBERS)
        return "vectors and numbers: as many as a list has";
    if (!k->has || !k->force)
        return "has, force";
    if (!k->pack != !(k->vectors || k->numbers || k->material_bytes))
        return "pack: of what a list has";
    if (!k->material != !k->material_bytes || k->material_bytes % sizeof(phys_vec))
        return "material: of whole vectors";
    if (k->pairs && (!k->matrix || !k->energy || !k->system == !k->stiffness || k->warn))
        return "matrix, energy, and system or stiffness: of pairs, which need no warning";
    if (!k->pairs && (k->matrix || k->energy || k->system || k->stiffness || k->torque ||
                      k->stiffest || !k->warn))
        return "warn: without pairs, and nothing that is of pairs";
    return NULL;
}

START_TEST(descriptors_are_whole)
{
    const char *flaw = flaw_of(element_kinds[_i]);
    ck_assert_msg(!flaw, "%s: %s", element_kinds[_i]->name, flaw);
}
END_TEST

/* A descriptor without one of its parts: every byte of it is zeroed. */
#define WITHOUT(kind, part)                                                                        \
    {                                                                                              \
        struct element_kind k = *(kind);                                                           \
        memset(&k.part, 0, sizeof k.part);                                                         \
        if (memcmp(&k, (kind), sizeof k) != 0)                                                     \
            ck_assert_msg(flaw_of(&k), "%s without " #part " passes", (kind)->name);               \
    }

START_TEST(missing_parts_are_found)
{
    const struct element_kind *kind = element_kinds[_i];
    WITHOUT(kind, name)
    WITHOUT(kind, corners)
    WITHOUT(kind, pairs)
    WITHOUT(kind, has)
    WITHOUT(kind, pack)
    WITHOUT(kind, material)
    WITHOUT(kind, material_bytes)
    WITHOUT(kind, warn)
    WITHOUT(kind, force)
    WITHOUT(kind, matrix)
    WITHOUT(kind, system)
    WITHOUT(kind, stiffness)
    WITHOUT(kind, energy)
}
END_TEST

/* ---- Cloths ---- */

enum { COLUMNS = 4, ROWS = 3, VERTICES = COLUMNS * ROWS, CLOTHS = 3 };

static struct model_material material[CLOTHS] = {
    {.density = 1,
     .model = MODEL_TRIANGLES,
     .stretch = 20,
     .weft_excess = -5,
     .shear = 8,
     .poisson = 0.3,
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

/* An uneven sheet, flat. */
static void make_uneven(struct mesh *mesh)
{
    double x[3 * VERTICES];
    uint32_t triangle[6 * (COLUMNS - 1) * (ROWS - 1)], n = 0;
    for (int v = 0; v < VERTICES; v++) {
        x[3 * v] = v % COLUMNS + 0.1 * (v * 5 % 3);
        x[3 * v + 1] = 0;
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

static void make_scene(struct scene *s)
{
    struct cloth_error error = {0};
    memset(s, 0, sizeof *s);
    for (uint32_t c = 0; c < CLOTHS; c++) {
        s->cloth[c] = (struct model_cloth){.name = (char[]){"cloth"}, .material = c};
        if (c < 2)
            make_uneven(&s->cloth[c].mesh);
        else
            ck_assert_int_eq(mesh_grid(&s->cloth[c].mesh, COLUMNS - 1, ROWS - 1, COLUMNS, ROWS,
                                       MESH_ALTERNATE, &error),
                             0);
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
    ck_assert_msg(element_cloths_make(&s->cloths, &s->model, &error) == 0, "%s", error.text);
}

static void free_scene(struct scene *s)
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
    struct element_world world;
    struct element_list list;
    uint32_t corner[MAX][4];
    phys_vec vector[MAX], material[64];
    double number[ELEMENT_NUMBERS][MAX];
};

static void collect(void *to, const struct element *element)
{
    struct sample *s = to;
    if (element->kind != s->kind || element->cloth != s->cloth)
        return;
    ck_assert_uint_lt(s->list.n, MAX);
    s->element[s->list.n++] = *element;
}

/* Corners are the vertices of the cloth or, apart, rows that no two elements share. */
static void take(struct sample *s, const struct scene *scene, uint32_t kind, uint32_t cloth,
                 bool apart)
{
    const struct element_kind *k = element_kinds[kind];
    *s = (struct sample){.scene = scene, .kind = kind, .cloth = cloth};
    s->world = (struct element_world){&scene->model, 0.5};
    s->list = (struct element_list){
        .corner = s->corner, .vector = s->vector, .material = (void *)s->material};
    ck_assert_uint_le(CLOTHS * k->material_bytes, sizeof s->material);
    element_materials(k, &scene->model, s->material);
    for (int i = 0; i < ELEMENT_NUMBERS; i++)
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
static void start(struct elements_state *state, const struct sample *s)
{
    const double *x = s->scene->cloth[s->cloth].mesh.position;
    *state = (struct elements_state){.n = VERTICES};
    for (int v = 0; v < VERTICES; v++)
        state->x[v] = (phys_vec){x[3 * v], x[3 * v + 1], x[3 * v + 2], 0};
}

static const struct element_kind *kind_of(const struct sample *s)
{
    return element_kinds[s->kind];
}

static double energy(const void *of, const struct phys_sight *sight)
{
    const struct sample *s = of;
    return kind_of(s)->energy(&s->list, sight);
}
static void force(const void *of, const struct phys_sight *sight, phys_vec *f)
{
    const struct sample *s = of;
    kind_of(s)->force(&s->list, &s->world, sight, f);
}
static void stiffness(const void *of, int full, double scale, const struct phys_sight *sight,
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
static void matrix(const void *of, const struct phys_step *step, const struct phys_sight *sight,
                   struct phys_pair *pair)
{
    const struct sample *s = of;
    const size_t n = s->list.n, middle = n < 5 ? 1 : 5;
    kind_of(s)->matrix(&s->list, 0, middle, step, sight, NULL, pair);
    kind_of(s)->matrix(&s->list, middle, n, step, sight, NULL, pair + kind_of(s)->pairs * middle);
}

static struct elements model_of(const struct sample *s)
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
static void each_sample(uint32_t kind, bool apart, void (*check)(const struct sample *))
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

/* ---- Parts that belong together ---- */

static void check_force(const struct sample *s)
{
    struct elements_state state;
    const struct elements model = model_of(s);
    start(&state, s);
    elements_shake(&state, 0.2, 3);
    printf("# %s\n", kind_of(s)->name);
    elements_check_gradient(&model, &state, 1e-7);
    elements_check_momentum(&model, &state, 1e-12);
    elements_check_split(&model, &state, 5);
}

static void check_matrix(const struct sample *s)
{
    struct elements_state state;
    const struct elements model = model_of(s);
    start(&state, s);
    elements_shake(&state, 0.2, 3);
    printf("# %s\n", kind_of(s)->name);
    elements_check_matrix(&model, &state, 1e-6);
}

static void check_rest(const struct sample *s)
{
    struct elements_state state;
    const struct elements model = model_of(s);
    start(&state, s);
    elements_check_rigid(&model, &state, 1e-12);
}

START_TEST(force_is_the_slope_of_the_energy)
{
    if (element_kinds[_i]->pairs)
        each_sample((uint32_t)_i, false, check_force);
}
END_TEST

START_TEST(matrix_is_the_slope_of_the_force)
{
    if (element_kinds[_i]->pairs)
        each_sample((uint32_t)_i, false, check_matrix);
}
END_TEST

START_TEST(rigid_motion_gives_no_force)
{
    if (element_kinds[_i]->pairs)
        each_sample((uint32_t)_i, false, check_rest);
}
END_TEST

/* The right side that comes with a matrix is push times the force less h^2 K v. */
static void check_system(const struct sample *s)
{
    const double push = 0.3;
    const struct phys_step step = {0.5, 1};
    struct elements_state state;
    struct phys_pair pair[2][ELEMENT_PAIRS * MAX];
    phys_vec b[VERTICES] = {{0}}, f[VERTICES] = {{0}}, y[VERTICES] = {{0}};
    start(&state, s);
    elements_shake(&state, 0.2, 3);
    const struct phys_sight sight = {state.n, state.x, state.v, NULL, NULL};
    kind_of(s)->system(&s->list, 0, s->list.n, &step, push, &sight, NULL, b, pair[0]);
    matrix(s, &step, &sight, pair[1]);
    force(s, &sight, f);
    stiffness(s, 1, step.h * step.h, &sight, y);
    ck_assert_mem_eq(pair[0], pair[1], s->list.n * kind_of(s)->pairs * sizeof **pair);
    for (int i = 0; i < VERTICES; i++)
        for (int c = 0; c < 3; c++)
            ck_assert_double_eq_tol(b[i][c], push * f[i][c] + y[i][c], 1e-12);
}

START_TEST(right_side_comes_with_the_matrix)
{
    if (element_kinds[_i]->system)
        each_sample((uint32_t)_i, false, check_system);
}
END_TEST

/* ---- Lanes ---- */

/* Rows that no two elements share, and what elements do to them. */
struct apart {
    phys_vec x[4 * MAX], v[4 * MAX], f[4 * MAX];
    struct phys_pair pair[ELEMENT_PAIRS * MAX];
};

/* Pairs, forces and energy of one element alone are those that it has in its list, in any lane, bit
 * for bit. */
static void check_alone(const struct sample *s, const struct apart *all, uint32_t e)
{
    const struct element_kind *kind = kind_of(s);
    const struct phys_step step = {0.5, 1};
    const struct phys_sight sight = {4, all->x + 4 * e, all->v + 4 * e, NULL, NULL};
    struct sample copy = *s; /* its material alone, which lists do not own */
    struct element_one one;
    struct phys_pair pair[ELEMENT_PAIRS];
    phys_vec f[4] = {{0}};
    element_alone(&s->scene->cloths, s->element + e, copy.material, &one);
    kind->force(&one.list, &s->world, &sight, f);
    ck_assert_mem_eq(f, all->f + 4 * e, sizeof f);
    if (!kind->pairs)
        return;
    kind->matrix(&one.list, 0, 1, &step, &sight, NULL, pair);
    ck_assert_mem_eq(pair, all->pair + kind->pairs * e, kind->pairs * sizeof *pair);
}

static void check_lanes(const struct sample *s)
{
    const struct element_kind *kind = kind_of(s);
    const struct phys_step step = {0.5, 1};
    struct elements_state state;
    struct apart all = {0};
    start(&state, s);
    elements_shake(&state, 0.2, 3);
    for (uint32_t e = 0; e < s->list.n; e++)
        for (uint32_t i = 0; i < s->element[e].corners; i++) {
            all.x[4 * e + i] = state.x[s->element[e].corner[i]];
            all.v[4 * e + i] = state.v[s->element[e].corner[i]];
        }
    const struct phys_sight sight = {4 * s->list.n, all.x, all.v, NULL, NULL};
    kind->force(&s->list, &s->world, &sight, all.f);
    if (kind->pairs)
        kind->matrix(&s->list, 0, s->list.n, &step, &sight, NULL, all.pair);
    for (uint32_t e = 0; e < s->list.n; e++)
        check_alone(s, &all, e);
}

START_TEST(elements_do_not_know_their_neighbours)
{
    each_sample((uint32_t)_i, true, check_lanes);
}
END_TEST

/* ---- Links ---- */

/* Which vertices springs join, of all cloths. */
struct links {
    bool pair[CLOTHS * VERTICES][CLOTHS * VERTICES];
    uint32_t kind, elements;
};

static void join(void *to, const struct flow_spring *spring)
{
    struct links *links = to;
    links->pair[spring->a][spring->b] = links->pair[spring->b][spring->a] = true;
}

static void find_links(void *to, const struct element *element)
{
    struct links *links = to;
    if (element->kind != links->kind)
        return;
    links->elements++;
    for (uint32_t j = 1; j < element->corners; j++)
        for (uint32_t i = 0; i < j; i++)
            ck_assert_msg(links->pair[element->first + element->corner[i]]
                                     [element->first + element->corner[j]],
                          "no spring joins corners %u and %u of %s", i, j,
                          element_kinds[element->kind]->name);
}

/* Neighbours, ghosts and entries of the matrix are found for springs alone. */
START_TEST(corners_are_joined)
{
    struct scene scene;
    const struct flow_welds welds = {0};
    struct flow_springs springs;
    struct cloth_error error = {0};
    struct links links = {.kind = (uint32_t)_i};
    make_scene(&scene);
    ck_assert_msg(!flow_springs_make(&springs, &scene.model, &welds, &scene.cloths, &error), "%s",
                  error.text);
    flow_springs_each(&springs, join, &links);
    element_each(&scene.cloths, find_links, &links);
    ck_assert_uint_gt(links.elements, 0);
    flow_springs_free(&springs);
    free_scene(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("kinds");
    TCase *kinds = tcase_create("kinds");
    tcase_add_loop_test(kinds, descriptors_are_whole, 0, ELEMENT_KINDS);
    tcase_add_loop_test(kinds, missing_parts_are_found, 0, ELEMENT_KINDS);
    tcase_add_loop_test(kinds, force_is_the_slope_of_the_energy, 0, ELEMENT_KINDS);
    tcase_add_loop_test(kinds, matrix_is_the_slope_of_the_force, 0, ELEMENT_KINDS);
    tcase_add_loop_test(kinds, rigid_motion_gives_no_force, 0, ELEMENT_KINDS);
    tcase_add_loop_test(kinds, right_side_comes_with_the_matrix, 0, ELEMENT_KINDS);
    tcase_add_loop_test(kinds, elements_do_not_know_their_neighbours, 0, ELEMENT_KINDS);
    tcase_add_loop_test(kinds, corners_are_joined, 0, ELEMENT_KINDS);
    suite_add_tcase(suite, kinds);
    return unit_run(suite);
}
