/* How pins move. Keys of all motions stand in one array of the model, in the order of the pins. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/yaml/scalar.h"

#include <math.h>
#include <stdlib.h>

/* Makes room for one more motion with n more keys. */
static int grow(struct model *model, size_t n, struct cloth_error *error)
{
    struct model_motion *motions =
        realloc(model->motions, (model->n_motions + 1) * sizeof *motions);
    model->motions = motions ? motions : model->motions;
    struct phys_key *keys = realloc(model->keys, (model->n_keys + n) * sizeof *keys);
    model->keys = keys ? keys : model->keys;
    return motions && keys
               ? CLOTH_OK
               : cloth_fail(error, CLOTH_E_MEMORY, "out of memory while the scene is read");
}

static int build_times(struct phys_key *keys, const struct scene_tree *tree, int list, size_t n,
                       struct cloth_error *error)
{
    for (size_t i = 0; i < n; i++) {
        scene_scalar_number(scene_tree_scalar(tree, scene_tree_item(tree, list, i)), &keys[i].time);
        if (i && !(keys[i].time > keys[i - 1].time))
            return scene_tree_fail(tree, scene_tree_item(tree, list, i), error,
                                   "the time %g of a motion does not come after %g, the one before "
                                   "it; times in ascending order are expected",
                                   keys[i].time, keys[i - 1].time);
    }
    return CLOTH_OK;
}

static int check_length(const struct scene_tree *tree, int list, const char *what, size_t n,
                        struct cloth_error *error)
{
    if (!list || scene_tree_length(tree, list) == n)
        return CLOTH_OK;
    return scene_tree_fail(tree, list, error,
                           "%s of a motion has %zu entries, but there are %zu times; as many are "
                           "expected",
                           what, scene_tree_length(tree, list), n);
}

static int build_rotate(struct phys_key *key, const struct scene_tree *tree, int node,
                        struct cloth_error *error)
{
    double square = 0, largest = 0;
    scene_tree_vector(tree, node, 4, key->rotate);
    for (int i = 0; i < 4; i++)
        largest = fmax(largest, fabs(key->rotate[i]));
    if (largest <= 0)
        return scene_tree_fail(tree, node, error,
                               "a rotation of a motion is zero; a quaternion [w, x, y, z] that is "
                               "not is expected");
    for (int i = 0; i < 4; i++) {
        key->rotate[i] /= largest; /* so that the squares neither overflow nor vanish */
        square += key->rotate[i] * key->rotate[i];
    }
    for (int i = 0; i < 4; i++)
        key->rotate[i] /= sqrt(square);
    return CLOTH_OK;
}

/* Halfway between opposite quaternions there is no rotation. */
static int check_turns(const struct phys_key *keys, const struct scene_tree *tree, int list,
                       size_t n, struct cloth_error *error)
{
    for (size_t k = 1; k < n; k++) {
        double dot = 0;
        for (int i = 0; i < 4; i++)
            dot += keys[k].rotate[i] * keys[k - 1].rotate[i];
        if (fabs(dot) < 1e-3)
            return scene_tree_fail(tree, scene_tree_item(tree, list, k), error,
                                   "a rotation of a motion is half a turn from the one before, so "
                                   "that its way is open; smaller ones are expected");
    }
    return CLOTH_OK;
}

/* What does not begin where the vertices are would tear them away in the first step. */
static int check_begin(const struct phys_key *keys, size_t n, const double about[3],
                       const struct scene_tree *tree, int node, struct cloth_error *error)
{
    struct phys_pose pose;
    double away = 0;
    phys_pose_at(n, keys, about, 0, &pose);
    for (int i = 0; i < 3; i++) {
        away = fmax(away, fabs(pose.translate[i]));
        for (int k = 0; k < 3; k++)
            away = fmax(away, fabs(pose.turn[i][k] - (i == k)));
    }
    if (away <= 1e-12)
        return CLOTH_OK;
    return scene_tree_fail(tree, node, error,
                           "a motion does not begin where the vertices start; at time 0 no shift "
                           "and no rotation are expected");
}

int scene_build_motion(struct model *model, struct model_pin *pin, const struct scene_tree *tree,
                       int node, struct cloth_error *error)
{
    const int times = scene_tree_get(tree, node, "times");
    const int translate = scene_tree_get(tree, node, "translate");
    const int rotate = scene_tree_get(tree, node, "rotate");
    const size_t n = scene_tree_length(tree, times);
    int code = grow(model, n, error);
    if (code)
        return code;
    struct model_motion *motion = &model->motions[model->n_motions];
    struct phys_key *keys = model->keys + model->n_keys;
    *motion = (struct model_motion){.first = model->n_keys, .n = (uint32_t)n};
    scene_tree_vector(tree, scene_tree_get(tree, node, "about"), 3, motion->about);
    for (size_t i = 0; i < n; i++)
        keys[i] = (struct phys_key){.rotate = {1, 0, 0, 0}};
    code = build_times(keys, tree, times, n, error);
    if (!code)
        code = check_length(tree, translate, "translate", n, error);
    if (!code)
        code = check_length(tree, rotate, "rotate", n, error);
    for (size_t i = 0; translate && i < n && !code; i++)
        scene_tree_vector(tree, scene_tree_item(tree, translate, i), 3, keys[i].translate);
    for (size_t i = 0; rotate && i < n && !code; i++)
        code = build_rotate(keys + i, tree, scene_tree_item(tree, rotate, i), error);
    if (!code && rotate)
        code = check_turns(keys, tree, rotate, n, error);
    if (!code)
        code = check_begin(keys, n, motion->about, tree, node, error);
    if (code)
        return code;
    model->n_keys += (uint32_t)n;
    pin->motion = ++model->n_motions;
    return CLOTH_OK;
}
