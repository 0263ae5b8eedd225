/* Every kind of the table, also the next one, has a whole descriptor and parts that belong
 * together, and its elements do not know which others they stand with. */
#include "cloth/flow/run/source.h"
#include "tests/cloth/element/samples.h"

#include <stdio.h>
#include <stdlib.h>

/* ---- Descriptors ---- */

/* The member that a descriptor lacks, or has too much; NULL: it is whole. */
static const char *flaw_of(const struct element_kind *k)
{
    const uint32_t all = k->corners * (k->corners - 1) / 2;
    if (!k->name || !k->name[0])
        return "name";
    if (k->part >= ELEMENT_PARTS || k->corners < 2 || k->corners > ELEMENT_CORNERS)
        return "part and corners";
    if (k->pairs != 0 && k->pairs != all)
        return "pairs: all or none";
    if (k->vectors > 1 || k->numbers > PHYS_NUMBERS)
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

UNIT_LOOP(descriptors_are_whole, 0, ELEMENT_KINDS)
{
    const char *flaw = flaw_of(element_kinds[_i]);
    ck_assert_msg(!flaw, "%s: %s", element_kinds[_i]->name, flaw);
}

/* A descriptor without one of its parts: every byte of it is zeroed. */
#define WITHOUT(kind, part)                                                                        \
    {                                                                                              \
        struct element_kind k = *(kind);                                                           \
        memset(&k.part, 0, sizeof k.part);                                                         \
        if (memcmp(&k, (kind), sizeof k) != 0)                                                     \
            ck_assert_msg(flaw_of(&k), "%s without " #part " passes", (kind)->name);               \
    }

UNIT_LOOP(missing_parts_are_found, 0, ELEMENT_KINDS)
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

UNIT_LOOP(force_is_the_slope_of_the_energy, 0, ELEMENT_KINDS)
{
    if (element_kinds[_i]->pairs)
        each_sample((uint32_t)_i, false, check_force);
}

UNIT_LOOP(matrix_is_the_slope_of_the_force, 0, ELEMENT_KINDS)
{
    if (element_kinds[_i]->pairs)
        each_sample((uint32_t)_i, false, check_matrix);
}

UNIT_LOOP(rigid_motion_gives_no_force, 0, ELEMENT_KINDS)
{
    if (element_kinds[_i]->pairs)
        each_sample((uint32_t)_i, false, check_rest);
}

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

UNIT_LOOP(right_side_comes_with_the_matrix, 0, ELEMENT_KINDS)
{
    if (element_kinds[_i]->system)
        each_sample((uint32_t)_i, false, check_system);
}

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
    kind->force(&one.list, &s->air, &sight, f);
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
    kind->force(&s->list, &s->air, &sight, all.f);
    if (kind->pairs)
        kind->matrix(&s->list, 0, s->list.n, &step, &sight, NULL, all.pair);
    for (uint32_t e = 0; e < s->list.n; e++)
        check_alone(s, &all, e);
}

UNIT_LOOP(elements_do_not_know_their_neighbours, 0, ELEMENT_KINDS)
{
    each_sample((uint32_t)_i, true, check_lanes);
}

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
UNIT_LOOP(corners_are_joined, 0, ELEMENT_KINDS)
{
    struct scene scene;
    const struct flow_welds welds = {0};
    struct flow_springs springs;
    struct links links = {.kind = (uint32_t)_i};
    make_scene(&scene);
    UNIT_FINE(flow_springs_make(&springs, &scene.model, &welds, &scene.cloths, &error));
    flow_springs_each(&springs, join, &links);
    element_each(&scene.cloths, find_links, &links);
    ck_assert_uint_gt(links.elements, 0);
    flow_springs_free(&springs);
    free_scene(&scene);
}
