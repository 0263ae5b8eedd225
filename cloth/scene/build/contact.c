/* The default mode of contact, and the needs of certified contact: a solve that supports it, and a
 * thickness that the numbers of the scene resolve. */
#include "cloth/scene/build/build.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static const double MARGIN = 1e-9; /* m: of a certificate */
static const double OPEN = 0.1;    /* part of the thickness that steps leave open */

/* True if a cloth meets itself, one before it or an obstacle. surfaces: planes and cloths without
 * triangles do not count. */
static bool meets_anything(const struct model *model, uint32_t cloth, bool surfaces)
{
    bool meets = false;
    for (uint32_t c = 0; c <= cloth; c++)
        meets = meets ||
                ((!surfaces || model->cloths[c].mesh.n_triangles) && model_meets(model, cloth, c));
    for (uint32_t i = 0; i < model->n_obstacles; i++)
        meets =
            meets || ((!surfaces || contact_kinds[model->obstacles[i].kind] != &contact_plane) &&
                      model_meets(model, cloth, model->n_cloths + i));
    return meets;
}

/* ---- Its default ---- */

/* True if a cloth meets more than planes: thin or sharp obstacles go through a cloth whose vertices
 * alone are put out, and cloths through each other. Edges without triangles are in no certificate,
 * which would let them through obstacles. */
static bool wants_certificate(const struct model *model)
{
    bool surfaces = false, edges = false;
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const struct mesh *mesh = &model->cloths[c].mesh;
        surfaces = surfaces || (mesh->n_triangles && meets_anything(model, c, true));
        edges = edges || mesh->n_bare_edges;
    }
    return surfaces && !(edges && model->n_obstacles);
}

int scene_build_contact(struct scene_tree *tree)
{
    struct model *model = tree->model;
    model->contact.assumed = !scene_tree_at(tree, 1, "contact.mode");
    if (model->contact.assumed && model_is_implicit(model) && wants_certificate(model) &&
        !model_has_maps(model))
        model->contact.mode = MODEL_CONTACT_BEST;
    if (!scene_tree_at(tree, 1, "contact.self"))
        model->contact.self = model_contact_is[model->contact.mode].promise.near;
    return CLOTH_OK;
}

int scene_build_contact_idle(struct scene_tree *tree)
{
    const struct model *model = tree->model;
    bool idle = true;
    for (uint32_t c = 0; c < model->n_cloths; c++)
        idle = idle && !meets_anything(model, c, false);
    for (uint32_t i = 0; i < model->n_probes; i++) {
        const struct model_probe *probe = model->probes + i;
        idle = idle && !probe->by_obstacle && !probe->contact && !probe->contact_total;
    }
    tree->model->contact.idle = idle;
    return CLOTH_OK;
}

/* ---- Its needs ---- */

/* The largest coordinate of a vertex where it starts, m. */
static double farthest_coordinate(const struct model *model)
{
    double far = 0;
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        for (size_t i = 0; i < 3 * (size_t)cloth->mesh.n_vertices; i++)
            far = fmax(far, fabs(cloth->start ? cloth->start[i / 3 * 6 + i % 3]
                                              : cloth->mesh.position[i]));
    }
    return far;
}

/* Points that steps leave apart must stay apart in frames. Floats move each coordinate by up to
 * 2^-24 of it, so two points approach by up to 2 sqrt(3) of that. A thickness of 0 is not given. */
static int check_thickness(const struct scene_tree *tree, int map, const char *of, double thickness)
{
    const struct model *model = tree->model;
    const double far = thickness > 0 ? farthest_coordinate(model) : 0;
    const double least = (MARGIN + 2 * sqrt(3) * far / 16777216) / OPEN;
    if (thickness >= least || !(thickness > 0))
        return CLOTH_OK;
    return scene_tree_fail(tree, scene_tree_get(tree, map, "thickness"),
                           "%.80s.thickness is %g m; at least %.3g m is expected: frames are in "
                           "float, and cloth that is %g m from the origin needs that much%s",
                           of, thickness, least, far, model_contact_cure(model));
}

static int check_thicknesses(const struct scene_tree *tree)
{
    const struct model *model = tree->model;
    const int materials = scene_tree_get(tree, 1, "materials"),
              obstacles = scene_tree_get(tree, 1, "obstacles");
    int code = check_thickness(tree, scene_tree_get(tree, 1, "contact"), "contact",
                               model->contact.thickness);
    char of[80];
    for (uint32_t i = 0; i < model->n_materials && !code; i++) {
        snprintf(of, sizeof of, "materials.%.60s", model->materials[i].name);
        code = check_thickness(tree, scene_tree_pair(tree, materials, i).value, of,
                               model->materials[i].thickness);
    }
    for (uint32_t i = 0; i < model->n_obstacles && !code; i++) {
        const struct contact_shape *shape = model->obstacles + i;
        const char *kind = contact_kinds[shape->kind]->name;
        snprintf(of, sizeof of, "obstacles[%" PRIu32 "].%s", i, kind);
        const int obstacle = scene_tree_item(tree, obstacles, i);
        code = check_thickness(tree, scene_tree_get(tree, obstacle, kind), of, shape->thickness);
    }
    return code;
}

/* Checks that no body is met by maps. */
static int check_bodies(const struct scene_tree *tree)
{
    const struct model *model = tree->model;
    const int list = scene_tree_get(tree, 1, "obstacles");
    uint32_t i = 0;
    while (i < model->n_obstacles && !model->obstacles[i].view.height)
        i++;
    if (i == model->n_obstacles)
        return CLOTH_OK;
    return scene_tree_fail(tree, scene_tree_at(tree, scene_tree_item(tree, list, i), "body.meet"),
                           "a body that is met by image, in contact.mode %s%s; meet: bvh, or "
                           "contact: {mode: project}, is expected",
                           model_contact_name(model),
                           model_contact_is[model->contact.mode].no_maps);
}

int scene_build_check_contact(struct scene_tree *tree)
{
    const struct model *model = tree->model;
    const struct model_contact_is *is = model_contact_is + model->contact.mode;
    if (is->solves && !model_is_implicit(model))
        return scene_tree_fail(tree, scene_tree_at(tree, 1, "contact.mode"),
                               "contact.mode is %s, which implicit_euler and bdf2 can do: "
                               "explicit steps (integrator: %s) solve no system that knows of "
                               "contact; repulsion or project is expected",
                               model_contact_name(model), model_scheme(model)->name);
    return (is->no_maps && check_bodies(tree)) || (is->promise.apart && check_thicknesses(tree));
}
