/* Edges and fans by counting: their order is that of vertices and triangles. */
#include "cloth/mannequin/detail/surface.h"
#include "cloth/base/memory.h"

#include <stdlib.h>

static uint32_t more(uint32_t room)
{
    return room ? 2 * room : 4096;
}

uint32_t surface_add_vertex(struct surface *surface, struct cloth_error *error)
{
    if (surface->n == surface->room) {
        const uint32_t room = more(surface->room);
        double(*x)[3] = realloc(surface->x, room * sizeof *x);
        if (x)
            surface->x = x;
        bool *middle = realloc(surface->middle, room * sizeof *middle);
        if (middle)
            surface->middle = middle;
        if (!x || !middle) {
            cloth_fail(error, CLOTH_E_MEMORY, "no memory for %u vertices of a figure", room);
            return UINT32_MAX;
        }
        surface->room = room;
    }
    return surface->n++;
}

uint32_t surface_add_triangle(struct surface *surface, struct cloth_error *error)
{
    if (surface->m == surface->space) {
        const uint32_t space = more(surface->space);
        uint32_t(*triangle)[3] = realloc(surface->triangle, space * sizeof *triangle);
        if (!triangle) {
            cloth_fail(error, CLOTH_E_MEMORY, "no memory for %u triangles of a figure", space);
            return UINT32_MAX;
        }
        surface->triangle = triangle;
        surface->space = space;
    }
    return surface->m++;
}

void surface_free(struct surface *surface)
{
    free(surface->x);
    free(surface->middle);
    free(surface->triangle);
    *surface = (struct surface){0};
}

/* Counts become places: first[v] is where v's begin. */
static void detail_surface_sum_up(uint32_t *first, uint32_t n)
{
    uint32_t sum = 0;
    for (uint32_t v = 0; v <= n; v++) {
        const uint32_t count = first[v];
        first[v] = sum;
        sum += count;
    }
}

/* Each vertex has room for the edges of all sides that begin or end there; then gaps close. */
int surface_edges_find(struct surface_edges *edges, const struct surface *surface,
                       struct cloth_error *error)
{
    edges->first = cloth_alloc((size_t)surface->n + 1, sizeof *edges->first, error);
    edges->edge = cloth_alloc(3 * (size_t)surface->m, sizeof *edges->edge, error);
    uint32_t *used = cloth_alloc((size_t)surface->n + 1, sizeof *used, error);
    const bool fine = edges->first && edges->edge && used;
    for (uint32_t s = 0; fine && s < 3 * surface->m; s++) {
        const uint32_t a = surface->triangle[s / 3][s % 3];
        const uint32_t b = surface->triangle[s / 3][(s + 1) % 3];
        edges->first[a < b ? a : b]++;
    }
    if (fine)
        detail_surface_sum_up(edges->first, surface->n);
    for (uint32_t s = 0; fine && s < 3 * surface->m; s++) {
        const uint32_t a = surface->triangle[s / 3][s % 3];
        const uint32_t b = surface->triangle[s / 3][(s + 1) % 3];
        const uint32_t low = a < b ? a : b, high = a < b ? b : a;
        struct surface_edge *list = edges->edge + edges->first[low];
        uint32_t k = 0;
        while (k < used[low] && list[k].end[1] != high)
            k++;
        if (k < used[low])
            list[k].triangle[1] = s / 3;
        else
            list[used[low]++] = (struct surface_edge){{low, high}, {s / 3, UINT32_MAX}};
    }
    edges->n = 0;
    for (uint32_t v = 0; fine && v < surface->n; v++) {
        const uint32_t from = edges->first[v];
        edges->first[v] = edges->n;
        for (uint32_t k = 0; k < used[v]; k++)
            edges->edge[edges->n++] = edges->edge[from + k];
    }
    if (fine)
        edges->first[surface->n] = edges->n;
    free(used);
    return fine ? CLOTH_OK : error->code;
}

void surface_edges_free(struct surface_edges *edges)
{
    free(edges->first);
    free(edges->edge);
    *edges = (struct surface_edges){0};
}

int surface_fans_find(struct surface_fans *fans, const struct surface *surface,
                      struct cloth_error *error)
{
    fans->first = cloth_alloc((size_t)surface->n + 2, sizeof *fans->first, error);
    fans->fan = cloth_alloc(3 * (size_t)surface->m, sizeof *fans->fan, error);
    if (!fans->first || !fans->fan)
        return error->code;
    for (uint32_t s = 0; s < 3 * surface->m; s++)
        fans->first[surface->triangle[s / 3][s % 3] + 1]++;
    detail_surface_sum_up(fans->first + 1, surface->n);
    for (uint32_t s = 0; s < 3 * surface->m; s++)
        fans->fan[fans->first[surface->triangle[s / 3][s % 3] + 1]++] = s / 3;
    return CLOTH_OK;
}

void surface_fans_free(struct surface_fans *fans)
{
    free(fans->first);
    free(fans->fan);
    *fans = (struct surface_fans){0};
}
