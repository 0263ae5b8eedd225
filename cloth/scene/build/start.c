/* How vertices start where that is not the shape of the mesh, and what they weigh more. */
#include "cloth/scene/build/build.h"

#include <stdlib.h>

/* seen, number: as of scene_build_once, here and below. */
static int build_mass(struct model_mass *mass, const struct scene_tree *tree, int node,
                      const struct model_cloth *cloth, uint32_t *seen, uint32_t number,
                      struct cloth_error *error)
{
    mass->mass = scene_tree_number(tree, node, "mass");
    const int code = scene_build_pick(&mass->pick, tree, node, cloth, error);
    return code ? code : scene_build_once(&mass->pick, tree, node, seen, number, "one mass", error);
}

static int build_masses(struct model_cloth *cloth, const struct scene_tree *tree, int list,
                        uint32_t *seen, struct cloth_error *error)
{
    const uint32_t n = (uint32_t)scene_tree_length(tree, list);
    int code = CLOTH_OK;
    cloth->masses = scene_build_array(n, sizeof *cloth->masses, error);
    if (!cloth->masses)
        return error->code;
    cloth->n_masses = n;
    for (uint32_t i = 0; i < n && !code; i++)
        code = build_mass(cloth->masses + i, tree, scene_tree_item(tree, list, i), cloth, seen,
                          i + 1, error);
    return code;
}

static void build_wave(struct model_wave *wave, const struct scene_tree *tree, int node)
{
    if (!node)
        return;
    wave->phase = scene_tree_number(tree, node, "phase");
    scene_tree_vector(tree, scene_tree_get(tree, node, "vector"), 3, wave->vector);
    scene_tree_vector(tree, scene_tree_get(tree, node, "translate"), 3, wave->translate);
    scene_tree_vector(tree, scene_tree_get(tree, node, "velocity"), 3, wave->velocity);
}

static int build_start(struct model_start *start, const struct scene_tree *tree, int node,
                       const struct model_cloth *cloth, uint32_t *seen, uint32_t number,
                       struct cloth_error *error)
{
    const int velocity = scene_tree_get(tree, node, "velocity");
    scene_tree_vector(tree, scene_tree_get(tree, node, "about"), 3, start->about);
    scene_tree_vector(tree, scene_tree_get(tree, node, "spin"), 3, start->spin);
    start->has_velocity = velocity != 0;
    if (velocity)
        scene_tree_vector(tree, velocity, 3, start->velocity);
    build_wave(&start->wave, tree, scene_tree_get(tree, node, "wave"));
    int code = scene_build_transform(&start->transform, tree, node, error);
    if (!code)
        code = scene_build_pick(&start->pick, tree, node, cloth, error);
    return code ? code
                : scene_build_once(&start->pick, tree, node, seen, number, "one start", error);
}

static int build_starts(struct model_cloth *cloth, const struct scene_tree *tree, int list,
                        uint32_t *seen, struct cloth_error *error)
{
    const uint32_t n = (uint32_t)scene_tree_length(tree, list);
    int code = CLOTH_OK;
    cloth->starts = scene_build_array(n, sizeof *cloth->starts, error);
    if (!cloth->starts)
        return error->code;
    cloth->n_starts = n;
    for (uint32_t i = 0; i < n && !code; i++)
        code = build_start(cloth->starts + i, tree, scene_tree_item(tree, list, i), cloth, seen,
                           cloth->n_masses + i + 1, error);
    return code;
}

int scene_build_starts(struct model_cloth *cloth, const struct scene_tree *tree, int node,
                       struct cloth_error *error)
{
    const int masses = scene_tree_get(tree, node, "masses");
    const int starts = scene_tree_get(tree, node, "start");
    const size_t n = scene_tree_length(tree, masses) + scene_tree_length(tree, starts);
    uint32_t *seen = scene_build_array(n ? cloth->mesh.n_vertices : 0, sizeof *seen, error);
    int code = seen ? build_masses(cloth, tree, masses, seen, error) : error->code;
    if (!code)
        code = build_starts(cloth, tree, starts, seen, error);
    free(seen);
    return code;
}
