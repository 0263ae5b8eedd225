/* Principal axes by Jacobi's rotations, in a fixed order: + - * / and sqrt only. */
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

/* Turns rows and columns p and q of m so that m[p][q] becomes 0; the same columns of `axis`. */
static void turn(double m[3][3], double axis[3][3], int p, int q)
{
    if (fabs(m[p][q]) <= 1e-15 * (m[p][p] + m[q][q]))
        return;
    const double d = (m[q][q] - m[p][p]) / (2 * m[p][q]);
    const double t = (d < 0 ? -1 : 1) / (fabs(d) + sqrt(d * d + 1));
    const double c = 1 / sqrt(t * t + 1), s = t * c;
    for (int i = 0; i < 3; i++) {
        const double a = m[i][p], b = m[i][q];
        m[i][p] = c * a - s * b;
        m[i][q] = s * a + c * b;
    }
    for (int i = 0; i < 3; i++) {
        const double a = m[p][i], b = m[q][i];
        m[p][i] = c * a - s * b;
        m[q][i] = s * a + c * b;
    }
    for (int i = 0; i < 3; i++) {
        const double a = axis[i][p], b = axis[i][q];
        axis[i][p] = c * a - s * b;
        axis[i][q] = s * a + c * b;
    }
}

/* The axis as column k, its largest component above 0. */
static void take(double axis[3][3], int k, double to[3])
{
    int largest = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(axis[i][k]) > fabs(axis[largest][k]) * (1 + 1e-9))
            largest = i;
    for (int i = 0; i < 3; i++)
        to[i] = axis[largest][k] < 0 ? -axis[i][k] : axis[i][k];
}

void mesh_axes(const struct mesh *mesh, double u[3], double v[3])
{
    double m[3][3], axis[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    moments(mesh, m);
    for (int sweep = 0; sweep < 12; sweep++) {
        turn(m, axis, 0, 1);
        turn(m, axis, 0, 2);
        turn(m, axis, 1, 2);
    }
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
    take(axis, first, u);
    take(axis, second, v);
}
