/* Loads: forces on vertices, or along edges; and curves by which loads and the wind vary. Keys of
 * all curves stand in one array of the model, in the order in which the scene is built. */
#include "cloth/scene/build/build.h"

/* ---- Curves ---- */

static int build_keys(const struct scene_tree *tree, int list)
{
    struct model *model = tree->model;
    const size_t n = scene_tree_length(tree, list);
    struct phys_curve_key *key =
        scene_build_add(&model->curve_keys, &model->n_curve_keys, n, sizeof *key, tree->error);
    for (size_t i = 0; key && i < n; i++) {
        const int item = scene_tree_item(tree, list, i);
        double pair[2];
        scene_tree_vector(tree, item, 2, pair);
        key[i] = (struct phys_curve_key){pair[0], pair[1]};
        if (i && !(pair[0] > key[i - 1].time))
            return scene_tree_fail(tree, scene_tree_item(tree, item, 0),
                                   "the time of curve.keys[%zu] is %g, which does not come after "
                                   "%g, that of the one before it; times in ascending order are "
                                   "expected",
                                   i, pair[0], key[i - 1].time);
    }
    return tree->error->code;
}

/* Steps that are too few for a sine would see another one, or none. */
static int build_sine(struct model_curve *curve, const struct scene_tree *tree, int node)
{
    const double max = 0.5 / tree->model->h;
    curve->frequency = scene_tree_number(tree, node, "frequency");
    curve->phase = scene_tree_number(tree, node, "phase");
    if (curve->frequency < max)
        return CLOTH_OK;
    return scene_tree_fail(tree, scene_tree_get(tree, node, "frequency"),
                           "curve.sine.frequency is %g, but steps of time.h = %g s can follow "
                           "less than %g turns a second; fewer, or shorter steps, are expected",
                           curve->frequency, tree->model->h, max);
}

int scene_build_curve(uint32_t *number, const struct scene_tree *tree, int node)
{
    struct model *model = tree->model;
    const int curve = scene_tree_get(tree, node, "curve"),
              keys = scene_tree_get(tree, curve, "keys");
    const uint32_t first = model->n_curve_keys;
    *number = 0;
    if (!curve)
        return CLOTH_OK;
    struct model_curve *to =
        scene_build_add(&model->curves, &model->n_curves, 1, sizeof *to, tree->error);
    if (!to)
        return tree->error->code;
    *number = model->n_curves;
    to->first = first;
    to->n = (uint32_t)scene_tree_length(tree, keys);
    return keys ? build_keys(tree, keys)
                : build_sine(to, tree, scene_tree_get(tree, curve, "sine"));
}

/* ---- Loads ---- */

static int check_load_edges(const struct model_load *load, const struct scene_tree *tree, int list,
                            const struct model_cloth *cloth)
{
    for (uint32_t i = 0; i < load->n_edges; i++) {
        const uint32_t *end = load->edges[i];
        const int item = scene_tree_item(tree, list, i);
        if (scene_build_check_vertices(end, 2, cloth, tree, item))
            return tree->error->code;
        if (end[0] == end[1])
            return scene_tree_fail(tree, scene_tree_item(tree, item, 1),
                                   "an edge of a load joins vertex %u to itself; two vertices are "
                                   "expected",
                                   end[0]);
    }
    return CLOTH_OK;
}

int scene_build_loads(struct model_cloth *cloth, struct scene_tree *tree, int node)
{
    const int list = scene_tree_get(tree, node, "loads");
    int code = CLOTH_OK;
    for (uint32_t i = 0; !code && i < cloth->n_loads; i++) {
        struct model_load *load = &cloth->loads[i];
        const int item = scene_tree_item(tree, list, i);
        code = scene_build_pick_once(&load->pick, tree, item, cloth,
                                     "one load; to load it twice, write another load or a larger "
                                     "force") ||
               check_load_edges(load, tree, scene_tree_get(tree, item, "edges"), cloth) ||
               scene_build_curve(&load->curve, tree, item);
    }
    return code;
}
