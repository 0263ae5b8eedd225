/* Weights of a pin's vertices: a column of the mesh's uv, or a text file. Vertices of a weight
 * above 0 are listed, as if the scene named them, each with its weight. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/rules.h"

#include <stdlib.h>

/* The weights of all vertices are the numbers of one column of their uv. */
static int weigh_by_uv(double *weight, const struct model_cloth *cloth,
                       const struct scene_tree *tree, int node)
{
    const int column = scene_word_value(scene_columns, scene_tree_scalar(tree, node), NULL);
    for (uint32_t v = 0; v < cloth->mesh.n_vertices; v++) {
        double uv[2];
        if (!mesh_uv(&cloth->mesh, v, uv))
            return scene_tree_fail(tree, node,
                                   "weights are taken from uv, but the mesh of cloth '%.60s' has "
                                   "none; an OBJ file with vt at all corners, or weights.file is "
                                   "expected",
                                   cloth->name);
        if (!(uv[column] >= 0 && uv[column] <= 1))
            return scene_tree_fail(tree, node,
                                   "vertex %u of cloth '%.60s' has %s = %g, which is no weight; a "
                                   "number from 0 to 1 is expected (vertices count from 0)",
                                   v, cloth->name, scene_columns[column].word, uv[column]);
        weight[v] = uv[column];
    }
    return CLOTH_OK;
}

static int weigh_by_file(double *weight, const struct model_cloth *cloth, struct scene_tree *tree,
                         int node)
{
    char *path = scene_build_path(tree, node);
    const int code = path ? mesh_read_weights(path, cloth->mesh.n_vertices, weight, &tree->inner)
                          : tree->error->code;
    free(path);
    return scene_build_blame(code, "weights", tree, node);
}

/* Lists the vertices of a weight above 0. all: by vertex. */
static int list_weighted(struct model_pin *pin, const double *all, const struct model_cloth *cloth,
                         const struct scene_tree *tree, int node)
{
    uint32_t n = 0;
    for (uint32_t v = 0; v < cloth->mesh.n_vertices; v++)
        n += all[v] > 0;
    if (!n)
        return scene_tree_fail(tree, node,
                               "no vertex of cloth '%.60s' has a weight above 0, so nothing is "
                               "pinned",
                               cloth->name);
    pin->weight = cloth_alloc(n, sizeof *pin->weight, tree->error);
    pin->pick.vertices = cloth_alloc(n, sizeof *pin->pick.vertices, tree->error);
    for (uint32_t v = 0; v < cloth->mesh.n_vertices && !tree->error->code; v++)
        if (all[v] > 0) {
            pin->weight[pin->pick.n_vertices] = all[v];
            pin->pick.vertices[pin->pick.n_vertices++] = v;
        }
    return tree->error->code;
}

int scene_build_weights(struct model_pin *pin, const struct model_cloth *cloth,
                        struct scene_tree *tree, int node)
{
    const int weights = scene_tree_get(tree, node, "weights");
    const int file = scene_tree_get(tree, weights, "file");
    if (!weights)
        return CLOTH_OK;
    if (!(pin->stiffness > 0))
        return scene_tree_fail(tree, weights,
                               "weights are of soft pins, and this one has no stiffness; a finite "
                               "number > 0 (N/m) is expected");
    double *all = cloth_alloc(cloth->mesh.n_vertices, sizeof *all, tree->error);
    int code = tree->error->code;
    if (!code)
        code = file ? weigh_by_file(all, cloth, tree, file)
                    : weigh_by_uv(all, cloth, tree, scene_tree_get(tree, weights, "uv"));
    if (!code)
        code = list_weighted(pin, all, cloth, tree, weights);
    free(all);
    return code;
}
