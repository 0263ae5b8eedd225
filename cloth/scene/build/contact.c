/* Contact that is certified needs a solve that knows of it, and a thickness that the numbers of the
 * scene resolve. */
#include "cloth/scene/build/build.h"

#include <math.h>

static const double MARGIN = 1e-9; /* m: of a certificate */
static const double OPEN = 0.1;    /* of the thickness: so much of it steps leave open */

/* The largest coordinate of a vertex where it starts, m. */
static double farthest(const struct model *model)
{
    double far = 0;
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        for (size_t i = 0; i < 3 * (size_t)cloth->mesh.n_vertices; i++)
            far = fmax(far, fabs(cloth->mesh.position[i]));
    }
    return far;
}

/* Two points that steps leave apart stay so in frames, whose floats move each coordinate of a point
 * by up to 2^-24 of it: two points by up to 2 sqrt(3) of that towards each other. */
static int check_thickness(const struct model *model, const struct scene_tree *tree, int node,
                           struct cloth_error *error)
{
    const double far = farthest(model);
    const double least = (MARGIN + 2 * sqrt(3) * far / 16777216) / OPEN;
    if (model->contact.thickness >= least)
        return CLOTH_OK;
    return scene_tree_fail(tree, node, error,
                           "contact.thickness is %g m; at least %.3g m is expected: frames are in "
                           "float, which this is what %g m from the origin needs",
                           model->contact.thickness, least, far);
}

int scene_build_check_contact(const struct model *model, const struct scene_tree *tree,
                              struct cloth_error *error)
{
    const int contact = scene_tree_get(tree, 1, "contact");
    const int mode = scene_tree_get(tree, contact, "mode");
    if (model->contact.mode != MODEL_CONTACT_CERTIFIED)
        return CLOTH_OK;
    if (!model_is_implicit(model))
        return scene_tree_fail(tree, mode, error,
                               "contact.mode is certified, which implicit_euler and bdf2 can do: "
                               "explicit steps (integrator: %s) solve no system that knows of "
                               "contact; project is expected",
                               model_integrator_name(model->integrator));
    return check_thickness(model, tree, scene_tree_get(tree, contact, "thickness"), error);
}
