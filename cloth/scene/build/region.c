/* Regions of a cloth: each a bit in the mask of every vertex that it picks. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/check.h"

#include <stdlib.h>
#include <string.h>

static bool has_edge(const struct model_cloth *cloth, uint64_t bit)
{
    const struct mesh *mesh = &cloth->mesh;
    const uint64_t *mask = cloth->mask;
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        uint32_t corner[3];
        mesh_corners(mesh, t, corner);
        for (int i = 0; i < 3; i++)
            if (mask[corner[i]] & mask[corner[(i + 1) % 3]] & bit)
                return true;
    }
    for (uint32_t e = 0; e < mesh->n_lone_edges; e++)
        if (mask[mesh->lone_edge[2 * (size_t)e]] & mask[mesh->lone_edge[2 * (size_t)e + 1]] & bit)
            return true;
    return false;
}

static int mark(struct model_cloth *cloth, struct scene_tree *tree, int node, uint64_t bit,
                struct cloth_error *error)
{
    struct model_pick pick = {0};
    int code = scene_fill(&pick, &scene_region, tree, node, error);
    if (!code)
        code = scene_build_pick(&pick, tree, node, cloth, error);
    for (uint32_t i = 0; i < pick.n_vertices && !code; i++)
        cloth->mask[pick.vertices[i]] |= bit;
    for (uint32_t v = 0; v < cloth->mesh.n_vertices && !code; v++)
        if (pick.kind == MODEL_PICK_BOX &&
            model_in_box(cloth->mesh.position + 3 * (size_t)v, (const double(*)[3])pick.box))
            cloth->mask[v] |= bit;
    free(pick.vertices);
    if (code || has_edge(cloth, bit))
        return code;
    return scene_tree_fail(tree, node, error,
                           "no edge of cloth '%.60s' lies whole in this region; both ends of one, "
                           "at least, are expected",
                           cloth->name);
}

/* What holds for a cloth as a whole is the same in all its regions. */
static int check_alike(const struct model_material *base, const struct model_material *material,
                       const struct scene_tree *tree, int node, struct cloth_error *error)
{
    const bool bent = base->bending != MODEL_NO_BENDING && material->bending != MODEL_NO_BENDING;
    const char *other = NULL;
    if (base->model != material->model)
        other = "model";
    else if (bent && base->bending != material->bending)
        other = "bending.model";
    else if (base->both_diagonals != material->both_diagonals)
        other = "diagonals";
    if (!other)
        return CLOTH_OK;
    return scene_tree_fail(tree, scene_tree_get(tree, node, "material"), error,
                           "material '%.60s' of a region has another %s than '%.60s', that of the "
                           "cloth; the same is expected",
                           material->name, other, base->name);
}

static int build_region(struct model_cloth *cloth, const struct model *model, uint32_t i,
                        struct scene_tree *tree, int node, struct cloth_error *error)
{
    uint32_t *material = cloth->region + i;
    int code = scene_build_material(material, cloth, model, tree, node, error);
    for (uint32_t k = 0; k < i && !code; k++) /* so that all that bend do so alike */
        code = check_alike(model->materials + cloth->region[k], model->materials + *material, tree,
                           node, error);
    if (!code)
        code = check_alike(model->materials + cloth->material, model->materials + *material, tree,
                           node, error);
    return code ? code : mark(cloth, tree, node, (uint64_t)1 << i, error);
}

int scene_build_regions(struct model_cloth *cloth, const struct model *model,
                        struct scene_tree *tree, int node, struct cloth_error *error)
{
    const int list = scene_tree_get(tree, node, "regions");
    const size_t n = scene_tree_length(tree, list);
    if (!n)
        return CLOTH_OK;
    if (n > MODEL_MAX_REGIONS)
        return scene_tree_fail(tree, list, error,
                               "cloth '%.60s' has %zu regions; at most %d are possible",
                               cloth->name, n, MODEL_MAX_REGIONS);
    cloth->mask = scene_build_array(cloth->mesh.n_vertices, sizeof *cloth->mask, error);
    cloth->region = scene_build_array(n, sizeof *cloth->region, error);
    int code = cloth->mask && cloth->region ? CLOTH_OK : error->code;
    cloth->n_regions = code ? 0 : (uint32_t)n;
    for (uint32_t i = 0; i < n && !code; i++)
        code = build_region(cloth, model, i, tree, scene_tree_item(tree, list, i), error);
    return code;
}
