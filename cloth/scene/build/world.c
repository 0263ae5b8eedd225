/* Checks of materials, time, air, solver and phases beyond the rule of one key. */
#include "cloth/scene/build/build.h"

#include "cloth/physics/triangle.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double MAX_STEPS = 4294967294;  /* of a run: steps are counted in 32 bits */
static const double MAX_FRAMES = 2147483647; /* of a run: as many as PC2 can count */

static void world_out_of_memory(struct cloth_error *error)
{
    cloth_fail(error, CLOTH_E_MEMORY, "out of memory while the scene is read");
}

void *scene_build_array(size_t n, size_t size, struct cloth_error *error)
{
    void *array = calloc(n ? n : 1, size);
    if (!array)
        world_out_of_memory(error);
    return array;
}

void *scene_build_grow(void *list, size_t n, size_t more, size_t size, struct cloth_error *error)
{
    char *grown = realloc(list, (n + more) * size);
    if (!grown) {
        world_out_of_memory(error);
        return NULL;
    }
    memset(grown + n * size, 0, more * size);
    return grown;
}

char *scene_build_copy(const char *text, struct cloth_error *error)
{
    size_t size = strlen(text) + 1;
    char *copy = scene_build_array(size, 1, error);
    if (copy)
        memcpy(copy, text, size);
    return copy;
}

char *scene_build_place(const struct scene_tree *tree, int node, struct cloth_error *error)
{
    char *place = scene_tree_place(tree, node);
    if (!place)
        world_out_of_memory(error);
    return place;
}

int scene_build_warn(struct model *model, const struct scene_tree *tree, int node,
                     struct cloth_error *error, const char *format, ...)
{
    char text[500], *place = scene_build_place(tree, node, error);
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    const size_t size = place ? strlen(place) + strlen(text) + 3 : 0;
    char *warning = place ? scene_build_array(size, 1, error) : NULL;
    char **all = scene_build_grow(model->warnings, model->n_warnings, 1, sizeof *all, error);
    model->warnings = all ? all : model->warnings;
    if (warning && all) {
        snprintf(warning, size, "%s: %s", place, text);
        all[model->n_warnings++] = warning;
    } else
        free(warning);
    free(place);
    return error->code;
}

int scene_build_blame(int code, const struct cloth_error *inner, const char *what,
                      const struct scene_tree *tree, int node, struct cloth_error *error)
{
    if (inner->code == CLOTH_E_MEMORY)
        return cloth_fail(error, inner->code, "%s: %s", tree->path, inner->text);
    return inner->code ? scene_tree_fail(tree, node, error, "%s: %s", what, inner->text) : code;
}

/* The scene's name, else the file's without folder and ending. */
static int world_name_scene(struct model *model, const struct scene_tree *tree,
                            struct cloth_error *error)
{
    const char *slash = strrchr(tree->path, '/');
    if (model->name)
        return CLOTH_OK;
    model->name = scene_build_copy(slash ? slash + 1 : tree->path, error);
    if (!model->name)
        return error->code;
    char *dot = strrchr(model->name, '.');
    if (dot && dot > model->name)
        *dot = 0;
    return CLOTH_OK;
}

/* Checks a membrane's values together, which a table of keys cannot. */
static int check_membrane(const struct model_material *material, const struct scene_tree *tree,
                          int node, struct cloth_error *error)
{
    const double warp = material->stretch, weft = model_weft(material), nu = material->poisson;
    struct phys_membrane membrane;
    if (!phys_membrane_make(warp, weft, material->shear, nu, material->damping_stiffness,
                            &membrane))
        return CLOTH_OK;
    const int place = scene_tree_get(tree, node, "poisson");
    if (!(warp > 0) || !(weft > 0))
        return scene_tree_fail(
            tree, place, error,
            "materials.%.60s.poisson is %g, but stretch is %g along the %s; 0 is "
            "expected here",
            material->name, nu, 0.0, warp > 0 ? "weft" : "warp");
    return scene_tree_fail(tree, place, error,
                           "materials.%.60s.poisson is %g: nu12 nu21 = nu12^2 weft / warp is %g; "
                           "less than 1 is expected, here a ratio between -%g and %g",
                           material->name, nu, nu * nu * weft / warp, sqrt(warp / weft),
                           sqrt(warp / weft));
}

/* Turns fields as the scene gives them into those of the model. */
static int build_material(struct model *model, struct model_material *material,
                          const struct scene_tree *tree, int node, struct cloth_error *error)
{
    const int damping = scene_tree_get(tree, node, "damping");
    if (!scene_tree_get(tree, node, "friction"))
        material->friction = model->contact.friction;
    if (scene_tree_get(tree, node, "stretch"))
        material->weft_excess -= material->stretch;
    if (scene_tree_get(tree, damping, "bending"))
        material->damping_excess -= material->damping_stiffness;
    if (material->correction.rounds > model->correction_rounds)
        model->correction_rounds = material->correction.rounds;
    return material->model == MODEL_TRIANGLES ? check_membrane(material, tree, node, error)
                                              : CLOTH_OK;
}

static int build_materials(struct model *model, const struct scene_tree *tree,
                           struct cloth_error *error)
{
    const int map = scene_tree_get(tree, 1, "materials");
    int code = CLOTH_OK;
    for (uint32_t i = 0; !code && i < model->n_materials; i++)
        code = build_material(model, &model->materials[i], tree,
                              scene_tree_pair(tree, map, i).value, error);
    return code;
}

static int build_time(struct model *model, const struct scene_tree *tree, struct cloth_error *error)
{
    const int time = scene_tree_get(tree, 1, "time"), end = scene_tree_get(tree, time, "end");
    int fps = scene_tree_get(tree, time, "fps");
    if (!scene_tree_is_given(tree, fps)) {
        fps = end;
        free(model->fps_place);
        model->fps_place = scene_build_place(tree, fps, error);
        if (!model->fps_place)
            return error->code;
    }
    if (!model->halving)
        model->stretch_growth = 0;
    double steps = model->end / model->h;
    if (steps < 0.5)
        return scene_tree_fail(tree, end, error,
                               "time.end is %g, less than half a step; at least time.h = %g is "
                               "expected",
                               model->end, model->h);
    if (!(steps <= MAX_STEPS))
        return scene_tree_fail(tree, end, error,
                               "time.end / time.h is %g steps; at most %.0f are possible", steps,
                               MAX_STEPS);
    if (!(model->fps * model->end <= MAX_FRAMES))
        return scene_tree_fail(tree, fps, error,
                               "time.fps * time.end is %g frames; at most %.0f are possible",
                               model->fps * model->end, MAX_FRAMES);
    return CLOTH_OK;
}

static int build_air(struct model *model, const struct scene_tree *tree, struct cloth_error *error)
{
    const int air = scene_tree_get(tree, 1, "air");
    if (!air)
        return CLOTH_OK;
    return scene_build_curve(model, &model->wind_curve, tree, air, error);
}

/* Sets the count again: the default of max_iterations, which has the same field, was filled in
 * later. */
static void build_count(struct model *model, const struct scene_tree *tree)
{
    const int stop = scene_tree_get(tree, scene_tree_get(tree, 1, "solver"), "stop");
    if (model->stop == MODEL_STOP_COUNT)
        model->max_iterations = scene_tree_integer(tree, stop, "count");
}

int scene_build_world(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    build_count(model, tree);
    int code = world_name_scene(model, tree, error);
    if (!code)
        code = build_time(model, tree, error);
    if (!code)
        code = build_air(model, tree, error);
    if (!code)
        code = build_materials(model, tree, error);
    return code ? code : scene_build_obstacles(model, tree, error);
}

/* Messages and reports know phases by their names. */
int scene_build_phases(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    (void)tree;
    for (uint32_t i = 0; i < model->n_phases; i++)
        for (uint32_t k = 0; k < i; k++)
            if (!strcmp(model->phases[i].name, model->phases[k].name))
                return model_fail(model->phases[i].place, error,
                                  "phases[%u].name is '%.60s', as that of phases[%u]; each phase "
                                  "has a name of its own",
                                  i, model->phases[i].name, k);
    return CLOTH_OK;
}
