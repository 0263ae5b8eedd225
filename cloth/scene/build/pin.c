/* Pins become motions, sliders and curves of the model, in the order of the pins. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/rules.h"

#include <math.h>
#include <string.h>

static struct model_motion *add_motion(const struct scene_tree *tree)
{
    return scene_build_add(&tree->model->motions, &tree->model->n_motions, 1,
                           sizeof(struct model_motion), tree->error);
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

/* A pin that pulls a vertex to its place never pushes it away. */
static int check_curve(uint32_t curve, const struct scene_tree *tree, int pin)
{
    const struct model *model = tree->model;
    const struct model_curve *is = model->curves + curve - 1;
    const int node = scene_tree_get(tree, pin, "curve"), keys = scene_tree_get(tree, node, "keys");
    if (!is->n)
        return scene_tree_fail(tree, scene_tree_get(tree, node, "sine"),
                               "the curve of a pin is a sine, which goes below 0; keys with "
                               "factors >= 0 are expected");
    for (uint32_t i = 0; i < is->n; i++)
        if (model->curve_keys[is->first + i].factor < 0)
            return scene_tree_fail(tree, scene_tree_item(tree, scene_tree_item(tree, keys, i), 1),
                                   "the factor of curve.keys[%u] of a pin is %g; one >= 0 is "
                                   "expected",
                                   i, model->curve_keys[is->first + i].factor);
    return CLOTH_OK;
}

static int build_soft(struct model_pin *pin, enum scene_constraint hold,
                      const struct scene_tree *tree, int node)
{
    if (hold != SCENE_POINT)
        return scene_tree_fail(tree, scene_tree_get(tree, node, "stiffness"),
                               "a pin to a %s cannot be soft; to: point is expected",
                               scene_holds[hold].word);
    if (scene_build_curve(&pin->curve, tree, node))
        return tree->error->code;
    return pin->curve ? check_curve(pin->curve, tree, node) : CLOTH_OK;
}

int scene_build_constraint(struct model_pin *pin, const struct scene_tree *tree, int node)
{
    const char *to = scene_tree_text(tree, node, "to");
    const enum scene_constraint hold =
        (enum scene_constraint)scene_word_value(scene_holds, to, NULL);
    const int motion = scene_tree_get(tree, node, "motion");
    const int follow = scene_tree_get(tree, node, "follow");
    if (check_constraint(hold, tree, node) ||
        (pin->stiffness > 0 && build_soft(pin, hold, tree, node)) ||
        (follow && (check_follow(hold, tree, node) || build_follow(tree, follow))) ||
        (motion && build_pin_motion(tree, motion)))
        return tree->error->code;
    pin->motion = motion || follow ? tree->model->n_motions : 0;
    return hold == SCENE_POINT ? CLOTH_OK : build_slider(pin, hold, tree, node);
}
