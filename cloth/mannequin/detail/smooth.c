/* Vertices of the middle plane see their neighbours and the mirror images of these. */
#include "cloth/base/memory.h"
#include "cloth/mannequin/detail/surface.h"
#include "cloth/mannequin/detail/vector.h"

#include <stdlib.h>

static const double WAY = 0.7; /* towards the middle of the neighbours */

static const double STEP = 0.008; /* m: no step is longer, since beyond thin parts slopes end */

/* Newton's steps along the gradient. */
static void project(const struct surface *surface, const struct figure *figure, uint32_t v,
                    int steps)
{
    double *x = surface->x[v];
    for (int i = 0; i < steps; i++) {
        double g[3];
        const double d = figure_gradient(figure, x, g);
        if (surface->middle[v])
            g[0] = 0;
        const double square = fmax(vector_dot(g, g), fmax(0.01, fabs(d) * fabs(d) / (STEP * STEP)));
        for (int c = 0; c < 3; c++)
            x[c] -= d * g[c] / square;
    }
}

void surface_project(struct surface *surface, const struct figure *figure)
{
    for (uint32_t v = 0; v < surface->n; v++)
        project(surface, figure, v, 3);
}

/* Sums of neighbours, by edges: those of a boundary's edge once, others twice, as seen from the
 * middle plane. */
static void sum_neighbours(const struct surface *surface, const struct surface_edges *edges,
                           double (*sum)[4])
{
    for (uint32_t e = 0; e < edges->n; e++) {
        const struct surface_edge *edge = &edges->edge[e];
        for (int i = 0; i < 2; i++) {
            const uint32_t v = edge->end[i], w = edge->end[1 - i];
            const double weight = surface->middle[v] && edge->triangle[1] != UINT32_MAX ? 2 : 1;
            for (int c = surface->middle[v]; c < 3; c++)
                sum[v][c] += weight * surface->x[w][c];
            sum[v][3] += weight;
        }
    }
}

static void slide(const struct surface *surface, const struct figure *figure, uint32_t v,
                  const double sum[4])
{
    double *x = surface->x[v], g[3], way[3];
    figure_gradient(figure, x, g);
    if (surface->middle[v])
        g[0] = 0;
    for (int c = 0; c < 3; c++)
        way[c] = WAY * (sum[c] / sum[3] - x[c]);
    const double across = vector_dot(way, g) / vector_dot(g, g);
    for (int c = 0; c < 3; c++)
        x[c] += way[c] - across * g[c];
    if (surface->middle[v])
        x[0] = 0;
    project(surface, figure, v, 1);
}

int surface_smooth(struct surface *surface, const struct figure *figure, struct cloth_error *error)
{
    struct surface_edges edges = {0};
    int code = surface_edges_find(&edges, surface, error);
    double(*sum)[4] = code ? NULL : cloth_alloc(surface->n, sizeof *sum, error);
    if (sum) {
        sum_neighbours(surface, &edges, sum);
        for (uint32_t v = 0; v < surface->n; v++)
            slide(surface, figure, v, sum[v]);
    }
    code = sum || code ? code : error->code;
    free(sum);
    surface_edges_free(&edges);
    return code;
}
