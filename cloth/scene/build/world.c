/* Checks of materials, time, air, solver and phases beyond the rule of one key, and the grain that
 * a scene does not give. */
#include "cloth/scene/build/build.h"

#include "cloth/physics/triangle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double MAX_STEPS = 4294967294;  /* of a run: steps are counted in 32 bits */
static const double MAX_FRAMES = 2147483647; /* of a run: as many as PC2 can count */

/* The scene's name, else the file's without folder and ending. */
static int world_name_scene(const struct scene_tree *tree)
{
    struct model *model = tree->model;
    const char *slash = strrchr(tree->path, '/');
    if (model->name)
        return CLOTH_OK;
    model->name = scene_build_copy(slash ? slash + 1 : tree->path, tree->error);
    if (!model->name)
        return tree->error->code;
    char *dot = strrchr(model->name, '.');
    if (dot && dot > model->name)
        *dot = 0;
    return CLOTH_OK;
}

/* Where the scene gives a part of a curve: there, or in the sheet of an instrument, or by a name.
 */
static int curve_place(const struct scene_tree *tree, int part, int material)
{
    static const char *const from[] = {"kes", "fast", "like"};
    int place = scene_tree_is_given(tree, part) ? part : material;
    for (size_t i = 0; place == material && i < sizeof from / sizeof *from; i++)
        if (scene_tree_get(tree, material, from[i]))
            place = scene_tree_get(tree, material, from[i]);
    return place;
}

/* Reads the curve of a thread, 0 the warp and 1 the weft, which may be that of the warp. */
static int build_thread(struct model_material *material, const struct scene_tree *tree, int node,
                        int thread, double *modulus)
{
    const int curve = scene_tree_get(tree, node, "stretch_curve");
    const int weft = thread ? scene_tree_get(tree, curve, "weft") : 0;
    const int list = weft ? weft : scene_tree_get(tree, curve, "warp");
    const size_t n = scene_tree_length(tree, list);
    double point[PHYS_KNEES + 1][2];
    for (size_t i = 0; i < n; i++)
        scene_tree_vector(tree, scene_tree_item(tree, list, i), 2, point[i]);
    const size_t good =
        phys_stiffening_make(n, (const double(*)[2])point, thread, &material->stiffening, modulus);
    return good == n
               ? CLOTH_OK
               : scene_tree_fail(tree, curve_place(tree, scene_tree_item(tree, list, good), node),
                                 "materials.%.60s.stretch_curve.%s[%zu] is [%g, %g]; strain and "
                                 "stress above those of the pair before, or above 0, are expected",
                                 material->name, weft ? "weft" : "warp", good, point[good][0],
                                 point[good][1]);
}

/* The moduli at rest and the knees of a curve. */
static int build_curve(struct model_material *material, const struct scene_tree *tree, int node)
{
    const int curve = scene_tree_get(tree, node, "stretch_curve");
    const int stretch = scene_tree_get(tree, node, "stretch");
    double warp = 0, weft = 0;
    if (!curve)
        return CLOTH_OK;
    if (stretch)
        return scene_tree_fail(tree, stretch,
                               "materials.%.60s has stretch and stretch_curve, which has moduli of "
                               "its own; leave one of them out",
                               material->name);
    if (build_thread(material, tree, node, 0, &warp) ||
        build_thread(material, tree, node, 1, &weft))
        return tree->error->code;
    material->stretch = warp;
    material->weft_excess = weft - warp;
    return CLOTH_OK;
}

/* Checks a membrane's values together, which a table of keys cannot. */
static int check_membrane(const struct model_material *material, const struct scene_tree *tree,
                          int node)
{
    const double warp = material->stretch, weft = model_weft(material), nu = material->poisson;
    struct phys_membrane membrane;
    if (!phys_membrane_make(warp, weft, material->shear, nu, material->damping_stiffness,
                            &membrane)) {
        if (!phys_membrane_stiffen(&membrane, &material->stiffening))
            return CLOTH_OK;
        return scene_tree_fail(tree, scene_tree_get(tree, node, "poisson"),
                               "materials.%.60s.poisson is %g, which is too much where "
                               "stretch_curve is least steep; a ratio nearer to 0 is expected",
                               material->name, nu);
    }
    const int place = scene_tree_get(tree, node, "poisson");
    if (!(warp > 0) || !(weft > 0))
        return scene_tree_fail(
            tree, place,
            "materials.%.60s.poisson is %g, but stretch is %g along the %s; 0 is "
            "expected here",
            material->name, nu, 0.0, warp > 0 ? "weft" : "warp");
    return scene_tree_fail(tree, place,
                           "materials.%.60s.poisson is %g: nu12 nu21 = nu12^2 weft / warp is %g; "
                           "less than 1 is expected, here a ratio between -%g and %g",
                           material->name, nu, nu * nu * weft / warp, sqrt(warp / weft),
                           sqrt(warp / weft));
}

/* Builds how lengths at rest change. */
static int build_sizes(struct model_material *material, const struct scene_tree *tree, int node)
{
    static const char *const key[] = {"warp", "weft"};
    const int size = scene_tree_get(tree, node, "size"), both = scene_tree_get(tree, size, "both");
    int code = scene_build_size(material->size, tree, both);
    if (both)
        material->size[1] = material->size[0];
    for (int i = 0; i < 2 && !code; i++) {
        const int list = scene_tree_get(tree, size, key[i]);
        if (both && list)
            return scene_tree_fail(tree, list,
                                   "materials.%.60s.size has both and %s; both, or one of warp "
                                   "and weft or the two are expected",
                                   material->name, key[i]);
        code = scene_build_size(material->size + i, tree, list);
    }
    if (!code && size && material->correction.rounds)
        return scene_tree_fail(tree, size,
                               "materials.%.60s.size changes the lengths at rest, which "
                               "velocity_correction takes from the start; strain_limit knows them",
                               material->name);
    return code;
}

/* Turns fields as the scene gives them into those of the model. */
static int build_material(struct model_material *material, const struct scene_tree *tree, int node)
{
    struct model *model = tree->model;
    const int damping = scene_tree_get(tree, node, "damping");
    if (!scene_tree_get(tree, node, "friction"))
        material->friction = model->contact.friction;
    if (scene_tree_get(tree, node, "stretch"))
        material->weft_excess -= material->stretch;
    if (scene_tree_get(tree, damping, "bending"))
        material->damping_excess -= material->damping_stiffness;
    if (material->correction.rounds > model->correction_rounds)
        model->correction_rounds = material->correction.rounds;
    if (build_curve(material, tree, node) ||
        (material->model == MODEL_TRIANGLES && check_membrane(material, tree, node)))
        return tree->error->code;
    return build_sizes(material, tree, node);
}

static int build_materials(const struct scene_tree *tree)
{
    const int map = scene_tree_get(tree, 1, "materials");
    int code = CLOTH_OK;
    for (uint32_t i = 0; !code && i < tree->model->n_materials; i++)
        code =
            build_material(&tree->model->materials[i], tree, scene_tree_pair(tree, map, i).value);
    return code;
}

static int build_time(const struct scene_tree *tree)
{
    struct model *model = tree->model;
    const int end = scene_tree_at(tree, 1, "time.end");
    int fps = scene_tree_at(tree, 1, "time.fps");
    if (!scene_tree_is_given(tree, fps)) {
        fps = end;
        free(model->fps_place);
        model->fps_place = scene_build_place(tree, fps);
        if (!model->fps_place)
            return tree->error->code;
    }
    if (!model->halving)
        model->stretch_growth = 0;
    double steps = model->end / model->h;
    if (steps < 0.5)
        return scene_tree_fail(tree, end,
                               "time.end is %g, less than half a step; at least time.h = %g is "
                               "expected",
                               model->end, model->h);
    if (!(steps <= MAX_STEPS))
        return scene_tree_fail(tree, end,
                               "time.end / time.h is %g steps; at most %.0f are possible", steps,
                               MAX_STEPS);
    if (!(model->fps * model->end <= MAX_FRAMES))
        return scene_tree_fail(tree, fps,
                               "time.fps * time.end is %g frames; at most %.0f are possible",
                               model->fps * model->end, MAX_FRAMES);
    return CLOTH_OK;
}

int scene_build_world(struct scene_tree *tree)
{
    struct model *model = tree->model;
    const int air = scene_tree_get(tree, 1, "air");
    if (model->stop == MODEL_STOP_COUNT) /* max_iterations has the same field, and its default */
        model->max_iterations =
            (uint32_t)scene_tree_number(tree, scene_tree_at(tree, 1, "solver.stop"), "count");
    return world_name_scene(tree) || build_time(tree) ||
           (air && scene_build_curve(&model->wind_curve, tree, air)) || build_materials(tree) ||
           scene_build_obstacles(tree);
}

/* Messages and reports know phases by their names. */
int scene_build_phases(struct scene_tree *tree)
{
    const struct model *model = tree->model;
    for (uint32_t i = 0; i < model->n_phases; i++)
        for (uint32_t k = 0; k < i; k++)
            if (!strcmp(model->phases[i].name, model->phases[k].name))
                return model_fail(model->phases[i].place, tree->error,
                                  "phases[%u].name is '%.60s', as that of phases[%u]; each phase "
                                  "has a name of its own",
                                  i, model->phases[i].name, k);
    return CLOTH_OK;
}

int scene_build_grain(struct scene_tree *tree)
{
    struct model *model = tree->model;
    if (!model->grain)
        model->grain = model_usual_grain(model_first(model, model->n_cloths));
    return CLOTH_OK;
}
