/* Wavefront OBJ: as the mesh of a cloth, and as a surface. */
#include "cloth/mesh/mesh.h"
#include "tests/fuzz/fuzz.h"

static void use(struct mesh *mesh)
{
    struct mesh_edges edges = {0};
    struct cloth_error error = {0};
    double u[3], v[3];
    if (!mesh_edges_find(&edges, mesh, &error))
        mesh_edges_free(&edges);
    mesh_axes(mesh, u, v);
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
