/* Corners of faces and triangles, their uv and their places. A grid's numbering is a promise that
 * hashes rest on: row-major, u fastest, two triangles a cell in cell order, so that only its
 * positions need to be stored; the place of a cell decides which diagonal cuts it.
 *
 * A vertex may have another uv in each of its triangles, and then another place at rest if the rest
 * shape comes from uv. So places at rest are asked for by triangle. */
#include "cloth/base/vector.h"
#include "cloth/mesh/mesh.h"

#include <string.h>

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
    } else {
        corner[0] = v;
        corner[1] = t % 2 ? v + nx + 1 : v + nx;
        corner[2] = t % 2 ? v + 1 : v + nx + 1;
    }
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

/* ---- Places ---- */

uint32_t mesh_uv_number(const struct mesh *mesh, uint32_t t, uint32_t vertex)
{
    if (!mesh->triangle_uv || t == UINT32_MAX)
        return vertex;
    const size_t first = 3 * (size_t)t;
    size_t i = 0;
    while (i < 2 && mesh->triangle[first + i] != vertex)
        i++;
    return mesh->triangle_uv[first + i];
}

/* The number of a place among the positions. */
static uint32_t places_number_of(const struct mesh *mesh, uint32_t t, uint32_t vertex)
{
    return mesh->placed_by_uv ? mesh_uv_number(mesh, t, vertex) : vertex;
}

const double *mesh_place(const struct mesh *mesh, uint32_t t, uint32_t vertex)
{
    return mesh->position + 3 * (size_t)places_number_of(mesh, t, vertex);
}

double mesh_distance(const double *position, uint32_t a, uint32_t b)
{
    return cloth_distance(position + 3 * (size_t)a, position + 3 * (size_t)b);
}

double mesh_area(const double *position, const uint32_t corner[3])
{
    double normal[3];
    cloth_normal(position + 3 * (size_t)corner[0], position + 3 * (size_t)corner[1],
                 position + 3 * (size_t)corner[2], normal);
    return 0.5 * sqrt(cloth_dot(normal, normal));
}

double mesh_triangle_area(const struct mesh *mesh, uint32_t t)
{
    uint32_t place[3];
    mesh_corners(mesh, t, place);
    if (mesh->placed_by_uv && mesh->triangle_uv)
        memcpy(place, mesh->triangle_uv + 3 * (size_t)t, sizeof place);
    return mesh_area(mesh->position, place);
}

double mesh_length(const struct mesh *mesh, const uint32_t triangle[2], uint32_t a, uint32_t b)
{
    double length[2];
    for (int k = 0; k < 2; k++)
        length[k] = mesh_distance(mesh->position, places_number_of(mesh, triangle[k], a),
                                  places_number_of(mesh, triangle[k], b));
    return triangle[1] == UINT32_MAX ? length[0] : (length[0] + length[1]) / 2;
}

void mesh_find_low(const struct mesh *mesh, double below, struct mesh_low *low)
{
    *low = (struct mesh_low){.height = below, .below = below};
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        const uint32_t triangle[2] = {t, UINT32_MAX};
        uint32_t corner[3];
        double longest = 0;
        mesh_corners(mesh, t, corner);
        for (int k = 0; k < 3; k++)
            longest = fmax(longest, mesh_length(mesh, triangle, corner[k], corner[(k + 1) % 3]));
        const double height = longest > 0 ? 2 * mesh_triangle_area(mesh, t) / longest : 0;
        low->n += height < below;
        low->lowest = height < low->height ? t : low->lowest;
        low->height = fmin(low->height, height);
    }
}

void mesh_lay_beside(const double a[9], const double b[9], double x[3])
{
    double edge[3], arm[3], other[3], packed[3];
    for (int c = 0; c < 3; c++) {
        edge[c] = a[3 + c] - a[c];
        arm[c] = a[6 + c] - a[c];
        other[c] = b[3 + c] - b[c];
        packed[c] = b[6 + c] - b[c];
    }
    const double foot = cloth_dot(arm, edge) / cloth_dot(edge, edge);
    const double other_foot = cloth_dot(packed, other) / cloth_dot(other, other);
    for (int c = 0; c < 3; c++) {
        arm[c] -= foot * edge[c];
        packed[c] -= other_foot * other[c];
    }
    const double size = sqrt(cloth_dot(packed, packed) / cloth_dot(arm, arm));
    for (int c = 0; c < 3; c++)
        x[c] = a[c] + other_foot * edge[c] - size * arm[c];
}

void mesh_hinge(const struct mesh *mesh, const uint32_t triangle[2], const uint32_t corner[4],
                double x[12])
{
    double other[9];
    bool one = true;
    for (int i = 0; i < 3; i++) {
        const uint32_t vertex = corner[i < 2 ? i : 3];
        memcpy(x + 3 * i, mesh_place(mesh, triangle[0], corner[i]), 3 * sizeof *x);
        memcpy(other + 3 * i, mesh_place(mesh, triangle[1], vertex), 3 * sizeof *x);
        one = one && (i == 2 || places_number_of(mesh, triangle[0], vertex) ==
                                    places_number_of(mesh, triangle[1], vertex));
    }
    memcpy(x + 9, other + 6, 3 * sizeof *x);
    if (!one)
        mesh_lay_beside(x, other, x + 9);
}
