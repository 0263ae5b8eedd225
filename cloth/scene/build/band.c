/* Bands: elastics along paths of vertices. Each edge of the path becomes a joint of the model. */
#include "cloth/scene/build/build.h"

/* Adds the joint of an edge whose length at rest, m, is such a part of the band's. */
static int add_joint(const struct model_band *band, uint32_t cloth, const uint32_t end[2],
                     double length, const struct scene_tree *tree, int node)
{
    struct model *model = tree->model;
    struct model_joint *joint =
        scene_build_add(&model->joints, &model->n_joints, 1, sizeof *joint, tree->error);
    if (!joint || scene_build_room(&joint->pairs, cloth, 1, tree, node))
        return tree->error->code;
    scene_build_pair(&joint->pairs, end[0], end[1]);
    joint->length = length;
    joint->stiffness = band->ea / length;
    joint->damping = band->damping * joint->stiffness;
    joint->size = band->size;
    return CLOTH_OK;
}

static double edge_length(const struct model_cloth *cloth, const struct mesh_edges *edges,
                          const uint32_t end[2])
{
    const struct mesh_edge *edge = mesh_edges_get(edges, end[0], end[1]);
    return mesh_length(model_rest(cloth), edge->triangle, end[0], end[1]);
}

static int build_band(struct model_band *band, uint32_t c, const struct mesh_edges *edges,
                      const struct scene_tree *tree, int node)
{
    const struct model_cloth *cloth = tree->model->cloths + c;
    const int edge = scene_tree_get(tree, node, "edge");
    double all = 0;
    int code = scene_build_pick(&band->pick, tree, node, cloth);
    const uint32_t *vertex = band->pick.vertices, n = band->pick.n_vertices;
    code = code ||
           scene_build_check_path(vertex, n, "a band", cloth, edges, tree,
                                  edge ? edge : scene_tree_get(tree, node, "vertices")) ||
           scene_build_size(&band->size, tree, scene_tree_get(tree, node, "size"));
    for (uint32_t i = 1; i < n && !code; i++)
        all += edge_length(cloth, edges, vertex + i - 1);
    for (uint32_t i = 1; i < n && !code; i++)
        code =
            add_joint(band, c, vertex + i - 1,
                      band->length * edge_length(cloth, edges, vertex + i - 1) / all, tree, node);
    return code;
}

int scene_build_bands(struct scene_tree *tree, uint32_t c, int node)
{
    const struct model_cloth *cloth = tree->model->cloths + c;
    const int list = scene_tree_get(tree, node, "bands");
    struct mesh_edges edges;
    if (!cloth->n_bands)
        return CLOTH_OK;
    int code = mesh_edges_find(&edges, &cloth->mesh, tree->error);
    for (uint32_t i = 0; i < cloth->n_bands && !code; i++)
        code = build_band(cloth->bands + i, c, &edges, tree, scene_tree_item(tree, list, i));
    mesh_edges_free(&edges);
    return code;
}
