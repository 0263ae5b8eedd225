/* A cloth's mesh: made or read, then transformed. Errors of a mesh name its file and line
 * themselves; the place in the scene that asked for it is put before them. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/schema/check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The bytes that a vertex of a grid takes on rank 0 while it is cut, for any number of ranks:
 * position, graph, METIS. The system overcommits memory, so an allocation is no test. */
static const double LEAST_BYTES = 150;

/* The memory of this machine; infinite if unknown. */
static double memory_bytes(void)
{
    const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0 ? (double)pages * (double)size : INFINITY;
}

/* The height follows from the width if triangles are equilateral. */
static int grid_height(struct scene_grid *grid, const struct scene_tree *tree, int node,
                       struct cloth_error *error)
{
    const double near = 1e-3, follows = mesh_row_distance(grid->width, grid->nx) * (grid->ny - 1.0);
    const int given = scene_tree_get(tree, node, "height");
    if (!given && grid->cells != MESH_EQUILATERAL)
        return scene_tree_fail(tree, node, error,
                               "mesh.grid.height is missing; a finite number > 0 (m) is expected");
    if (!given)
        grid->height = follows;
    if (grid->cells != MESH_EQUILATERAL || fabs(grid->height / follows - 1) <= near)
        return CLOTH_OK;
    return scene_tree_fail(
        tree, given, error,
        "mesh.grid.height is %g, but the height of %u rows of equilateral "
        "triangles follows of the width and nx: %.6g m is expected, or no height",
        grid->height, grid->ny, follows);
}

int scene_build_check_memory(uint64_t n, const char *what, const struct scene_tree *tree, int node,
                             struct cloth_error *error)
{
    const double need = LEAST_BYTES * (double)n, memory = memory_bytes();
    if (need <= memory)
        return CLOTH_OK;
    return scene_tree_fail(tree, node, error,
                           "%s %llu vertices, which take %.0f GB of memory or more; this machine "
                           "has %.0f GB",
                           what, (unsigned long long)n, need / 1e9, memory / 1e9);
}

static int build_disc(struct mesh *mesh, struct scene_tree *tree, int node,
                      struct cloth_error *error, struct cloth_error *inner)
{
    struct scene_disc disc = {0};
    int code = scene_fill(&disc, &scene_disc, tree, node, error);
    const uint64_t n = 1 + 3 * (uint64_t)disc.rings * (disc.rings + 1);
    if (!code)
        code = scene_build_check_memory(n, "so many rings have", tree,
                                        scene_tree_get(tree, node, "rings"), error);
    return code ? code : mesh_disc(mesh, disc.radius, disc.rings, inner);
}

static int build_grid(struct mesh *mesh, struct scene_tree *tree, int node,
                      struct cloth_error *error, struct cloth_error *inner)
{
    struct scene_grid grid = {0};
    int code = scene_fill(&grid, &scene_grid, tree, node, error);
    const uint64_t n = (uint64_t)grid.nx * grid.ny;
    if (code)
        return code;
    if (n > UINT32_C(1) << 31)
        return scene_tree_fail(tree, scene_tree_get(tree, node, "nx"), error,
                               "nx times ny is %llu; at most 2^31 vertices are possible",
                               (unsigned long long)n);
    code = scene_build_check_memory(n, "nx times ny is", tree, scene_tree_get(tree, node, "nx"),
                                    error);
    if (!code)
        code = grid_height(&grid, tree, node, error);
    return code ? code
                : mesh_grid(mesh, grid.width, grid.height, grid.nx, grid.ny, grid.cells, inner);
}

/* The path of a file that a scene names: relative to the scene's folder. */
static char *path_beside(const char *scene, const char *name, struct cloth_error *error)
{
    const char *slash = strrchr(scene, '/');
    size_t folder = slash && *name != '/' ? (size_t)(slash - scene) + 1 : 0;
    size_t size = strlen(name) + 1;
    char *path = scene_build_array(folder + size, 1, error);
    if (path) {
        memcpy(path, scene, folder);
        memcpy(path + folder, name, size);
    }
    return path;
}

int scene_build_file(struct model *model, const char *path, struct cloth_error *error)
{
    char *copy = scene_build_copy(path, error);
    char **all =
        copy ? scene_build_grow(model->files, model->n_files, 1, sizeof *all, error) : NULL;
    if (!all) {
        free(copy);
        return error->code;
    }
    model->files = all;
    all[model->n_files++] = copy;
    return CLOTH_OK;
}

char *scene_build_path(struct model *model, const struct scene_tree *tree, int node,
                       struct cloth_error *error)
{
    char *path = path_beside(tree->path, scene_tree_scalar(tree, node), error);
    if (path && scene_build_file(model, path, error)) {
        free(path);
        path = NULL;
    }
    return path;
}

int scene_build_obj(struct model *model, struct mesh *mesh, scene_obj_reader *reads,
                    const struct scene_tree *tree, int node, struct cloth_error *error,
                    struct cloth_error *inner)
{
    char *path = scene_build_path(model, tree, node, error);
    const int code = path ? reads(mesh, path, inner) : error->code;
    free(path);
    return code == CLOTH_E_IO ? CLOTH_E_INPUT : code; /* a scene that names no readable file */
}

static int build_inline(struct mesh *mesh, struct scene_tree *tree, int node,
                        struct cloth_error *error, struct cloth_error *inner)
{
    struct scene_inline parts = {0};
    int code = scene_fill(&parts, &scene_inline, tree, node, error);
    if (!code)
        code = mesh_inline(mesh, parts.n_vertices, *parts.vertices, parts.n_edges, *parts.edges,
                           parts.n_triangles, *parts.triangles, inner);
    free(parts.vertices);
    free(parts.edges);
    free(parts.triangles);
    return code;
}

int scene_build_check_turn(const struct mesh_transform *transform, const struct scene_tree *tree,
                           int node, struct cloth_error *error)
{
    double square = 0;
    for (int i = 0; i < 4; i++)
        square += transform->rotate[i] * transform->rotate[i];
    if (!(square > 1e-200) || !isfinite(square))
        return scene_tree_fail(tree, scene_tree_get(tree, node, "rotate"), error,
                               "the quaternion [w, x, y, z] has no direction; its length must be "
                               "neither zero nor huge");
    return CLOTH_OK;
}

yaml_node_pair_t scene_build_mesh_kind(const struct scene_tree *tree, int node)
{
    const int mesh = scene_tree_get(tree, node, "mesh");
    const yaml_node_pair_t first = scene_tree_pair(tree, mesh, 0);
    const bool other = !strcmp(scene_tree_scalar(tree, first.key), "weld");
    return other ? scene_tree_pair(tree, mesh, 1) : first;
}

/* Warns of partial uv: it does not count, though its author means it to. */
static int warn_of_uv(struct model *model, const struct mesh *mesh, const struct scene_tree *tree,
                      int node, struct cloth_error *error)
{
    if (!mesh->n_without_uv)
        return CLOTH_OK;
    return scene_build_warn(model, tree, node, error,
                            "%u of %u faces have corners without vt, so that no uv of the mesh "
                            "counts: warp and weft follow its longest axes",
                            mesh->n_without_uv, mesh->n_faces);
}

int scene_build_mesh(struct model *model, struct model_cloth *cloth, struct scene_tree *tree,
                     int node, struct cloth_error *error)
{
    struct mesh *mesh = &cloth->mesh;
    struct cloth_error inner = {0};
    struct mesh_transform transform;
    const int change = scene_tree_get(tree, node, "transform");
    const yaml_node_pair_t kind = scene_build_mesh_kind(tree, node);
    const char *name = scene_tree_scalar(tree, kind.key);
    int code = scene_fill(&transform, &scene_transform, tree, change, error);
    if (!code)
        code = scene_build_check_turn(&transform, tree, change, error);
    if (code)
        return code;
    if (!strcmp(name, "grid"))
        code = build_grid(mesh, tree, kind.value, error, &inner);
    else if (!strcmp(name, "disc"))
        code = build_disc(mesh, tree, kind.value, error, &inner);
    else if (!strcmp(name, "file"))
        code = scene_build_obj(model, mesh, mesh_read_obj, tree, kind.value, error, &inner);
    else if (!strcmp(name, "pattern"))
        code = scene_build_pattern(model, cloth, tree, kind.value, error, &inner);
    else
        code = build_inline(mesh, tree, kind.value, error, &inner);
    code = scene_build_blame(code, &inner, "mesh", tree, kind.value, error);
    if (code)
        return code;
    mesh_apply(mesh, &transform);
    return warn_of_uv(model, mesh, tree, kind.value, error);
}
