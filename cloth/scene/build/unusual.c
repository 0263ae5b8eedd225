/* Values that are allowed, but hardly ever meant, draw a warning each: often the unit is another.
 */
#include "cloth/scene/build/build.h"

#include <float.h>
#include <math.h>

static const double LEAST_DENSITY = 0.005, MOST_DENSITY = 5; /* kg/m^2: of a veil, of a carpet */
static const double MOST_RIGIDITY = 1e-2;                    /* N m: of thick leather */
static const double FAR = 2; /* a quaternion's length, or 1 by it: [1, 1, 1, 1] is often written */

/* ---- Materials ---- */

/* The number of the first value of a node, one or a list of them, that is not from low to high;
 * -1: all are. */
static int find_beyond(const struct scene_tree *tree, int node, double low, double high,
                       double *value)
{
    const int n = !node                           ? 0
                  : scene_tree_scalar(tree, node) ? 1
                                                  : (int)scene_tree_length(tree, node);
    for (int i = 0; i < n; i++) {
        scene_tree_vector(tree, scene_tree_part(tree, node, (size_t)i), 1, value);
        if (!(*value >= low && *value <= high))
            return i;
    }
    return -1;
}

static void warn_of_values(const struct scene_tree *tree, const char *name, int material)
{
    const int density = scene_tree_get(tree, material, "density");
    const int rigidity = scene_tree_at(tree, material, "bending.rigidity");
    double value;
    if (find_beyond(tree, density, LEAST_DENSITY, MOST_DENSITY, &value) >= 0)
        scene_build_warn(tree, density,
                         "materials.%.60s.density is %g kg/m^2; fabrics have %g to %g: is its unit "
                         "right?",
                         name, value, LEAST_DENSITY, MOST_DENSITY);
    const int i = find_beyond(tree, rigidity, 0, MOST_RIGIDITY, &value);
    if (i >= 0)
        scene_build_warn(tree, scene_tree_part(tree, rigidity, (size_t)i),
                         "materials.%.60s.bending.rigidity is %g N m; fabrics have up to %g: is "
                         "its unit right?",
                         name, value, MOST_RIGIDITY);
}

/* Diagonals that only triangles without shear hold fold without a force. */
static void warn_of_triangles(const struct scene_tree *tree, const struct model_material *material,
                              int node)
{
    static const char *const along[] = {" along the warp", " along the weft"};
    const int stretch = scene_tree_get(tree, node, "stretch");
    const bool one = stretch && scene_tree_scalar(tree, stretch);
    double value;
    const int i = find_beyond(tree, stretch, DBL_TRUE_MIN, INFINITY, &value);
    if (i >= 0)
        scene_build_warn(tree, scene_tree_part(tree, stretch, (size_t)i),
                         "materials.%.60s.stretch is 0%s: nothing resists being stretched%s",
                         material->name, one ? "" : along[i], one ? "" : " there");
    if (material->model == MODEL_TRIANGLES && !(material->shear > 0))
        scene_build_warn(tree, node,
                         "materials.%.60s.shear is 0: nothing resists its triangles' being sheared",
                         material->name);
}

/* ---- Turns ---- */

static void warn_of_turn(const struct scene_tree *tree, int rotate)
{
    double turn[4], square = 0;
    if (!scene_tree_is(tree, rotate, YAML_SEQUENCE_NODE))
        return; /* an axis and an angle */
    scene_tree_vector(tree, rotate, 4, turn);
    for (int i = 0; i < 4; i++)
        square += turn[i] * turn[i];
    const double length = sqrt(square);
    if (!(length <= FAR && length * FAR >= 1))
        scene_build_warn(tree, rotate,
                         "rotate is a quaternion of length %g, which is taken as if it were 1; [w, "
                         "x, y, z] is cos(a/2) and sin(a/2) times the axis of a turn by a",
                         length);
}

/* Warns of the key rotate of a map and of its motion. */
static void warn_of_turns(const struct scene_tree *tree, int map)
{
    const int rotate = scene_tree_get(tree, map, "rotate");
    const int list = scene_tree_at(tree, map, "motion.rotate");
    if (rotate)
        warn_of_turn(tree, rotate);
    for (size_t i = 0; i < scene_tree_length(tree, list); i++)
        warn_of_turn(tree, scene_tree_item(tree, list, i));
}

/* Warns of the turns of a list of maps. */
static void warn_of_list(const struct scene_tree *tree, int list)
{
    for (size_t i = 0; i < scene_tree_length(tree, list); i++)
        warn_of_turns(tree, scene_tree_item(tree, list, i));
}

/* ---- Joints ---- */

/* A joint acts in the steps that begin within its time, to a tick of h / 1024. */
static void warn_of_joint(const struct scene_tree *tree, const struct model_joint *joint, int map)
{
    const struct model *model = tree->model;
    const double h = model->h, begin = joint->begin;
    const double end = joint->end > 0 ? joint->end : INFINITY;
    const double tick = h / 1024, first = ceil((begin - tick / 2) / h) * h;
    const int node = scene_tree_get(tree, map, "begin");
    if (begin >= model->end)
        scene_build_warn(tree, node, "the joint begins at %g s, when the run is over", begin);
    else if (first > model->end - tick / 2)
        scene_build_warn(tree, node, "the joint begins at %g s, after the last step has begun",
                         begin);
    else if (first > end - tick / 2)
        scene_build_warn(tree, node,
                         "the joint acts from %g s to %g s, when no step of %g s begins; only "
                         "shorter ones can have it",
                         begin, end, h);
}

int scene_build_unusual(struct scene_tree *tree)
{
    const struct model *model = tree->model;
    const int materials = scene_tree_get(tree, 1, "materials");
    const int cloths = scene_tree_get(tree, 1, "cloths");
    const int obstacles = scene_tree_get(tree, 1, "obstacles");
    const int joints = scene_tree_get(tree, 1, "joints");
    for (uint32_t i = 0; i < model->n_materials; i++) {
        const int node = scene_tree_pair(tree, materials, i).value;
        bool triangles, edges;
        model_parts(model, i, &triangles, &edges);
        warn_of_values(tree, model->materials[i].name, node);
        if (triangles)
            warn_of_triangles(tree, model->materials + i, node);
    }
    for (size_t i = 0; i < scene_tree_length(tree, cloths); i++) {
        const int cloth = scene_tree_item(tree, cloths, i);
        warn_of_turns(tree, scene_tree_get(tree, cloth, "transform"));
        warn_of_list(tree, scene_tree_get(tree, cloth, "start"));
        warn_of_list(tree, scene_tree_get(tree, cloth, "pins"));
    }
    for (size_t i = 0; i < scene_tree_length(tree, obstacles); i++)
        warn_of_turns(tree, scene_tree_pair(tree, scene_tree_item(tree, obstacles, i), 0).value);
    for (size_t i = 0; i < scene_tree_length(tree, joints); i++)
        warn_of_joint(tree, model->joints + i, scene_tree_item(tree, joints, i));
    return tree->error->code;
}
