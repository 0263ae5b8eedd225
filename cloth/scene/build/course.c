/* How loads and the wind vary. Beats of all courses stand in one array of the model, in the order
 * in which the scene is built. */
#include "cloth/scene/build/build.h"

#include <stdlib.h>

/* Makes room for one more course with n more beats. */
static int grow(struct model *model, size_t n, struct cloth_error *error)
{
    struct model_course *courses =
        realloc(model->courses, (model->n_courses + 1) * sizeof *courses);
    model->courses = courses ? courses : model->courses;
    struct phys_beat *beats = realloc(model->beats, (model->n_beats + n + 1) * sizeof *beats);
    model->beats = beats ? beats : model->beats;
    return courses && beats
               ? CLOTH_OK
               : cloth_fail(error, CLOTH_E_MEMORY, "out of memory while the scene is read");
}

static int build_keys(struct phys_beat *beats, const struct scene_tree *tree, int list,
                      struct cloth_error *error)
{
    for (size_t i = 0; i < scene_tree_length(tree, list); i++) {
        const int item = scene_tree_item(tree, list, i);
        double pair[2];
        scene_tree_vector(tree, item, 2, pair);
        beats[i] = (struct phys_beat){pair[0], pair[1]};
        if (i && !(pair[0] > beats[i - 1].time))
            return scene_tree_fail(tree, scene_tree_item(tree, item, 0), error,
                                   "the time of course.keys[%zu] is %g, which does not come after "
                                   "%g, that of the one before it; times in ascending order are "
                                   "expected",
                                   i, pair[0], beats[i - 1].time);
    }
    return CLOTH_OK;
}

/* Steps that are too few for a sine would see another one, or none. */
static int build_sine(struct model_course *course, const struct model *model,
                      const struct scene_tree *tree, int node, struct cloth_error *error)
{
    const double most = 0.5 / model->h;
    course->frequency = scene_tree_number(tree, node, "frequency");
    course->phase = scene_tree_number(tree, node, "phase");
    if (course->frequency < most)
        return CLOTH_OK;
    return scene_tree_fail(tree, scene_tree_get(tree, node, "frequency"), error,
                           "course.sine.frequency is %g, but steps of time.h = %g s can follow "
                           "less than %g turns a second; fewer, or shorter steps, are expected",
                           course->frequency, model->h, most);
}

int scene_build_course(struct model *model, uint32_t *number, const struct scene_tree *tree,
                       int node, struct cloth_error *error)
{
    const int course = scene_tree_get(tree, node, "course");
    *number = 0;
    if (!course)
        return CLOTH_OK;
    const int keys = scene_tree_get(tree, course, "keys");
    const size_t n = scene_tree_length(tree, keys);
    int code = grow(model, n, error);
    if (code)
        return code;
    struct model_course *to = model->courses + model->n_courses;
    *to = (struct model_course){.first = model->n_beats, .n = (uint32_t)n};
    code = keys ? build_keys(model->beats + model->n_beats, tree, keys, error)
                : build_sine(to, model, tree, scene_tree_get(tree, course, "sine"), error);
    if (code)
        return code;
    model->n_beats += (uint32_t)n;
    *number = ++model->n_courses;
    return CLOTH_OK;
}
