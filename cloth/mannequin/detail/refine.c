/* A pass goes over the edges in their order. The surroundings of a change are marked, and left
 * alone for the rest of the pass. */
#include "cloth/base/vector.h"
#include "cloth/mannequin/detail/surface.h"

#include <stdlib.h>
#include <string.h>

static const double LONG = 4.0 / 3, SHORT = 0.8; /* of the length that is wanted */
static const double BENT = 0.5; /* the cosine by which a change may turn a triangle */

/* A pass. touched: by triangle (split), by vertex (others). */
struct pass {
    struct surface *surface;
    double wanted; /* how long edges are to be at most, m */
    struct surface_links links;
    unsigned char *touched;
};

/* Goes over all edges; `change` may change the surface at one. */
static void run_pass(struct surface *surface, double wanted,
                     void (*change)(struct pass *pass, const struct surface_edge *))
{
    struct pass pass = {.surface = surface, .wanted = wanted};
    const uint32_t n = surface->n, m = surface->m;
    if (surface_links_find(&pass.links, surface))
        pass.touched = cloth_take(&pass.links.memory, n > m ? n : m, 1, surface->error);
    for (uint32_t e = 0; !surface->error->code && e < pass.links.n_edges; e++)
        change(&pass, &pass.links.edge[e]);
    cloth_pool_free(&pass.links.memory);
}

static void middle_of(const struct surface *surface, const struct surface_edge *edge, double x[3])
{
    const double *a = surface->x[edge->end[0]], *b = surface->x[edge->end[1]];
    for (int c = 0; c < 3; c++)
        x[c] = 0.5 * (a[c] + b[c]);
}

/* Its length as a part of what is wanted there. */
static double relative_length(const struct pass *pass, const struct surface_edge *edge)
{
    const struct surface *surface = pass->surface;
    double x[3];
    middle_of(surface, edge, x);
    return cloth_distance(surface->x[edge->end[0]], surface->x[edge->end[1]]) /
           figure_edge(surface->figure, x, pass->wanted);
}

/* The cosine of the angle between two vectors; 0 if one has no length. */
static double refine_cosine(const double a[3], const double b[3])
{
    const double lengths = sqrt(cloth_dot(a, a) * cloth_dot(b, b));
    return lengths > 0 ? cloth_dot(a, b) / lengths : 0;
}

/* ---- Split ---- */

/* The half of a triangle at the end a stays; the other half, at b, is new. */
static void halve(struct surface *surface, uint32_t t, uint32_t a, uint32_t b, uint32_t vertex)
{
    uint32_t *old = surface->triangle[t], new[3];
    for (int i = 0; i < 3; i++) {
        new[i] = old[i] == a ? vertex : old[i];
        old[i] = old[i] == b ? vertex : old[i];
    }
    surface_add_triangle(surface, new);
}

static void refine_split_edge(struct pass *pass, const struct surface_edge *edge)
{
    const uint32_t *t = edge->triangle, a = edge->end[0], b = edge->end[1];
    double x[3];
    if (pass->touched[t[0]] || (t[1] != UINT32_MAX && pass->touched[t[1]]) ||
        !(relative_length(pass, edge) > LONG))
        return;
    middle_of(pass->surface, edge, x);
    const uint32_t v = surface_add_vertex(pass->surface, x, t[1] == UINT32_MAX);
    for (int i = 0; i < 2 && v != UINT32_MAX; i++)
        if (t[i] != UINT32_MAX) {
            pass->touched[t[i]] = 1;
            halve(pass->surface, t[i], a, b, v);
        }
}

void surface_split(struct surface *surface, double edge)
{
    run_pass(surface, edge, refine_split_edge);
}

/* ---- Collapse ---- */

static bool has(const uint32_t triangle[3], uint32_t v)
{
    return triangle[0] == v || triangle[1] == v || triangle[2] == v;
}

/* How many neighbours two vertices share; UINT32_MAX: one of them or of theirs is touched. */
static uint32_t shared(const struct pass *pass, uint32_t a, uint32_t b)
{
    const struct surface_links *fans = &pass->links;
    uint32_t near[64], n = 0, count = 0;
    for (uint32_t i = fans->first[a]; i < fans->first[a + 1]; i++)
        for (int k = 0; k < 3; k++) {
            const uint32_t v = pass->surface->triangle[fans->fan[i]][k];
            uint32_t j = 0;
            while (j < n && near[j] != v)
                j++;
            if (pass->touched[v] || (j == n && n == 64))
                return UINT32_MAX;
            if (j == n)
                near[n++] = v;
        }
    for (uint32_t j = 0; j < n; j++) {
        bool is_near = false;
        for (uint32_t i = fans->first[b]; i < fans->first[b + 1] && !is_near; i++)
            is_near = has(pass->surface->triangle[fans->fan[i]], near[j]);
        count += is_near && near[j] != a && near[j] != b;
    }
    for (uint32_t i = fans->first[b]; i < fans->first[b + 1]; i++)
        for (int k = 0; k < 3; k++)
            if (pass->touched[pass->surface->triangle[fans->fan[i]][k]])
                return UINT32_MAX;
    return count;
}

/* True if the triangles of a but not of b keep their side, and get no long edge, if a moves. */
static bool may_move(const struct pass *pass, uint32_t a, uint32_t b, const double to[3],
                     double most)
{
    const struct surface *surface = pass->surface;
    for (uint32_t i = pass->links.first[a]; i < pass->links.first[a + 1]; i++) {
        const uint32_t *v = surface->triangle[pass->links.fan[i]];
        const double *x[3];
        double before[3], after[3];
        if (has(v, b))
            continue;
        cloth_normal(surface->x[v[0]], surface->x[v[1]], surface->x[v[2]], before);
        for (int k = 0; k < 3; k++) {
            x[k] = v[k] == a ? to : surface->x[v[k]];
            if (v[k] != a && cloth_distance(x[k], to) > most)
                return false;
        }
        cloth_normal(x[0], x[1], x[2], after);
        if (!(refine_cosine(before, after) > BENT))
            return false;
    }
    return true;
}

/* Makes one vertex, a, of both; b's triangles at the edge lose their corners. */
static void refine_join(struct pass *pass, uint32_t a, uint32_t b, const double to[3])
{
    struct surface *surface = pass->surface;
    const uint32_t both[2] = {a, b};
    for (int s = 0; s < 2; s++)
        for (uint32_t i = pass->links.first[both[s]]; i < pass->links.first[both[s] + 1]; i++)
            for (int k = 0; k < 3; k++)
                pass->touched[surface->triangle[pass->links.fan[i]][k]] = 1;
    for (uint32_t i = pass->links.first[b]; i < pass->links.first[b + 1]; i++) {
        uint32_t *v = surface->triangle[pass->links.fan[i]];
        const bool gone = has(v, a);
        for (int k = 0; k < 3; k++)
            v[k] = gone ? UINT32_MAX : v[k] == b ? a : v[k];
    }
    memcpy(surface->x[a], to, sizeof surface->x[a]);
    surface->middle[a] = surface->middle[a] || surface->middle[b];
}

static void collapse_edge(struct pass *pass, const struct surface_edge *edge)
{
    const struct surface *surface = pass->surface;
    const uint32_t a = edge->end[0], b = edge->end[1];
    const bool boundary = edge->triangle[1] == UINT32_MAX;
    double to[3];
    if (pass->touched[a] || pass->touched[b] ||
        (surface->middle[a] && surface->middle[b] && !boundary))
        return;
    const double relative = relative_length(pass, edge);
    if (!(relative < SHORT))
        return;
    const double most = LONG * cloth_distance(surface->x[a], surface->x[b]) / relative;
    const double part = surface->middle[a] == surface->middle[b] ? 0.5 : surface->middle[b];
    for (int c = 0; c < 3; c++)
        to[c] = surface->x[a][c] + part * (surface->x[b][c] - surface->x[a][c]);
    if (shared(pass, a, b) != (boundary ? 1 : 2))
        return;
    if (may_move(pass, a, b, to, most) && may_move(pass, b, a, to, most))
        refine_join(pass, a, b, to);
}

/* Leaves out triangles without corners, and vertices without triangles. */
static void compact(struct surface *surface)
{
    uint32_t *place = cloth_alloc(surface->n, sizeof *place, surface->error), m = 0, n = 0;
    if (!place)
        return;
    for (uint32_t t = 0; t < surface->m; t++)
        if (surface->triangle[t][0] != UINT32_MAX)
            memmove(surface->triangle[m++], surface->triangle[t], sizeof *surface->triangle);
    surface->m = m;
    for (uint32_t t = 0; t < m; t++)
        for (int k = 0; k < 3; k++)
            place[surface->triangle[t][k]] = 1;
    for (uint32_t v = 0; v < surface->n; v++)
        if (place[v]) {
            memmove(surface->x[n], surface->x[v], sizeof *surface->x);
            surface->middle[n] = surface->middle[v];
            place[v] = n++;
        }
    surface->n = n;
    for (uint32_t t = 0; t < m; t++)
        for (int k = 0; k < 3; k++)
            surface->triangle[t][k] = place[surface->triangle[t][k]];
    free(place);
}

void surface_collapse(struct surface *surface, double edge)
{
    run_pass(surface, edge, collapse_edge);
    if (!surface->error->code)
        compact(surface);
}

/* ---- Turn ---- */

static uint32_t opposite(const uint32_t v[3], const struct surface_edge *edge)
{
    return v[0] ^ v[1] ^ v[2] ^ edge->end[0] ^ edge->end[1];
}

/* How far from its best number of neighbours a vertex is that gets `change` more, squared. Half
 * of those of a vertex in the middle plane are in the mirror image. */
static int64_t excess(const struct pass *pass, uint32_t v, int change)
{
    const uint32_t n = pass->links.first[v + 1] - pass->links.first[v];
    const int64_t d = (int64_t)n + change - (pass->surface->middle[v] ? 3 : 6);
    return pass->surface->middle[v] ? 4 * d * d : d * d;
}

static bool is_edge(const struct pass *pass, uint32_t a, uint32_t b)
{
    const uint32_t *first = pass->links.first_edge, low = a < b ? a : b, high = a < b ? b : a;
    for (uint32_t e = first[low]; e < first[low + 1]; e++)
        if (pass->links.edge[e].end[1] == high)
            return true;
    return false;
}

/* True if the triangles a d c and d b c, made of a b c and b a d, lie as the old ones do. */
static bool lies_well(const struct surface *surface, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    const double(*x)[3] = (const double(*)[3])surface->x;
    double old[2][3], new[2][3];
    cloth_normal(x[a], x[b], x[c], old[0]);
    cloth_normal(x[b], x[a], x[d], old[1]);
    cloth_normal(x[a], x[d], x[c], new[0]);
    cloth_normal(x[d], x[b], x[c], new[1]);
    for (int i = 0; i < 4; i++)
        if (!(refine_cosine(old[i / 2], new[i % 2]) > BENT))
            return false;
    return refine_cosine(new[0], new[1]) > BENT;
}

static void turn_edge(struct pass *pass, const struct surface_edge *edge)
{
    struct surface *surface = pass->surface;
    if (pass->touched[edge->end[0]] || pass->touched[edge->end[1]] ||
        edge->triangle[1] == UINT32_MAX)
        return;
    uint32_t *one = surface->triangle[edge->triangle[0]];
    uint32_t *two = surface->triangle[edge->triangle[1]];
    const uint32_t c = opposite(one, edge), d = opposite(two, edge);
    uint32_t k = 0;
    while (one[k] != c)
        k++;
    const uint32_t a = one[(k + 1) % 3], b = one[(k + 2) % 3];
    const uint32_t all[4] = {a, b, c, d};
    int64_t gain = 0;
    if (pass->touched[c] || pass->touched[d])
        return;
    for (int i = 0; i < 4; i++)
        gain += excess(pass, all[i], 0) - excess(pass, all[i], i < 2 ? -1 : 1);
    if (gain <= 0 || is_edge(pass, c, d) || !lies_well(surface, a, b, c, d))
        return;
    memcpy(one, (uint32_t[3]){a, d, c}, sizeof(uint32_t[3]));
    memcpy(two, (uint32_t[3]){d, b, c}, sizeof(uint32_t[3]));
    for (int i = 0; i < 4; i++)
        pass->touched[all[i]] = 1;
}

void surface_turn(struct surface *surface)
{
    run_pass(surface, 0, turn_edge);
}
