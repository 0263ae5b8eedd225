/* Edges of a mesh may be shorter than the thickness of contact if they are few and join small sets.
 * The ends of such an edge count as one for contact, as the two sides of a pulled seam do, so their
 * neighbours are not pushed apart. A set joined by a longer chain would not meet itself in places
 * that are apart, so the thickness is refused. */
#include "cloth/scene/build/build.h"

#include "cloth/base/sets.h"

#include <math.h>
#include <stdlib.h>

static const double MOST_EXTENT = 4;  /* thicknesses: of a set that short edges join */
static const double MOST_SHARE = 0.1; /* of all edges that may be short */

/* The short edges of a cloth. */
struct shorts {
    const struct mesh *mesh, *rest;
    double thickness;
    uint32_t n;
    const struct mesh_edge *shortest;
    double least, most;  /* m: the shortest edge; the longest side of a box around what is joined */
    uint32_t *set;       /* by vertex: which are */
    double (*box)[2][3]; /* by the lowest vertex of a set, m */
};

static void short_find(struct shorts *shorts, const struct mesh_edges *edges)
{
    cloth_sets_start(shorts->set, shorts->rest->n_vertices);
    for (uint32_t e = 0; e < edges->n; e++) {
        const struct mesh_edge *edge = edges->edge + e;
        if (edge->opposite[0] == UINT32_MAX)
            continue;
        const double length = mesh_length(shorts->rest, edge->triangle, edge->a, edge->b);
        if (length >= shorts->thickness)
            continue;
        shorts->shortest = length < shorts->least ? edge : shorts->shortest;
        shorts->least = fmin(shorts->least, length);
        shorts->n++;
        cloth_sets_join(shorts->set, edge->a, edge->b);
    }
}

static void find_extent(struct shorts *shorts)
{
    const uint32_t n = shorts->mesh->n_vertices;
    for (uint32_t v = 0; v < n; v++) {
        const double *x = shorts->mesh->position + 3 * (size_t)v;
        const uint32_t root = cloth_sets_root(shorts->set, v);
        double(*box)[3] = shorts->box[root];
        for (int i = 0; i < 3; i++) {
            box[0][i] = root == v ? x[i] : fmin(box[0][i], x[i]);
            box[1][i] = root == v ? x[i] : fmax(box[1][i], x[i]);
            shorts->most = fmax(shorts->most, box[1][i] - box[0][i]);
        }
    }
}

/* Enters the sets into the model's `apart`. first: number of the cloth's first vertex. */
static int join_shorts(struct model *model, const struct shorts *shorts, uint32_t first,
                       struct cloth_error *error)
{
    struct contact_apart *apart = &model->contact.apart;
    const uint32_t n = model_first(model, model->n_cloths);
    if (!apart->joined) {
        apart->joined = cloth_alloc(n, sizeof *apart->joined, error);
        if (!apart->joined)
            return error->code;
        cloth_sets_start(apart->joined, n);
    }
    for (uint32_t v = 0; v < shorts->rest->n_vertices; v++)
        cloth_sets_join(apart->joined, first + v, first + cloth_sets_root(shorts->set, v));
    for (uint32_t v = 0; v < n; v++)
        apart->joined[v] = cloth_sets_root(apart->joined, v);
    return CLOTH_OK;
}

static int short_take_cloth(uint32_t c, struct shorts *shorts, const struct mesh_edges *edges,
                            const struct scene_tree *tree, int node)
{
    struct model *model = tree->model;
    short_find(shorts, edges);
    if (!shorts->n || shorts->n > MOST_SHARE * edges->n)
        return CLOTH_OK;
    find_extent(shorts);
    if (shorts->most > MOST_EXTENT * shorts->thickness)
        return CLOTH_OK; /* flow_thickness_check refuses */
    const struct mesh_edge *edge = shorts->shortest;
    return join_shorts(model, shorts, model_first(model, c), tree->error) ||
           scene_build_warn(tree, node,
                            "%u of %u edges of cloth '%.60s' %s shorter at rest than "
                            "contact.thickness, %g m; the shortest, between vertices %u and %u "
                            "(counted from 0), has %.3g m: for contact the ends of each count as "
                            "one",
                            shorts->n, edges->n, model->cloths[c].name,
                            shorts->n == 1 ? "is" : "are", shorts->thickness, edge->a, edge->b,
                            shorts->least);
}

static bool has_short(const struct shorts *shorts)
{
    for (size_t i = 0; i < 3 * (size_t)shorts->rest->n_triangles; i++) {
        const uint32_t t = (uint32_t)(i / 3), triangle[2] = {t, UINT32_MAX};
        uint32_t corner[3];
        mesh_corners(shorts->rest, t, corner);
        if (mesh_length(shorts->rest, triangle, corner[i % 3], corner[(i + 1) % 3]) <
            shorts->thickness)
            return true;
    }
    return false;
}

int scene_build_short_edges(struct scene_tree *tree, uint32_t c, int node)
{
    const struct model *model = tree->model;
    const struct model_cloth *cloth = model->cloths + c;
    const struct mesh *rest = model_rest(cloth);
    struct mesh_edges edges = {0};
    struct shorts shorts = {.mesh = &cloth->mesh,
                            .rest = rest,
                            .thickness = model->contact.thickness,
                            .least = INFINITY};
    if (!model_seeks(model) || !has_short(&shorts))
        return CLOTH_OK;
    shorts.set = cloth_alloc(rest->n_vertices, sizeof *shorts.set, tree->error);
    shorts.box = cloth_alloc(rest->n_vertices, sizeof *shorts.box, tree->error);
    const int code = tree->error->code || mesh_edges_find(&edges, rest, tree->error) ||
                     short_take_cloth(c, &shorts, &edges, tree, node);
    mesh_edges_free(&edges);
    free(shorts.set);
    free(shorts.box);
    return code;
}
