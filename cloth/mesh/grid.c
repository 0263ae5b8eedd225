/* A grid's numbering is a promise that hashes rest on: row-major, u fastest, two triangles a cell
 * in cell order, so that only its positions need to be stored. The place of a cell decides which
 * diagonal cuts it. */
#include "cloth/base/memory.h"
#include "cloth/mesh/detail/equilateral.h"
#include "cloth/mesh/detail/finish.h"
#include "cloth/mesh/mesh.h"

#include <math.h>
#include <string.h>

static int mesh_grid_check_size(double width, double height, uint32_t nx, uint32_t ny,
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
    if ((uint64_t)nx * ny > MESH_MAX / 6)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "a grid of %u x %u vertices is too large; at most %u vertices", nx, ny,
                          MESH_MAX / 6);
    return CLOTH_OK;
}

static int mesh_grid_make(struct mesh *mesh, uint32_t nx, uint32_t ny, struct cloth_error *error)
{
    mesh->grid_nx = nx;
    mesh->grid_ny = ny;
    mesh->n_vertices = nx * ny;
    mesh->n_faces = mesh->n_triangles = 2 * (nx - 1) * (ny - 1);
    mesh->position = cloth_alloc(mesh->n_vertices, 3 * sizeof(double), error);
    return mesh->position ? CLOTH_OK : CLOTH_E_MEMORY;
}

/* Place of the i-th of n points that divide a length centred on 0: x(n - 1 - i) = -x(i) to the last
 * bit. */
static double mesh_grid_centred(double length, uint32_t i, uint32_t n)
{
    return length * (2.0 * i - (n - 1.0)) / (2.0 * (n - 1.0));
}

static void mesh_grid_place_vertices(struct mesh *mesh)
{
    uint32_t nx = mesh->grid_nx, ny = mesh->grid_ny;
    double *x = mesh->position;
    for (uint32_t j = 0; j < ny; j++) {
        for (uint32_t i = 0; i < nx; i++) {
            *x++ = mesh_grid_centred(mesh->grid_width, i, nx);
            *x++ = 0;
            *x++ = mesh_grid_centred(mesh->grid_height, j, ny);
        }
    }
}

int mesh_grid(struct mesh *mesh, double width, double height, uint32_t nx, uint32_t ny,
              enum mesh_cells cells, struct cloth_error *error)
{
    *mesh = (struct mesh){0};
    int code =
        mesh_grid_check_size(width, cells == MESH_EQUILATERAL ? width : height, nx, ny, error);
    if (!code && cells == MESH_EQUILATERAL)
        return mesh_equilateral(mesh, width, nx, ny, error);
    if (!code)
        code = mesh_grid_make(mesh, nx, ny, error);
    if (code) {
        mesh_free(mesh);
        return code;
    }
    mesh->grid_width = width;
    mesh->grid_height = height;
    mesh->grid_cells = cells;
    mesh_grid_place_vertices(mesh);
    return CLOTH_OK;
}

/* How far from the nearer end of a row of n cells: the same for mirror images. */
static uint32_t depth(uint32_t i, uint32_t n)
{
    return i < n - 1 - i ? i : n - 1 - i;
}

/* True if the cell lies in the second half of a row of n. Middle cells do in every other row. */
static bool second_half(uint32_t i, uint32_t n, uint32_t across)
{
    const uint32_t mirrored = n - 1 - i;
    return i == mirrored ? across % 2 : i > mirrored;
}

bool mesh_cell_turned(const struct mesh *mesh, uint32_t i, uint32_t j)
{
    const uint32_t across = mesh->grid_nx - 1, along = mesh->grid_ny - 1;
    if (mesh->grid_cells == MESH_ALTERNATE)
        return (i + j) % 2;
    if (mesh->grid_cells == MESH_MIRRORED)
        return second_half(i, across, depth(j, along)) != second_half(j, along, depth(i, across));
    return false;
}

/* Wound so that the normals are +y. */
static void grid_corners(const struct mesh *mesh, uint32_t t, uint32_t corner[3])
{
    const uint32_t nx = mesh->grid_nx, i = t / 2 % (nx - 1), j = t / 2 / (nx - 1);
    const uint32_t v = j * nx + i;
    if (mesh_cell_turned(mesh, i, j)) {
        corner[0] = v + 1;
        corner[1] = t % 2 ? v + nx : v;
        corner[2] = t % 2 ? v + nx + 1 : v + nx;
        return;
    }
    corner[0] = v;
    corner[1] = t % 2 ? v + nx + 1 : v + nx;
    corner[2] = t % 2 ? v + 1 : v + nx + 1;
}

void mesh_corners(const struct mesh *mesh, uint32_t t, uint32_t corner[3])
{
    if (mesh->grid_nx)
        grid_corners(mesh, t, corner);
    else
        memcpy(corner, mesh->triangle + 3 * (size_t)t, 3 * sizeof *corner);
}

uint32_t mesh_fourth(const struct mesh *mesh, uint32_t t)
{
    const uint32_t nx = mesh->grid_nx;
    if (!nx)
        return UINT32_MAX;
    uint32_t corner[3];
    grid_corners(mesh, t, corner);
    const uint32_t first = t / 2 / (nx - 1) * nx + t / 2 % (nx - 1);
    return 4 * first + 2 * nx + 2 - corner[0] - corner[1] - corner[2]; /* of the sum of all */
}

uint32_t mesh_face(const struct mesh *mesh, uint32_t f, uint32_t room[3], const uint32_t **corner)
{
    *corner = room;
    if (mesh->grid_nx) {
        grid_corners(mesh, f, room);
        return 3;
    }
    *corner = mesh->face_corner + mesh->face_start[f];
    return mesh->face_start[f + 1] - mesh->face_start[f];
}

int mesh_uv(const struct mesh *mesh, uint32_t number, double uv[2])
{
    const uint32_t nx = mesh->grid_nx, ny = mesh->grid_ny;
    if (nx) {
        uv[0] = mesh->grid_width * (number % nx) / (nx - 1.0);
        uv[1] = mesh->grid_height * (number / nx) / (ny - 1.0);
        return 1;
    }
    if (mesh->uv)
        memcpy(uv, mesh->uv + 2 * (size_t)number, 2 * sizeof *uv);
    return mesh->uv != NULL;
}
