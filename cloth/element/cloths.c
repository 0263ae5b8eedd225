/* Parts of meshes become elements in the order of their mesh, so that every list of a kind has one
 * order. */
#include "cloth/element/cloths.h"

#include "cloth/base/memory.h"
#include "cloth/physics/triangle.h"

#include <stdlib.h>
#include <string.h>

/* ---- Rest shapes ---- */

const struct mesh *element_rest(const struct element_cloths *cloths, uint32_t cloth)
{
    return model_rest(cloths->model->cloths + cloth);
}

double element_rest_length(const struct element_cloths *cloths, const struct element *element)
{
    return mesh_length(element_rest(cloths, element->cloth), element->triangle, element->corner[0],
                       element->corner[1]);
}

/* The uv of a triangle's corners; whether they have an area there. */
static bool uv_of(const struct mesh *mesh, uint32_t triangle, const uint32_t corner[3],
                  double uv[6])
{
    double gradient[4], area;
    for (int i = 0; i < 3; i++)
        if (!mesh_uv(mesh, mesh_uv_number(mesh, triangle, corner[i]), uv + 2 * i))
            return false;
    return !phys_triangle_rest(uv, gradient, &area);
}

void element_rest_local(const struct element_cloths *cloths, uint32_t cloth, uint32_t triangle,
                        const uint32_t corner[3], double local[6])
{
    const struct mesh *rest = element_rest(cloths, cloth);
    double x[9], uv[6], own[6];
    for (int i = 0; i < 3; i++) {
        const double *place = mesh_place(rest, triangle, corner[i]);
        memcpy(x + 3 * i, place, 3 * sizeof *x);
        for (int d = 0; d < 2; d++) {
            const double *axis = cloths->axis[cloth][d];
            uv[2 * i + d] = place[0] * axis[0] + place[1] * axis[1] + place[2] * axis[2];
        }
    }
    if (uv_of(rest, triangle, corner, own))
        memcpy(uv, own, sizeof uv);
    phys_triangle_local(x, uv, local);
    const double *turn = model_grain(cloths->model->cloths + cloth, 3, corner);
    for (int i = 0; i < 3 && turn; i++) {
        const double u = local[2 * i], v = local[2 * i + 1];
        local[2 * i] = turn[0] * u + turn[1] * v;
        local[2 * i + 1] = turn[0] * v - turn[1] * u;
    }
}

void element_alone(const struct element_cloths *cloths, const struct element *element,
                   void *material, struct element_one *one)
{
    const struct element_kind *kind = element_kinds[element->kind];
    *one = (struct element_one){.list = {.n = 1, .corner = one->corner, .material = material}};
    one->list.vector = &one->vector;
    for (uint32_t i = 0; i < kind->numbers; i++)
        one->list.number[i] = one->number + i;
    for (uint32_t i = 0; i < 4; i++)
        one->corner[0][i] = i < element->corners ? i : PHYS_NO_CORNER;
    if (kind->pack)
        kind->pack(cloths, element, &one->list, 0);
}

/* ---- Going through them ---- */

struct walk {
    void (*visit)(void *to, const struct element *element);
    void *to;
    const struct element_cloths *cloths;
    const struct model_cloth *cloth;
    struct element element; /* of the kind and cloth that are gone through */
};

/* Triangles; of faces the cells, if the mesh has them. */
static void walk_faces(struct walk *walk)
{
    const struct mesh *mesh = &walk->cloth->mesh;
    const bool cells = element_kinds[walk->element.kind]->part == ELEMENT_FACES &&
                       model_has_cells(walk->cloths->model, walk->cloth);
    walk->element.corners = cells ? 4 : 3;
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        mesh_corners(mesh, t, walk->element.corner);
        walk->element.triangle[0] = t;
        walk->element.corner[3] = cells ? mesh_fourth(mesh, t) : 0;
        walk->visit(walk->to, &walk->element);
    }
}

static void walk_hinges(struct walk *walk)
{
    const struct mesh_edges *edges = walk->cloths->edges + walk->element.cloth;
    walk->element.corners = 4;
    for (uint32_t e = 0; e < edges->n; e++) {
        const struct mesh_edge *edge = edges->edge + e;
        const uint32_t corner[4] = {edge->a, edge->b, edge->opposite[0], edge->opposite[1]};
        if (!element_is_hinge(edge))
            continue;
        memcpy(walk->element.corner, corner, sizeof corner);
        memcpy(walk->element.triangle, edge->triangle, sizeof edge->triangle);
        walk->visit(walk->to, &walk->element);
    }
}

/* True if an edge of a grid is a diagonal of a cell. */
static bool is_diagonal(const struct mesh *mesh, const struct mesh_edge *edge)
{
    const uint32_t nx = mesh->grid_nx;
    return edge->a / nx != edge->b / nx && edge->a % nx != edge->b % nx;
}

static void walk_edges(struct walk *walk)
{
    const struct mesh_edges *edges = walk->cloths->edges + walk->element.cloth;
    const bool cells = model_has_cells(walk->cloths->model, walk->cloth);
    walk->element.corners = 2;
    for (uint32_t e = 0; e < edges->n; e++) {
        if (cells && is_diagonal(&walk->cloth->mesh, edges->edge + e))
            continue;
        walk->element.corner[0] = edges->edge[e].a;
        walk->element.corner[1] = edges->edge[e].b;
        memcpy(walk->element.triangle, edges->edge[e].triangle, sizeof edges->edge[e].triangle);
        walk->visit(walk->to, &walk->element);
    }
}

/* Walks seams whose two cloths bend by the same model and have elements of the kind: the latter is
 * not enough, as hinges damp a quadratic energy, too. */
static void walk_seams(struct walk *walk)
{
    const struct element_cloths *cloths = walk->cloths;
    const struct element_kind *kind = element_kinds[walk->element.kind];
    for (uint32_t s = 0; s < cloths->n_seams && kind->part == ELEMENT_HINGES; s++) {
        const struct element_seam *seam = cloths->seam + s;
        const struct element_side *one = seam->side, *two = seam->side + 1;
        const uint32_t other = two->first - one->first + two->corner[2];
        if (!element_bend_alike(cloths->model, one->cloth, two->cloth) ||
            !kind->has(cloths->model, cloths->model->cloths + one->cloth) ||
            !kind->has(cloths->model, cloths->model->cloths + two->cloth))
            continue;
        const struct element element = {
            .cloth = one->cloth,
            .first = one->first,
            .corner = {one->corner[0], one->corner[1], one->corner[2], other},
            .corners = 4,
            .kind = walk->element.kind,
            .seam = seam};
        walk->visit(walk->to, &element);
    }
}

static void (*const walks[ELEMENT_PARTS])(struct walk *) = {
    [ELEMENT_TRIANGLES] = walk_faces,
    [ELEMENT_FACES] = walk_faces,
    [ELEMENT_HINGES] = walk_hinges,
    [ELEMENT_EDGES] = walk_edges,
};

void element_each(const struct element_cloths *cloths,
                  void (*visit)(void *to, const struct element *element), void *to)
{
    const struct model *model = cloths->model;
    for (uint32_t kind = 0; kind < ELEMENT_KINDS; kind++) {
        struct walk walk = {.visit = visit, .to = to, .cloths = cloths};
        for (uint32_t c = 0; c < model->n_cloths; c++) {
            walk.cloth = model->cloths + c;
            walk.element =
                (struct element){.cloth = c, .first = model_first(model, c), .kind = kind};
            if (element_kinds[kind]->has(model, walk.cloth))
                walks[element_kinds[kind]->part](&walk);
        }
        walk.element.kind = kind;
        walk_seams(&walk);
    }
}

/* ---- Making ---- */

static int check_format(const struct model *model, const struct model_cloth *cloth,
                        struct cloth_error *error)
{
    const struct element_kind *kind = element_in_matrix(model, cloth);
    if (model->format != SOLVE_SPRINGS || !kind)
        return CLOTH_OK;
    return cloth_fail(error, CLOTH_E_INPUT,
                      "a matrix of springs cannot hold %s; the format half is expected",
                      kind->name);
}

static int check_cloth(const struct element_cloths *cloths, uint32_t c, struct cloth_error *error)
{
    const struct model *model = cloths->model;
    int code = CLOTH_OK;
    for (int i = 0; i < ELEMENT_KINDS && !code; i++)
        if (element_kinds[i]->check && element_kinds[i]->has(model, model->cloths + c))
            code = element_kinds[i]->check(cloths, c, error);
    return code;
}

static int cloths_make_cloth(struct element_cloths *cloths, uint32_t c, struct cloth_error *error)
{
    const struct model *model = cloths->model;
    const struct model_cloth *cloth = model->cloths + c;
    struct cloth_error inner = {0};
    const bool parts = element_parts(model, cloth);
    int code = parts ? check_format(model, cloth, error) : CLOTH_OK;
    if (code)
        return code;
    if (parts || model->sizes)
        mesh_axes(model_rest(cloth), cloths->axis[c][0], cloths->axis[c][1]);
    if (!parts)
        return CLOTH_OK;
    code = mesh_edges_find(cloths->edges + c, model_rest(cloth), &inner);
    if (code == CLOTH_E_INPUT)
        return model_fail(cloth->mesh_place, error, "cloth '%.60s': %s", cloth->name, inner.text);
    if (code)
        return cloth_fail(error, code, "%s", inner.text);
    return check_cloth(cloths, c, error);
}

int element_cloths_make(struct element_cloths *cloths, const struct model *model,
                        struct cloth_error *error)
{
    *cloths = (struct element_cloths){.model = model};
    cloths->edges = cloth_alloc(model->n_cloths, sizeof *cloths->edges, error);
    cloths->axis = cloth_alloc(model->n_cloths, sizeof *cloths->axis, error);
    int code = cloths->edges && cloths->axis ? CLOTH_OK : CLOTH_E_MEMORY;
    for (uint32_t c = 0; c < model->n_cloths && !code; c++)
        code = cloths_make_cloth(cloths, c, error);
    if (!code)
        code = element_folds_make(cloths, error);
    if (code)
        element_cloths_free(cloths);
    return code;
}

void element_cloths_free(struct element_cloths *cloths)
{
    for (uint32_t c = 0; cloths->edges && c < cloths->model->n_cloths; c++)
        mesh_edges_free(cloths->edges + c);
    free(cloths->edges);
    free(cloths->axis);
    free(cloths->seam);
    free(cloths->fold);
    *cloths = (struct element_cloths){0};
}
