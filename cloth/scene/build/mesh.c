/* A cloth's mesh: made or read, then transformed. Errors of a mesh name its file and line
 * themselves; the place in the scene that asked for it is put before them. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/check.h"

#include <math.h>
#include <stdlib.h>

/* The height follows from the width if triangles are equilateral. */
static int grid_height(struct scene_grid *grid, const struct scene_tree *tree, int node)
{
    const double near = 1e-3, follows = mesh_row_distance(grid->width, grid->nx) * (grid->ny - 1.0);
    const int given = scene_tree_get(tree, node, "height");
    if (!given && grid->cells != MESH_EQUILATERAL)
        return scene_tree_fail(tree, node,
                               "mesh.grid.height is missing; a finite number > 0 (m) is expected");
    if (!given)
        grid->height = follows;
    if (grid->cells != MESH_EQUILATERAL || fabs(grid->height / follows - 1) <= near)
        return CLOTH_OK;
    return scene_tree_fail(tree, given,
                           "mesh.grid.height is %g, but the height of %u rows of equilateral "
                           "triangles follows of the width and nx: %.6g m is expected, or no "
                           "height",
                           grid->height, grid->ny, follows);
}

static int build_grid(struct model_cloth *cloth, struct scene_tree *tree, int node)
{
    struct scene_grid grid = {0};
    const int nx = scene_tree_get(tree, node, "nx");
    if (scene_fill(&grid, &scene_grid, tree, node))
        return tree->error->code;
    const uint64_t n = (uint64_t)grid.nx * grid.ny;
    if (n > UINT32_C(1) << 31)
        return scene_tree_fail(tree, nx, "nx times ny is %llu; at most 2^31 vertices are possible",
                               (unsigned long long)n);
    return scene_build_check_memory(n, "nx times ny is", tree, nx) ||
           grid_height(&grid, tree, node) ||
           mesh_grid(&cloth->mesh, grid.width, grid.height, grid.nx, grid.ny, grid.cells,
                     &tree->inner);
}

static int build_disc(struct model_cloth *cloth, struct scene_tree *tree, int node)
{
    struct scene_disc disc = {0};
    if (scene_fill(&disc, &scene_disc, tree, node))
        return tree->error->code;
    const uint64_t n = 1 + 3 * (uint64_t)disc.rings * (disc.rings + 1);
    return scene_build_check_memory(n, "so many rings have", tree,
                                    scene_tree_get(tree, node, "rings")) ||
           mesh_disc(&cloth->mesh, disc.radius, disc.rings, &tree->inner);
}

static int build_file(struct model_cloth *cloth, struct scene_tree *tree, int node)
{
    return scene_build_obj(&cloth->mesh, mesh_read_obj, "mesh", tree, node);
}

static int build_inline(struct model_cloth *cloth, struct scene_tree *tree, int node)
{
    struct scene_inline parts = {0};
    const int code = scene_fill(&parts, &scene_inline, tree, node) ||
                     mesh_inline(&cloth->mesh, parts.n_vertices, *parts.vertices, parts.n_edges,
                                 *parts.edges, parts.n_triangles, *parts.triangles, &tree->inner);
    free(parts.vertices);
    free(parts.edges);
    free(parts.triangles);
    return code;
}

/* The keys of a mesh, one of which is there. Faults may be in tree->inner. */
static const struct {
    const char *key;
    scene_build_part *make;
} kinds[] = {{"grid", build_grid},
             {"disc", build_disc},
             {"file", build_file},
             {"inline", build_inline},
             {"pattern", scene_build_pattern}};

/* Before anything else a mesh takes the units and the axes of the scene. The start of a cloth has
 * no such keys. */
static void take_from_file(struct mesh_transform *transform, const struct scene_tree *tree,
                           int node)
{
    const char *units = scene_tree_text(tree, node, "units"),
               *up = scene_tree_text(tree, node, "up");
    double *q = transform->rotate;
    for (int i = 0; units && i < 3; i++)
        transform->scale[i] *= scene_word_value(scene_units, units, NULL) / 1e4;
    if (!up || scene_word_value(scene_ups, up, NULL) == 1)
        return;
    const double turned[4] = {q[0] + q[1], q[1] - q[0], q[2] - q[3], q[3] + q[2]};
    for (int i = 0; i < 4; i++) /* q, after a quarter turn from z to y */
        q[i] = turned[i] * M_SQRT1_2;
}

int scene_build_transform(struct mesh_transform *transform, const struct scene_tree *tree, int node)
{
    double square = 0;
    if (scene_build_quaternion(transform->rotate, tree, scene_tree_get(tree, node, "rotate")))
        return tree->error->code;
    for (int i = 0; i < 4; i++)
        square += transform->rotate[i] * transform->rotate[i];
    if (!(square > 1e-200) || !isfinite(square))
        return scene_tree_fail(tree, scene_tree_get(tree, node, "rotate"),
                               "the quaternion [w, x, y, z] has no direction; its length must be "
                               "neither zero nor huge");
    take_from_file(transform, tree, node);
    return CLOTH_OK;
}

int scene_build_mesh(struct model_cloth *cloth, struct scene_tree *tree, int node)
{
    struct mesh_transform transform;
    const int change = scene_tree_get(tree, node, "transform");
    const int map = scene_tree_get(tree, node, "mesh");
    size_t kind = 0;
    while (!scene_tree_get(tree, map, kinds[kind].key))
        kind++;
    const int at = scene_tree_get(tree, map, kinds[kind].key);
    if (scene_fill(&transform, &scene_transform, tree, change) ||
        scene_build_transform(&transform, tree, change) ||
        scene_build_blame(kinds[kind].make(cloth, tree, at), "mesh", tree, at))
        return tree->error->code;
    mesh_apply(&cloth->mesh, &transform);
    if (cloth->mesh.n_without_uv) /* it does not count, though its author means it to */
        scene_build_warn(tree, at,
                         "%u of %u faces have corners without vt, so that no uv of the mesh "
                         "counts: warp and weft follow its longest axes",
                         cloth->mesh.n_without_uv, cloth->mesh.n_faces);
    return tree->error->code;
}
