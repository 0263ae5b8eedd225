/* Sides of one edge stand together, triangles in their order, lone edges after them. */
#include "cloth/mesh/detail/sides.h"

#include "cloth/base/memory.h"
#include "cloth/mesh/detail/sort.h"

#include <stdlib.h>

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
    if (!sides->pair || !sides->order) {
        mesh_sides_free(sides);
        return CLOTH_E_MEMORY;
    }
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        uint32_t corner[3];
        mesh_corners(mesh, t, corner);
        for (size_t s = 0; s < 3; s++)
            set_pair(sides->pair + 2 * (3 * (size_t)t + s), corner[s], corner[(s + 1) % 3]);
    }
    for (size_t e = 0; e < mesh->n_lone_edges; e++)
        set_pair(sides->pair + 2 * (of_triangles + e), mesh->lone_edge[2 * e],
                 mesh->lone_edge[2 * e + 1]);
    int code = mesh_sort_pairs(sides->order, n, sides->pair, mesh->n_vertices, error);
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
