/* A lattice of cubes, each cut in six tetrahedra along its diagonal (Kuhn). Tetrahedra of
 * neighbours share their faces, so the surface is closed but at x = 0, where a plane of the lattice
 * is. The places on edges are linear between nodes. */
#include "cloth/mannequin/detail/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct lattice {
    struct surface *surface;
    uint32_t n[3]; /* nodes along each axis */
    double low[3], cell;
    double *value;    /* of a node; below 0: inside */
    uint32_t *vertex; /* of the edge from a node along a direction, 1 to 7: its bits are axes */
};

static uint32_t node_at(const struct lattice *lattice, uint32_t node, uint32_t corner)
{
    return node + (corner & 1) +
           lattice->n[0] * ((corner >> 1 & 1) + lattice->n[1] * (corner >> 2));
}

static void march_place_of(const struct lattice *lattice, uint32_t node, double x[3])
{
    const uint32_t row = node / lattice->n[0];
    x[0] = lattice->low[0] + lattice->cell * (node % lattice->n[0]);
    x[1] = lattice->low[1] + lattice->cell * (row % lattice->n[1]);
    x[2] = lattice->low[2] + lattice->cell * (row / lattice->n[1]);
}

/* The vertex on an edge of the cube at a node, between two of its corners. */
static uint32_t vertex_on(struct lattice *lattice, uint32_t node, uint32_t a, uint32_t b)
{
    const uint32_t low = a < b ? a : b, high = a ^ b ^ low;
    const uint32_t from = node_at(lattice, node, low), to = node_at(lattice, node, high);
    uint32_t *vertex = &lattice->vertex[7 * (size_t)from + (low ^ high) - 1];
    if (*vertex != UINT32_MAX)
        return *vertex;
    double x[3], y[3];
    const double p = lattice->value[from], q = lattice->value[to], part = p / (p - q);
    march_place_of(lattice, from, x);
    march_place_of(lattice, to, y);
    const bool middle = !(x[0] > 0) && !(y[0] > 0);
    for (int c = 0; c < 3; c++)
        x[c] += part * (y[c] - x[c]);
    return *vertex = surface_add_vertex(lattice->surface, x, middle);
}

/* The part of a tetrahedron, whose corners are those of the cube at a node and turn right. */
static void march_cut(struct lattice *lattice, uint32_t node, const uint32_t corner[4])
{
    /* Corners that are inside, and even orders in which they come first. */
    static const unsigned char order[16][4] = {
        [1] = {0, 1, 2, 3},  [2] = {1, 0, 3, 2},  [4] = {2, 0, 1, 3},  [8] = {3, 0, 2, 1},
        [3] = {0, 1, 2, 3},  [5] = {0, 2, 3, 1},  [9] = {0, 3, 1, 2},  [6] = {1, 2, 0, 3},
        [10] = {1, 3, 2, 0}, [12] = {2, 3, 0, 1}, [14] = {0, 1, 2, 3}, [13] = {1, 0, 3, 2},
        [11] = {2, 0, 1, 3}, [7] = {3, 0, 2, 1}};
    uint32_t inside = 0, c[4], v[4];
    for (uint32_t i = 0; i < 4; i++)
        inside |= (uint32_t)(lattice->value[node_at(lattice, node, corner[i])] < 0) << i;
    if (inside == 0 || inside == 15)
        return;
    for (uint32_t i = 0; i < 4; i++)
        c[i] = corner[order[inside][i]];
    const int count = __builtin_popcount(inside);
    if (count == 2) {
        const uint32_t end[4][2] = {{0, 2}, {0, 3}, {1, 3}, {1, 2}};
        for (int i = 0; i < 4; i++)
            v[i] = vertex_on(lattice, node, c[end[i][0]], c[end[i][1]]);
        const uint32_t second[3] = {v[0], v[2], v[3]};
        surface_add_triangle(lattice->surface, v);
        surface_add_triangle(lattice->surface, second);
        return;
    }
    for (uint32_t i = 0; i < 3; i++)
        v[count == 1 ? i : 2 - i] = vertex_on(lattice, node, c[0], c[i + 1]);
    surface_add_triangle(lattice->surface, v);
}

static void cut_cube(struct lattice *lattice, uint32_t node)
{
    static const uint32_t kuhn[6][4] = {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7},
                                        {0, 3, 2, 7}, {0, 6, 4, 7}, {0, 5, 1, 7}};
    uint32_t inside = 0;
    for (uint32_t k = 0; k < 8; k++)
        inside += lattice->value[node_at(lattice, node, k)] < 0;
    for (int i = 0; i < 6 && inside % 8; i++)
        march_cut(lattice, node, kuhn[i]);
}

/* The box of all parts, from x = 0 on, and a cell more. */
static void march_find_box(struct lattice *lattice, const struct figure *figure)
{
    double low[3] = {0, INFINITY, INFINITY}, high[3] = {0};
    for (uint32_t i = 0; i < figure->n; i++)
        for (int c = 0; c < 3; c++) {
            low[c] = fmin(low[c], figure->part[i].low[c]);
            high[c] = fmax(high[c], figure->part[i].high[c]);
        }
    for (int c = 0; c < 3; c++) {
        lattice->low[c] = c ? low[c] - lattice->cell : 0;
        lattice->n[c] = (uint32_t)((high[c] - lattice->low[c]) / lattice->cell) + 3;
    }
}

void surface_march(struct surface *surface, double cell)
{
    struct cloth_error *error = surface->error;
    struct lattice lattice = {.surface = surface, .cell = cell};
    march_find_box(&lattice, surface->figure);
    const uint32_t *n = lattice.n, nodes = n[0] * n[1] * n[2];
    lattice.value = cloth_alloc(nodes, sizeof *lattice.value, error);
    lattice.vertex = cloth_alloc(7 * (size_t)nodes, sizeof *lattice.vertex, error);
    if (!error->code)
        memset(lattice.vertex, 0xff, 7 * (size_t)nodes * sizeof *lattice.vertex);
    for (uint32_t i = 0; i < nodes && !error->code; i++) {
        double x[3];
        march_place_of(&lattice, i, x);
        lattice.value[i] = figure_near(surface->figure, x).distance;
    }
    for (uint32_t k = 0; k + 1 < n[2]; k++)
        for (uint32_t j = 0; j + 1 < n[1]; j++)
            for (uint32_t i = 0; i + 1 < n[0] && !error->code; i++)
                cut_cube(&lattice, i + n[0] * (j + n[1] * k));
    free(lattice.value);
    free(lattice.vertex);
}
