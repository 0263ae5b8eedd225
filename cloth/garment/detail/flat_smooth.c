/* The lattice ends at some distance from the boundary, which varies along it. Laplacian smoothing
 * spreads that over the next rows; where it would make an angle worse than it is good for, the
 * vertex stays. */
#include "cloth/garment/detail/flat.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 4, PASSES = 8, MOST = 24 };

static const double FINE = 0.766; /* cos 40 degrees: an angle from there on may become worse */

/* How many edges each vertex is from the boundary, at most ROWS + 1. */
static void find_rows(const struct delaunay *plane, unsigned char *row)
{
    memset(row, ROWS + 1, plane->n);
    memset(row, 0, plane->n_fixed);
    for (unsigned char depth = 1; depth <= ROWS; depth++)
        for (uint32_t t = 0; t < plane->n_triangles; t++) {
            const uint32_t *v = plane->triangle[t].vertex;
            bool near = false;
            for (int i = 0; i < 3; i++)
                near = near || row[v[i]] == depth - 1;
            for (int i = 0; near && i < 3; i++)
                row[v[i]] = row[v[i]] > depth ? depth : row[v[i]];
        }
}

static double worst_of(const struct delaunay *plane, uint32_t n, const uint32_t *around)
{
    double worst = 0;
    for (uint32_t k = 0; k < n; k++)
        worst = fmax(worst, delaunay_sharpness_of(plane, around[k]));
    return worst;
}

static void flat_smooth_move(struct delaunay *plane, uint32_t vertex)
{
    uint32_t around[MOST];
    const uint32_t n = delaunay_around(plane, vertex, MOST, around);
    if (n == 0)
        return;
    double *place = plane->place[vertex], sum[2] = {0, 0};
    for (uint32_t k = 0; k < n; k++) {
        const struct delaunay_triangle *of = &plane->triangle[around[k]];
        const double *next = plane->place[of->vertex[(delaunay_corner(of, vertex) + 1) % 3]];
        sum[0] += next[0];
        sum[1] += next[1];
    }
    const double before = worst_of(plane, n, around), old[2] = {place[0], place[1]};
    place[0] = sum[0] / n;
    place[1] = sum[1] / n;
    if (worst_of(plane, n, around) > fmax(before, FINE))
        memcpy(place, old, sizeof old);
    for (uint32_t k = 0; k < n; k++)
        delaunay_suspect(plane, around[k]);
}

void flat_smooth(struct delaunay *plane, struct cloth_error *error)
{
    unsigned char *row = cloth_alloc(plane->n, 1, error);
    if (!row) {
        plane->failed = true;
        return;
    }
    find_rows(plane, row);
    for (int pass = 0; pass < PASSES; pass++) {
        for (uint32_t v = plane->n_fixed; v < plane->n; v++)
            if (row[v] <= ROWS)
                flat_smooth_move(plane, v);
        delaunay_legalise(plane);
    }
    free(row);
}
