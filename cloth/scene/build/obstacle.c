/* Obstacles, and whether they leave the cloths any room. */
#include "cloth/scene/build/build.h"

#include <math.h>

static const double TOUCH = 1e-9; /* m: planes that overlap by less touch */

static int build_plane(struct model_plane *plane, const struct scene_tree *tree, int node,
                       struct cloth_error *error)
{
    scene_tree_vector(tree, scene_tree_get(tree, node, "point"), 3, plane->point);
    return scene_build_direction(plane->normal, "the normal of a plane", tree,
                                 scene_tree_get(tree, node, "normal"), error);
}

int scene_build_obstacles(struct model *model, const struct scene_tree *tree,
                          struct cloth_error *error)
{
    int list = scene_tree_get(tree, 1, "obstacles");
    size_t n = scene_tree_length(tree, list);
    model->planes = scene_build_array(n, sizeof *model->planes, error);
    if (!model->planes)
        return error->code;
    model->n_planes = (uint32_t)n;
    int code = CLOTH_OK;
    for (size_t i = 0; !code && i < n; i++) {
        int obstacle = scene_tree_item(tree, list, i);
        code = build_plane(&model->planes[i], tree, scene_tree_get(tree, obstacle, "plane"), error);
    }
    return code;
}

/* How far a point is on the free side of a plane. */
static double height(const struct model_plane *plane, const double x[3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += plane->normal[i] * (x[i] - plane->point[i]);
    return sum;
}

/* The middle of the box around a mesh, and how far from it the corners of the box are. */
static double surround(const struct mesh *mesh, double middle[3])
{
    double square = 0;
    for (size_t i = 0; i < 3; i++) {
        double least = INFINITY, most = -INFINITY;
        for (size_t v = 0; v < mesh->n_vertices; v++) {
            least = fmin(least, mesh->position[3 * v + i]);
            most = fmax(most, mesh->position[3 * v + i]);
        }
        middle[i] = (least + most) / 2;
        square += (most - least) * (most - least) / 4;
    }
    return sqrt(square);
}

/* Whether no point so near to the middle is on the free sides of both: there the sum of both
 * heights is below 0, since it grows with the sum of the normals only. */
static bool exclude(const struct model_plane *a, const struct model_plane *b,
                    const double middle[3], double radius)
{
    double cosine = 0, square = 0;
    for (int i = 0; i < 3; i++) {
        cosine += a->normal[i] * b->normal[i];
        square += (a->normal[i] + b->normal[i]) * (a->normal[i] + b->normal[i]);
    }
    return cosine < 0 && height(a, middle) + height(b, middle) + radius * sqrt(square) < -TOUCH;
}

static int check_pair(const struct model *model, const struct scene_tree *tree, uint32_t a,
                      uint32_t b, struct cloth_error *error)
{
    for (uint32_t c = 0; c < model->n_cloths; c++) {
        const struct model_cloth *cloth = model->cloths + c;
        double middle[3];
        const double radius = surround(&cloth->mesh, middle);
        if (exclude(model->planes + a, model->planes + b, middle, radius))
            return scene_tree_fail(
                tree, scene_tree_item(tree, scene_tree_get(tree, 1, "obstacles"), b), error,
                "obstacles[%u] and obstacles[%u] face each other and overlap: around cloth '%.60s' "
                "no point is on the free sides of both; turn a normal round, or move a plane",
                b, a, cloth->name);
    }
    return CLOTH_OK;
}

int scene_build_check_obstacles(const struct model *model, const struct scene_tree *tree,
                                struct cloth_error *error)
{
    int code = CLOTH_OK;
    for (uint32_t b = 0; b < model->n_planes; b++)
        for (uint32_t a = 0; a < b && !code; a++)
            code = check_pair(model, tree, a, b, error);
    return code;
}
