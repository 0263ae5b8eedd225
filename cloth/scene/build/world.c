/* Materials, obstacles, time and solver. Materials keep the order of the file. */
#include "cloth/scene/build/build.h"

#include "cloth/physics/triangle.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double MOST_STEPS = 4294967294;  /* of a run: steps are counted in 32 bits */
static const double MOST_FRAMES = 2147483647; /* of a run: as many as PC2 can count */

static void out_of_memory(struct cloth_error *error)
{
    cloth_fail(error, CLOTH_E_MEMORY, "out of memory while the scene is read");
}

void *scene_build_array(size_t n, size_t size, struct cloth_error *error)
{
    void *array = calloc(n ? n : 1, size);
    if (!array)
        out_of_memory(error);
    return array;
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
        out_of_memory(error);
    return place;
}

/* The scene's name, else the file's without folder and ending. */
static int build_name(struct model *model, const struct scene_tree *tree, struct cloth_error *error)
{
    const char *name = scene_tree_text(tree, 1, "name");
    const char *slash = strrchr(tree->path, '/');
    model->name = scene_build_copy(name ? name : slash ? slash + 1 : tree->path, error);
    if (!model->name)
        return error->code;
    char *dot = name ? NULL : strrchr(model->name, '.');
    if (dot && dot > model->name)
        *dot = 0;
    return CLOTH_OK;
}

/* A number for both, or a list of two. */
static void pair_of(const struct scene_tree *tree, int map, const char *key, double pair[2])
{
    const int node = scene_tree_get(tree, map, key);
    if (scene_tree_is(tree, node, YAML_SEQUENCE_NODE))
        scene_tree_vector(tree, node, 2, pair);
    else
        pair[0] = pair[1] = scene_tree_number(tree, map, key);
}

static void build_bending(struct model_material *material, const struct scene_tree *tree, int node)
{
    if (!node)
        return;
    const bool hinge = !strcmp(scene_tree_text(tree, node, "model"), "hinge");
    pair_of(tree, node, "rigidity", material->rigidity);
    material->bending = hinge ? MODEL_HINGES : MODEL_QUADRATIC;
}

/* What a table of keys cannot check of triangles. */
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

static int build_material(struct model_material *material, const struct scene_tree *tree,
                          const char *name, int node, struct cloth_error *error)
{
    int damping = scene_tree_get(tree, node, "damping");
    double stretch[2];
    *material = (struct model_material){
        .name = scene_build_copy(name, error),
        .density =
            scene_tree_get(tree, node, "density") ? scene_tree_number(tree, node, "density") : 0,
        .shear = scene_tree_number(tree, node, "shear"),
        .bend = scene_tree_number(tree, node, "bend"),
        .poisson = scene_tree_number(tree, node, "poisson"),
        .model = strcmp(scene_tree_text(tree, node, "model"), "springs") ? MODEL_TRIANGLES
                                                                         : MODEL_SPRINGS,
        .uncorrected = strcmp(scene_tree_text(tree, node, "forces"), "exact"),
        .damping_viscous = scene_tree_number(tree, damping, "viscous"),
        .damping_mass = scene_tree_number(tree, damping, "mass"),
        .damping_stiffness = scene_tree_number(tree, damping, "stiffness"),
        .both_diagonals = !strcmp(scene_tree_text(tree, node, "diagonals"), "both"),
    };
    if (!material->name)
        return error->code;
    if (scene_tree_get(tree, node, "stretch")) {
        pair_of(tree, node, "stretch", stretch);
        material->stretch = stretch[0];
        material->weft_excess = stretch[1] - stretch[0];
    }
    if (scene_tree_get(tree, node, "ea"))
        material->ea = scene_tree_number(tree, node, "ea");
    if (scene_tree_get(tree, damping, "bending"))
        material->damping_excess =
            scene_tree_number(tree, damping, "bending") - material->damping_stiffness;
    build_bending(material, tree, scene_tree_get(tree, node, "bending"));
    return material->model == MODEL_TRIANGLES ? check_membrane(material, tree, node, error)
                                              : CLOTH_OK;
}

static int build_materials(struct model *model, const struct scene_tree *tree,
                           struct cloth_error *error)
{
    int map = scene_tree_get(tree, 1, "materials");
    size_t n = scene_tree_length(tree, map);
    model->materials = scene_build_array(n, sizeof *model->materials, error);
    if (!model->materials)
        return error->code;
    model->n_materials = (uint32_t)n;
    int code = CLOTH_OK;
    for (size_t i = 0; !code && i < n; i++) {
        yaml_node_pair_t pair = scene_tree_pair(tree, map, i);
        code = build_material(&model->materials[i], tree, scene_tree_scalar(tree, pair.key),
                              pair.value, error);
    }
    return code;
}

static int build_time(struct model *model, const struct scene_tree *tree, struct cloth_error *error)
{
    int time = scene_tree_get(tree, 1, "time"), end = scene_tree_get(tree, time, "end");
    model->h = scene_tree_number(tree, time, "h");
    model->h_place = scene_build_place(tree, scene_tree_get(tree, time, "h"), error);
    if (!model->h_place)
        return error->code;
    model->end = scene_tree_number(tree, time, "end");
    model->fps = scene_tree_number(tree, time, "fps");
    const int rest = scene_tree_get(tree, time, "rest");
    if (rest)
        model->rest = (struct model_rest){scene_tree_number(tree, rest, "speed"),
                                          scene_tree_number(tree, rest, "hold")};
    model->halving = !strcmp(scene_tree_text(tree, time, "halving"), "on");
    model->stretch_growth = model->halving ? scene_tree_number(tree, time, "stretch_growth") : 0;
    model->stretch_limit = scene_tree_number(tree, time, "stretch_limit");
    model->energy_growth = scene_tree_number(tree, time, "energy_growth");
    const int fps = scene_tree_get(tree, time, "fps");
    const bool by_default = scene_tree_node(tree, fps)->start_mark.index == SCENE_BY_DEFAULT;
    model->fps_place = scene_build_place(tree, by_default ? end : fps, error);
    if (!model->fps_place)
        return error->code;
    double steps = model->end / model->h;
    if (steps < 0.5)
        return scene_tree_fail(tree, end, error,
                               "time.end is %g, less than half a step; at least time.h = %g is "
                               "expected",
                               model->end, model->h);
    if (!(steps <= MOST_STEPS))
        return scene_tree_fail(tree, end, error,
                               "time.end / time.h is %g steps; at most %.0f are possible", steps,
                               MOST_STEPS);
    if (!(model->fps * model->end <= MOST_FRAMES))
        return scene_tree_fail(tree, by_default ? end : fps, error,
                               "time.fps * time.end is %g frames; at most %.0f are possible",
                               model->fps * model->end, MOST_FRAMES);
    return CLOTH_OK;
}

static enum model_preconditioner preconditioner_of(const char *word)
{
    static const char *const words[] = {[MODEL_PLAIN] = "none",
                                        [MODEL_JACOBI] = "jacobi",
                                        [MODEL_IC0] = "ic0",
                                        [MODEL_COARSE] = "coarse",
                                        [MODEL_IC0_COARSE] = "ic0_coarse"};
    int found = MODEL_PLAIN;
    for (int i = 0; i < (int)(sizeof words / sizeof *words); i++)
        if (!strcmp(words[i], word))
            found = i;
    return (enum model_preconditioner)found;
}

static enum model_integrator integrator_of(const char *word)
{
    int found = MODEL_IMPLICIT_EULER;
    for (int i = 0; i < MODEL_INTEGRATORS; i++)
        if (!strcmp(model_integrator_name((enum model_integrator)i), word))
            found = i;
    return (enum model_integrator)found;
}

static enum solve_format format_of(const char *word)
{
    if (!strcmp(word, "half"))
        return SOLVE_HALF;
    return strcmp(word, "half_float") ? SOLVE_SPRINGS : SOLVE_HALF_FLOAT;
}

static enum model_guess guess_of(const char *word)
{
    if (!strcmp(word, "previous"))
        return MODEL_GUESS_PREVIOUS;
    return strcmp(word, "zero") ? MODEL_GUESS_AUTO : MODEL_GUESS_ZERO;
}

static int slope_of(const char *word)
{
    if (!strcmp(word, "full"))
        return PHYS_FULL;
    return strcmp(word, "absolute") ? PHYS_DEFINITE : PHYS_ABSOLUTE;
}

static void build_solver(struct model *model, const struct scene_tree *tree)
{
    int newton = scene_tree_get(tree, 1, "newton");
    int solver = scene_tree_get(tree, 1, "solver"), stop = scene_tree_get(tree, solver, "stop");
    model->integrator = integrator_of(scene_tree_text(tree, 1, "integrator"));
    model->energy_steps = !strcmp(scene_tree_text(tree, 1, "energies"), "steps");
    model->newton_steps = scene_tree_integer(tree, newton, "steps");
    model->newton_tolerance = scene_tree_number(tree, newton, "tolerance");
    model->preconditioner = preconditioner_of(scene_tree_text(tree, solver, "preconditioner"));
    model->guess = guess_of(scene_tree_text(tree, solver, "guess"));
    model->patches =
        scene_tree_get(tree, solver, "patches") ? scene_tree_integer(tree, solver, "patches") : 0;
    model->format = format_of(scene_tree_text(tree, solver, "format"));
    model->full_slope = slope_of(scene_tree_text(tree, solver, "jacobian"));
    model->max_iterations = scene_tree_integer(tree, solver, "max_iterations");
    if (scene_tree_get(tree, stop, "count")) {
        model->stop = MODEL_STOP_COUNT;
        model->max_iterations = scene_tree_integer(tree, stop, "count");
    } else if (scene_tree_get(tree, stop, "absolute")) {
        model->stop = MODEL_STOP_ABSOLUTE;
        model->tolerance = scene_tree_number(tree, stop, "absolute");
    } else if (scene_tree_get(tree, stop, "normalised")) {
        model->stop = MODEL_STOP_NORMALISED;
        model->tolerance = scene_tree_number(tree, stop, "normalised");
    } else if (scene_tree_get(tree, stop, "mass_norm")) {
        model->stop = MODEL_STOP_MASS_NORM;
        model->tolerance = scene_tree_number(tree, stop, "mass_norm");
    } else {
        model->stop = MODEL_STOP_RELATIVE;
        model->tolerance = scene_tree_number(tree, stop, "relative");
    }
}

static int build_air(struct model *model, const struct scene_tree *tree, struct cloth_error *error)
{
    const int air = scene_tree_get(tree, 1, "air");
    if (!air)
        return CLOTH_OK;
    model->air.density = scene_tree_number(tree, air, "density");
    model->air.normal = scene_tree_number(tree, air, "normal");
    model->air.tangent = scene_tree_number(tree, air, "tangent");
    scene_tree_vector(tree, scene_tree_get(tree, air, "wind"), 3, model->air.wind);
    return scene_build_course(model, &model->wind_course, tree, air, error);
}

int scene_build_world(struct model *model, const struct scene_tree *tree, struct cloth_error *error)
{
    model->grain = scene_tree_integer(tree, 1, "grain");
    scene_tree_vector(tree, scene_tree_get(tree, 1, "gravity"), 3, model->gravity);
    build_solver(model, tree);
    if (!strcmp(scene_tree_text(tree, 1, "contact"), "filter"))
        model->contact = MODEL_CONTACT_FILTER;
    int code = build_name(model, tree, error);
    if (!code)
        code = build_time(model, tree, error);
    if (!code)
        code = build_air(model, tree, error);
    if (!code)
        code = build_materials(model, tree, error);
    return code ? code : scene_build_obstacles(model, tree, error);
}
