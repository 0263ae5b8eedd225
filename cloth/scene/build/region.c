/* Parts of a cloth, each a bit in the mask of every vertex that it has: panels with a material,
 * then regions; and apart from these panels with a grain. */
#include "cloth/physics/curve.h"
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

static int mark_region(struct model_cloth *cloth, struct scene_tree *tree, int node, uint64_t bit)
{
    struct model_pick pick = {0};
    int code =
        scene_fill(&pick, &scene_region, tree, node) || scene_build_pick(&pick, tree, node, cloth);
    for (uint32_t i = 0; i < pick.n_vertices && !code; i++)
        cloth->mask[pick.vertices[i]] |= bit;
    for (uint32_t v = 0; v < cloth->mesh.n_vertices && !code; v++)
        if (pick.kind == MODEL_PICK_BOX &&
            model_in_box(cloth->mesh.position + 3 * (size_t)v, (const double(*)[3])pick.box))
            cloth->mask[v] |= bit;
    free(pick.vertices);
    if (code || has_edge(cloth, bit))
        return code;
    return scene_tree_fail(tree, node,
                           "no edge of cloth '%.60s' lies whole in this region; both ends of one, "
                           "at least, are expected",
                           cloth->name);
}

/* Keys that hold for a whole cloth must be the same in all its parts. what: "region" */
static int check_alike(const struct model_material *base, const struct model_material *material,
                       const char *what, const struct scene_tree *tree, int node)
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
    return scene_tree_fail(tree, scene_tree_get(tree, node, "material"),
                           "material '%.60s' of a %s has another %s than '%.60s', that of the "
                           "cloth; the same is expected",
                           material->name, what, other, base->name);
}

/* The material of the next part, whose number it then has. */
static int add_material(struct model_cloth *cloth, const char *what, const struct scene_tree *tree,
                        int node)
{
    const struct model_material *all = tree->model->materials;
    uint32_t *material = cloth->region + cloth->n_regions;
    int code = scene_build_material(material, cloth, tree, node);
    for (uint32_t k = 0; k <= cloth->n_regions && !code; k++) { /* all that bend do so alike */
        const uint32_t base = k < cloth->n_regions ? cloth->region[k] : cloth->material;
        code = check_alike(all + base, all + *material, what, tree, node);
    }
    cloth->n_regions += code == CLOTH_OK;
    return code;
}

/* ---- Panels ---- */

static void mark_group(const struct model_cloth *cloth, uint32_t group, unsigned char *room,
                       uint64_t *mask, uint64_t bit)
{
    memset(room, 0, cloth->mesh.n_vertices);
    mesh_group_vertices(&cloth->mesh, group, room);
    for (uint32_t v = 0; v < cloth->mesh.n_vertices; v++)
        mask[v] |= room[v] ? bit : 0;
}

static int build_grain(struct model_cloth *cloth, const struct scene_tree *tree, int node)
{
    const int grain = scene_tree_get(tree, node, "grain");
    double uv[2];
    if (!mesh_uv(&cloth->mesh, 0, uv))
        return scene_tree_fail(tree, grain,
                               "the grain of a panel is measured from u, but the mesh of cloth "
                               "'%.60s' has no uv; an OBJ file with vt, or a pattern, is expected",
                               cloth->name);
    double *turn = cloth->grain[cloth->n_grains++];
    phys_turn(scene_tree_number(tree, node, "grain"), turn, turn + 1);
    return CLOTH_OK;
}

/* room: a byte a vertex. */
static int build_panel(struct model_cloth *cloth, unsigned char *room,
                       const struct scene_tree *tree, int node)
{
    const bool has_material = scene_tree_get(tree, node, "material");
    const bool has_grain = scene_tree_get(tree, node, "grain");
    uint32_t group;
    if (scene_build_group(&group, cloth, tree, scene_tree_get(tree, node, "group")))
        return tree->error->code;
    if (!has_material && !has_grain)
        return scene_tree_fail(tree, node,
                               "a panel has neither material nor grain; one of them, at least, is "
                               "expected");
    if ((has_material && add_material(cloth, "panel", tree, node)) ||
        (has_grain && build_grain(cloth, tree, node)))
        return tree->error->code;
    if (has_material)
        mark_group(cloth, group, room, cloth->mask, UINT64_C(1) << (cloth->n_regions - 1));
    if (has_grain)
        mark_group(cloth, group, room, cloth->grain_mask, UINT64_C(1) << (cloth->n_grains - 1));
    return CLOTH_OK;
}

/* Checks that no group stands twice. */
static int region_check_once(const struct scene_tree *tree, int list, size_t i)
{
    const int group = scene_tree_get(tree, scene_tree_item(tree, list, i), "group");
    const char *name = scene_tree_scalar(tree, group);
    for (size_t k = 0; k < i; k++)
        if (!strcmp(scene_tree_text(tree, scene_tree_item(tree, list, k), "group"), name))
            return scene_tree_fail(tree, group,
                                   "group '%.60s' stands twice in panels; once is expected", name);
    return CLOTH_OK;
}

static int build_panels(struct model_cloth *cloth, const struct scene_tree *tree, int list)
{
    const size_t n = scene_tree_length(tree, list);
    if (!n)
        return CLOTH_OK;
    cloth->grain_mask = cloth_alloc(cloth->mesh.n_vertices, sizeof(uint64_t), tree->error);
    cloth->grain = cloth_alloc(n, sizeof *cloth->grain, tree->error);
    unsigned char *room = cloth_alloc(cloth->mesh.n_vertices, 1, tree->error);
    int code = tree->error->code;
    for (size_t i = 0; i < n && !code; i++)
        code = region_check_once(tree, list, i) ||
               build_panel(cloth, room, tree, scene_tree_item(tree, list, i));
    free(room);
    return code;
}

/* ---- Warnings ---- */

/* Counts triangles of other groups that have all their corners on the border of this one, as groups
 * may share vertices. mask: that of the panels with a key; bit: the number of this panel there. */
static uint32_t count_taken(const struct model_cloth *cloth, uint32_t group, const uint64_t *mask,
                            uint32_t bit, unsigned char *room)
{
    uint32_t taken = 0;
    memset(room, 0, cloth->mesh.n_triangles);
    mesh_group_triangles(&cloth->mesh, group, room);
    for (uint32_t t = 0; t < cloth->mesh.n_triangles; t++) {
        uint32_t corner[3];
        mesh_corners(&cloth->mesh, t, corner);
        taken += !room[t] && mesh_region(mask, 3, corner) == (int)bit;
    }
    return taken;
}

static void warn_of_taken(const struct model_cloth *cloth, const struct scene_tree *tree, int list)
{
    unsigned char *room = cloth_alloc(cloth->mesh.n_triangles, 1, tree->error);
    uint32_t material = 0, grain = 0;
    for (size_t i = 0; room && i < scene_tree_length(tree, list); i++) {
        const int node = scene_tree_item(tree, list, i);
        const bool has_grain = scene_tree_get(tree, node, "grain");
        const char *name = scene_tree_text(tree, node, "group");
        const uint32_t group = mesh_group_of(&cloth->mesh, name);
        uint32_t taken = 0;
        if (scene_tree_get(tree, node, "material"))
            taken = count_taken(cloth, group, cloth->mask, material++, room);
        if (has_grain && !taken)
            taken = count_taken(cloth, group, cloth->grain_mask, grain, room);
        grain += has_grain;
        if (taken)
            scene_build_warn(tree, node,
                             "triangles of cloth '%.60s' that are not in group '%.60s', but have "
                             "all corners in it, count as its own: %u",
                             cloth->name, name, taken);
    }
    free(room);
}

/* True if warp and weft differ in any value of the cloth. */
static bool has_directions(const struct model_cloth *cloth, const struct model *model)
{
    bool has = model_has_triangles(model, cloth);
    for (uint32_t i = 0; i <= cloth->n_regions; i++) {
        const struct model_material *material = model_material(model, cloth, i);
        has = has || material->weft_excess < 0 || material->weft_excess > 0 ||
              material->rigidity[0] < material->rigidity[1] ||
              material->rigidity[0] > material->rigidity[1];
    }
    return has;
}

/* ---- All ---- */

int scene_build_parts(struct model_cloth *cloth, struct scene_tree *tree, int node)
{
    const int regions = scene_tree_get(tree, node, "regions");
    const int panels = scene_tree_get(tree, node, "panels");
    const size_t n_regions = scene_tree_length(tree, regions);
    const size_t n = n_regions + scene_tree_length(tree, panels);
    if (!n)
        return CLOTH_OK;
    if (n > MODEL_MAX_REGIONS)
        return scene_tree_fail(tree, n_regions ? regions : panels,
                               "cloth '%.60s' has %zu panels and regions; at most %d are possible",
                               cloth->name, n, MODEL_MAX_REGIONS);
    cloth->mask = cloth_alloc(cloth->mesh.n_vertices, sizeof *cloth->mask, tree->error);
    cloth->region = cloth_alloc(n, sizeof *cloth->region, tree->error);
    int code = tree->error->code || build_panels(cloth, tree, panels);
    for (size_t i = 0; i < n_regions && !code; i++) {
        const int region = scene_tree_item(tree, regions, i);
        code = add_material(cloth, "region", tree, region) ||
               mark_region(cloth, tree, region, UINT64_C(1) << (cloth->n_regions - 1));
    }
    if (!code)
        warn_of_taken(cloth, tree, panels);
    if (!code && cloth->n_grains && !has_directions(cloth, tree->model))
        scene_build_warn(tree, panels,
                         "grain means nothing in cloth '%.60s': it turns model: triangles, and "
                         "stretch or bending of two numbers",
                         cloth->name);
    if (!cloth->n_regions) { /* panels with a grain alone */
        free(cloth->mask);
        cloth->mask = NULL;
    }
    return tree->error->code;
}
