/* The sphere of radius 1 comes first: its new vertices are middles of edges, put out to length 1. A
 * middle is listed at the lower end of its edge, where the edge's other triangle finds it. */
#include "cloth/base/memory.h"
#include "cloth/mesh/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HALVINGS = 4, N_TRIANGLES = 20 << 2 * HALVINGS, N_VERTICES = N_TRIANGLES / 2 + 2 };

struct sphere {
    uint32_t n_vertices, n_triangles;
    double x[N_VERTICES][3];
    uint32_t corner[N_TRIANGLES][3];
    uint32_t next[N_VERTICES]; /* of the middles on edges whose lower end is a vertex; 0: no more */
    uint32_t first[N_VERTICES], other[N_VERTICES]; /* the first of these; the upper end of each */
};

static void put_out(double x[3])
{
    const double length = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    for (int c = 0; c < 3; c++)
        x[c] /= length;
}

static void begin_sphere(struct sphere *sphere)
{
    static const uint32_t corner[20][3] = {
        {0, 5, 1}, {0, 1, 7}, {0, 11, 5}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9},   {1, 8, 7},
        {1, 9, 8}, {2, 3, 4}, {2, 6, 3},  {2, 4, 11}, {2, 10, 6},  {2, 11, 10}, {3, 9, 4},
        {3, 6, 8}, {3, 8, 9}, {4, 9, 5},  {4, 5, 11}, {6, 7, 8},   {6, 10, 7}};
    const double golden = (1 + sqrt(5)) / 2;
    for (uint32_t i = 0; i < 12; i++) {
        double *x = sphere->x[i];
        const uint32_t axis = i / 4;
        x[axis] = i & 1 ? 1 : -1;
        x[(axis + 1) % 3] = i & 2 ? -golden : golden;
        x[(axis + 2) % 3] = 0;
        put_out(x);
    }
    sphere->n_vertices = 12;
    sphere->n_triangles = 20;
    memcpy(sphere->corner, corner, sizeof corner);
}

static uint32_t middle_of(struct sphere *sphere, uint32_t a, uint32_t b)
{
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;
    for (uint32_t m = sphere->first[low]; m; m = sphere->next[m])
        if (sphere->other[m] == high)
            return m;
    const uint32_t m = sphere->n_vertices++;
    for (int c = 0; c < 3; c++)
        sphere->x[m][c] = sphere->x[low][c] + sphere->x[high][c];
    put_out(sphere->x[m]);
    sphere->other[m] = high;
    sphere->next[m] = sphere->first[low];
    return sphere->first[low] = m;
}

/* Triangles behind the n that there are: three at the corners, and the middle one in place. */
static void halve(struct sphere *sphere)
{
    const uint32_t n = sphere->n_triangles;
    memset(sphere->first, 0, sizeof sphere->first);
    for (uint32_t t = 0; t < n; t++) {
        uint32_t corner[3], middle[3];
        memcpy(corner, sphere->corner[t], sizeof corner);
        for (int k = 0; k < 3; k++)
            middle[k] = middle_of(sphere, corner[k], corner[(k + 1) % 3]);
        for (int k = 0; k < 3; k++) {
            uint32_t *to = sphere->corner[sphere->n_triangles++];
            to[0] = corner[k];
            to[1] = middle[k];
            to[2] = middle[(k + 2) % 3];
        }
        memcpy(sphere->corner[t], middle, sizeof middle);
    }
}

int mesh_ellipsoid(struct mesh *mesh, const double half[3], struct cloth_error *error)
{
    *mesh = (struct mesh){0};
    struct sphere *sphere = cloth_alloc(1, sizeof *sphere, error);
    if (!sphere)
        return CLOTH_E_MEMORY;
    begin_sphere(sphere);
    for (int k = 0; k < HALVINGS; k++)
        halve(sphere);
    for (uint32_t v = 0; v < sphere->n_vertices; v++)
        for (int c = 0; c < 3; c++)
            sphere->x[v][c] *= half[c];
    const int code = mesh_inline(mesh, sphere->n_vertices, *sphere->x, 0, NULL, sphere->n_triangles,
                                 *sphere->corner, error);
    free(sphere);
    return code;
}
