/* Sections of the half: the plane's pieces in triangles are joined where they share an edge. */
#include "cloth/base/memory.h"
#include "cloth/base/sets.h"
#include "cloth/mannequin/detail/surface.h"
#include "cloth/mannequin/detail/vector.h"

#include <stdlib.h>

struct section {
    const struct surface *surface;
    const struct surface_edges *edges;
    double point[3], normal[3];
    double *height;   /* of a vertex over the plane */
    uint32_t *parent; /* sets of edges that are joined */
    double (*sum)[4]; /* by set: its length, the sum of its places weighted by length */
};

static uint32_t edge_of(const struct surface_edges *edges, uint32_t a, uint32_t b)
{
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;
    uint32_t e = edges->first[low];
    while (edges->edge[e].end[1] != high)
        e++;
    return e;
}

/* The two edges of a triangle that the plane crosses, and where; false: it crosses none. */
static bool cross(const struct section *section, uint32_t t, uint32_t edge[2], double at[2][3])
{
    const uint32_t *v = section->surface->triangle[t];
    int n = 0;
    for (int k = 0; k < 3; k++) {
        const uint32_t a = v[k], b = v[(k + 1) % 3];
        const double p = section->height[a], q = section->height[b];
        if ((p < 0) == (q < 0))
            continue;
        edge[n] = edge_of(section->edges, a, b);
        for (int c = 0; c < 3; c++)
            at[n][c] = section->surface->x[a][c] +
                       p / (p - q) * (section->surface->x[b][c] - section->surface->x[a][c]);
        n++;
    }
    return n == 2;
}

static void measure(struct section *section)
{
    uint32_t edge[2];
    double at[2][3];
    for (uint32_t t = 0; t < section->surface->m; t++)
        if (cross(section, t, edge, at))
            cloth_sets_join(section->parent, edge[0], edge[1]);
    for (uint32_t t = 0; t < section->surface->m; t++)
        if (cross(section, t, edge, at)) {
            double *sum = section->sum[cloth_sets_root(section->parent, edge[0])];
            const double length = vector_distance(at[0], at[1]);
            for (int c = 0; c < 3; c++)
                sum[c] += 0.5 * length * (at[0][c] + at[1][c]);
            sum[3] += length;
        }
}

/* The length of the loop whose middle is nearest; one that is open goes on in the mirror image. */
static double nearest(const struct section *section, bool half)
{
    double best = INFINITY, length = 0;
    for (uint32_t e = 0; e < section->edges->n; e++) {
        const double *sum = section->sum[e];
        if (!(sum[3] > 0))
            continue;
        const double middle[3] = {half ? 0 : sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]};
        const double far = vector_distance(middle, section->point) + (half ? sum[0] / sum[3] : 0);
        if (far < best) {
            best = far;
            length = half ? 2 * sum[3] : sum[3];
        }
    }
    return length;
}

int surface_girth(const struct surface *surface, const struct figure *figure, uint32_t measured,
                  double *girth, struct cloth_error *error)
{
    struct surface_edges edges = {0};
    struct section section = {.surface = surface, .edges = &edges};
    int code = surface_edges_find(&edges, surface, error);
    figure_section(figure, measured, section.point, section.normal);
    section.height = cloth_alloc(surface->n, sizeof *section.height, error);
    section.parent = cloth_alloc(edges.n, sizeof *section.parent, error);
    section.sum = cloth_alloc(edges.n, sizeof *section.sum, error);
    if (!code && section.height && section.parent && section.sum) {
        const double level = vector_dot(section.point, section.normal);
        for (uint32_t v = 0; v < surface->n; v++)
            section.height[v] = vector_dot(surface->x[v], section.normal) - level;
        cloth_sets_start(section.parent, edges.n);
        measure(&section);
        *girth = nearest(&section, measured < MANNEQUIN_THIGH);
    }
    free(section.height);
    free(section.parent);
    free(section.sum);
    surface_edges_free(&edges);
    return error->code;
}
