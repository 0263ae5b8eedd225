/* Folds of cloths: along paths of vertices, or edges of panels, whose vertices seams know. */
#include "cloth/scene/build/build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Checks that the mesh has an edge between each two consecutive vertices. */
static int check_path(const struct model_cloth *cloth, const struct model_fold *fold,
                      const struct mesh_edges *edges, const struct scene_tree *tree, int node,
                      struct cloth_error *error)
{
    const int list = scene_tree_get(tree, node, "vertices");
    if (fold->n < 2)
        return scene_tree_fail(tree, list, error,
                               "a fold has one vertex; the vertices along it, two at least, are "
                               "expected");
    if (scene_build_check_vertices(fold->vertices, fold->n, cloth, tree, list, error))
        return error->code;
    for (uint32_t i = 1; i < fold->n; i++)
        if (!mesh_edges_get(edges, fold->vertices[i - 1], fold->vertices[i]))
            return scene_tree_fail(tree, scene_tree_item(tree, list, i), error,
                                   "there is no edge between vertices %u and %u of cloth '%.60s', "
                                   "which a fold has one after the other; such two are expected",
                                   fold->vertices[i - 1], fold->vertices[i], cloth->name);
    return CLOTH_OK;
}

/* The vertices along one side of a seam. */
static int fold_take_side(struct model_fold *fold, const struct model_seam *seam, int side,
                          struct cloth_error *error)
{
    fold->sewn = true;
    fold->open = seam->sewing.state == MODEL_SEAMS_OPEN;
    fold->vertices = scene_build_array(seam->n_pairs, sizeof *fold->vertices, error);
    if (!fold->vertices)
        return error->code;
    fold->n = seam->n_pairs;
    for (uint32_t i = 0; i < seam->n_pairs; i++)
        fold->vertices[i] = seam->pair[i][side];
    return CLOTH_OK;
}

/* Along an edge of a panel that is sewn. */
static int build_edge(struct model_fold *fold, const struct model_cloth *cloth,
                      const struct scene_tree *tree, int node, struct cloth_error *error)
{
    const char *panel = scene_tree_text(tree, node, "panel");
    const uint32_t edge = scene_tree_integer(tree, node, "edge");
    const struct model_seams *seams = &cloth->seams;
    for (uint32_t s = 0; s < seams->n; s++)
        for (int k = 0; k < 2; k++)
            if (seams->seam[s].side[k].edge == edge && !strcmp(seams->seam[s].side[k].panel, panel))
                return fold_take_side(fold, seams->seam + s, k, error);
    return scene_tree_fail(tree, node, error,
                           "no seam of cloth '%.60s' has edge %u of a panel '%.60s', so nothing "
                           "folds there; an edge that is sewn is expected",
                           cloth->name, edge, panel);
}

static int build_fold(struct model_fold *fold, const struct model_cloth *cloth,
                      const struct mesh_edges *edges, const struct scene_tree *tree, int node,
                      struct cloth_error *error)
{
    const int edge = scene_tree_get(tree, node, "edge");
    if (!(fabs(fold->angle) < 180))
        return scene_tree_fail(tree, scene_tree_get(tree, node, "angle"), error,
                               "a fold has an angle of %g degrees; one above -180 and below 180 is "
                               "expected",
                               fold->angle);
    return edge ? build_edge(fold, cloth, tree, edge, error)
                : check_path(cloth, fold, edges, tree, node, error);
}

/* Seams that are never welded have no hinges; pulled ones may be welded in another phase. */
static int warn_of_open(struct model *model, const struct model_cloth *cloth,
                        const struct scene_tree *tree, int list, struct cloth_error *error)
{
    bool open = false;
    for (uint32_t i = 0; i < cloth->n_folds; i++)
        open = open || cloth->folds[i].open;
    if (!open)
        return CLOTH_OK;
    return scene_build_warn(model, tree, list, error,
                            "folds along edges of panels mean nothing in cloth '%.60s' where "
                            "seams are open",
                            cloth->name);
}

static int build_folds(struct model *model, struct model_cloth *cloth,
                       const struct scene_tree *tree, int list, struct cloth_error *error)
{
    struct mesh_edges edges;
    if (!cloth->n_folds)
        return CLOTH_OK;
    int code = mesh_edges_find(&edges, &cloth->mesh, error);
    for (uint32_t i = 0; i < cloth->n_folds && !code; i++)
        code = build_fold(cloth->folds + i, cloth, &edges, tree, scene_tree_item(tree, list, i),
                          error);
    mesh_edges_free(&edges);
    return code ? code : warn_of_open(model, cloth, tree, list, error);
}

int scene_build_folds(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    const int list = scene_tree_get(tree, 1, "cloths");
    int code = CLOTH_OK;
    for (uint32_t i = 0; !code && i < model->n_cloths; i++)
        code = build_folds(model, model->cloths + i, tree,
                           scene_tree_get(tree, scene_tree_item(tree, list, i), "folds"), error);
    return code;
}
