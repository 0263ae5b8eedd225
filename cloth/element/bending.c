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

/* ---- Checks ---- */

static bool quadratic_has(const struct model *model, const struct model_cloth *cloth)
{
    const struct model_material *bends = element_bending_of(model, cloth);
    return bends && bends->bending == MODEL_QUADRATIC;
}

/* True if s is not that of a flat edge. */
static bool is_bent(double s)
{
    const double flat = 1e-6;
    return !(fabs(s) <= flat);
}

static int bending_check(const struct element_cloths *cloths, uint32_t c, struct cloth_error *error)
{
    const struct model_cloth *cloth = cloths->model->cloths + c;
    const bool flat = quadratic_has(cloths->model, cloth);
    for (uint32_t e = 0; e < cloths->edges[c].n; e++) {
        const struct mesh_edge *edge = cloths->edges[c].edge + e;
        const uint32_t corner[4] = {edge->a, edge->b, edge->opposite[0], edge->opposite[1]};
        struct phys_bend_rest rest;
        if (!element_is_hinge(edge))
            continue;
        if (bend_rest(cloths, c, edge->triangle, corner, &rest))
            return model_fail(
                cloth->mesh_place, error,
                "mesh: a triangle at the edge between vertices %u and %u of cloth "
                "'%.60s' (counted from 1) has no area at rest; an area above 0 is expected",
                edge->a + 1, edge->b + 1, cloth->name);
        if (flat && is_bent(rest.s))
            return model_fail(
                cloth->mesh_place, error,
                "mesh: cloth '%.60s' is not flat at the edge between vertices %u and %u "
                "(counted from 1), as bending: {model: quadratic} of material "
                "'%.60s' expects; take model: hinge, or rest: uv",
                cloth->name, edge->a + 1, edge->b + 1,
                element_bending_of(cloths->model, cloth)->name);
    }
    return CLOTH_OK;
}

int element_seams_check(const struct element_cloths *cloths, struct cloth_error *error)
{
    const struct model *model = cloths->model;
    int code = CLOTH_OK;
    for (uint32_t s = 0; s < cloths->n_seams && !code; s++) {
        const struct element_side *one = cloths->seam[s].side, *two = one + 1;
        const struct model_cloth *cloth = model->cloths + one->cloth;
        struct phys_bend_rest rest;
        const bool failed = seam_rest(cloths, cloths->seam + s, &rest);
        const bool bent = quadratic_has(model, cloth) &&
                          quadratic_has(model, model->cloths + two->cloth) && is_bent(rest.s);
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

/* ---- Hinges: stiffness, damping and rest shape of each ---- */

static bool hinges_has(const struct model *model, const struct model_cloth *cloth)
{
    const struct model_material *bends = element_bending_of(model, cloth);
    return bends && (bends->bending == MODEL_HINGES || damps_bending(model, cloth));
}

static void hinges_pack(const struct element_cloths *cloths, const struct element *element,
                        const struct phys_elements *list, uint32_t e)
{
    struct bend bend;
    bend_make(cloths, element, MODEL_HINGES, &bend);
    list->number[PHYS_HINGE_STIFFNESS][e] = bend.stiffness;
    list->number[PHYS_HINGE_DAMPING][e] = bend.damping;
    list->number[PHYS_HINGE_REST][e] = bend.rest.s;
}

/* L^2 / (A1 + A2) changes; angles do not. */
static void hinges_resize(const struct phys_elements *list, uint32_t e,
                          const struct element_scale *scale)
{
    list->number[PHYS_HINGE_STIFFNESS][e] *= scale->square / scale->area;
    list->number[PHYS_HINGE_DAMPING][e] *= scale->square / scale->area;
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
    .resize = hinges_resize,
    .force = phys_hinges_force,
    .matrix = phys_hinges_matrix,
    .stiffness = phys_hinges_stiffness,
    .energy = phys_hinges_energy,
};

/* ---- Quadratic energies: the weights of each ---- */

static void quadratic_pack(const struct element_cloths *cloths, const struct element *element,
                           const struct phys_elements *list, uint32_t e)
{
    struct bend bend;
    bend_make(cloths, element, MODEL_QUADRATIC, &bend);
    for (int i = 0; i < 4; i++)
        list->vector[e][i] = sqrt(bend.stiffness) * bend.rest.weight[i];
}

/* Weights of a flat shape, which it has still, sum to nothing with its places: they change alike.
 * Those of the vertices opposite are one over their heights, L / 2 A. */
static void quadratic_resize(const struct phys_elements *list, uint32_t e,
                             const struct element_scale *scale)
{
    list->vector[e] *= scale->square / (scale->area * sqrt(scale->area));
}

const struct element_kind element_quadratic = {
    .name = "quadratic bending energies",
    .part = ELEMENT_HINGES,
    .corners = 4,
    .pairs = PHYS_BEND_PAIRS,
    .vectors = 1,
    .has = quadratic_has,
    .check = bending_check,
    .pack = quadratic_pack,
    .resize = quadratic_resize,
    .force = phys_quadratic_force,
    .matrix = phys_quadratic_matrix,
    .stiffness = phys_quadratic_stiffness,
    .energy = phys_quadratic_energy,
};
