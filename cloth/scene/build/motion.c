/* Motions by key frames. Keys of all motions stand in one array of the model, obstacles first, then
 * in the order of the pins. Quaternions of two keys are interpolated along the shorter way. Key
 * frames that name one axis turn all the way from angle to angle: further keys stand between them.
 */
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/rules.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double MOST_APART = 1.0 / 36; /* turns between keys: speeds vary by 0.2 % */
static const double MOST_TURNS = 1000;     /* between key frames: 36,000 keys */

static int check_key_times(const struct scene_tree *tree, int list)
{
    double before = 0, time;
    for (size_t i = 0; i < scene_tree_length(tree, list); i++, before = time) {
        scene_tree_vector(tree, scene_tree_item(tree, list, i), 1, &time);
        if (i && !(time > before))
            return scene_tree_fail(tree, scene_tree_item(tree, list, i),
                                   "motion.times[%zu] is %g, which does not come after %g, the one "
                                   "before it; times in ascending order are expected",
                                   i, time, before);
    }
    return CLOTH_OK;
}

static int check_motion_length(const struct scene_tree *tree, int list, const char *what, size_t n)
{
    if (!list || scene_tree_length(tree, list) == n)
        return CLOTH_OK;
    return scene_tree_fail(tree, list,
                           "%s of a motion has %zu entries, but there are %zu times; as many are "
                           "expected",
                           what, scene_tree_length(tree, list), n);
}

/* Makes n numbers of length 1; false: all are zero. */
static bool make_unit(double *value, size_t n)
{
    double square = 0, largest = 0;
    for (size_t i = 0; i < n; i++)
        largest = fmax(largest, fabs(value[i]));
    if (largest <= 0)
        return false;
    for (size_t i = 0; i < n; i++) {
        value[i] /= largest; /* so that the squares neither overflow nor vanish */
        square += value[i] * value[i];
    }
    for (size_t i = 0; i < n; i++)
        value[i] /= sqrt(square);
    return true;
}

/* The turns of a rotation by axis and angle. */
static double turns_of(const struct scene_tree *tree, int node)
{
    return scene_tree_get(tree, node, "turns") ? scene_tree_number(tree, node, "turns")
                                               : scene_tree_number(tree, node, "degrees") / 360;
}

/* By the axis of a rotation and these turns. */
static int build_turn(double rotate[4], const struct scene_tree *tree, int node, double turns)
{
    const double half = M_PI * remainder(turns, 2); /* half of the angle, in radians */
    double axis[3];
    if (scene_build_direction(axis, "the axis of a rotation", tree,
                              scene_tree_get(tree, node, "axis")))
        return tree->error->code;
    rotate[0] = cos(half);
    for (int i = 0; i < 3; i++)
        rotate[1 + i] = sin(half) * axis[i];
    return CLOTH_OK;
}

int scene_build_quaternion(double rotate[4], const struct scene_tree *tree, int node)
{
    if (scene_tree_is(tree, node, YAML_MAPPING_NODE))
        return build_turn(rotate, tree, node, turns_of(tree, node));
    scene_tree_vector(tree, node, 4, rotate);
    return CLOTH_OK;
}

int scene_build_rotation(double rotate[4], const char *what, const struct scene_tree *tree,
                         int node)
{
    if (scene_build_quaternion(rotate, tree, node))
        return tree->error->code;
    if (make_unit(rotate, 4))
        return CLOTH_OK;
    return scene_tree_fail(tree, node,
                           "%s is zero; a quaternion [w, x, y, z] that is not is expected", what);
}

int scene_build_direction(double direction[3], const char *what, const struct scene_tree *tree,
                          int node)
{
    scene_tree_vector(tree, node, 3, direction);
    if (make_unit(direction, 3))
        return CLOTH_OK;
    return scene_tree_fail(tree, node, "%s is zero; a direction is expected", what);
}

/* ---- Key frames ---- */

/* The lists of a motion; 0: it has none. */
struct key_frames {
    const struct scene_tree *tree;
    int times, translate, rotate;
    size_t n;
};

/* The turns from a key frame to the next, where both name one axis; else 0. */
static double turns_from(const struct key_frames *frames, size_t i)
{
    const struct scene_tree *tree = frames->tree;
    double axis[2][3];
    int node[2];
    for (size_t k = 0; k < 2; k++) {
        node[k] = frames->rotate ? scene_tree_item(tree, frames->rotate, i + k) : 0;
        if (!scene_tree_is(tree, node[k], YAML_MAPPING_NODE))
            return 0;
        scene_tree_vector(tree, scene_tree_get(tree, node[k], "axis"), 3, axis[k]);
    }
    return memcmp(axis[0], axis[1], sizeof axis[0])
               ? 0
               : turns_of(tree, node[1]) - turns_of(tree, node[0]);
}

/* The keys of a key frame and of the way to the next one. */
static size_t count_keys(const struct key_frames *frames, size_t i)
{
    const double turns = i + 1 < frames->n ? fabs(turns_from(frames, i)) : 0;
    return turns > MOST_APART ? (size_t)ceil(turns / MOST_APART) : 1;
}

static int check_key_frames(const struct key_frames *frames)
{
    const struct scene_tree *tree = frames->tree;
    if (check_key_times(tree, frames->times) ||
        check_motion_length(tree, frames->translate, "translate", frames->n) ||
        check_motion_length(tree, frames->rotate, "rotate", frames->n))
        return tree->error->code;
    for (size_t i = 1; i < frames->n; i++)
        if (!(fabs(turns_from(frames, i - 1)) <= MOST_TURNS))
            return scene_tree_fail(tree, scene_tree_item(tree, frames->rotate, i),
                                   "a rotation of a motion is %g turns from the one before; at "
                                   "most %g are expected",
                                   fabs(turns_from(frames, i - 1)), MOST_TURNS);
    return CLOTH_OK;
}

/* n numbers of a list that follow its item i by a part of the way to the next. */
static void read_between(double *value, size_t n, const struct key_frames *frames, int list,
                         size_t i, double part)
{
    double next[3];
    scene_tree_vector(frames->tree, scene_tree_item(frames->tree, list, i), n, value);
    if (part <= 0)
        return;
    scene_tree_vector(frames->tree, scene_tree_item(frames->tree, list, i + 1), n, next);
    for (size_t c = 0; c < n; c++)
        value[c] += part * (next[c] - value[c]);
}

static int build_key(struct phys_key *key, const struct key_frames *frames, size_t i, double part)
{
    *key = (struct phys_key){.rotate = {1}};
    read_between(&key->time, 1, frames, frames->times, i, part);
    if (frames->translate)
        read_between(key->translate, 3, frames, frames->translate, i, part);
    if (!frames->rotate)
        return CLOTH_OK;
    const int node = scene_tree_item(frames->tree, frames->rotate, i);
    if (part > 0)
        return build_turn(key->rotate, frames->tree, node,
                          turns_of(frames->tree, node) + part * turns_from(frames, i));
    return scene_build_rotation(key->rotate, "a rotation of a motion", frames->tree, node);
}

/* Halfway between opposite quaternions there is no rotation. */
static int check_way(const struct phys_key *key, const struct key_frames *frames, size_t i)
{
    double dot = 0;
    for (int c = 0; c < 4; c++)
        dot += key[0].rotate[c] * key[-1].rotate[c];
    if (fabs(dot) >= 1e-3)
        return CLOTH_OK;
    return scene_tree_fail(frames->tree, scene_tree_item(frames->tree, frames->rotate, i),
                           "a rotation of a motion is half a turn from the one before, so that its "
                           "way is open; smaller ones are expected, or turns about one axis");
}

int scene_build_motion(struct model_motion *motion, const struct scene_tree *tree, int node)
{
    struct model *model = tree->model;
    const int times = scene_tree_get(tree, node, "times");
    const struct key_frames frames = {tree, times, scene_tree_get(tree, node, "translate"),
                                      scene_tree_get(tree, node, "rotate"),
                                      scene_tree_length(tree, times)};
    size_t n = 0;
    if (check_key_frames(&frames))
        return tree->error->code;
    for (size_t i = 0; i < frames.n; i++)
        n += count_keys(&frames, i);
    *motion = (struct model_motion){.first = model->n_keys, .n = (uint32_t)n};
    struct phys_key *key =
        scene_build_add(&model->keys, &model->n_keys, n, sizeof *key, tree->error);
    if (!key)
        return tree->error->code;
    scene_tree_vector(tree, scene_tree_get(tree, node, "about"), 3, motion->about);
    for (size_t i = 0; i < frames.n; i++) {
        const size_t of_frame = count_keys(&frames, i);
        for (size_t k = 0; k < of_frame; k++, key++)
            if (build_key(key, &frames, i, (double)k / (double)of_frame) ||
                (i && !k && check_way(key, &frames, i)))
                return tree->error->code;
    }
    return CLOTH_OK;
}

/* ---- Pins ---- */
