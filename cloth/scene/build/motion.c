/* Motions by key frames; what pins hold to, and how they move. Keys of all motions stand in one
 * array of the model, obstacles first, then in the order of the pins; so do sliders. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/rules.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int build_times(struct phys_key *keys, const struct scene_tree *tree, int list, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        scene_tree_vector(tree, scene_tree_item(tree, list, i), 1, &keys[i].time);
        if (i && !(keys[i].time > keys[i - 1].time))
            return scene_tree_fail(tree, scene_tree_item(tree, list, i),
                                   "motion.times[%zu] is %g, which does not come after %g, the one "
                                   "before it; times in ascending order are expected",
                                   i, keys[i].time, keys[i - 1].time);
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

int scene_build_rotation(double rotate[4], const char *what, const struct scene_tree *tree,
                         int node)
{
    scene_tree_vector(tree, node, 4, rotate);
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

/* Halfway between opposite quaternions there is no rotation. */
static int check_turns(const struct phys_key *keys, const struct scene_tree *tree, int list,
                       size_t n)
{
    for (size_t k = 1; k < n; k++) {
        double dot = 0;
        for (int i = 0; i < 4; i++)
            dot += keys[k].rotate[i] * keys[k - 1].rotate[i];
        if (fabs(dot) < 1e-3)
            return scene_tree_fail(tree, scene_tree_item(tree, list, k),
                                   "a rotation of a motion is half a turn from the one before, so "
                                   "that its way is open; smaller ones are expected");
    }
    return CLOTH_OK;
}

/* A motion must begin where the vertices are: else it tears them away in the first step. */
static int check_begin(const struct phys_key *keys, size_t n, const double about[3],
                       const struct scene_tree *tree, int node)
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
    return scene_tree_fail(tree, node,
                           "a motion does not begin where the vertices start; at time 0 no shift "
                           "and no rotation are expected");
}

int scene_build_motion(struct model_motion *motion, const struct scene_tree *tree, int node)
{
    struct model *model = tree->model;
    const int times = scene_tree_get(tree, node, "times");
    const int translate = scene_tree_get(tree, node, "translate");
    const int rotate = scene_tree_get(tree, node, "rotate");
    const size_t n = scene_tree_length(tree, times);
    *motion = (struct model_motion){.first = model->n_keys, .n = (uint32_t)n};
    struct phys_key *keys =
        scene_build_add(&model->keys, &model->n_keys, n, sizeof *keys, tree->error);
    if (!keys)
        return tree->error->code;
    scene_tree_vector(tree, scene_tree_get(tree, node, "about"), 3, motion->about);
    for (size_t i = 0; i < n; i++)
        keys[i].rotate[0] = 1;
    int code = build_times(keys, tree, times, n) ||
               check_motion_length(tree, translate, "translate", n) ||
               check_motion_length(tree, rotate, "rotate", n);
    for (size_t i = 0; translate && i < n && !code; i++)
        scene_tree_vector(tree, scene_tree_item(tree, translate, i), 3, keys[i].translate);
    for (size_t i = 0; rotate && i < n && !code; i++)
        code = scene_build_rotation(keys[i].rotate, "a rotation of a motion", tree,
                                    scene_tree_item(tree, rotate, i));
    return code || (rotate && check_turns(keys, tree, rotate, n));
}

/* ---- Pins ---- */

static struct model_motion *add_motion(const struct scene_tree *tree)
{
    return scene_build_add(&tree->model->motions, &tree->model->n_motions, 1,
                           sizeof(struct model_motion), tree->error);
}

static int build_pin_motion(const struct scene_tree *tree, int node)
{
    struct model_motion *motion = add_motion(tree);
    return !motion || scene_build_motion(motion, tree, node) ||
           check_begin(tree->model->keys + motion->first, motion->n, motion->about, tree, node);
}

/* Adds the motion of an obstacle to the model's. */
static int build_follow(const struct scene_tree *tree, int node)
{
    const uint32_t obstacle =
        scene_build_find(tree->model, SCENE_OBSTACLES, scene_tree_scalar(tree, node));
    if (obstacle == UINT32_MAX)
        return scene_build_no_name(tree, node, "obstacle", 1U << SCENE_OBSTACLES);
    const struct contact_shape *shape = tree->model->obstacles + obstacle;
    struct model_motion *motion = add_motion(tree);
    if (!motion)
        return tree->error->code;
    *motion = (struct model_motion){.first = shape->first, .n = shape->n, .follow = obstacle + 1};
    memcpy(motion->about, shape->about, sizeof motion->about);
    return CLOTH_OK;
}

/* A slider has one of these, a point neither. */
static const char *const hold_keys[] = {[SCENE_LINE] = "direction", [SCENE_PLANE] = "normal"};

static int check_constraint(enum scene_constraint hold, const struct scene_tree *tree, int node)
{
    const char *to = scene_holds[hold].word;
    for (int i = SCENE_LINE; i <= SCENE_PLANE; i++) {
        const int key = scene_tree_get(tree, node, hold_keys[i]);
        const bool wanted = i == (int)hold;
        const char *of = scene_holds[i].word;
        if (wanted && !key)
            return scene_tree_fail(tree, node,
                                   "a pin to a %s has no %s; a list of 3 numbers is expected", to,
                                   hold_keys[i]);
        if (!wanted && key)
            return scene_tree_fail(tree, key,
                                   "a pin to a %s has a %s, which is that of a %s; to: %s is "
                                   "expected with it",
                                   to, hold_keys[i], of, of);
    }
    return CLOTH_OK;
}

static int build_slider(struct model_pin *pin, enum scene_constraint hold,
                        const struct scene_tree *tree, int node)
{
    struct model *model = tree->model;
    const bool line = hold == SCENE_LINE;
    struct model_slider *slider =
        scene_build_add(&model->sliders, &model->n_sliders, 1, sizeof *slider, tree->error);
    if (!slider)
        return tree->error->code;
    *slider = (struct model_slider){.kind = line ? MODEL_LINE : MODEL_PLANE, .motion = pin->motion};
    pin->motion = 0;
    pin->slider = model->n_sliders;
    return scene_build_direction(slider->direction,
                                 line ? "the direction of a pin" : "the normal of a pin", tree,
                                 scene_tree_get(tree, node, hold_keys[hold]));
}

/* A pin follows an obstacle with all of its vertices, and has no motion of its own. */
static int check_follow(enum scene_constraint hold, const struct scene_tree *tree, int pin)
{
    const int motion = scene_tree_get(tree, pin, "motion");
    if (hold != SCENE_POINT)
        return scene_tree_fail(tree, scene_tree_get(tree, pin, "follow"),
                               "a pin to a %s cannot follow an obstacle; to: point is expected",
                               scene_holds[hold].word);
    if (motion)
        return scene_tree_fail(tree, motion,
                               "a pin follows an obstacle and has a motion; one of the two is "
                               "expected");
    return CLOTH_OK;
}

int scene_build_constraint(struct model_pin *pin, const struct scene_tree *tree, int node)
{
    const char *to = scene_tree_text(tree, node, "to");
    const enum scene_constraint hold =
        (enum scene_constraint)scene_word_value(scene_holds, to, NULL);
    const int motion = scene_tree_get(tree, node, "motion");
    const int follow = scene_tree_get(tree, node, "follow");
    if (check_constraint(hold, tree, node) ||
        (follow && (check_follow(hold, tree, node) || build_follow(tree, follow))) ||
        (motion && build_pin_motion(tree, motion)))
        return tree->error->code;
    pin->motion = motion || follow ? tree->model->n_motions : 0;
    return hold == SCENE_POINT ? CLOTH_OK : build_slider(pin, hold, tree, node);
}
