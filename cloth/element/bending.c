/* Bending about edges (cloth/physics/bending.h): hinges, and the quadratic energy, which has no
 * damping. A cloth with a damped quadratic energy has hinges without stiffness, too. */
#include "cloth/physics/bending.h"
#include "cloth/base/vector.h"
#include "cloth/element/cloths.h"

#include <math.h>
#include <string.h>

const struct model_material *element_bending_of(const struct model *model,
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

bool element_bend_alike(const struct model *model, uint32_t a, uint32_t b)
{
    const struct model_material *one = element_bending_of(model, model->cloths + a);
    const struct model_material *other = element_bending_of(model, model->cloths + b);
    return one && other && one->bending == other->bending;
}

/* ---- Rest shapes ---- */

static int bend_rest(const struct element_cloths *cloths, uint32_t cloth,
                     const uint32_t triangle[2], const uint32_t corner[4],
                     struct phys_bend_rest *rest)
{
    double x[12];
    mesh_hinge(element_rest(cloths, cloth), triangle, corner, x);
    const int code = phys_bend_rest(x, rest);
    if (cloths->model->cloths[cloth].rest)
        rest->s = 0; /* flat in u and v, also where these fold over */
    return code;
}

/* True if both sides of a seam, ends of the edge first, have the edge at one place. Then moves the
 * second side onto the first, by nothing if they are equal. */
static bool seam_meets(const struct element_seam *seam, const double a[9], double b[9])
{
    const double rounding = 1e-6, most = 1e-2; /* of the length of the edge */
    const double square = cloth_square(a, a + 3), tolerance = seam->tolerance;
    const double limit =
        fmax(rounding * rounding * square, fmin(tolerance * tolerance, most * most * square));
    for (int i = 0; i < 2; i++)
        if (!(cloth_square(a + 3 * i, b + 3 * i) <= limit))
            return false;
    for (int c = 0; c < 3; c++)
        b[6 + c] += ((a[c] - b[c]) + (a[3 + c] - b[3 + c])) / 2;
    return true;
}

/* The rest angle across a seam: as the meshes lie if both have the edge at one place and it is not
 * sewn; else flat. A pattern places panels without regard to the angle between them. */
static int seam_rest(const struct element_cloths *cloths, const struct element_seam *seam,
                     struct phys_bend_rest *rest)
{
    double x[2][12];
    bool flat = seam->flat;
    for (int k = 0; k < 2; k++) {
        const struct element_side *side = seam->side + k;
        const struct mesh *mesh = element_rest(cloths, side->cloth);
        for (int i = 0; i < 3; i++)
            memcpy(x[k] + 3 * i, mesh_place(mesh, side->triangle, side->corner[i]), 3 * sizeof **x);
        flat = flat || cloths->model->cloths[side->cloth].rest;
    }
    const bool one = !seam->flat && seam_meets(seam, x[0], x[1]);
    memcpy(x[0] + 9, x[1] + 6, 3 * sizeof **x);
    if (!one)
        mesh_lay_beside(x[0], x[1], x[0] + 9);
    const int code = phys_bend_rest(x[0], rest);
    if (flat || !one)
        rest->s = 0;
    return code;
}

/* The rigidity across an edge whose direction is the mean of its triangles' directions. */
static double rigidity_of(const struct element_cloths *cloths, uint32_t cloth,
                          const uint32_t triangle[2], const uint32_t corner[4],
                          const struct model_material *material)
{
    const uint32_t second[3] = {corner[0], corner[1], corner[3]};
    double one[6], two[6];
    element_rest_local(cloths, cloth, triangle[0], corner, one);
    element_rest_local(cloths, cloth, triangle[1], second, two);
    const double sign = one[2] * two[2] + one[3] * two[3] < 0 ? -1 : 1;
    const double direction[2] = {one[2] + sign * two[2], one[3] + sign * two[3]};
    return phys_bend_rigidity(material->rigidity[0], material->rigidity[1], direction);
}

/* A hinge of one energy; across a seam, the mean of both sides, each by its own material and
 * threads. */
struct bend {
    struct phys_bend_rest rest;
    double stiffness, damping; /* N m, N m s */
};

static void bend_make(const struct element_cloths *cloths, const struct element *element,
                      int energy, struct bend *bend)
{
    const struct model *model = cloths->model;
    const int sides = element->seam ? 2 : 1;
    bend->stiffness = bend->damping = 0;
    if (element->seam)
        seam_rest(cloths, element->seam, &bend->rest);
    else
        bend_rest(cloths, element->cloth, element->triangle, element->corner, &bend->rest);
    element_fold_rest(cloths, element, &bend->rest.s);
    for (int k = 0; k < sides; k++) {
        const struct element_side *side = element->seam ? element->seam->side + k : NULL;
        const uint32_t cloth = side ? side->cloth : element->cloth;
        const uint32_t own[4] = {side ? side->corner[0] : element->corner[0],
                                 side ? side->corner[1] : element->corner[1],
                                 side ? side->corner[2] : element->corner[2],
                                 side ? side->corner[2] : element->corner[3]};
        const uint32_t triangle[2] = {side ? side->triangle : element->triangle[0],
                                      side ? side->triangle : element->triangle[1]};
        const struct model_material *material =
            model->materials + model_material_of(model->cloths + cloth, 2, own);
        const double rigidity = element->seam && element->seam->rigidity >= 0
                                    ? element->seam->rigidity
                                    : rigidity_of(cloths, cloth, triangle, own, material);
        const double k_of = rigidity * bend->rest.shape / sides;
        bend->stiffness += (int)material->bending == energy ? k_of : 0;
        bend->damping += model_damping_bending(material) * k_of;
    }
}

static int bending_check(const struct element_cloths *cloths, uint32_t c, struct cloth_error *error)
{
    const struct model_cloth *cloth = cloths->model->cloths + c;
    for (uint32_t e = 0; e < cloths->edges[c].n; e++) {
        const struct mesh_edge *edge = cloths->edges[c].edge + e;
        const uint32_t corner[4] = {edge->a, edge->b, edge->opposite[0], edge->opposite[1]};
        struct phys_bend_rest rest;
        if (element_is_hinge(edge) && bend_rest(cloths, c, edge->triangle, corner, &rest))
            return model_fail(
                cloth->mesh_place, error,
                "mesh: a triangle at the edge between vertices %u and %u of cloth "
                "'%.60s' (counted from 1) has no area at rest; an area above 0 is expected",
                edge->a + 1, edge->b + 1, cloth->name);
    }
    return CLOTH_OK;
}

/* ---- Hinges: stiffness, damping and rest shape of each ---- */

static bool hinges_has(const struct model *model, const struct model_cloth *cloth)
{
    const struct model_material *bends = element_bending_of(model, cloth);
    return bends && (bends->bending == MODEL_HINGES || damps_bending(model, cloth));
}

static void hinges_pack(const struct element_cloths *cloths, const struct element *element,
                        const struct element_list *list, uint32_t e)
{
    struct bend bend;
    bend_make(cloths, element, MODEL_HINGES, &bend);
    list->number[0][e] = bend.stiffness;
    list->number[1][e] = bend.damping;
    list->number[2][e] = bend.rest.s;
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
    const struct model_material *bends = element_bending_of(model, cloth);
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
        if (!element_is_hinge(edge) || bend_rest(cloths, c, edge->triangle, corner, &rest))
            continue;
        if (!(fabs(rest.s) <= flat))
            return model_fail(
                cloth->mesh_place, error,
                "mesh: cloth '%.60s' is not flat at the edge between vertices %u and %u "
                "(counted from 1), as bending: {model: quadratic} of material "
                "'%.60s' expects; take model: hinge, or rest: uv",
                cloth->name, edge->a + 1, edge->b + 1,
                element_bending_of(cloths->model, cloth)->name);
    }
    return code;
}

int element_seams_check(const struct element_cloths *cloths, struct cloth_error *error)
{
    const double flat = 1e-6;
    const struct model *model = cloths->model;
    int code = CLOTH_OK;
    for (uint32_t s = 0; s < cloths->n_seams && !code; s++) {
        const struct element_side *one = cloths->seam[s].side, *two = one + 1;
        const struct model_cloth *cloth = model->cloths + one->cloth;
        struct phys_bend_rest rest;
        const bool failed = seam_rest(cloths, cloths->seam + s, &rest);
        const bool bent = quadratic_has(model, cloth) &&
                          quadratic_has(model, model->cloths + two->cloth) &&
                          !(fabs(rest.s) <= flat);
        if (failed || bent)
            code = model_fail(cloth->mesh_place, error,
                              "mesh: where welds bring cloth '%.60s' to cloth '%.60s', at the edge "
                              "between vertices %u and %u (counted from 1), %s",
                              cloth->name, model->cloths[two->cloth].name, one->corner[0] + 1,
                              one->corner[1] + 1,
                              failed ? "a triangle has no area at rest; an area above 0 is expected"
                                     : "they are not flat at rest, as bending: {model: quadratic} "
                                       "expects; take model: hinge, or rest: uv");
    }
    return code;
}

static void quadratic_pack(const struct element_cloths *cloths, const struct element *element,
                           const struct element_list *list, uint32_t e)
{
    struct bend bend;
    bend_make(cloths, element, MODEL_QUADRATIC, &bend);
    for (int i = 0; i < 4; i++)
        list->vector[e][i] = sqrt(bend.stiffness) * bend.rest.weight[i];
}

static struct phys_quadratic quadratic_of(const struct element_list *list)
{
    return (struct phys_quadratic){list->n, (const uint32_t(*)[4])list->corner, list->vector};
}

static void quadratic_force(const struct element_list *list, const struct element_world *world,
                            const struct phys_sight *sight, phys_vec *f)
{
    const struct phys_quadratic quadratic = quadratic_of(list);
    (void)world;
    phys_quadratic_force(&quadratic, sight, f);
}

static void quadratic_matrix(const struct element_list *list, size_t from, size_t to,
                             const struct phys_step *step, const struct phys_sight *sight,
                             const uint32_t *at, struct phys_pair *pair)
{
    const struct phys_quadratic quadratic = quadratic_of(list);
    (void)sight;
    (void)at; /* blocks are symmetric */
    phys_quadratic_matrix(&quadratic, from, to, step->h, pair);
}

static void quadratic_stiffness(const struct element_list *list, int full, double scale,
                                const struct phys_sight *sight, phys_vec *y)
{
    const struct phys_quadratic quadratic = quadratic_of(list);
    (void)full;
    phys_quadratic_stiffness(&quadratic, scale, sight, y);
}

static double quadratic_energy(const struct element_list *list, const struct phys_sight *sight)
{
    const struct phys_quadratic quadratic = quadratic_of(list);
    return phys_quadratic_energy(&quadratic, sight);
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
