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
                                   "the time of key %zu, from 0, is %g, which does not come after "
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

/* Adds a curve of a list of keys, if there is one. NULL: no memory. */
static struct model_curve *add_curve(uint32_t *number, const struct scene_tree *tree, int list)
{
    struct model *model = tree->model;
    struct model_curve *to =
        scene_build_add(&model->curves, &model->n_curves, 1, sizeof *to, tree->error);
    if (!to)
        return NULL;
    *number = model->n_curves;
    to->first = model->n_curve_keys;
    to->n = (uint32_t)scene_tree_length(tree, list);
    return to;
}

/* A curve of a list of keys. */
static int build_curve(uint32_t *number, const struct scene_tree *tree, int list)
{
    return add_curve(number, tree, list) ? build_keys(tree, list) : tree->error->code;
}

int scene_build_curve(uint32_t *number, const struct scene_tree *tree, int node)
{
    const int curve = scene_tree_get(tree, node, "curve"),
              keys = scene_tree_get(tree, curve, "keys");
    *number = 0;
    if (!curve)
        return CLOTH_OK;
    if (keys)
        return build_curve(number, tree, keys);
    struct model_curve *to = add_curve(number, tree, 0);
    return to ? build_sine(to, tree, scene_tree_get(tree, curve, "sine")) : tree->error->code;
}

/* ---- Sizes ---- */

static const double LEAST_SIZE = 0.1, MOST_SIZE = 10; /* beyond these hardly anything is cloth */

int scene_build_size(uint32_t *number, const struct scene_tree *tree, int list)
{
    const struct model *model = tree->model;
    if (!list)
        return CLOTH_OK;
    const int code = build_curve(number, tree, list);
    for (uint32_t i = 0; !code && i < model->curves[*number - 1].n; i++) {
        const double factor = model->curve_keys[model->curves[*number - 1].first + i].factor;
        if (!(factor >= LEAST_SIZE && factor <= MOST_SIZE))
            return scene_tree_fail(tree, scene_tree_item(tree, scene_tree_item(tree, list, i), 1),
                                   "a size is %g times that of the mesh; a factor from %g to %g "
                                   "is expected",
                                   factor, LEAST_SIZE, MOST_SIZE);
    }
    tree->model->sizes = true;
    return code;
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
