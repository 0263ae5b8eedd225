/* Edges are found by sorting the sides of the triangles, so that their order and sums depend on the
 * mesh only. */
#include "cloth/base/memory.h"
#include "cloth/base/order.h"
#include "cloth/mesh/detail/sides.h"
#include "cloth/mesh/mesh.h"

#include <stdlib.h>

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
    if (code)
        return code;
    if (mesh_sides_third(&sides, mesh->n_triangles, &third)) {
        code = cloth_fail(error, CLOTH_E_INPUT,
                          "triangle %u is the third at one edge (non-manifold); an edge may have "
                          "at most two (triangles count from 1)",
                          third / 3 + 1);
        goto done;
    }
    for (uint32_t i = 0; i < sides.n; i = mesh_sides_run(&sides, i))
        n++;
    edges->edge = cloth_alloc(n, sizeof *edges->edge, error);
    if (!edges->edge) {
        code = CLOTH_E_MEMORY;
        goto done;
    }
    for (uint32_t i = 0, end; i < sides.n; i = end) {
        end = mesh_sides_run(&sides, i);
        edges->edge[edges->n++] = make_edge(mesh, &sides, i, end);
    }
done:
    mesh_sides_free(&sides);
    return code;
}

static int compare_ends(const void *va, const void *vb)
{
    const struct mesh_edge *a = va, *b = vb;
    return a->a != b->a ? cloth_compare_u32(a->a, b->a) : cloth_compare_u32(a->b, b->b);
}

const struct mesh_edge *mesh_edges_get(const struct mesh_edges *edges, uint32_t a, uint32_t b)
{
    const struct mesh_edge wanted = {.a = a < b ? a : b, .b = a < b ? b : a};
    return edges->n ? bsearch(&wanted, edges->edge, edges->n, sizeof wanted, compare_ends) : NULL;
}

void mesh_edges_free(struct mesh_edges *edges)
{
    free(edges->edge);
    *edges = (struct mesh_edges){0};
}
