/* Vertices that stand for others are farther than the distance from each other, so a cell has a
 * bounded number of them, and the work is linear for any mesh. */
#include "cloth/base/memory.h"
#include "cloth/base/vector.h"
#include "cloth/mesh/mesh.h"

#include <stdlib.h>

enum { CELL = 4 }; /* distances a side: near vertices are mostly in one cell */

/* Chains of the vertices that stand for others, by a hash of their cells. */
struct cells {
    const double *position;
    double distance;
    uint32_t mask;         /* number of chains, less one */
    uint32_t *head, *next; /* vertex + 1; 0: the end */
};

/* The cell that a vertex is in, or one that is `aside` along each axis. */
static void cell_of(const struct cells *cells, uint32_t v, double aside, double cell[3])
{
    for (size_t i = 0; i < 3; i++)
        cell[i] = floor((cells->position[3 * (size_t)v + i] + aside) / (CELL * cells->distance));
}

static uint32_t chain_of(const struct cells *cells, const double cell[3])
{
    uint64_t hash = 0;
    for (int i = 0; i < 3; i++)
        hash = (hash ^ (uint64_t)(int64_t)cell[i]) * UINT64_C(0x9E3779B97F4A7C15) >> 7;
    return (uint32_t)(hash >> 16) & cells->mask;
}

/* The lowest vertex of a chain that is near; `best` where none is lower. */
static uint32_t coincide_look_along(const struct cells *cells, uint32_t chain, uint32_t v,
                                    uint32_t best)
{
    const double *x = cells->position, most = cells->distance * cells->distance;
    for (uint32_t at = cells->head[chain]; at; at = cells->next[at - 1])
        if (at - 1 < best && cloth_square(x + 3 * (size_t)v, x + 3 * (size_t)(at - 1)) <= most)
            best = at - 1;
    return best;
}

/* The lowest vertex that stands for others and is near; v itself: there is none. */
static uint32_t coincide_find_near(const struct cells *cells, uint32_t v)
{
    double low[3], high[3], at[3];
    cell_of(cells, v, -cells->distance, low);
    cell_of(cells, v, cells->distance, high);
    uint32_t best = v;
    for (at[0] = low[0]; at[0] <= high[0]; at[0]++)
        for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
            for (at[2] = low[2]; at[2] <= high[2]; at[2]++)
                best = coincide_look_along(cells, chain_of(cells, at), v, best);
    return best;
}

static void coincide_put(struct cells *cells, uint32_t v)
{
    double at[3];
    cell_of(cells, v, 0, at);
    const uint32_t chain = chain_of(cells, at);
    cells->next[v] = cells->head[chain];
    cells->head[chain] = v + 1;
}

/* True if cells can be told apart where the vertex is. */
static bool is_within(const struct cells *cells, uint32_t v)
{
    const double most = 4503599627370496.0; /* 2^52: a whole number and the next one differ */
    bool within = true;
    for (size_t i = 0; i < 3; i++)
        within = within && fabs(cells->position[3 * (size_t)v + i]) < most * cells->distance;
    return within;
}

int mesh_coincide(const struct mesh *mesh, double distance, uint32_t *same,
                  struct cloth_error *error)
{
    struct cells cells = {.position = mesh->position, .distance = distance, .mask = 1};
    while (cells.mask < mesh->n_vertices)
        cells.mask = 2 * cells.mask + 1;
    struct cloth_pool memory = {0};
    unsigned char *used = cloth_take(&memory, mesh->n_vertices, 1, error);
    cells.head = cloth_take(&memory, (size_t)cells.mask + 1, sizeof *cells.head, error);
    cells.next = cloth_take(&memory, mesh->n_vertices, sizeof *cells.next, error);
    const bool made = !memory.lacks;
    if (made)
        mesh_used(mesh, used);
    for (uint32_t v = 0; made && v < mesh->n_vertices; v++) {
        const bool seen = used[v] && is_within(&cells, v);
        same[v] = seen ? coincide_find_near(&cells, v) : v;
        if (seen && same[v] == v)
            coincide_put(&cells, v);
    }
    cloth_pool_free(&memory);
    return made ? CLOTH_OK : CLOTH_E_MEMORY;
}
