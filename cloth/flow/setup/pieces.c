/* A piece is what springs and elements join, directly or through others. Pieces are numbered by
 * their lowest vertex, so that the numbers depend on the scene alone. */
#include "cloth/flow/setup/source.h"

#include "cloth/base/memory.h"

#include <stdlib.h>

/* The lowest vertex of a piece stands for it. */
static uint32_t root_of(uint32_t *parent, uint32_t vertex)
{
    while (parent[vertex] != vertex) {
        parent[vertex] = parent[parent[vertex]];
        vertex = parent[vertex];
    }
    return vertex;
}

static void join(void *to, const struct flow_spring *spring)
{
    uint32_t *parent = to;
    const uint32_t a = root_of(parent, spring->a), b = root_of(parent, spring->b);
    parent[a > b ? a : b] = a > b ? b : a;
}

/* Where each vertex is in its piece: the lowest one gets the number, or 0 if a pin holds a vertex
 * of the piece; then all others theirs. Vertices come after the lowest one of their piece. */
static uint32_t number(struct flow_particles *p, uint32_t *parent, const unsigned char *held)
{
    uint32_t n = 0;
    for (uint32_t v = 0; v < p->n; v++) {
        const uint32_t root = root_of(parent, v);
        const bool counts = root == v && p->used[v] && !held[v];
        p->piece[v] = counts ? ++n : root == v ? 0 : p->piece[root];
    }
    return n;
}

int flow_pieces_make(struct flow_source *source, struct cloth_error *error)
{
    struct flow_particles *p = &source->particles;
    uint32_t *parent = cloth_alloc(p->n, sizeof *parent, error);
    unsigned char *held = cloth_alloc(p->n, 1, error);
    p->piece = cloth_alloc(p->n, sizeof *p->piece, error);
    const bool made = parent && held && p->piece;
    for (uint32_t v = 0; made && v < p->n; v++)
        parent[v] = v;
    if (made)
        flow_springs_each(&source->springs, join, parent);
    for (uint32_t i = 0; made && i < p->welds.n; i++)
        join(parent, &(struct flow_spring){.a = p->welds.name[i][0], .b = p->welds.name[i][1]});
    for (uint32_t v = 0; made && v < p->n; v++)
        if (!p->free[v] || (p->slider && p->slider[v]))
            held[root_of(parent, v)] = 1;
    if (made)
        p->n_pieces = number(p, parent, held);
    free(parent);
    free(held);
    return made ? CLOTH_OK : CLOTH_E_MEMORY;
}
