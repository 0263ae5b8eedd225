/* Meshes in pieces whose vertices lie on each other's places: `mesh.weld` makes as many welds as
 * join them all. Unjoined pieces draw a warning. */
#include "cloth/scene/build/build.h"

#include "cloth/base/sets.h"

#include <stdlib.h>

/* m: vertices so near are meant to be at one place; the advice gives this number, too. */
static const double ONE_PLACE = 1e-5;

static int weld_cloth(struct model *model, uint32_t c, const struct scene_tree *tree, int node,
                      struct cloth_error *error)
{
    const struct model_cloth *cloth = model->cloths + c;
    const uint32_t n = cloth->mesh.n_vertices;
    uint32_t *same = scene_build_array(n, sizeof *same, error), joined = 0;
    int code = same ? mesh_coincide(&cloth->mesh, cloth->weld, same, error) : error->code;
    for (uint32_t v = 0; !code && v < n; v++)
        joined += same[v] != v;
    if (!code && !joined)
        code = scene_build_warn(model, tree, node, error,
                                "weld joins no vertices: no two of cloth '%.60s' are within %g m",
                                cloth->name, cloth->weld);
    struct model_weld *weld =
        !code && joined ? scene_build_add_weld(model, cloth->weld, c, joined, error) : NULL;
    if (weld)
        weld->pairs.place = scene_build_place(tree, node, error);
    for (uint32_t v = 0; weld && v < n; v++)
        if (same[v] != v) {
            uint32_t *at = &weld->pairs.end[0].n;
            weld->pairs.end[0].vertices[*at] = same[v];
            weld->pairs.end[1].vertices[(*at)++] = v;
            weld->pairs.end[1].n = *at;
        }
    free(same);
    return code ? code : error->code;
}

int scene_build_mesh_welds(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    const int list = scene_tree_get(tree, 1, "cloths");
    int code = CLOTH_OK;
    for (uint32_t c = 0; c < model->n_cloths && !code; c++) {
        const int mesh = scene_tree_get(tree, scene_tree_item(tree, list, c), "mesh");
        if (model->cloths[c].weld > 0)
            code = weld_cloth(model, c, tree, scene_tree_get(tree, mesh, "weld"), error);
    }
    return code;
}

/* ---- Unjoined pieces ---- */

static void join_welded_pairs(uint32_t *set, uint32_t c, const struct model_pairs *pairs)
{
    const struct model_end *a = pairs->end, *b = pairs->end + 1;
    for (uint32_t i = 0; i < a->n && a->cloth == c && b->cloth == c && b->vertices; i++)
        cloth_sets_join(set, a->vertices[i], b->vertices[i]);
}

/* Joins the vertices of a cloth that welds and joints bring together. */
static void join_all(uint32_t *set, const struct model *model, uint32_t c)
{
    cloth_sets_start(set, model->cloths[c].mesh.n_vertices);
    for (uint32_t w = 0; w < model->n_welds; w++)
        join_welded_pairs(set, c, &model->welds[w].pairs);
    for (uint32_t j = 0; j < model->n_joints; j++)
        join_welded_pairs(set, c, &model->joints[j].pairs);
}

/* Marks the ends of edges that have no second triangle. */
static int mark_borders(const struct mesh *mesh, unsigned char *border, struct cloth_error *error)
{
    struct mesh_edges edges;
    const int code = mesh_edges_find(&edges, mesh, error);
    for (uint32_t e = 0; !code && e < edges.n; e++)
        if (edges.edge[e].opposite[1] == UINT32_MAX)
            border[edges.edge[e].a] = border[edges.edge[e].b] = 1;
    mesh_edges_free(&edges);
    return code;
}

/* Pieces of a mesh, with what joins them. Uses up the sets. */
static uint32_t count_pieces(const struct mesh *mesh, uint32_t *set, unsigned char *used)
{
    uint32_t pieces = 0, corner[3];
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        mesh_corners(mesh, t, corner);
        cloth_sets_join(set, corner[0], corner[1]);
        cloth_sets_join(set, corner[0], corner[2]);
    }
    for (size_t e = 0; e < mesh->n_lone_edges; e++)
        cloth_sets_join(set, mesh->lone_edge[2 * e], mesh->lone_edge[2 * e + 1]);
    mesh_used(mesh, used);
    for (uint32_t v = 0; v < mesh->n_vertices; v++)
        pieces += used[v] && cloth_sets_root(set, v) == v;
    return pieces;
}

/* set, same: a number a vertex; mark: a byte. */
static int look_at_cloth(struct model *model, uint32_t c, uint32_t *set, uint32_t *same,
                         unsigned char *mark, const struct scene_tree *tree, int node,
                         struct cloth_error *error)
{
    struct model_cloth *cloth = model->cloths + c;
    const struct mesh *mesh = &cloth->mesh;
    uint32_t near = 0;
    join_all(set, model, c);
    int code = mesh_coincide(mesh, ONE_PLACE, same, error);
    for (uint32_t v = 0; v < mesh->n_vertices && !code; v++)
        near += same[v] != v;
    if (near)
        code = mark_borders(mesh, mark, error);
    for (uint32_t v = 0; v < mesh->n_vertices && near && !code; v++)
        cloth->n_unjoined += same[v] != v && mark[v] && mark[same[v]] &&
                             cloth_sets_root(set, v) != cloth_sets_root(set, same[v]);
    if (code || !cloth->n_unjoined)
        return code;
    const uint32_t pieces = count_pieces(mesh, set, mark);
    return scene_build_warn(model, tree, node, error,
                            "the mesh of cloth '%.60s' has %u piece%s; %u vertices at borders lie "
                            "on another's place, and nothing joins them: mesh: {weld: 1e-5} does",
                            cloth->name, pieces, pieces == 1 ? "" : "s", cloth->n_unjoined);
}

int scene_build_pieces(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    const int list = scene_tree_get(tree, 1, "cloths");
    int code = CLOTH_OK;
    for (uint32_t c = 0; c < model->n_cloths && !code; c++) {
        const struct mesh *mesh = &model->cloths[c].mesh;
        const int node = scene_tree_get(tree, scene_tree_item(tree, list, c), "mesh");
        const bool given =
            scene_tree_get(tree, node, "file") || scene_tree_get(tree, node, "inline");
        if (!given)
            continue;
        uint32_t *set = scene_build_array(mesh->n_vertices, 2 * sizeof *set, error);
        unsigned char *mark = scene_build_array(mesh->n_vertices, 1, error);
        code = set && mark
                   ? look_at_cloth(model, c, set, set + mesh->n_vertices, mark, tree, node, error)
                   : error->code;
        free(set);
        free(mark);
    }
    return code;
}
