/* Bending about edges (cloth/physics/bending.h): hinges, and the quadratic energy, which has no
 * damping. A cloth with a damped quadratic energy has hinges without stiffness, too. */
#include "cloth/physics/bending.h"
#include "cloth/element/cloths.h"

#include <math.h>

/* The material that says how a cloth bends, which is alike in all its regions; NULL: it does not.
 * Without a bending of its own a region has no rigidity. */
static const struct model_material *bending_of(const struct model *model,
                                               const struct model_cloth *cloth)
{
    for (uint32_t i = 0; i <= cloth->n_regions; i++)
        if (model_material(model, cloth, i)->bending != MODEL_NO_BENDING)
            return model_material(model, cloth, i);
    return NULL;
}

static bool damps_bending(const struct model *model, const struct model_cloth *cloth)
{
    for (uint32_t i = 0; i <= cloth->n_regions; i++)
        if (model_damping_bending(model_material(model, cloth, i)) > 0)
            return true;
    return false;
}

/* ---- Rest shapes ---- */

static int bend_rest(const struct element_cloths *cloths, uint32_t cloth, const uint32_t corner[4],
                     struct phys_bend_rest *rest)
{
    double x[12];
    for (int i = 0; i < 4; i++)
        element_rest_position(cloths, cloth, corner[i], x + 3 * i);
    const int code = phys_bend_rest(x, rest);
    if (cloths->model->cloths[cloth].rest)
        rest->s = 0; /* flat in u and v, also where these fold over */
    return code;
}

/* The rigidity across an edge, whose direction is the mean of what its triangles say. */
static double rigidity_of(const struct element_cloths *cloths, const struct element *element,
                          const struct model_material *material)
{
    const uint32_t *corner = element->corner, second[3] = {corner[0], corner[1], corner[3]};
    double one[6], two[6];
    element_rest_local(cloths, element->cloth, corner, one);
    element_rest_local(cloths, element->cloth, second, two);
    const double sign = one[2] * two[2] + one[3] * two[3] < 0 ? -1 : 1;
    const double direction[2] = {one[2] + sign * two[2], one[3] + sign * two[3]};
    return phys_bend_rigidity(material->rigidity[0], material->rigidity[1], direction);
}

static int bending_check(const struct element_cloths *cloths, uint32_t c, struct cloth_error *error)
{
    const struct model_cloth *cloth = cloths->model->cloths + c;
    for (uint32_t e = 0; e < cloths->edges[c].n; e++) {
        const struct mesh_edge *edge = cloths->edges[c].edge + e;
        const uint32_t corner[4] = {edge->a, edge->b, edge->opposite[0], edge->opposite[1]};
        struct phys_bend_rest rest;
        if (element_is_hinge(edge) && bend_rest(cloths, c, corner, &rest))
            return model_fail(
                cloth->mesh_place, error,
                "mesh: a triangle at the edge between vertices %u and %u of cloth "
                "'%.60s' (counted from 0) has no area at rest; an area above 0 is expected",
                edge->a, edge->b, cloth->name);
    }
    return CLOTH_OK;
}

/* ---- Hinges: stiffness, damping and rest shape of each ---- */

static bool hinges_has(const struct model *model, const struct model_cloth *cloth)
{
    const struct model_material *bends = bending_of(model, cloth);
    return bends && (bends->bending == MODEL_HINGES || damps_bending(model, cloth));
}

static void hinges_pack(const struct element_cloths *cloths, const struct element *element,
                        const struct element_list *list, uint32_t e)
{
    const struct model_material *material =
        cloths->model->materials + element_material(cloths, element, 2);
    struct phys_bend_rest rest;
    bend_rest(cloths, element->cloth, element->corner, &rest);
    const double k = rigidity_of(cloths, element, material) * rest.shape;
    list->number[0][e] = material->bending == MODEL_HINGES ? k : 0;
    list->number[1][e] = model_damping_bending(material) * k;
    list->number[2][e] = rest.s;
}

static struct phys_hinges hinges_of(const struct element_list *list)
{
    return (struct phys_hinges){list->n, (const uint32_t(*)[4])list->corner, list->number[0],
                                list->number[1], list->number[2]};
}

static void hinges_force(const struct element_list *list, const struct element_world *world,
                         const struct phys_sight *sight, phys_vec *f)
{
    const struct phys_hinges hinges = hinges_of(list);
    (void)world;
    phys_hinges_force(&hinges, sight, f);
}

static void hinges_matrix(const struct element_list *list, size_t from, size_t to,
                          const struct phys_step *step, const struct phys_sight *sight,
                          const uint32_t *at, struct phys_pair *pair)
{
    const struct phys_hinges hinges = hinges_of(list);
    phys_hinges_matrix(&hinges, from, to, step, sight, at, pair);
}

static void hinges_stiffness(const struct element_list *list, int full, double scale,
                             const struct phys_sight *sight, phys_vec *y)
{
    const struct phys_hinges hinges = hinges_of(list);
    phys_hinges_stiffness(&hinges, full, scale, sight, y);
}

static double hinges_energy(const struct element_list *list, const struct phys_sight *sight)
{
    const struct phys_hinges hinges = hinges_of(list);
    return phys_hinges_energy(&hinges, sight);
}

const struct element_kind element_hinges = {
    .name = "hinges",
    .part = ELEMENT_HINGES,
    .corners = 4,
    .pairs = PHYS_BEND_PAIRS,
    .numbers = 3,
    .has = hinges_has,
    .check = bending_check,
    .pack = hinges_pack,
    .force = hinges_force,
    .matrix = hinges_matrix,
    .stiffness = hinges_stiffness,
    .energy = hinges_energy,
};

/* ---- Quadratic energies: the weights of each ---- */

static bool quadratic_has(const struct model *model, const struct model_cloth *cloth)
{
    const struct model_material *bends = bending_of(model, cloth);
    return bends && bends->bending == MODEL_QUADRATIC;
}

static int quadratic_check(const struct element_cloths *cloths, uint32_t c,
                           struct cloth_error *error)
{
    const double flat = 1e-6;
    const struct model_cloth *cloth = cloths->model->cloths + c;
    const int code = bending_check(cloths, c, error);
    for (uint32_t e = 0; e < cloths->edges[c].n && !code; e++) {
        const struct mesh_edge *edge = cloths->edges[c].edge + e;
        const uint32_t corner[4] = {edge->a, edge->b, edge->opposite[0], edge->opposite[1]};
        struct phys_bend_rest rest;
        if (!element_is_hinge(edge) || bend_rest(cloths, c, corner, &rest))
            continue;
        if (!(fabs(rest.s) <= flat))
            return model_fail(
                cloth->mesh_place, error,
                "mesh: cloth '%.60s' is not flat at the edge between vertices %u and %u "
                "(counted from 0), as bending: {model: quadratic} of material "
                "'%.60s' expects; take model: hinge, or rest: uv",
                cloth->name, edge->a, edge->b, bending_of(cloths->model, cloth)->name);
    }
    return code;
}

static void quadratic_pack(const struct element_cloths *cloths, const struct element *element,
                           const struct element_list *list, uint32_t e)
{
    const struct model_material *material =
        cloths->model->materials + element_material(cloths, element, 2);
    struct phys_bend_rest rest;
    bend_rest(cloths, element->cloth, element->corner, &rest);
    const double k = rigidity_of(cloths, element, material) * rest.shape;
    for (int i = 0; i < 4; i++)
        list->vector[e][i] = sqrt(k) * rest.weight[i];
}

static struct phys_folds folds_of(const struct element_list *list)
{
    return (struct phys_folds){list->n, (const uint32_t(*)[4])list->corner, list->vector};
}

static void quadratic_force(const struct element_list *list, const struct element_world *world,
                            const struct phys_sight *sight, phys_vec *f)
{
    const struct phys_folds folds = folds_of(list);
    (void)world;
    phys_folds_force(&folds, sight, f);
}

static void quadratic_matrix(const struct element_list *list, size_t from, size_t to,
                             const struct phys_step *step, const struct phys_sight *sight,
                             const uint32_t *at, struct phys_pair *pair)
{
    const struct phys_folds folds = folds_of(list);
    (void)sight;
    (void)at; /* blocks are symmetric */
    phys_folds_matrix(&folds, from, to, step->h, pair);
}

static void quadratic_stiffness(const struct element_list *list, int full, double scale,
                                const struct phys_sight *sight, phys_vec *y)
{
    const struct phys_folds folds = folds_of(list);
    (void)full;
    phys_folds_stiffness(&folds, scale, sight, y);
}

static double quadratic_energy(const struct element_list *list, const struct phys_sight *sight)
{
    const struct phys_folds folds = folds_of(list);
    return phys_folds_energy(&folds, sight);
}

const struct element_kind element_quadratic = {
    .name = "quadratic bending energies",
    .part = ELEMENT_HINGES,
    .corners = 4,
    .pairs = PHYS_BEND_PAIRS,
    .vectors = 1,
    .has = quadratic_has,
    .check = quadratic_check,
    .pack = quadratic_pack,
    .force = quadratic_force,
    .matrix = quadratic_matrix,
    .stiffness = quadratic_stiffness,
    .energy = quadratic_energy,
};
