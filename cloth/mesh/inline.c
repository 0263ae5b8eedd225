/* A mesh from arrays: copies, so that the caller's arrays may go. */
#include "cloth/base/memory.h"
#include "cloth/mesh/detail/finish.h"
#include "cloth/mesh/mesh.h"

#include <math.h>
#include <string.h>

static int check_input(uint32_t n_vertices, const double *vertices, uint32_t n_edges,
                       uint32_t n_triangles, struct cloth_error *error)
{
    if (n_vertices == 0)
        return cloth_fail(error, CLOTH_E_INPUT, "the mesh has no vertices; it needs at least one");
    if (n_vertices > MESH_MAX || n_triangles > MESH_MAX / 3 || n_edges > MESH_MAX / 2)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "the mesh is too large: at most %u vertices, %u triangles and %u edges",
                          MESH_MAX, MESH_MAX / 3, MESH_MAX / 2);
    for (size_t i = 0; i < 3 * (size_t)n_vertices; i++)
        if (!isfinite(vertices[i]))
            return cloth_fail(error, CLOTH_E_INPUT, "vertices[%zu]: %g is not a finite number",
                              i / 3, vertices[i]);
    return CLOTH_OK;
}

static void *inline_copy(const void *from, size_t n, size_t size, struct cloth_error *error)
{
    void *to = cloth_alloc(n, size, error);
    if (to && n)
        memcpy(to, from, n * size);
    return to;
}

int mesh_inline(struct mesh *mesh, uint32_t n_vertices, const double *vertices, uint32_t n_edges,
                const uint32_t *edges, uint32_t n_triangles, const uint32_t *triangles,
                struct cloth_error *error)
{
    *mesh = (struct mesh){0};
    int code = check_input(n_vertices, vertices, n_edges, n_triangles, error);
    if (code)
        return code;
    mesh->n_vertices = n_vertices;
    mesh->n_lone_edges = n_edges;
    mesh->n_faces = n_triangles;
    mesh->position = inline_copy(vertices, n_vertices, 3 * sizeof *vertices, error);
    mesh->lone_edge = inline_copy(edges, n_edges, 2 * sizeof *edges, error);
    mesh->face_corner = inline_copy(triangles, n_triangles, 3 * sizeof *triangles, error);
    mesh->face_start = cloth_alloc((size_t)n_triangles + 1, sizeof *mesh->face_start, error);
    if (!mesh->position || !mesh->lone_edge || !mesh->face_corner || !mesh->face_start) {
        mesh_free(mesh);
        return CLOTH_E_MEMORY;
    }
    for (uint32_t f = 0; f <= n_triangles; f++)
        mesh->face_start[f] = 3 * f;
    code = mesh_finish(mesh, &(struct mesh_source){0}, error);
    if (code)
        mesh_free(mesh);
    return code;
}
