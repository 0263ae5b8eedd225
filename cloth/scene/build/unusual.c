/* Values that are allowed, but hardly ever meant, draw a warning each: often the unit is another.
 */
#include "cloth/scene/build/build.h"
#include "cloth/scene/yaml/scalar.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double LEAST_DENSITY = 0.005, MOST_DENSITY = 5; /* kg/m^2: of a veil, of a carpet */
static const double MOST_RIGIDITY = 1e-2;                    /* N m: of thick leather */
static const double FAR = 2; /* a quaternion's length, or 1 by it: [1, 1, 1, 1] is often written */

struct unusual {
    struct model *model;
    const struct scene_tree *tree;
    struct cloth_error *error;
};

#define WARN(of, node, ...)                                                                        \
    scene_build_warn((of)->model, (of)->tree, node, (of)->error, __VA_ARGS__)

/* Number i of a node, a number or a list of n of them; 0: it has no node. */
static double unusual_number_of(const struct unusual *of, int node, size_t i, int *at, size_t *n)
{
    const bool list = scene_tree_is(of->tree, node, YAML_SEQUENCE_NODE);
    double value = 0;
    *n = !node ? 0 : list ? scene_tree_length(of->tree, node) : 1;
    *at = list ? scene_tree_item(of->tree, node, i) : node;
    if (node)
        scene_scalar_number(scene_tree_scalar(of->tree, *at), &value);
    return value;
}

static int warn_of_density(const struct unusual *of, const char *name, int material)
{
    const int node = scene_tree_get(of->tree, material, "density");
    int at;
    size_t n;
    const double value = unusual_number_of(of, node, 0, &at, &n);
    if (!n || (value >= LEAST_DENSITY && value <= MOST_DENSITY))
        return CLOTH_OK;
    return WARN(of, at,
                "materials.%.60s.density is %g kg/m^2; fabrics have %g to %g: is its unit right?",
                name, value, LEAST_DENSITY, MOST_DENSITY);
}

static int warn_of_rigidity(const struct unusual *of, const char *name, int material)
{
    const int bending = scene_tree_get(of->tree, material, "bending");
    const int node = scene_tree_get(of->tree, bending, "rigidity");
    size_t n = 1;
    for (size_t i = 0; i < n; i++) {
        int at;
        const double value = unusual_number_of(of, node, i, &at, &n);
        if (n && value > MOST_RIGIDITY)
            return WARN(of, at,
                        "materials.%.60s.bending.rigidity is %g N m; fabrics have up to %g: is "
                        "its unit right?",
                        name, value, MOST_RIGIDITY);
    }
    return CLOTH_OK;
}

/* Warns of the stretch of a material of triangles. */
static int warn_of_stretch(const struct unusual *of, const char *name, int material)
{
    static const char *const along[] = {" along the warp", " along the weft"};
    const int node = scene_tree_get(of->tree, material, "stretch");
    size_t n = 1;
    for (size_t i = 0; i < n; i++) {
        int at;
        const double value = unusual_number_of(of, node, i, &at, &n);
        if (n && !(value > 0))
            return WARN(of, at, "materials.%.60s.stretch is 0%s: nothing resists being stretched%s",
                        name, n > 1 ? along[i] : "", n > 1 ? " there" : "");
    }
    return CLOTH_OK;
}

/* Diagonals that only triangles without shear hold fold without a force. */
static int warn_of_shear(const struct unusual *of, uint32_t i, int material)
{
    if (of->model->materials[i].model != MODEL_TRIANGLES || of->model->materials[i].shear > 0)
        return CLOTH_OK;
    return WARN(of, material,
                "materials.%.60s.shear is 0: nothing resists its triangles' being sheared",
                of->model->materials[i].name);
}

static int warn_of_material(const struct unusual *of, uint32_t i)
{
    const int map = scene_tree_get(of->tree, 1, "materials");
    const int material = scene_tree_pair(of->tree, map, i).value;
    const char *name = of->model->materials[i].name;
    bool triangles, edges;
    model_parts(of->model, i, &triangles, &edges);
    int code = warn_of_density(of, name, material);
    if (!code)
        code = warn_of_rigidity(of, name, material);
    if (!code && triangles)
        code = warn_of_stretch(of, name, material);
    return code || !triangles ? code : warn_of_shear(of, i, material);
}

static int warn_of_turn(const struct unusual *of, int rotate)
{
    double turn[4], square = 0;
    if (!rotate)
        return CLOTH_OK;
    scene_tree_vector(of->tree, rotate, 4, turn);
    for (int i = 0; i < 4; i++)
        square += turn[i] * turn[i];
    const double length = sqrt(square);
    if (length <= FAR && length * FAR >= 1)
        return CLOTH_OK;
    return WARN(of, rotate,
                "rotate is a quaternion of length %g, which is taken as if it were 1; [w, x, y, z] "
                "is cos(a/2) and sin(a/2) times the axis of a turn by a",
                length);
}

/* Warns of the key rotate of a map and of its motion. */
static int warn_of_turns(const struct unusual *of, int map)
{
    const int motion = scene_tree_get(of->tree, map, "motion");
    const int list = scene_tree_get(of->tree, motion, "rotate");
    int code = warn_of_turn(of, scene_tree_get(of->tree, map, "rotate"));
    for (size_t i = 0; i < scene_tree_length(of->tree, list) && !code; i++)
        code = warn_of_turn(of, scene_tree_item(of->tree, list, i));
    return code;
}

/* Warns of the turns of a list of maps. */
static int warn_of_list(const struct unusual *of, int list)
{
    int code = CLOTH_OK;
    for (size_t i = 0; i < scene_tree_length(of->tree, list) && !code; i++)
        code = warn_of_turns(of, scene_tree_item(of->tree, list, i));
    return code;
}

static int warn_of_cloth(const struct unusual *of, int cloth)
{
    int code = warn_of_turns(of, scene_tree_get(of->tree, cloth, "transform"));
    if (!code)
        code = warn_of_list(of, scene_tree_get(of->tree, cloth, "start"));
    return code ? code : warn_of_list(of, scene_tree_get(of->tree, cloth, "pins"));
}

/* A joint acts in the steps that begin within its time, to a tick of h / 1024. */
static int warn_of_joint(const struct unusual *of, int joint)
{
    const double h = of->model->h, begin = scene_tree_number(of->tree, joint, "begin");
    const int end_node = scene_tree_get(of->tree, joint, "end");
    const bool ends = strcmp(scene_tree_scalar(of->tree, end_node), "never") != 0;
    const double end = ends ? scene_tree_number(of->tree, joint, "end") : INFINITY;
    const double tick = h / 1024, first = ceil((begin - tick / 2) / h) * h;
    const int node = scene_tree_get(of->tree, joint, "begin");
    if (begin >= of->model->end)
        return WARN(of, node, "the joint begins at %g s, when the run is over", begin);
    if (first > of->model->end - tick / 2)
        return WARN(of, node, "the joint begins at %g s, after the last step has begun", begin);
    if (first > end - tick / 2)
        return WARN(of, node,
                    "the joint acts from %g s to %g s, when no step of %g s begins; only shorter "
                    "ones can have it",
                    begin, end, h);
    return CLOTH_OK;
}

int scene_build_unusual(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    const struct unusual of = {model, tree, error};
    const int cloths = scene_tree_get(tree, 1, "cloths");
    const int obstacles = scene_tree_get(tree, 1, "obstacles");
    const int joints = scene_tree_get(tree, 1, "joints");
    int code = CLOTH_OK;
    for (uint32_t i = 0; i < model->n_materials && !code; i++)
        code = warn_of_material(&of, i);
    for (size_t i = 0; i < scene_tree_length(tree, cloths) && !code; i++)
        code = warn_of_cloth(&of, scene_tree_item(tree, cloths, i));
    for (size_t i = 0; i < scene_tree_length(tree, obstacles) && !code; i++) {
        const int shape = scene_tree_item(tree, obstacles, i);
        code = warn_of_turns(&of, scene_tree_pair(tree, shape, 0).value);
    }
    for (size_t i = 0; i < scene_tree_length(tree, joints) && !code; i++)
        code = warn_of_joint(&of, scene_tree_item(tree, joints, i));
    return code;
}
