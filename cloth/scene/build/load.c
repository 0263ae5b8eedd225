/* Loads: forces on vertices, or along edges; and curves by which loads and the wind vary. Keys of
 * all curves stand in one array of the model, in the order in which the scene is built. */
#include "cloth/scene/build/build.h"

/* ---- Curves ---- */

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
    struct model_curve *to = scene_build_grow(model->curves, model->n_curves, 1, sizeof *to, error);
    model->curves = to ? to : model->curves;
    struct phys_curve_key *curve_keys =
        scene_build_grow(model->curve_keys, model->n_curve_keys, n + 1, sizeof *curve_keys, error);
    model->curve_keys = curve_keys ? curve_keys : model->curve_keys;
    if (!to || !curve_keys)
        return error->code;
    to += model->n_curves;
    *to = (struct model_curve){.first = model->n_curve_keys, .n = (uint32_t)n};
    const int code = keys ? build_keys(model->curve_keys + model->n_curve_keys, tree, keys, error)
                          : build_sine(to, model, tree, scene_tree_get(tree, curve, "sine"), error);
    if (code)
        return code;
    model->n_curve_keys += (uint32_t)n;
    *number = ++model->n_curves;
    return CLOTH_OK;
}

/* ---- Loads ---- */

static int check_load_edges(const struct model_load *load, const struct scene_tree *tree, int list,
                            const struct model_cloth *cloth, struct cloth_error *error)
{
    for (size_t i = 0; i < 2 * (size_t)load->n_edges; i++) {
        const int item = scene_tree_item(tree, scene_tree_item(tree, list, i / 2), i % 2);
        const uint32_t *end = &load->edges[i / 2][i % 2];
        if (*end >= cloth->mesh.n_vertices)
            return scene_build_no_vertex(*end, cloth, tree, item, error);
        if (i % 2 && end[0] == end[-1])
            return scene_tree_fail(tree, item, error,
                                   "an edge of a load joins vertex %u to itself; two vertices are "
                                   "expected",
                                   *end);
    }
    return CLOTH_OK;
}

static int build_load(struct model_load *load, const struct scene_tree *tree, int node,
                      const struct model_cloth *cloth, struct cloth_error *error)
{
    const int edges = scene_tree_get(tree, node, "edges");
    if (edges && scene_build_check_radius(tree, node, error))
        return error->code;
    if (edges)
        return check_load_edges(load, tree, edges, cloth, error);
    return scene_build_pick_once(&load->pick, tree, node, cloth,
                                 "one load; to load it twice, write another load or a larger force",
                                 error);
}

int scene_build_loads(struct model *model, struct model_cloth *cloth, const struct scene_tree *tree,
                      int node, struct cloth_error *error)
{
    int list = scene_tree_get(tree, node, "loads"), code = CLOTH_OK;
    for (uint32_t i = 0; !code && i < cloth->n_loads; i++) {
        struct model_load *load = &cloth->loads[i];
        const int item = scene_tree_item(tree, list, i);
        code = build_load(load, tree, item, cloth, error);
        if (!code)
            code = scene_build_curve(model, &load->curve, tree, item, error);
    }
    return code;
}
