/* A cloth's mesh: made or read, then transformed. Errors of a mesh name its file and line
 * themselves; the place in the scene that asked for it is put before them. */
#include "cloth/scene/build/build.h"
#include "cloth/scene/yaml/scalar.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What a vertex of a grid takes on rank 0 while it is cut, however many ranks there are: position,
 * graph, METIS. The system gives away more memory than it has, so asking for it is no test. */
static const double LEAST_BYTES = 150;

/* Of this machine; infinite where it does not say. */
static double memory_bytes(void)
{
    const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0 ? (double)pages * (double)size : INFINITY;
}

static enum mesh_cells cells_of(const char *word)
{
    if (!strcmp(word, "same"))
        return MESH_SAME;
    if (!strcmp(word, "equilateral"))
        return MESH_EQUILATERAL;
    return strcmp(word, "alternate") ? MESH_MIRRORED : MESH_ALTERNATE;
}

/* The height of a grid, m, which follows of its width where triangles are equilateral. */
static int grid_height(double *height, const struct scene_tree *tree, int node,
                       enum mesh_cells cells, uint32_t nx, uint32_t ny, struct cloth_error *error)
{
    const double near = 1e-3, width = scene_tree_number(tree, node, "width");
    const double follows = mesh_row_distance(width, nx) * (ny - 1.0);
    const int given = scene_tree_get(tree, node, "height");
    *height = given ? scene_tree_number(tree, node, "height") : follows;
    if (!given && cells != MESH_EQUILATERAL)
        return scene_tree_fail(tree, node, error,
                               "mesh.grid.height is missing; a finite number > 0 (m) is expected");
    if (cells != MESH_EQUILATERAL || fabs(*height / follows - 1) <= near)
        return CLOTH_OK;
    return scene_tree_fail(
        tree, given, error,
        "mesh.grid.height is %g, but the height of %u rows of equilateral "
        "triangles follows of the width and nx: %.6g m is expected, or no height",
        *height, ny, follows);
}

static int build_grid(struct mesh *mesh, const struct scene_tree *tree, int node,
                      struct cloth_error *error, struct cloth_error *inner)
{
    uint32_t nx = scene_tree_integer(tree, node, "nx"), ny = scene_tree_integer(tree, node, "ny");
    if ((uint64_t)nx * ny > UINT32_C(1) << 31)
        return scene_tree_fail(tree, scene_tree_get(tree, node, "nx"), error,
                               "nx times ny is %llu; at most 2^31 vertices are possible",
                               (unsigned long long)nx * ny);
    const double need = LEAST_BYTES * nx * ny, memory = memory_bytes();
    if (need > memory)
        return scene_tree_fail(
            tree, scene_tree_get(tree, node, "nx"), error,
            "nx times ny is %llu vertices, which take %.0f GB of memory or more; "
            "this machine has %.0f GB",
            (unsigned long long)nx * ny, need / 1e9, memory / 1e9);
    const enum mesh_cells cells = cells_of(scene_tree_text(tree, node, "cells"));
    double height;
    const int code = grid_height(&height, tree, node, cells, nx, ny, error);
    return code ? code
                : mesh_grid(mesh, scene_tree_number(tree, node, "width"), height, nx, ny, cells,
                            inner);
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

static int build_file(struct mesh *mesh, const struct scene_tree *tree, int node,
                      struct cloth_error *error, struct cloth_error *inner)
{
    char *path = path_beside(tree->path, scene_tree_scalar(tree, node), error);
    if (!path)
        return error->code;
    int code = mesh_read_obj(mesh, path, inner);
    free(path);
    return code == CLOTH_E_IO ? CLOTH_E_INPUT : code; /* a scene that names no readable file */
}

/* Lists of `width` whole numbers each, one after the other. NULL: out of memory. */
static uint32_t *indices_of(const struct scene_tree *tree, int list, size_t width,
                            struct cloth_error *error)
{
    size_t n = scene_tree_length(tree, list);
    uint32_t *index = scene_build_array(n * width, sizeof *index, error);
    for (size_t i = 0; index && i < n * width; i++) {
        int entry = scene_tree_item(tree, list, i / width);
        int corner = scene_tree_item(tree, entry, i % width);
        scene_scalar_integer(scene_tree_scalar(tree, corner), &index[i]);
    }
    return index;
}

static int build_inline(struct mesh *mesh, const struct scene_tree *tree, int node,
                        struct cloth_error *error, struct cloth_error *inner)
{
    int vertices = scene_tree_get(tree, node, "vertices");
    int edges = scene_tree_get(tree, node, "edges");
    int triangles = scene_tree_get(tree, node, "triangles");
    size_t n = scene_tree_length(tree, vertices);
    double *position = scene_build_array(3 * n, sizeof *position, error);
    uint32_t *edge = indices_of(tree, edges, 2, error);
    uint32_t *triangle = indices_of(tree, triangles, 3, error);
    int code = CLOTH_E_MEMORY;
    if (position && edge && triangle) {
        for (size_t i = 0; i < n; i++)
            scene_tree_vector(tree, scene_tree_item(tree, vertices, i), 3, position + 3 * i);
        code = mesh_inline(mesh, (uint32_t)n, position, (uint32_t)scene_tree_length(tree, edges),
                           edge, (uint32_t)scene_tree_length(tree, triangles), triangle, inner);
    }
    free(position);
    free(edge);
    free(triangle);
    return code;
}

int scene_build_transform(struct mesh_transform *transform, const struct scene_tree *tree, int node,
                          struct cloth_error *error)
{
    int scale = scene_tree_get(tree, node, "scale"), rotate = scene_tree_get(tree, node, "rotate");
    if (scene_tree_is(tree, scale, YAML_SEQUENCE_NODE))
        scene_tree_vector(tree, scale, 3, transform->scale);
    else
        for (int i = 0; i < 3; i++)
            transform->scale[i] = scene_tree_number(tree, node, "scale");
    scene_tree_vector(tree, scene_tree_get(tree, node, "translate"), 3, transform->translate);
    scene_tree_vector(tree, rotate, 4, transform->rotate);
    double square = 0;
    for (int i = 0; i < 4; i++)
        square += transform->rotate[i] * transform->rotate[i];
    if (!(square > 1e-200) || !isfinite(square))
        return scene_tree_fail(tree, rotate, error,
                               "the quaternion [w, x, y, z] has no direction; its length must be "
                               "neither zero nor huge");
    return CLOTH_OK;
}

int scene_build_mesh(struct mesh *mesh, const struct scene_tree *tree, int cloth,
                     struct cloth_error *error)
{
    struct cloth_error inner = {0};
    struct mesh_transform transform;
    yaml_node_pair_t kind = scene_tree_pair(tree, scene_tree_get(tree, cloth, "mesh"), 0);
    const char *name = scene_tree_scalar(tree, kind.key);
    int code =
        scene_build_transform(&transform, tree, scene_tree_get(tree, cloth, "transform"), error);
    if (code)
        return code;
    if (!strcmp(name, "grid"))
        code = build_grid(mesh, tree, kind.value, error, &inner);
    else if (!strcmp(name, "file"))
        code = build_file(mesh, tree, kind.value, error, &inner);
    else
        code = build_inline(mesh, tree, kind.value, error, &inner);
    if (inner.code == CLOTH_E_MEMORY)
        return cloth_fail(error, inner.code, "%s: %s", tree->path, inner.text);
    if (inner.code)
        return scene_tree_fail(tree, kind.value, error, "mesh: %s", inner.text);
    if (!code)
        mesh_apply(mesh, &transform);
    return code;
}
