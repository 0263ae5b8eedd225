/* The order of edges and of triangles at a vertex is that of vertices and triangles. Where vertices
 * are moved, those of the middle plane see their neighbours and the mirror images of these. */
#include "cloth/mannequin/detail/surface.h"
#include "cloth/base/vector.h"

#include <stdlib.h>

/* Adds an item behind the first n of a list. False: after an error. */
static bool put_behind(const struct surface *surface, struct cloth_list *list, uint32_t n,
                       const void *item, size_t size)
{
    list->n = n;
    return !surface->error->code && !cloth_list_put(list, item, size, surface->error);
}

uint32_t surface_add_vertex(struct surface *surface, const double x[3], bool middle)
{
    if (!put_behind(surface, &surface->places, surface->n, x, sizeof *surface->x) ||
        !put_behind(surface, &surface->middles, surface->n, &middle, sizeof middle))
        return UINT32_MAX;
    surface->x = surface->places.items;
    surface->middle = surface->middles.items;
    return surface->n++;
}

void surface_add_triangle(struct surface *surface, const uint32_t corner[3])
{
    if (put_behind(surface, &surface->triangles, surface->m, corner, sizeof *surface->triangle)) {
        surface->triangle = surface->triangles.items;
        surface->m++;
    }
}

void surface_free(struct surface *surface)
{
    free(surface->places.items);
    free(surface->middles.items);
    free(surface->triangles.items);
    *surface = (struct surface){0};
}

static void find_fans(struct surface_links *links, const struct surface *surface)
{
    const uint32_t *corner = (const uint32_t *)surface->triangle, n = 3 * surface->m;
    uint32_t *next = links->first + 1; /* of a vertex: until its fan is full, where it goes on */
    for (uint32_t s = 0; s < n; s++)
        next[corner[s] + 1]++;
    for (uint32_t v = 0; v < surface->n; v++)
        next[v + 1] += next[v];
    for (uint32_t s = 0; s < n; s++)
        links->fan[next[corner[s]]++] = s / 3;
}

/* The edge between two vertices of triangle t, whose lower one is v, among those of v so far. */
static void find_edge(struct surface_links *links, uint32_t v, uint32_t high, uint32_t t)
{
    for (uint32_t e = links->first_edge[v]; e < links->n_edges; e++)
        if (links->edge[e].end[1] == high) {
            links->edge[e].triangle[1] = t;
            return;
        }
    links->edge[links->n_edges++] = (struct surface_edge){{v, high}, {t, UINT32_MAX}};
}

bool surface_links_find(struct surface_links *links, const struct surface *surface)
{
    struct cloth_error *error = surface->error;
    struct cloth_pool *memory = &links->memory;
    const size_t n = surface->n, sides = 3 * (size_t)surface->m;
    *links = (struct surface_links){0};
    links->edge = cloth_take(memory, sides, sizeof *links->edge, error);
    links->first_edge = cloth_take(memory, n + 1, sizeof *links->first_edge, error);
    links->first = cloth_take(memory, n + 2, sizeof *links->first, error);
    links->fan = cloth_take(memory, sides, sizeof *links->fan, error);
    if (error->code)
        return false;
    find_fans(links, surface);
    for (uint32_t v = 0; v < surface->n; v++) {
        for (uint32_t i = links->first[v]; i < links->first[v + 1]; i++)
            for (int k = 0; k < 3; k++) {
                const uint32_t *corner = surface->triangle[links->fan[i]];
                const uint32_t a = corner[k], b = corner[(k + 1) % 3];
                if (a == v ? b > v : b == v && a > v)
                    find_edge(links, v, a == v ? b : a, links->fan[i]);
            }
        links->first_edge[v + 1] = links->n_edges;
    }
    return true;
}

/* ---- Onto the figure ---- */

static const double WAY = 0.7; /* towards the middle of the neighbours */

static const double STEP = 0.008; /* m: no step is longer, since beyond thin parts slopes end */

/* Newton's steps along the gradient. */
static void project(const struct surface *surface, uint32_t v, int steps)
{
    double *x = surface->x[v];
    for (int i = 0; i < steps; i++) {
        double g[3];
        const double d = figure_gradient(surface->figure, x, g);
        if (surface->middle[v])
            g[0] = 0;
        const double square = fmax(cloth_dot(g, g), fmax(0.01, fabs(d) * fabs(d) / (STEP * STEP)));
        for (int c = 0; c < 3; c++)
            x[c] -= d * g[c] / square;
    }
}

void surface_project(struct surface *surface)
{
    for (uint32_t v = 0; v < surface->n; v++)
        project(surface, v, 3);
}

/* Sums of neighbours, by edges: those of a boundary's edge once, others twice, as seen from the
 * middle plane. */
static void sum_neighbours(const struct surface *surface, const struct surface_links *links,
                           double (*sum)[4])
{
    for (uint32_t e = 0; e < links->n_edges; e++) {
        const struct surface_edge *edge = &links->edge[e];
        for (int i = 0; i < 2; i++) {
            const uint32_t v = edge->end[i], w = edge->end[1 - i];
            const double weight = surface->middle[v] && edge->triangle[1] != UINT32_MAX ? 2 : 1;
            for (int c = surface->middle[v]; c < 3; c++)
                sum[v][c] += weight * surface->x[w][c];
            sum[v][3] += weight;
        }
    }
}

static void slide(const struct surface *surface, uint32_t v, const double sum[4])
{
    double *x = surface->x[v], g[3], way[3];
    figure_gradient(surface->figure, x, g);
    if (surface->middle[v])
        g[0] = 0;
    for (int c = 0; c < 3; c++)
        way[c] = WAY * (sum[c] / sum[3] - x[c]);
    const double across = cloth_dot(way, g) / cloth_dot(g, g);
    for (int c = 0; c < 3; c++)
        x[c] += way[c] - across * g[c];
    if (surface->middle[v])
        x[0] = 0;
    project(surface, v, 1);
}

void surface_smooth(struct surface *surface)
{
    struct surface_links links;
    double(*sum)[4] = NULL;
    if (surface_links_find(&links, surface))
        sum = cloth_take(&links.memory, surface->n, sizeof *sum, surface->error);
    if (sum)
        sum_neighbours(surface, &links, sum);
    for (uint32_t v = 0; sum && v < surface->n; v++)
        slide(surface, v, sum[v]);
    cloth_pool_free(&links.memory);
}
