/* Sides of one edge stand together, triangles in their order, lone edges after them. */
#include "cloth/mesh/detail/sides.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"

#include <stdlib.h>
#include <string.h>

/* A counting pass, which keeps the order of equals: so the result is one and the same on every
 * machine. from: the order before, NULL for 0 .. n-1; which: the number of the pair to sort by. */
static void sort_pass(uint32_t *to, const uint32_t *from, size_t n, const uint32_t *pair,
                      size_t which, uint32_t *start, uint32_t n_keys)
{
    memset(start, 0, ((size_t)n_keys + 1) * sizeof *start);
    for (size_t i = 0; i < n; i++)
        start[pair[2 * i + which] + 1]++;
    for (uint32_t k = 0; k < n_keys; k++)
        start[k + 1] += start[k];
    for (size_t i = 0; i < n; i++) {
        uint32_t item = from ? from[i] : (uint32_t)i;
        to[start[pair[2 * (size_t)item + which]]++] = item;
    }
}

int mesh_sort_pairs(uint32_t *order, size_t n, const uint32_t *pair, uint32_t n_keys,
                    struct cloth_error *error)
{
    uint32_t *start = cloth_alloc((size_t)n_keys + 1, sizeof *start, error);
    uint32_t *by_second = cloth_alloc(n, sizeof *by_second, error);
    const bool made = start && by_second;
    if (made) {
        sort_pass(by_second, NULL, n, pair, 1, start, n_keys);
        sort_pass(order, by_second, n, pair, 0, start, n_keys);
    }
    free(start);
    free(by_second);
    return made ? CLOTH_OK : CLOTH_E_MEMORY;
}

static void set_pair(uint32_t *pair, uint32_t a, uint32_t b)
{
    pair[0] = a < b ? a : b;
    pair[1] = a < b ? b : a;
}

int mesh_sides_sort(struct mesh_sides *sides, const struct mesh *mesh, struct cloth_error *error)
{
    size_t of_triangles = 3 * (size_t)mesh->n_triangles, n = of_triangles + mesh->n_lone_edges;
    *sides = (struct mesh_sides){0};
    if (n > UINT32_MAX)
        return cloth_fail(error, CLOTH_E_INPUT,
                          "the mesh has %zu triangle sides and edges; at most %u can be handled", n,
                          UINT32_MAX);
    sides->n = (uint32_t)n;
    sides->pair = cloth_alloc(2 * n, sizeof *sides->pair, error);
    sides->order = cloth_alloc(n, sizeof *sides->order, error);
    int code = sides->pair && sides->order ? CLOTH_OK : CLOTH_E_MEMORY;
    for (uint32_t t = 0; t < mesh->n_triangles && !code; t++) {
        uint32_t corner[3];
        mesh_corners(mesh, t, corner);
        for (size_t s = 0; s < 3; s++)
            set_pair(sides->pair + 2 * (3 * (size_t)t + s), corner[s], corner[(s + 1) % 3]);
    }
    for (size_t e = 0; e < mesh->n_lone_edges && !code; e++)
        set_pair(sides->pair + 2 * (of_triangles + e), mesh->lone_edge[2 * e],
                 mesh->lone_edge[2 * e + 1]);
    if (!code)
        code = mesh_sort_pairs(sides->order, n, sides->pair, mesh->n_vertices, error);
    if (code)
        mesh_sides_free(sides);
    return code;
}

void mesh_sides_free(struct mesh_sides *sides)
{
    free(sides->pair);
    free(sides->order);
    *sides = (struct mesh_sides){0};
}

uint32_t mesh_sides_run(const struct mesh_sides *sides, uint32_t first)
{
    const uint32_t *pair = sides->pair + 2 * (size_t)sides->order[first];
    uint32_t end = first + 1;
    for (; end < sides->n; end++) {
        const uint32_t *other = sides->pair + 2 * (size_t)sides->order[end];
        if (other[0] != pair[0] || other[1] != pair[1])
            break;
    }
    return end;
}

bool mesh_sides_third(const struct mesh_sides *sides, uint32_t n_triangles, uint32_t *side)
{
    bool found = false;
    for (uint32_t i = 0, end; i < sides->n; i = end) {
        end = mesh_sides_run(sides, i);
        if (end - i < 3)
            continue;
        uint32_t third = sides->order[i + 2];
        if (third / 3 < n_triangles && (!found || third < *side)) {
            *side = third;
            found = true;
        }
    }
    return found;
}

/* ---- Edges: their order and sums depend on the mesh only ---- */

static struct mesh_edge make_edge(const struct mesh *mesh, const struct mesh_sides *sides,
                                  uint32_t first, uint32_t end)
{
    const uint32_t *pair = sides->pair + 2 * (size_t)sides->order[first];
    struct mesh_edge edge = {.a = pair[0],
                             .b = pair[1],
                             .opposite = {UINT32_MAX, UINT32_MAX},
                             .triangle = {UINT32_MAX, UINT32_MAX}};
    bool first_ascends = false;
    for (uint32_t i = first, n = 0; i < end; i++) {
        uint32_t side = sides->order[i], t = side / 3;
        if (t >= mesh->n_triangles)
            break;
        uint32_t corner[3];
        mesh_corners(mesh, t, corner);
        const bool ascends = corner[side % 3] == edge.a;
        edge.against = n && ascends == first_ascends;
        first_ascends = ascends;
        edge.triangle[n] = t;
        edge.opposite[n++] = corner[(side % 3 + 2) % 3];
        edge.area += mesh_triangle_area(mesh, t);
    }
    return edge;
}

int mesh_edges_find(struct mesh_edges *edges, const struct mesh *mesh, struct cloth_error *error)
{
    struct mesh_sides sides;
    uint32_t third, n = 0;
    *edges = (struct mesh_edges){0};
    int code = mesh_sides_sort(&sides, mesh, error);
    if (!code && mesh_sides_third(&sides, mesh->n_triangles, &third))
        code = cloth_fail(error, CLOTH_E_INPUT,
                          "triangle %u is the third at one edge (non-manifold); an edge may have "
                          "at most two (triangles count from 1)",
                          third / 3 + 1);
    for (uint32_t i = 0; !code && i < sides.n; i = mesh_sides_run(&sides, i))
        n++;
    edges->edge = code ? NULL : cloth_alloc(n, sizeof *edges->edge, error);
    code = code || edges->edge ? code : CLOTH_E_MEMORY;
    for (uint32_t i = 0, end; !code && i < sides.n; i = end) {
        end = mesh_sides_run(&sides, i);
        edges->edge[edges->n++] = make_edge(mesh, &sides, i, end);
    }
    mesh_sides_free(&sides);
    return code;
}

const struct mesh_edge *mesh_edges_get(const struct mesh_edges *edges, uint32_t a, uint32_t b)
{
    const struct mesh_edge wanted = {.a = a < b ? a : b, .b = a < b ? b : a};
    return edges->n ? bsearch(&wanted, edges->edge, edges->n, sizeof wanted, cloth_by_two) : NULL;
}

void mesh_edges_free(struct mesh_edges *edges)
{
    free(edges->edge);
    *edges = (struct mesh_edges){0};
}
