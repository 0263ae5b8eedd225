/* Wavefront OBJ: as the mesh of a cloth, and as a surface. */
#include "cloth/mesh/mesh.h"
#include "tests/fuzz/fuzz.h"

#include <stdlib.h>

static void use(struct mesh *mesh)
{
    struct mesh_edges edges = {0};
    struct cloth_error error = {0};
    double u[3], v[3], uv[2], sum = 0;
    if (!mesh_edges_find(&edges, mesh, &error))
        mesh_edges_free(&edges);
    mesh_axes(mesh, u, v);
    uint32_t *same = calloc((size_t)mesh->n_vertices + 1, sizeof *same);
    if (same && !mesh_coincide(mesh, 1e-5, same, &error))
        sum += same[mesh->n_vertices - 1];
    free(same);
    for (uint32_t t = 0; t < mesh->n_triangles; t++)
        for (size_t i = 0; i < 3; i++)
            if (mesh_uv(mesh, mesh_uv_number(mesh, t, mesh->triangle[3 * (size_t)t + i]), uv))
                sum += uv[0];
    for (uint32_t c = 0; mesh->face_uv && c < mesh->face_start[mesh->n_faces]; c++)
        if (mesh_uv(mesh, mesh->face_uv[c], uv))
            sum += uv[1];
    for (uint32_t r = 0; r < mesh->n_material_runs; r++)
        sum += mesh->material[mesh->material_run[r].group][0];
    for (uint32_t l = 0; l < mesh->n_libraries; l++)
        sum += mesh->library[l][0];
    volatile double used = sum; /* else nothing would be read */
    (void)used;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct cloth_error error = {0};
    struct mesh mesh;
    const char *path = fuzz_file("mesh.obj", data, size);
    if (!mesh_read_obj(&mesh, path, &error))
        use(&mesh);
    mesh_free(&mesh);
    error = (struct cloth_error){0};
    if (!mesh_read_surface(&mesh, path, &error))
        use(&mesh);
    mesh_free(&mesh);
    return 0;
}
