/* A vertex may have another uv in each of its triangles, and then another place at rest if the rest
 * shape comes from uv. So places at rest are asked for by triangle. */
#include "cloth/mesh/detail/vector.h"
#include "cloth/mesh/mesh.h"

#include <math.h>
#include <string.h>

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

double mesh_difference(const double *a, const double *b, const double *z, double y[3])
{
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        y[c] = b[c] - a[c];
        sum += y[c] * (z ? z[c] : y[c]);
    }
    return sum;
}

void mesh_lay_beside(const double a[9], const double b[9], double x[3])
{
    double edge[3], arm[3], other[3], packed[3], in = 0, out = 0;
    const double square = mesh_difference(a, a + 3, NULL, edge);
    const double foot = mesh_difference(a, a + 6, edge, arm) / square;
    const double other_square = mesh_difference(b, b + 3, NULL, other);
    const double other_foot = mesh_difference(b, b + 6, other, packed) / other_square;
    for (int c = 0; c < 3; c++) {
        arm[c] -= foot * edge[c];
        packed[c] -= other_foot * other[c];
        in += arm[c] * arm[c];
        out += packed[c] * packed[c];
    }
    for (int c = 0; c < 3; c++)
        x[c] = a[c] + other_foot * edge[c] - sqrt(out / in) * arm[c];
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
