/* Keys that a scene gives and that do nothing beside its other keys draw a warning each. A key that
 * stands there by default draws none. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/yaml/scalar.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The model that is checked, and its scene. */
struct idle_scene {
    struct model *model;
    const struct scene_tree *tree;
    struct cloth_error *error;
};

static bool is_given(const struct scene_tree *tree, int node)
{
    return node && scene_tree_node(tree, node)->start_mark.index != SCENE_BY_DEFAULT;
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
    char **all = realloc(model->warnings, (model->n_warnings + 1) * sizeof *all);
    model->warnings = all ? all : model->warnings;
    if (warning && all) {
        snprintf(warning, size, "%s: %s", place, text);
        all[model->n_warnings++] = warning;
    } else {
        cloth_fail(error, CLOTH_E_MEMORY, "out of memory while the scene is read");
        free(warning);
    }
    free(place);
    return error->code;
}

static int warn(const struct idle_scene *scene, int node, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static int warn(const struct idle_scene *scene, int node, const char *format, ...)
{
    char text[500];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    return scene_build_warn(scene->model, scene->tree, node, scene->error, "%s", text);
}

static bool is_explicit(const struct model *model)
{
    return !model_is_implicit(model);
}

static bool certifies_nothing(const struct model *model)
{
    return !model_promise_of_mode(model).apart;
}

static bool meets_nothing(const struct model *model)
{
    return !model_seeks(model);
}

static bool repels_nothing(const struct model *model)
{
    return !model_promise(model).springs;
}

/* True under project if cloths meet all obstacles: there cloths never meet each other. */
static bool leaves_out_nothing(const struct model *model)
{
    bool leaves = model_seeks(model);
    for (uint32_t c = 0; c < model->n_cloths; c++)
        for (uint32_t i = 0; i < model->n_obstacles; i++)
            leaves = leaves || !model_meets(model, c, model->n_cloths + i);
    return !leaves;
}

static bool takes_one_newton_step(const struct model *model)
{
    return model_is_implicit(model) && model->newton_steps == 1;
}

static bool guesses_nothing(const struct model *model)
{
    const bool knows = model->integrator == MODEL_IMPLICIT_EULER && model->newton_steps == 1;
    return model_is_implicit(model) && model->guess == MODEL_GUESS_PREVIOUS && !knows;
}

static bool counts_iterations(const struct model *model)
{
    return model_is_implicit(model) && model->stop == MODEL_STOP_COUNT;
}

static bool has_no_patches(const struct model *model)
{
    return model_is_implicit(model) && !model_is_coarse(model);
}

static bool has_no_springs(const struct model *model)
{
    bool springs = model->n_joints > 0;
    for (uint32_t i = 0; i < model->n_materials; i++) {
        bool triangles, edges;
        model_parts(model, i, &triangles, &edges);
        springs = springs || edges || (triangles && model->materials[i].model == MODEL_SPRINGS);
    }
    return model_is_implicit(model) && model->full_slope == PHYS_ABSOLUTE && !springs;
}

static bool grows_unseen(const struct model *model)
{
    return !model->halving;
}

static bool is_unguarded(const struct model *model)
{
    return model->energy_growth > 0 && !model_is_guarded(model);
}

static bool never_rests(const struct model *model)
{
    bool sine = false;
    for (uint32_t i = 0; i < model->n_curves; i++)
        sine = sine || !model->curves[i].n;
    return model->rest.speed > 0 && sine;
}

static bool blows_nothing(const struct model *model)
{
    bool triangles = false;
    for (uint32_t i = 0; i < model->n_cloths; i++)
        triangles = triangles || model->cloths[i].mesh.n_triangles;
    return !triangles;
}

static bool has_no_wind(const struct model *model)
{
    const double *wind = model->air.wind;
    return !(wind[0] < 0 || wind[0] > 0 || wind[1] < 0 || wind[1] > 0 || wind[2] < 0 ||
             wind[2] > 0);
}

#define IS_CERTIFIED "means nothing: it is of contact.mode certified"
#define IS_MET       "means nothing: it is of contact.mode certified and repulsion"
#define IS_REPELLED  "means nothing: it is of contact.mode repulsion"

/* A key of the scene, or of a map of it, and the condition under which it does nothing. */
static const struct {
    const char *map, *key; /* map NULL: the scene */
    bool (*idle)(const struct model *model);
    const char *what; /* the rest of the sentence */
} idle_keys[] = {
    {"contact", "self", meets_nothing, IS_MET},
    {"contact", "untangle", certifies_nothing, IS_CERTIFIED},
    {"contact", "thickness", meets_nothing, IS_MET},
    {"contact", "friction", meets_nothing, IS_MET},
    {"contact", "pairs", meets_nothing, IS_MET},
    {"contact", "ignore", leaves_out_nothing,
     "means nothing: by project cloths meet obstacles alone, and these are of cloths"},
    {"contact", "stiffness", repels_nothing, IS_REPELLED},
    {"contact", "damping", repels_nothing, IS_REPELLED},
    {"contact", "force", certifies_nothing, IS_CERTIFIED},
    {NULL, "solver", is_explicit, "means nothing: explicit steps solve no system"},
    {NULL, "newton", is_explicit, "means nothing: explicit steps solve no system"},
    {NULL, "air", blows_nothing, "means nothing: it blows on triangles, and no cloth has any"},
    {"air", "curve", has_no_wind,
     "means nothing: it is what the wind is multiplied by, which is 0"},
    {"newton", "tolerance", takes_one_newton_step,
     "means nothing: it spares Newton steps, and newton.steps is 1"},
    {"solver", "guess", guesses_nothing,
     "previous is of implicit_euler in one linear step (newton.steps: 1); these solves begin with "
     "zero"},
    {"solver", "max_iterations", counts_iterations,
     "means nothing: solver.stop.count says how many are made"},
    {"solver", "patches", has_no_patches,
     "means nothing: the preconditioner has no coarse space; coarse and ic0_coarse have one"},
    {"solver", "jacobian", has_no_springs,
     "absolute is of springs; what triangles and bending have is definite"},
    {"time", "stretch_growth", grows_unseen,
     "means nothing: it asks for shorter steps, and halving is off"},
    {"time", "energy_growth", is_unguarded,
     "means nothing: it judges implicit steps where nothing does work on the cloth (no wind, no "
     "curve, no pin or obstacle that moves)"},
    {"time", "rest", never_rests, "means nothing: a load or wind with a sine never ends"},
};

/* A bound of 0, or no contact, switches something off, so it needs no warning. */
static bool is_off(const struct scene_tree *tree, int node, const char *key)
{
    const char *text = scene_tree_scalar(tree, node);
    double value = 1;
    if (!strcmp(key, "stretch_growth") || !strcmp(key, "friction"))
        scene_scalar_number(text, &value);
    return value <= 0 ||
           ((!strcmp(key, "self") || !strcmp(key, "untangle")) && !strcmp(text, "off"));
}

static int warn_of_keys(const struct idle_scene *scene)
{
    int code = CLOTH_OK;
    for (size_t i = 0; i < sizeof idle_keys / sizeof *idle_keys && !code; i++) {
        const char *map = idle_keys[i].map, *key = idle_keys[i].key;
        const int in = map ? scene_tree_get(scene->tree, 1, map) : 1;
        const int node = in ? scene_tree_get(scene->tree, in, key) : 0;
        if (is_given(scene->tree, node) && !is_off(scene->tree, node, key) &&
            idle_keys[i].idle(scene->model))
            code = warn(scene, node, "%s%s%s %s", map ? map : "", map ? "." : "", key,
                        idle_keys[i].what);
    }
    return code;
}

/* Springs that are asked for where something is no spring. */
static int warn_of_format(const struct idle_scene *scene)
{
    const int solver = scene_tree_get(scene->tree, 1, "solver");
    const int node = scene_tree_get(scene->tree, solver, "format");
    const bool springs = !strcmp(scene_tree_scalar(scene->tree, node), "springs");
    if (!is_given(scene->tree, node) || !springs || scene->model->format == SOLVE_SPRINGS)
        return CLOTH_OK;
    return warn(scene, node,
                "solver.format springs holds springs alone; triangles and bending take half");
}

static bool has_any(const struct scene_tree *tree, int map, const char *const *keys)
{
    bool any = false;
    for (; *keys; keys++)
        any = any || is_given(tree, scene_tree_get(tree, map, *keys));
    return any;
}

static int warn_of_start(const struct idle_scene *scene, int start)
{
    static const char *const changes[] = {"scale", "rotate", "translate", "velocity",
                                          "spin",  "wave",   NULL};
    static const char *const about[] = {"scale", "rotate", "spin", NULL};
    static const char *const sized[] = {"translate", "velocity", NULL};
    const int point = scene_tree_get(scene->tree, start, "about");
    const int wave = scene_tree_get(scene->tree, start, "wave");
    int code = CLOTH_OK;
    if (!has_any(scene->tree, start, changes))
        code = warn(scene, start, "a start changes nothing: it only picks vertices");
    else if (is_given(scene->tree, point) && !has_any(scene->tree, start, about))
        code = warn(scene, point,
                    "about means nothing: the start has no scale, rotate or spin about it");
    if (!code && wave && !has_any(scene->tree, wave, sized))
        code = warn(scene, wave, "a wave has neither translate nor velocity, so it does nothing");
    return code;
}

/* Warns of the motion of a pin or an obstacle. */
static int warn_of_motion(const struct idle_scene *scene, int owner)
{
    static const char *const moves[] = {"translate", "rotate", NULL};
    const int motion = scene_tree_get(scene->tree, owner, "motion");
    const int point = scene_tree_get(scene->tree, motion, "about");
    if (!motion)
        return CLOTH_OK;
    if (!has_any(scene->tree, motion, moves))
        return warn(scene, motion, "a motion has neither translate nor rotate, so nothing moves");
    if (is_given(scene->tree, point) && !scene_tree_get(scene->tree, motion, "rotate"))
        return warn(scene, point, "about means nothing: the motion does not rotate");
    return CLOTH_OK;
}

/* Warns of the friction of a material or an obstacle. */
static int warn_of_friction(const struct idle_scene *scene, int owner)
{
    const int node = scene_tree_get(scene->tree, owner, "friction");
    if (!node || !meets_nothing(scene->model) || is_off(scene->tree, node, "friction"))
        return CLOTH_OK;
    return warn(scene, node, "friction " IS_MET);
}

static int warn_of_materials(const struct idle_scene *scene)
{
    const int map = scene_tree_get(scene->tree, 1, "materials");
    int code = CLOTH_OK;
    for (size_t i = 0; i < scene_tree_length(scene->tree, map) && !code; i++)
        code = warn_of_friction(scene, scene_tree_pair(scene->tree, map, i).value);
    return code;
}

/* Warns of keys for the maps of a body without maps. */
static int warn_of_view(const struct idle_scene *scene, int body)
{
    static const char *const keys[] = {"resolution", "view"};
    const int meet = scene_tree_get(scene->tree, body, "meet");
    int code = CLOTH_OK;
    for (int i = 0; i < 2 && meet && !code; i++) {
        const int node = scene_tree_get(scene->tree, body, keys[i]);
        if (is_given(scene->tree, node) && strcmp(scene_tree_scalar(scene->tree, meet), "image"))
            code = warn(scene, node, "%s means nothing: it is of meet: image", keys[i]);
    }
    return code;
}

static int warn_of_obstacle(const struct idle_scene *scene, int obstacle)
{
    const int shape = scene_tree_pair(scene->tree, obstacle, 0).value;
    int code = warn_of_friction(scene, shape);
    if (!code)
        code = warn_of_view(scene, shape);
    return code ? code : warn_of_motion(scene, shape);
}

static int warn_of_layer(const struct idle_scene *scene, int cloth)
{
    const int node = scene_tree_get(scene->tree, cloth, "layer");
    const struct model *model = scene->model;
    if (!is_given(scene->tree, node) || (model_promise(model).apart && model->contact.untangle))
        return CLOTH_OK;
    return warn(scene, node, "layer means nothing: it is of contact.untangle");
}

/* A joint acts in the steps that begin within its time, to a tick of h / 1024. */
static int warn_of_joint(const struct idle_scene *scene, int joint)
{
    const double h = scene->model->h, begin = scene_tree_number(scene->tree, joint, "begin");
    const int end_node = scene_tree_get(scene->tree, joint, "end");
    const bool ends = strcmp(scene_tree_scalar(scene->tree, end_node), "never") != 0;
    const double end = ends ? scene_tree_number(scene->tree, joint, "end") : INFINITY;
    const double tick = h / 1024, first = ceil((begin - tick / 2) / h) * h;
    const int node = scene_tree_get(scene->tree, joint, "begin");
    if (begin >= scene->model->end)
        return warn(scene, node, "the joint begins at %g s, when the run is over", begin);
    if (first > scene->model->end - tick / 2)
        return warn(scene, node, "the joint begins at %g s, after the last step has begun", begin);
    if (first > end - tick / 2)
        return warn(scene, node,
                    "the joint acts from %g s to %g s, when no step of %g s begins; only shorter "
                    "ones can have it",
                    begin, end, h);
    return CLOTH_OK;
}

/* Warns of each entry of the list `key` of a map. */
static int warn_of_list(const struct idle_scene *scene, int map, const char *key,
                        int (*warn_of)(const struct idle_scene *scene, int item))
{
    const int list = scene_tree_get(scene->tree, map, key);
    int code = CLOTH_OK;
    for (size_t i = 0; i < scene_tree_length(scene->tree, list) && !code; i++)
        code = warn_of(scene, scene_tree_item(scene->tree, list, i));
    return code;
}

int scene_build_idle(struct model *model, const struct scene_tree *tree, struct cloth_error *error)
{
    const struct idle_scene scene = {model, tree, error};
    const int cloths = scene_tree_get(tree, 1, "cloths");
    int code = warn_of_keys(&scene);
    if (!code)
        code = warn_of_materials(&scene);
    if (!code)
        code = warn_of_format(&scene);
    for (uint32_t i = 0; i < model->n_cloths && !code; i++) {
        const int cloth = scene_tree_item(tree, cloths, i);
        code = warn_of_layer(&scene, cloth);
        if (!code)
            code = warn_of_list(&scene, cloth, "start", warn_of_start);
        if (!code)
            code = warn_of_list(&scene, cloth, "pins", warn_of_motion);
    }
    if (!code)
        code = warn_of_list(&scene, 1, "joints", warn_of_joint);
    return code ? code : warn_of_list(&scene, 1, "obstacles", warn_of_obstacle);
}
