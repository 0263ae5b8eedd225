/* A grid's numbering is a promise that hashes rest on: row-major, u fastest, two triangles a cell
 * in cell order. */
#include "cloth/base/memory.h"
#include "cloth/mesh/detail/finish.h"
#include "cloth/mesh/mesh.h"

#include <math.h>
#include <string.h>

static int check_size(double width, double height, uint32_t nx, uint32_t ny,
                      struct cloth_error *error)
{
    if (!isfinite(width) || !isfinite(height) || width <= 0 || height <= 0)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "a grid of %g m by %g m cannot be made; both must be positive", width,
                          height);
    if (nx < 2 || ny < 2)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "a grid of %u x %u vertices has no cell; both numbers must be at least 2",
                          nx, ny);
    if ((uint64_t)nx * ny > MESH_MOST / 6)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "a grid of %u x %u vertices is too large; at most %u vertices", nx, ny,
                          MESH_MOST / 6);
    return CLOTH_OK;
}

static int make_arrays(struct mesh *mesh, uint32_t nx, uint32_t ny, struct cloth_error *error)
{
    mesh->grid_nx = nx;
    mesh->grid_ny = ny;
    mesh->n_vertices = nx * ny;
    mesh->n_faces = mesh->n_triangles = 2 * (nx - 1) * (ny - 1);
    mesh->position = cloth_alloc(mesh->n_vertices, 3 * sizeof(double), error);
    mesh->uv = cloth_alloc(mesh->n_vertices, 2 * sizeof(double), error);
    mesh->face_start = cloth_alloc((size_t)mesh->n_faces + 1, sizeof(uint32_t), error);
    mesh->face_corner = cloth_alloc(mesh->n_faces, 3 * sizeof(uint32_t), error);
    mesh->triangle = cloth_alloc(mesh->n_faces, 3 * sizeof(uint32_t), error);
    mesh->lone_edge = cloth_alloc(0, sizeof(uint32_t), error);
    return mesh->position && mesh->uv && mesh->face_start && mesh->face_corner && mesh->triangle &&
                   mesh->lone_edge
               ? CLOTH_OK
               : CLOTH_E_MEMORY;
}

/* Of the i-th of n points that divide a length centred on 0: x(n - 1 - i) = -x(i) to the last bit.
 */
static double centred(double length, uint32_t i, uint32_t n)
{
    return length * (2.0 * i - (n - 1.0)) / (2.0 * (n - 1.0));
}

static void place_vertices(struct mesh *mesh, double width, double height)
{
    uint32_t nx = mesh->grid_nx, ny = mesh->grid_ny;
    double *x = mesh->position, *uv = mesh->uv;
    for (uint32_t j = 0; j < ny; j++) {
        for (uint32_t i = 0; i < nx; i++) {
            *x++ = centred(width, i, nx);
            *x++ = 0;
            *x++ = centred(height, j, ny);
            *uv++ = width * i / (nx - 1.0);
            *uv++ = height * j / (ny - 1.0);
        }
    }
}

/* Wound so that the normals are +y. */
static void make_faces(struct mesh *mesh)
{
    uint32_t nx = mesh->grid_nx, *corner = mesh->face_corner;
    for (uint32_t j = 0; j + 1 < mesh->grid_ny; j++) {
        for (uint32_t i = 0; i + 1 < nx; i++) {
            uint32_t v = j * nx + i;
            uint32_t cell[6] = {v, v + nx, v + nx + 1, v, v + nx + 1, v + 1};
            memcpy(corner, cell, sizeof cell);
            corner += 6;
        }
    }
    memcpy(mesh->triangle, mesh->face_corner, 3 * (size_t)mesh->n_faces * sizeof(uint32_t));
    for (uint32_t f = 0; f <= mesh->n_faces; f++)
        mesh->face_start[f] = 3 * f;
}

int mesh_grid(struct mesh *mesh, double width, double height, uint32_t nx, uint32_t ny,
              struct cloth_error *error)
{
    *mesh = (struct mesh){0};
    int code = check_size(width, height, nx, ny, error);
    if (!code)
        code = make_arrays(mesh, nx, ny, error);
    if (code) {
        mesh_free(mesh);
        return code;
    }
    place_vertices(mesh, width, height);
    make_faces(mesh);
    return CLOTH_OK;
}
