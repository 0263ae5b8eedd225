/* Starts of vertices that differ from the shape of the mesh, and their additional masses. */
#include "cloth/scene/build/build.h"

#include <stdlib.h>

/* seen, number: as of scene_build_once, here and below. */
static int build_mass(struct model_mass *mass, const struct scene_tree *tree, int node,
                      const struct model_cloth *cloth, uint32_t *seen, uint32_t number,
                      struct cloth_error *error)
{
    const int code = scene_build_pick(&mass->pick, tree, node, cloth, error);
    return code ? code : scene_build_once(&mass->pick, tree, node, seen, number, "one mass", error);
}

static int build_masses(struct model_cloth *cloth, const struct scene_tree *tree, int list,
                        uint32_t *seen, struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < cloth->n_masses && !code; i++)
        code = build_mass(cloth->masses + i, tree, scene_tree_item(tree, list, i), cloth, seen,
                          i + 1, error);
    return code;
}

static int build_start(struct model_start *start, const struct scene_tree *tree, int node,
                       const struct model_cloth *cloth, uint32_t *seen, uint32_t number,
                       struct cloth_error *error)
{
    int code = scene_build_check_turn(&start->transform, tree, node, error);
    if (!code)
        code = scene_build_pick(&start->pick, tree, node, cloth, error);
    return code ? code
                : scene_build_once(&start->pick, tree, node, seen, number, "one start", error);
}

static int build_starts(struct model_cloth *cloth, const struct scene_tree *tree, int list,
                        uint32_t *seen, struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < cloth->n_starts && !code; i++)
        code = build_start(cloth->starts + i, tree, scene_tree_item(tree, list, i), cloth, seen,
                           cloth->n_masses + i + 1, error);
    return code;
}

int scene_build_starts(struct model_cloth *cloth, const struct scene_tree *tree, int node,
                       struct cloth_error *error)
{
    const int masses = scene_tree_get(tree, node, "masses");
    const int starts = scene_tree_get(tree, node, "start");
    const bool any = cloth->n_masses || cloth->n_starts;
    uint32_t *seen = scene_build_array(any ? cloth->mesh.n_vertices : 0, sizeof *seen, error);
    int code = seen ? build_masses(cloth, tree, masses, seen, error) : error->code;
    if (!code)
        code = build_starts(cloth, tree, starts, seen, error);
    free(seen);
    return code;
}
