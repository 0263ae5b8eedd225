/* Reading a scene: load the document, edit it, check it and fill the model, build the parts that
 * are no copy. Each step relies on the one before. */
#include "cloth/scene/scene.h"
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/check.h"

/* Steps of the whole scene, or of each cloth. */
static const struct {
    scene_build_step *whole;
    scene_build_cloth_step *each;
} steps[] = {{.whole = scene_build_phases},        {.whole = scene_build_world},
             {.each = scene_build_cloth},          {.whole = scene_build_check_obstacles},
             {.whole = scene_build_sides},         {.whole = scene_build_contact},
             {.whole = scene_build_check_contact}, {.whole = scene_build_probes},
             {.whole = scene_build_contact_idle},  {.whole = scene_build_hdf5},
             {.whole = scene_build_drape},         {.whole = scene_build_joints},
             {.whole = scene_build_welds},         {.each = scene_build_bands},
             {.each = scene_build_mesh_weld},      {.each = scene_build_seams},
             {.whole = scene_build_sewn},          {.each = scene_build_pieces},
             {.each = scene_build_folds},          {.each = scene_build_girths},
             {.each = scene_build_warn_seams},     {.whole = scene_build_unusual},
             {.whole = scene_build_grain},         {.whole = scene_build_settings},
             {.whole = scene_build_needs}};

static int read_tree(struct scene_tree *tree, uint32_t phase)
{
    int code = scene_edit_sets(tree, phase) || scene_fabrics_fill(tree) || scene_check(tree) ||
               scene_build_file(tree, tree->path);
    for (size_t i = 0; i < tree->n_included && !code; i++)
        code = scene_build_file(tree, tree->included[i]);
    for (size_t i = 0; i < sizeof steps / sizeof *steps && !code; i++) {
        const int cloths = scene_tree_get(tree, 1, "cloths");
        if (steps[i].whole && steps[i].whole(tree))
            return tree->error->code;
        for (uint32_t c = 0; steps[i].each && c < tree->model->n_cloths; c++)
            if (steps[i].each(tree, c, scene_tree_item(tree, cloths, c)))
                return tree->error->code;
    }
    return tree->error->code;
}

static int read_phase(struct model *model, const char *path, uint32_t phase, size_t n_sets,
                      const struct scene_set *sets, struct scene_made *made,
                      struct cloth_error *error)
{
    struct cloth_error own = {0}; /* the caller may want none, the steps below rely on one */
    struct scene_tree tree;
    *model = (struct model){0};
    int code = scene_tree_load_scene(&tree, path, &own);
    tree.model = model;
    tree.n_sets = n_sets;
    tree.sets = sets;
    tree.made = made;
    code = code ? code : read_tree(&tree, phase);
    const int map = code && phase ? scene_tree_phase(&tree, phase) : 0;
    const char *name = map ? scene_tree_text(&tree, map, "name") : NULL;
    if (code)
        cloth_fail(error, own.code, "%.*s%s%.60s%s", name ? 900 : 1023, own.text,
                   name ? "; in phase '" : "", name ? name : "", name ? "'" : "");
    scene_tree_free(&tree);
    return own.code;
}

int scene_read(struct model *model, const char *path, size_t n_sets, const struct scene_set *sets,
               struct cloth_error *error)
{
    struct scene_made made = {0};
    const int code = read_phase(model, path, 0, n_sets, sets, &made, error);
    scene_made_free(&made);
    return code;
}

int scene_read_phases(struct model **models, uint32_t *n, const char *path, size_t n_sets,
                      const struct scene_set *sets, struct cloth_error *error)
{
    struct scene_made made = {0};
    struct model first;
    int code = read_phase(&first, path, 0, n_sets, sets, &made, error);
    *n = code ? 0 : first.n_phases ? first.n_phases : 1;
    *models = code ? NULL : cloth_alloc(*n, sizeof **models, error);
    if (*models)
        **models = first;
    else {
        *n = 0;
        model_free(&first);
        code = code ? code : CLOTH_E_MEMORY;
    }
    for (uint32_t i = 1; i < *n && !code; i++)
        code = read_phase(*models + i, path, i, n_sets, sets, &made, error);
    scene_made_free(&made);
    return code;
}
