/* Meshes in pieces whose vertices lie on each other's places: `mesh.weld` makes as many welds as
 * join them all. Unjoined pieces draw a warning. */
#include "cloth/scene/build/build.h"

#include "cloth/base/sets.h"

#include <stdlib.h>

/* m: vertices so near are meant to be at one place; the advice gives this number, too. */
static const double ONE_PLACE = 1e-5;

int scene_build_mesh_weld(struct scene_tree *tree, uint32_t c, int node)
{
    struct model *model = tree->model;
    const struct model_cloth *cloth = model->cloths + c;
    const int at = scene_tree_at(tree, node, "mesh.weld");
    const uint32_t n = cloth->mesh.n_vertices;
    uint32_t *same = at ? cloth_alloc(n, sizeof *same, tree->error) : NULL, joined = 0;
    if (!same)
        return tree->error->code;
    int code = mesh_coincide(&cloth->mesh, cloth->weld, same, tree->error);
    for (uint32_t v = 0; !code && v < n; v++)
        joined += same[v] != v;
    if (!code && !joined)
        code = scene_build_warn(tree, at,
                                "weld joins no vertices: no two of cloth '%.60s' are within %g m",
                                cloth->name, cloth->weld);
    struct model_weld *weld =
        joined ? scene_build_add(&model->welds, &model->n_welds, 1, sizeof *weld, tree->error)
               : NULL;
    if (weld) {
        weld->tolerance = cloth->weld;
        code = scene_build_room(&weld->pairs, c, joined, tree, at);
    }
    for (uint32_t v = 0; weld && !code && v < n; v++)
        if (same[v] != v)
            scene_build_pair(&weld->pairs, same[v], v);
    free(same);
    return tree->error->code;
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

/* Counts the vertices at borders that lie on another's place and are not joined with it. set, same:
 * a number a vertex; mark: a byte. */
static int count_unjoined(struct model_cloth *cloth, uint32_t *set, uint32_t *same,
                          unsigned char *mark, struct cloth_error *error)
{
    const struct mesh *mesh = &cloth->mesh;
    uint32_t near = 0;
    if (mesh_coincide(mesh, ONE_PLACE, same, error))
        return error->code;
    for (uint32_t v = 0; v < mesh->n_vertices; v++)
        near += same[v] != v;
    if (near && mark_borders(mesh, mark, error))
        return error->code;
    for (uint32_t v = 0; v < mesh->n_vertices && near; v++)
        cloth->n_unjoined += same[v] != v && mark[v] && mark[same[v]] &&
                             cloth_sets_root(set, v) != cloth_sets_root(set, same[v]);
    return CLOTH_OK;
}

int scene_build_pieces(struct scene_tree *tree, uint32_t c, int node)
{
    struct model_cloth *cloth = tree->model->cloths + c;
    const struct mesh *mesh = &cloth->mesh;
    const int at = scene_tree_get(tree, node, "mesh");
    if (!scene_tree_get(tree, at, "file") && !scene_tree_get(tree, at, "inline"))
        return CLOTH_OK;
    uint32_t *set = cloth_alloc(mesh->n_vertices, 2 * sizeof *set, tree->error);
    unsigned char *mark = cloth_alloc(mesh->n_vertices, 1, tree->error);
    if (set && mark) {
        join_all(set, tree->model, c);
        count_unjoined(cloth, set, set + mesh->n_vertices, mark, tree->error);
    }
    if (!tree->error->code && cloth->n_unjoined) {
        const uint32_t pieces = count_pieces(mesh, set, mark);
        scene_build_warn(tree, at,
                         "the mesh of cloth '%.60s' has %u piece%s; %u vertices at borders lie on "
                         "another's place, and nothing joins them: mesh: {weld: 1e-5} does",
                         cloth->name, pieces, pieces == 1 ? "" : "s", cloth->n_unjoined);
    }
    free(set);
    free(mark);
    return tree->error->code;
}
