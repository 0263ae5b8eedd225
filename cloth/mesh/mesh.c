/* Functions of every mesh, whatever its source. Sums run in triangle order, so they are the same
 * everywhere. */
#include "cloth/mesh/mesh.h"

#include "cloth/mesh/detail/vector.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

const struct mesh_transform mesh_identity = {{1, 1, 1}, {1, 0, 0, 0}, {0, 0, 0}};

/* The matrix of a quaternion (w, x, y, z) divided by its length; false if it turns nothing (also of
 * length zero). */
static bool rotation(const double *quaternion, double matrix[3][3])
{
    const double *q = quaternion;
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if ((q[1] == 0 && q[2] == 0 && q[3] == 0) || !(length > 0))
        return false;
    double w = q[0] / length, x = q[1] / length, y = q[2] / length, z = q[3] / length;
    double rows[3][3] = {
        {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
        {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
        {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)},
    };
    memcpy(matrix, rows, sizeof rows);
    return true;
}

void mesh_apply(struct mesh *mesh, const struct mesh_transform *transform)
{
    double matrix[3][3];
    bool turns = rotation(transform->rotate, matrix);
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        double *x = mesh->position + 3 * v, scaled[3];
        for (size_t i = 0; i < 3; i++)
            scaled[i] = x[i] * transform->scale[i];
        for (size_t i = 0; i < 3; i++) {
            x[i] = scaled[i];
            if (turns)
                x[i] =
                    matrix[i][0] * scaled[0] + matrix[i][1] * scaled[1] + matrix[i][2] * scaled[2];
            if (transform->translate[i] != 0) /* -0 + 0 would lose its sign */
                x[i] += transform->translate[i];
        }
    }
}

void mesh_used(const struct mesh *mesh, unsigned char *used)
{
    memset(used, 0, mesh->n_vertices);
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        uint32_t corner[3];
        mesh_corners(mesh, t, corner);
        for (size_t i = 0; i < 3; i++)
            used[corner[i]] = 1;
    }
    for (size_t i = 0; i < 2 * (size_t)mesh->n_lone_edges; i++)
        used[mesh->lone_edge[i]] = 1;
}

void mesh_share_of(const struct mesh *mesh, uint32_t triangle, double density, bool by_cell,
                   struct mesh_share *share)
{
    const uint32_t fourth = by_cell ? mesh_fourth(mesh, triangle) : UINT32_MAX;
    mesh_corners(mesh, triangle, share->vertex);
    share->n = fourth == UINT32_MAX ? 3 : 4;
    share->vertex[3] = fourth;
    share->mass = mesh_triangle_area(mesh, triangle) * density / share->n;
}

static void add_share(const struct mesh *mesh, uint32_t triangle, double density, bool by_cell,
                      double *mass)
{
    struct mesh_share share;
    mesh_share_of(mesh, triangle, density, by_cell, &share);
    for (uint32_t i = 0; i < share.n; i++)
        mass[share.vertex[i]] += share.mass;
}

void mesh_add_mass_of(const struct mesh *mesh, uint32_t triangle, double density, double *mass)
{
    add_share(mesh, triangle, density, false, mass);
}

void mesh_add_cell_mass_of(const struct mesh *mesh, uint32_t triangle, double density, double *mass)
{
    add_share(mesh, triangle, density, true, mass);
}

void mesh_add_mass(const struct mesh *mesh, double density, double *mass)
{
    for (uint32_t t = 0; t < mesh->n_triangles; t++)
        mesh_add_mass_of(mesh, t, density, mass);
}

double mesh_box(const struct mesh *mesh, double low[3], double high[3])
{
    double longest = 0;
    for (size_t i = 0; i < 3; i++) {
        low[i] = INFINITY;
        high[i] = -INFINITY;
        for (size_t v = 0; v < mesh->n_vertices; v++) {
            low[i] = fmin(low[i], mesh->position[3 * v + i]);
            high[i] = fmax(high[i], mesh->position[3 * v + i]);
        }
        longest = fmax(longest, high[i] - low[i]);
    }
    return longest;
}

static void free_names(char **name, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++)
        free(name[i]);
    free(name);
}

void mesh_free(struct mesh *mesh)
{
    free(mesh->position);
    free(mesh->uv);
    free(mesh->face_start);
    free(mesh->face_corner);
    free(mesh->face_uv);
    free(mesh->triangle);
    free(mesh->triangle_uv);
    free(mesh->lone_edge);
    free_names(mesh->group, mesh->n_groups);
    free_names(mesh->material, mesh->n_materials);
    free_names(mesh->library, mesh->n_libraries);
    free(mesh->group_run);
    free(mesh->material_run);
    *mesh = (struct mesh){0};
}
