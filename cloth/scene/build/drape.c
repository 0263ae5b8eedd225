/* A drape test has a border to look at: its cloth is larger than the disc that carries it. */
#include "cloth/scene/build/build.h"

int scene_build_drape(struct model *model, const struct scene_tree *tree, struct cloth_error *error)
{
    struct model_drape *drape = &model->drape;
    const int node = scene_tree_get(tree, 1, "drape");
    if (!node)
        return CLOTH_OK;
    int code = scene_build_cloth_of(&drape->cloth, "drape", model, tree, node, error);
    if (!code)
        code = scene_build_direction(drape->axis, "drape.axis", tree,
                                     scene_tree_get(tree, node, "axis"), error);
    if (code)
        return code;
    const struct model_cloth *cloth = model->cloths + drape->cloth;
    const double area = model_area(cloth), disc = model_disc(drape);
    if (disc < area)
        return CLOTH_OK;
    return scene_tree_fail(tree, scene_tree_get(tree, node, "radius"), error,
                           "drape.radius is %g m, a disc of %.3g m2; the triangles of cloth "
                           "'%.60s' have %.3g m2: a smaller disc is expected",
                           drape->radius, disc, cloth->name, area);
}
