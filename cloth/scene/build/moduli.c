/* Which moduli a material needs depends on what the meshes have: triangles need stretch, edges
 * without triangles need EA. So no table of keys can ask for them. */
#include "cloth/scene/build/build.h"

struct check {
    const struct model *model;
    const struct model_cloth *cloth;
    const struct scene_tree *tree;
    int node; /* of the cloth */
    struct cloth_error *error;
};

/* True if the scene gives the material, by number, a key. */
static bool has_key(const struct check *check, uint32_t material, const char *key)
{
    const int materials = scene_tree_get(check->tree, 1, "materials");
    const int node = scene_tree_get(check->tree, materials, check->model->materials[material].name);
    return scene_tree_get(check->tree, node, key) != 0;
}

static int fail_without(const struct check *check, uint32_t material, const char *format)
{
    const int place = scene_tree_get(check->tree, check->node, "material");
    return scene_tree_fail(check->tree, place, check->error, format, check->cloth->name,
                           check->model->materials[material].name);
}

/* True if each material of the cloth has a key: then no triangle needs a check. */
static bool all_have(const struct check *check, const char *key)
{
    bool all = has_key(check, check->cloth->material, key);
    for (uint32_t i = 0; i < check->cloth->n_regions; i++)
        all = all && has_key(check, check->cloth->region[i], key);
    return all;
}

/* Springs: each side of a triangle has a material. Else each triangle has one. */
static int check_triangles(const struct check *check)
{
    const struct model_cloth *cloth = check->cloth;
    const bool springs = check->model->materials[cloth->material].model == MODEL_SPRINGS;
    const uint32_t n = all_have(check, "stretch") ? 0 : cloth->mesh.n_triangles;
    for (uint32_t t = 0; t < n; t++) {
        uint32_t corner[4];
        mesh_corners(&cloth->mesh, t, corner);
        corner[3] = corner[0];
        for (int i = 0; i < (springs ? 3 : 1); i++) {
            const uint32_t material = model_material_of(cloth, springs ? 2 : 3, corner + i);
            if (!has_key(check, material, "stretch"))
                return fail_without(
                    check, material,
                    "cloth '%.60s' has triangles, for which material '%.60s' has no "
                    "stretch; a finite number >= 0 or a list of 2 of them (N/m) is "
                    "expected");
        }
    }
    return CLOTH_OK;
}

static int check_links(const struct check *check)
{
    const struct mesh *mesh = &check->cloth->mesh;
    const uint32_t n = all_have(check, "ea") ? 0 : mesh->n_bare_edges;
    for (uint32_t e = 0; e < n; e++) {
        const uint32_t material =
            model_material_of(check->cloth, 2, mesh->lone_edge + 2 * (size_t)e);
        if (!has_key(check, material, "ea"))
            return fail_without(
                check, material,
                "cloth '%.60s' has edges without triangles, for which material '%.60s' "
                "has no ea; a finite number >= 0 (N) is expected: the spring constant of "
                "such an edge times its length (stretch is of triangles and threads)");
    }
    return CLOTH_OK;
}

int scene_build_check_moduli(const struct model_cloth *cloth, const struct model *model,
                             const struct scene_tree *tree, int node, struct cloth_error *error)
{
    const struct check check = {model, cloth, tree, node, error};
    const int code = check_triangles(&check);
    return code ? code : check_links(&check);
}
