/* Principal axes of a mesh: those of its second moments. Off-diagonal moments below 1e-15 of the
 * trace are rounding. */
#include "cloth/base/axes.h"
#include "cloth/mesh/mesh.h"

#include <math.h>
#include <string.h>

/* Second moments about the mean of all vertices. */
static void moments(const struct mesh *mesh, double m[3][3])
{
    double mean[3] = {0};
    memset(m, 0, 9 * sizeof(double));
    for (size_t v = 0; v < mesh->n_vertices; v++)
        for (size_t i = 0; i < 3; i++)
            mean[i] += mesh->position[3 * v + i] / mesh->n_vertices;
    for (size_t v = 0; v < mesh->n_vertices; v++)
        for (size_t i = 0; i < 3; i++)
            for (size_t j = 0; j < 3; j++)
                m[i][j] +=
                    (mesh->position[3 * v + i] - mean[i]) * (mesh->position[3 * v + j] - mean[j]);
}

/* An axis, its largest component above 0. */
static void mesh_axes_take(const double axis[3], double to[3])
{
    int largest = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(axis[i]) > fabs(axis[largest]) * (1 + 1e-9))
            largest = i;
    for (int i = 0; i < 3; i++)
        to[i] = axis[largest] < 0 ? -axis[i] : axis[i];
}

void mesh_axes(const struct mesh *mesh, double u[3], double v[3])
{
    double m[3][3], axis[3][3];
    moments(mesh, m);
    cloth_axes(1e-15 * (m[0][0] + m[1][1] + m[2][2]), m, axis);
    int least = 2; /* of equals the last; the two others keep their order unless the later is longer
                    */
    for (int k = 1; k >= 0; k--)
        if (m[k][k] < m[least][least] * (1 - 1e-9))
            least = k;
    int first = least == 0 ? 1 : 0, second = least == 2 ? 1 : 2;
    if (m[second][second] > m[first][first] * (1 + 1e-9)) {
        const int other = first;
        first = second;
        second = other;
    }
    mesh_axes_take(axis[first], u);
    mesh_axes_take(axis[second], v);
}
