/* Loads: forces on vertices, or along edges. */
#include "cloth/scene/build/build.h"

#include <stdlib.h>

static int check_edges(const struct model_load *load, const struct scene_tree *tree, int list,
                       const struct model_cloth *cloth, struct cloth_error *error)
{
    for (size_t i = 0; i < 2 * (size_t)load->n_edges; i++) {
        const int item = scene_tree_item(tree, scene_tree_item(tree, list, i / 2), i % 2);
        const uint32_t *end = &load->edges[i / 2][i % 2];
        if (*end >= cloth->mesh.n_vertices)
            return scene_build_no_vertex(*end, cloth, tree, item, error);
        if (i % 2 && end[0] == end[-1])
            return scene_tree_fail(tree, item, error,
                                   "an edge of a load joins vertex %u to itself; two vertices are "
                                   "expected",
                                   *end);
    }
    return CLOTH_OK;
}

/* seen: an entry for each vertex, the number of the last load that named it; number: of this load,
 * from 1. */
static int build_load(struct model_load *load, const struct scene_tree *tree, int node,
                      const struct model_cloth *cloth, uint32_t *seen, uint32_t number,
                      struct cloth_error *error)
{
    const int edges = scene_tree_get(tree, node, "edges");
    if (edges && scene_build_check_radius(tree, node, error))
        return error->code;
    if (edges)
        return check_edges(load, tree, edges, cloth, error);
    const int code = scene_build_pick(&load->pick, tree, node, cloth, error);
    if (code)
        return code;
    return scene_build_once(&load->pick, tree, node, seen, number,
                            "one load; to load it twice, write another load or a larger force",
                            error);
}

int scene_build_loads(struct model *model, struct model_cloth *cloth, const struct scene_tree *tree,
                      int node, struct cloth_error *error)
{
    int list = scene_tree_get(tree, node, "loads"), code = CLOTH_OK;
    const uint32_t n = cloth->n_loads;
    uint32_t *seen = scene_build_array(n ? cloth->mesh.n_vertices : 0, sizeof *seen, error);
    if (!seen)
        return error->code;
    for (uint32_t i = 0; !code && i < n; i++) {
        struct model_load *load = &cloth->loads[i];
        const int item = scene_tree_item(tree, list, i);
        code = build_load(load, tree, item, cloth, seen, i + 1, error);
        if (!code)
            code = scene_build_curve(model, &load->curve, tree, item, error);
    }
    free(seen);
    return code;
}
