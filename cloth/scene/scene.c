/* Reading a scene: load the document, edit it, check it and fill the model, build what is no copy;
 * each step relies on the one before. */
#include "cloth/scene/scene.h"
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/check.h"
#include "cloth/scene/schema/fabrics.h"
#include "cloth/scene/yaml/edit.h"

int scene_read(struct model *model, const char *path, size_t n_sets, const struct scene_set *sets,
               struct cloth_error *error)
{
    struct cloth_error own = {0}; /* the caller may want none, the steps below rely on one */
    struct scene_tree tree;
    *model = (struct model){0};
    int code = scene_tree_load(&tree, path, &scene_words, &own);
    tree.n_sets = n_sets;
    tree.sets = sets;
    if (!code)
        code = scene_edit_sets(&tree, &own);
    if (!code)
        code = scene_fabrics_fill(&tree, &own);
    if (!code)
        code = scene_check(model, &tree, &own);
    if (!code)
        code = scene_build_file(model, path, &own);
    if (!code)
        code = scene_build_world(model, &tree, &own);
    if (!code)
        code = scene_build_cloths(model, &tree, &own);
    if (!code)
        code = scene_build_check_obstacles(model, &tree, &own);
    if (!code)
        code = scene_build_sides(model, &tree, &own);
    if (!code)
        scene_build_contact(model, &tree);
    if (!code)
        code = scene_build_check_contact(model, &tree, &own);
    if (!code)
        code = scene_build_probes(model, &tree, &own);
    if (!code)
        scene_build_contact_idle(model);
    if (!code)
        code = scene_build_drape(model, &tree, &own);
    if (!code)
        code = scene_build_joints(model, &tree, &own);
    if (!code)
        code = scene_build_welds(model, &tree, &own);
    if (!code)
        code = scene_build_idle(model, &tree, &own);
    scene_tree_free(&tree);
    return code ? cloth_fail(error, code, "%s", own.text) : CLOTH_OK;
}
