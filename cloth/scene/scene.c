/* Reading a scene: load the document, edit it, check it and fill the model, build the parts that
 * are no copy. Each step relies on the one before. */
#include "cloth/scene/scene.h"
#include "cloth/scene/build/build.h"
#include "cloth/scene/build/made.h"
#include "cloth/scene/schema/check.h"
#include "cloth/scene/schema/fabrics.h"
#include "cloth/scene/yaml/edit.h"

static scene_build_step *const steps[] = {scene_build_phases,        scene_build_world,
                                          scene_build_cloths,        scene_build_check_obstacles,
                                          scene_build_sides,         scene_build_contact,
                                          scene_build_check_contact, scene_build_probes,
                                          scene_build_contact_idle,  scene_build_hdf5,
                                          scene_build_drape,         scene_build_joints,
                                          scene_build_welds,         scene_build_mesh_welds,
                                          scene_build_seams,         scene_build_pieces,
                                          scene_build_short_edges,   scene_build_folds,
                                          scene_build_girths,        scene_build_warn_seams,
                                          scene_build_unusual,       scene_build_settings,
                                          scene_build_needs};

static int read_tree(struct model *model, struct scene_tree *tree, uint32_t phase,
                     struct cloth_error *error)
{
    int code = scene_edit_sets(tree, phase, error);
    if (!code)
        code = scene_fabrics_fill(tree, error);
    if (!code)
        code = scene_check(model, tree, error);
    if (!code)
        code = scene_build_file(model, tree->path, error);
    for (size_t i = 0; i < sizeof steps / sizeof *steps && !code; i++)
        code = steps[i](model, tree, error);
    return code;
}

static int read_phase(struct model *model, const char *path, uint32_t phase, size_t n_sets,
                      const struct scene_set *sets, struct scene_made *made,
                      struct cloth_error *error)
{
    struct cloth_error own = {0}; /* the caller may want none, the steps below rely on one */
    struct scene_tree tree;
    *model = (struct model){0};
    int code = scene_tree_load(&tree, path, &scene_words, &own);
    tree.n_sets = n_sets;
    tree.sets = sets;
    tree.made = made;
    if (!code)
        code = read_tree(model, &tree, phase, &own);
    const int map = code && phase ? scene_tree_phase(&tree, phase) : 0;
    const char *name = map ? scene_tree_text(&tree, map, "name") : NULL;
    if (code)
        cloth_fail(error, code, "%.*s%s%.60s%s", name ? 900 : 1023, own.text,
                   name ? "; in phase '" : "", name ? name : "", name ? "'" : "");
    scene_tree_free(&tree);
    return code;
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
    *models = code ? NULL : scene_build_array(*n, sizeof **models, error);
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
