/* Curves by which loads and the wind vary. Keys of all curves stand in one array of the model, in
 * the order in which the scene is built. */
#include "cloth/scene/build/build.h"

#include <stdlib.h>

/* Makes room for one more curve with n more keys. */
static int grow(struct model *model, size_t n, struct cloth_error *error)
{
    struct model_curve *curves = realloc(model->curves, (model->n_curves + 1) * sizeof *curves);
    model->curves = curves ? curves : model->curves;
    struct phys_curve_key *curve_keys =
        realloc(model->curve_keys, (model->n_curve_keys + n + 1) * sizeof *curve_keys);
    model->curve_keys = curve_keys ? curve_keys : model->curve_keys;
    return curves && curve_keys
               ? CLOTH_OK
               : cloth_fail(error, CLOTH_E_MEMORY, "out of memory while the scene is read");
}

static int build_keys(struct phys_curve_key *curve_keys, const struct scene_tree *tree, int list,
                      struct cloth_error *error)
{
    for (size_t i = 0; i < scene_tree_length(tree, list); i++) {
        const int item = scene_tree_item(tree, list, i);
        double pair[2];
        scene_tree_vector(tree, item, 2, pair);
        curve_keys[i] = (struct phys_curve_key){pair[0], pair[1]};
        if (i && !(pair[0] > curve_keys[i - 1].time))
            return scene_tree_fail(tree, scene_tree_item(tree, item, 0), error,
                                   "the time of curve.keys[%zu] is %g, which does not come after "
                                   "%g, that of the one before it; times in ascending order are "
                                   "expected",
                                   i, pair[0], curve_keys[i - 1].time);
    }
    return CLOTH_OK;
}

/* Steps that are too few for a sine would see another one, or none. */
static int build_sine(struct model_curve *curve, const struct model *model,
                      const struct scene_tree *tree, int node, struct cloth_error *error)
{
    const double max = 0.5 / model->h;
    curve->frequency = scene_tree_number(tree, node, "frequency");
    curve->phase = scene_tree_number(tree, node, "phase");
    if (curve->frequency < max)
        return CLOTH_OK;
    return scene_tree_fail(tree, scene_tree_get(tree, node, "frequency"), error,
                           "curve.sine.frequency is %g, but steps of time.h = %g s can follow "
                           "less than %g turns a second; fewer, or shorter steps, are expected",
                           curve->frequency, model->h, max);
}

int scene_build_curve(struct model *model, uint32_t *number, const struct scene_tree *tree,
                      int node, struct cloth_error *error)
{
    const int curve = scene_tree_get(tree, node, "curve");
    *number = 0;
    if (!curve)
        return CLOTH_OK;
    const int keys = scene_tree_get(tree, curve, "keys");
    const size_t n = scene_tree_length(tree, keys);
    int code = grow(model, n, error);
    if (code)
        return code;
    struct model_curve *to = model->curves + model->n_curves;
    *to = (struct model_curve){.first = model->n_curve_keys, .n = (uint32_t)n};
    code = keys ? build_keys(model->curve_keys + model->n_curve_keys, tree, keys, error)
                : build_sine(to, model, tree, scene_tree_get(tree, curve, "sine"), error);
    if (code)
        return code;
    model->n_curve_keys += (uint32_t)n;
    *number = ++model->n_curves;
    return CLOTH_OK;
}
