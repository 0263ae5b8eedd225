/* Nothing of an element is stored but the edges of its mesh: rest values are worked out when a
 * table is made. */
#include "cloth/flow/setup/elements.h"

#include "cloth/base/memory.h"
#include "cloth/physics/bending.h"
#include "cloth/physics/triangle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int flow_has_triangles(const struct model *model, const struct model_cloth *cloth)
{
    return model_material(model, cloth, 0)->model == MODEL_TRIANGLES;
}

int flow_has_cells(const struct model *model, const struct model_cloth *cloth)
{
    return cloth->mesh.grid_nx && !flow_has_triangles(model, cloth);
}

/* That bends as quadratic, or as hinges. Without a bending of its own a region has no rigidity. */
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

int flow_has_bending(const struct model *model, const struct model_cloth *cloth)
{
    return bending_of(model, cloth) != NULL;
}

/* ---- Rest shapes ---- */

static void position_of(const struct mesh *mesh, uint32_t vertex, double x[3])
{
    memcpy(x, mesh->position + 3 * (size_t)vertex, 3 * sizeof *x);
}

/* Directions of warp and weft at a vertex. */
static void directions_of(const struct flow_elements *elements, uint32_t cloth, uint32_t vertex,
                          double uv[2])
{
    const struct mesh *mesh = model_rest(elements->model->cloths + cloth);
    double x[3];
    if (mesh_uv(mesh, vertex, uv))
        return;
    position_of(mesh, vertex, x);
    for (int d = 0; d < 2; d++) {
        const double *axis = elements->axis[cloth][d];
        uv[d] = x[0] * axis[0] + x[1] * axis[1] + x[2] * axis[2];
    }
}

/* A triangle's coordinates along warp and weft. corner: of its cloth's mesh. */
static void local_of(const struct flow_elements *elements, uint32_t cloth, const uint32_t *corner,
                     double local[6])
{
    double x[9], uv[6];
    for (int i = 0; i < 3; i++) {
        position_of(model_rest(elements->model->cloths + cloth), corner[i], x + 3 * i);
        directions_of(elements, cloth, corner[i], uv + 2 * i);
    }
    phys_triangle_local(x, uv, local);
}

static int triangle_rest(const struct flow_elements *elements, uint32_t cloth,
                         const uint32_t *corner, struct flow_rest_of *rest)
{
    double local[6];
    local_of(elements, cloth, corner, local);
    return phys_triangle_rest(local, rest->gradient, &rest->area);
}

/* corner: the ends of the edge, then the vertices opposite, of the cloth's mesh. */
static int bend_rest(const struct flow_elements *elements, uint32_t cloth, const uint32_t *corner,
                     struct phys_bend_rest *rest)
{
    double x[12];
    for (int i = 0; i < 4; i++)
        position_of(model_rest(elements->model->cloths + cloth), corner[i], x + 3 * i);
    const int code = phys_bend_rest(x, rest);
    if (elements->model->cloths[cloth].rest)
        rest->s = 0; /* flat in u and v, also where these fold over */
    return code;
}

/* The rigidity across an edge, whose direction is the mean of what its triangles say. */
static double rigidity(const struct flow_elements *elements, uint32_t cloth, const uint32_t *corner,
                       const struct model_material *material)
{
    double one[6], two[6];
    const uint32_t second[3] = {corner[0], corner[1], corner[3]};
    local_of(elements, cloth, corner, one);
    local_of(elements, cloth, second, two);
    const double sign = one[2] * two[2] + one[3] * two[3] < 0 ? -1 : 1;
    const double direction[2] = {one[2] + sign * two[2], one[3] + sign * two[3]};
    return phys_bend_rigidity(material->rigidity[0], material->rigidity[1], direction);
}

static uint32_t first_of(const struct model *model, uint32_t cloth)
{
    uint32_t first = 0;
    for (uint32_t c = 0; c < cloth; c++)
        first += model->cloths[c].mesh.n_vertices;
    return first;
}

void flow_element_rest(const struct flow_elements *elements, const struct flow_element *element,
                       struct flow_rest_of *rest)
{
    const struct model *model = elements->model;
    const uint32_t c = element->cloth, first = first_of(model, c);
    uint32_t corner[4];
    for (uint32_t i = 0; i < element->corners; i++)
        corner[i] = element->corner[i] - first;
    const uint32_t n = element->kind == FLOW_TRIANGLES ? 3 : 2; /* those of its edge */
    *rest = (struct flow_rest_of){.material = model_material_of(model->cloths + c, n, corner)};
    const struct model_material *material = model->materials + rest->material;
    if (element->kind == FLOW_TRIANGLES) {
        triangle_rest(elements, c, corner, rest);
        return;
    }
    if (element->kind == FLOW_SAILS)
        return;
    struct phys_bend_rest bend;
    bend_rest(elements, c, corner, &bend);
    const double k = rigidity(elements, c, corner, material) * bend.shape;
    rest->s = bend.s;
    rest->stiffness = material->bending == MODEL_HINGES ? k : 0;
    rest->damping = model_damping_bending(material) * k;
    for (int i = 0; i < 4; i++)
        rest->weight[i] = sqrt(k) * bend.weight[i];
}

/* ---- Going through them ---- */

struct walk {
    void (*visit)(void *to, const struct flow_element *element);
    void *to;
    uint32_t cloth, first;
};

static void walk_cells(const struct walk *walk, const struct mesh *mesh)
{
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        struct flow_element element = {walk->cloth, t, {0}, 4, FLOW_SAILS};
        mesh_corners(mesh, t, element.corner);
        element.corner[3] = mesh_fourth(mesh, t);
        for (int i = 0; i < 4; i++)
            element.corner[i] += walk->first;
        walk->visit(walk->to, &element);
    }
}

static void walk_triangles(const struct walk *walk, const struct mesh *mesh, enum flow_kind kind)
{
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        struct flow_element element = {walk->cloth, t, {0}, 3, kind};
        mesh_corners(mesh, t, element.corner);
        for (int i = 0; i < 3; i++)
            element.corner[i] += walk->first;
        walk->visit(walk->to, &element);
    }
}

/* Whether an edge bends. */
static int bends(const struct mesh_edge *edge)
{
    return edge->opposite[1] != UINT32_MAX && edge->opposite[0] != edge->opposite[1];
}

static void walk_edges(const struct walk *walk, const struct mesh_edges *edges, bool quadratic,
                       bool damped)
{
    for (uint32_t e = 0; e < edges->n; e++) {
        const struct mesh_edge *edge = edges->edge + e;
        if (!bends(edge))
            continue;
        struct flow_element element = {walk->cloth,
                                       e,
                                       {walk->first + edge->a, walk->first + edge->b,
                                        walk->first + edge->opposite[0],
                                        walk->first + edge->opposite[1]},
                                       4,
                                       FLOW_HINGES};
        if (!quadratic || damped)
            walk->visit(walk->to, &element);
        element.kind = FLOW_FOLDS;
        if (quadratic)
            walk->visit(walk->to, &element);
    }
}

void flow_elements_each(const struct flow_elements *elements,
                        void (*visit)(void *to, const struct flow_element *element), void *to)
{
    const struct model *model = elements->model;
    struct walk walk = {.visit = visit, .to = to};
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        walk.cloth = c;
        if (flow_has_triangles(model, cloth))
            walk_triangles(&walk, &cloth->mesh, FLOW_TRIANGLES);
        if (flow_has_bending(model, cloth))
            walk_edges(&walk, elements->edges + c,
                       bending_of(model, cloth)->bending == MODEL_QUADRATIC,
                       damps_bending(model, cloth));
        if (model_has_air(model) && flow_has_cells(model, cloth))
            walk_cells(&walk, &cloth->mesh);
        else if (model_has_air(model))
            walk_triangles(&walk, &cloth->mesh, FLOW_SAILS);
        walk.first += cloth->mesh.n_vertices;
    }
}

/* ---- Making ---- */

static int check_triangles(const struct flow_elements *elements, uint32_t c,
                           struct cloth_error *error)
{
    const struct model_cloth *cloth = elements->model->cloths + c;
    for (uint32_t t = 0; t < cloth->mesh.n_triangles; t++) {
        uint32_t corner[3];
        struct flow_rest_of rest;
        mesh_corners(&cloth->mesh, t, corner);
        if (triangle_rest(elements, c, corner, &rest))
            return model_fail(cloth->mesh_place, error,
                              "mesh: triangle %u of cloth '%.60s' (vertices %u, %u and %u, all "
                              "counted from 0) has no area at rest; an area above 0 is expected",
                              t, cloth->name, corner[0], corner[1], corner[2]);
    }
    return CLOTH_OK;
}

static int check_edges(const struct flow_elements *elements, uint32_t c, struct cloth_error *error)
{
    const double flat = 1e-6;
    const struct model_cloth *cloth = elements->model->cloths + c;
    const struct model_material *material = bending_of(elements->model, cloth);
    for (uint32_t e = 0; e < elements->edges[c].n; e++) {
        const struct mesh_edge *edge = elements->edges[c].edge + e;
        const uint32_t corner[4] = {edge->a, edge->b, edge->opposite[0], edge->opposite[1]};
        struct phys_bend_rest rest;
        if (!bends(edge))
            continue;
        if (bend_rest(elements, c, corner, &rest))
            return model_fail(
                cloth->mesh_place, error,
                "mesh: a triangle at the edge between vertices %u and %u of cloth "
                "'%.60s' (counted from 0) has no area at rest; an area above 0 is expected",
                edge->a, edge->b, cloth->name);
        if (material->bending == MODEL_QUADRATIC && !(fabs(rest.s) <= flat))
            return model_fail(
                cloth->mesh_place, error,
                "mesh: cloth '%.60s' is not flat at the edge between vertices %u and %u "
                "(counted from 0), as bending: {model: quadratic} of material "
                "'%.60s' expects; take model: hinge, or rest: uv",
                cloth->name, edge->a, edge->b, material->name);
    }
    return CLOTH_OK;
}

static int check_format(const struct model *model, struct cloth_error *error)
{
    if (model->format != SOLVE_SPRINGS)
        return CLOTH_OK;
    return cloth_fail(error, CLOTH_E_INPUT,
                      "a matrix of springs cannot hold triangles or bending; the format half or "
                      "half_float is expected");
}

static int make_cloth(struct flow_elements *elements, uint32_t c, struct cloth_error *error)
{
    const struct model *model = elements->model;
    const struct model_cloth *cloth = model->cloths + c;
    struct cloth_error inner = {0};
    const bool stiff = flow_has_triangles(model, cloth) || flow_has_bending(model, cloth);
    if (!stiff && !model_has_air(model))
        return CLOTH_OK;
    int code = stiff ? check_format(model, error) : CLOTH_OK;
    if (code)
        return code;
    mesh_axes(model_rest(cloth), elements->axis[c][0], elements->axis[c][1]);
    code = mesh_edges_find(elements->edges + c, model_rest(cloth), &inner);
    if (code == CLOTH_E_INPUT)
        return model_fail(cloth->mesh_place, error, "cloth '%.60s': %s", cloth->name, inner.text);
    if (code)
        return cloth_fail(error, code, "%s", inner.text);
    if (flow_has_triangles(model, cloth))
        code = check_triangles(elements, c, error);
    return code || !flow_has_bending(model, cloth) ? code : check_edges(elements, c, error);
}

int flow_elements_make(struct flow_elements *elements, const struct model *model,
                       struct cloth_error *error)
{
    *elements = (struct flow_elements){.model = model};
    elements->edges = cloth_alloc(model->n_cloths, sizeof *elements->edges, error);
    elements->axis = cloth_alloc(model->n_cloths, sizeof *elements->axis, error);
    int code = elements->edges && elements->axis ? CLOTH_OK : CLOTH_E_MEMORY;
    for (uint32_t c = 0; c < model->n_cloths && !code; c++)
        code = make_cloth(elements, c, error);
    if (code)
        flow_elements_free(elements);
    return code;
}

void flow_elements_free(struct flow_elements *elements)
{
    for (uint32_t c = 0; elements->edges && c < elements->model->n_cloths; c++)
        mesh_edges_free(elements->edges + c);
    free(elements->edges);
    free(elements->axis);
    *elements = (struct flow_elements){0};
}
