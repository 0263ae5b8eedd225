/* The fields of scientific frames. A field that a scene cannot have is an error: users do not
 * notice a field that a run leaves out. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/rules.h"

static bool has_triangles(const struct model *model)
{
    bool has = false;
    for (uint32_t c = 0; c < model->n_cloths; c++)
        has = has || model_has_triangles(model, model->cloths + c);
    return has;
}

static int check(const struct model *model, const struct scene_tree *tree, int item,
                 struct cloth_error *error)
{
    const char *word = scene_tree_scalar(tree, item);
    if (model->hdf5.stress && !has_triangles(model))
        return scene_tree_fail(tree, item, error,
                               "output.hdf5 has the field %s, which materials with model: "
                               "triangles have; no cloth has one",
                               word);
    if (model->hdf5.contact_force && !model_shows_contact(model))
        return scene_tree_fail(tree, item, error,
                               "output.hdf5 has the field %s, which contact: {mode: certified, "
                               "force: on} knows, where there is anything to touch",
                               word);
    return CLOTH_OK;
}

int scene_build_hdf5(struct model *model, const struct scene_tree *tree, struct cloth_error *error)
{
    const int output = scene_tree_get(tree, 1, "output"),
              hdf5 = output ? scene_tree_get(tree, output, "hdf5") : 0,
              list = hdf5 ? scene_tree_get(tree, hdf5, "fields") : 0;
    int code = CLOTH_OK;
    for (size_t i = 0; list && i < scene_tree_length(tree, list) && !code; i++) {
        const int item = scene_tree_item(tree, list, i);
        const char *word = scene_tree_scalar(tree, item);
        bool *wants =
            (bool *)((char *)&model->hdf5 + scene_word_value(scene_hdf5_fields, word, NULL));
        if (*wants)
            return scene_tree_fail(tree, item, error,
                                   "%s stands twice in the fields of output.hdf5", word);
        *wants = true;
        code = check(model, tree, item, error);
    }
    return code;
}
