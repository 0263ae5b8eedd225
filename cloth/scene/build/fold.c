/* Folds of cloths: along paths of vertices, or edges of panels, whose vertices seams know. */
#include "cloth/scene/build/build.h"

#include <math.h>
#include <string.h>

int scene_build_check_path(const uint32_t *vertices, uint32_t n, const char *what,
                           const struct model_cloth *cloth, const struct mesh_edges *edges,
                           const struct scene_tree *tree, int list)
{
    if (n < 2)
        return scene_tree_fail(tree, list,
                               "%s has one vertex; the vertices along it, two at least, are "
                               "expected",
                               what);
    if (scene_build_check_vertices(vertices, n, cloth, tree, list))
        return tree->error->code;
    for (uint32_t i = 1; i < n; i++)
        if (!mesh_edges_get(edges, vertices[i - 1], vertices[i]))
            return scene_tree_fail(tree,
                                   scene_tree_is(tree, list, YAML_MAPPING_NODE)
                                       ? list
                                       : scene_tree_item(tree, list, i),
                                   "there is no edge between vertices %u and %u of cloth '%.60s', "
                                   "which %s has one after the other; such two are expected",
                                   vertices[i - 1], vertices[i], cloth->name, what);
    return CLOTH_OK;
}

/* The vertices along one side of a seam. */
static int fold_take_side(struct model_fold *fold, const struct model_seam *seam, int side,
                          struct cloth_error *error)
{
    fold->sewn = true;
    fold->open = seam->sewing.state == MODEL_SEAMS_OPEN;
    fold->vertices = cloth_alloc(seam->n_pairs, sizeof *fold->vertices, error);
    for (; fold->vertices && fold->n < seam->n_pairs; fold->n++)
        fold->vertices[fold->n] = seam->pair[fold->n][side];
    return error->code;
}

/* Along an edge of a panel that is sewn. */
static int build_edge(struct model_fold *fold, const struct model_cloth *cloth,
                      const struct scene_tree *tree, int node)
{
    const char *panel = scene_tree_text(tree, node, "panel");
    const uint32_t edge = (uint32_t)scene_tree_number(tree, node, "edge");
    const struct model_seams *seams = &cloth->seams;
    for (uint32_t s = 0; s < seams->n; s++)
        for (int k = 0; k < 2; k++)
            if (seams->seam[s].side[k].edge == edge && !strcmp(seams->seam[s].side[k].panel, panel))
                return fold_take_side(fold, seams->seam + s, k, tree->error);
    return scene_tree_fail(tree, node,
                           "no seam of cloth '%.60s' has edge %u of a panel '%.60s', so nothing "
                           "folds there; an edge that is sewn is expected",
                           cloth->name, edge, panel);
}

static int build_fold(struct model_fold *fold, const struct model_cloth *cloth,
                      const struct mesh_edges *edges, const struct scene_tree *tree, int node)
{
    const int edge = scene_tree_get(tree, node, "edge");
    if (!(fabs(fold->angle) < 180))
        return scene_tree_fail(tree, scene_tree_get(tree, node, "angle"),
                               "a fold has an angle of %g degrees; one above -180 and below 180 is "
                               "expected",
                               fold->angle);
    return edge ? build_edge(fold, cloth, tree, edge)
                : scene_build_check_path(fold->vertices, fold->n, "a fold", cloth, edges, tree,
                                         scene_tree_get(tree, node, "vertices"));
}

/* Seams that are never welded have no hinges; pulled ones may be welded in another phase. */
int scene_build_folds(struct scene_tree *tree, uint32_t c, int node)
{
    struct model_cloth *cloth = tree->model->cloths + c;
    const int list = scene_tree_get(tree, node, "folds");
    struct mesh_edges edges;
    bool open = false;
    if (!cloth->n_folds)
        return CLOTH_OK;
    int code = mesh_edges_find(&edges, &cloth->mesh, tree->error);
    for (uint32_t i = 0; i < cloth->n_folds && !code; i++) {
        code = build_fold(cloth->folds + i, cloth, &edges, tree, scene_tree_item(tree, list, i));
        open = open || cloth->folds[i].open;
    }
    mesh_edges_free(&edges);
    if (!code && open)
        scene_build_warn(tree, list,
                         "folds along edges of panels mean nothing in cloth '%.60s' where seams "
                         "are open",
                         cloth->name);
    return tree->error->code;
}
