/* A cloth: its parts one after the other, each of which needs those before. */
#include "cloth/element/kind.h"
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/rules.h"

#include <string.h>

/* ---- Moduli ---- */

/* True if the scene gives the material, by number, a key; triangles may stretch by a curve. */
static bool has_key(const struct scene_tree *tree, uint32_t number, const char *key)
{
    const struct model_material *material = tree->model->materials + number;
    const int materials = scene_tree_get(tree, 1, "materials");
    const int node = scene_tree_get(tree, materials, material->name);
    const bool curved = material->model == MODEL_TRIANGLES && !strcmp(key, "stretch") &&
                        scene_tree_get(tree, node, "stretch_curve");
    return curved || scene_tree_get(tree, node, key) != 0;
}

/* True if each material of the cloth has a key: then no element needs a check. */
static bool all_have(const struct scene_tree *tree, const struct model_cloth *cloth,
                     const char *key)
{
    bool all = has_key(tree, cloth->material, key);
    for (uint32_t i = 0; i < cloth->n_regions; i++)
        all = all && has_key(tree, cloth->region[i], key);
    return all;
}

/* Checks that the material of an element of n vertices has a key. format: of the error, with the
 * names of the cloth and the material. */
static int check_element(const struct model_cloth *cloth, size_t n, const uint32_t *vertex,
                         const char *key, const char *format, const struct scene_tree *tree,
                         int node)
{
    const uint32_t material = model_material_of(cloth, n, vertex);
    if (has_key(tree, material, key))
        return CLOTH_OK;
    return scene_tree_fail(tree, scene_tree_get(tree, node, "material"), format, cloth->name,
                           tree->model->materials[material].name);
}

/* Triangles need stretch, edges without triangles need EA, so no table of keys can ask for them. By
 * springs each side of a triangle has a material. Else each triangle has one. */
static int check_moduli(const struct model_cloth *cloth, const struct scene_tree *tree, int node)
{
    const struct mesh *mesh = &cloth->mesh;
    const bool springs = !model_has_triangles(tree->model, cloth);
    const uint32_t n_triangles = all_have(tree, cloth, "stretch") ? 0 : mesh->n_triangles;
    const uint32_t n_links = all_have(tree, cloth, "ea") ? 0 : mesh->n_bare_edges;
    int code = CLOTH_OK;
    for (uint32_t t = 0; t < n_triangles && !code; t++) {
        uint32_t corner[4];
        mesh_corners(mesh, t, corner);
        corner[3] = corner[0];
        for (int i = 0; i < (springs ? 3 : 1) && !code; i++)
            code = check_element(cloth, springs ? 2 : 3, corner + i, "stretch",
                                 "cloth '%.60s' has triangles, for which material '%.60s' has no "
                                 "stretch; a finite number >= 0 or a list of 2 of them (N/m) is "
                                 "expected",
                                 tree, node);
    }
    for (uint32_t e = 0; e < n_links && !code; e++)
        code = check_element(cloth, 2, mesh->lone_edge + 2 * (size_t)e, "ea",
                             "cloth '%.60s' has edges without triangles, for which material "
                             "'%.60s' has no ea; a finite number >= 0 (N) is expected: the spring "
                             "constant of such an edge times its length (stretch is of triangles "
                             "and threads)",
                             tree, node);
    return code;
}

/* ---- Parts ---- */

static int build_pins(struct model_cloth *cloth, struct scene_tree *tree, int node)
{
    const int list = scene_tree_get(tree, node, "pins");
    int code = CLOTH_OK;
    for (uint32_t i = 0; !code && i < cloth->n_pins; i++) {
        const int pin = scene_tree_item(tree, list, i);
        code = scene_build_weights(&cloth->pins[i], cloth, tree, pin) ||
               scene_build_pick(&cloth->pins[i].pick, tree, pin, cloth) ||
               scene_build_constraint(&cloth->pins[i], tree, pin);
    }
    return code;
}

/* A shape of its own at rest, from uv. */
static int build_rest(struct model_cloth *cloth, const struct scene_tree *tree, int node)
{
    const uint32_t n = cloth->mesh.n_vertices + cloth->mesh.n_more_uv;
    if (!scene_word_value(scene_rests, scene_tree_text(tree, node, "rest"), NULL))
        return CLOTH_OK;
    cloth->rest = cloth_alloc(1, sizeof *cloth->rest, tree->error);
    if (!cloth->rest)
        return tree->error->code;
    *cloth->rest = cloth->mesh;
    cloth->rest->placed_by_uv = true;
    cloth->rest->position = cloth_alloc(n, 3 * sizeof(double), tree->error);
    if (!cloth->rest->position)
        return tree->error->code;
    for (uint32_t v = 0; v < n; v++)
        if (!mesh_uv(&cloth->mesh, v, cloth->rest->position + 3 * (size_t)v))
            return scene_tree_fail(tree, scene_tree_get(tree, node, "rest"),
                                   "rest is uv, but the mesh of cloth '%.60s' has none; a grid, an "
                                   "OBJ file with vt, or rest: position is expected",
                                   cloth->name);
    return CLOTH_OK;
}

/* A matrix of springs can hold no other elements. */
static void choose_format(struct model *model, const struct model_cloth *cloth)
{
    if (model->format == SOLVE_SPRINGS && element_in_matrix(model, cloth))
        model->format = SOLVE_HALF;
}

int scene_build_cloth(struct scene_tree *tree, uint32_t i, int node)
{
    struct model_cloth *cloth = tree->model->cloths + i;
    if (scene_build_name(tree, SCENE_CLOTHS, i, node) ||
        scene_build_material(&cloth->material, cloth, tree, node) ||
        scene_build_mesh(cloth, tree, node) || scene_build_borders(cloth, tree, node) ||
        build_rest(cloth, tree, node) || scene_build_parts(cloth, tree, node) ||
        check_moduli(cloth, tree, node))
        return tree->error->code;
    choose_format(tree->model, cloth);
    return build_pins(cloth, tree, node) || scene_build_settled(cloth, tree, node) ||
           scene_build_starts(cloth, tree, node) || scene_build_loads(cloth, tree, node);
}
