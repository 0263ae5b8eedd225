/* A piece has all vertices that springs and elements join, directly or through others. Pieces are
 * numbered by their lowest vertex, so that the numbers depend on the scene alone. */
#include "cloth/flow/run/source.h"

#include "cloth/base/memory.h"
#include "cloth/base/sets.h"

#include <stdlib.h>

static void join(void *to, const struct flow_spring *spring)
{
    uint32_t *parent = to;
    cloth_sets_join(parent, spring->a, spring->b);
}

/* Numbers the vertices of pieces: the lowest vertex of a piece gets the number, or 0 if a pin holds
 * a vertex of the piece; then all others get theirs. Vertices come after the lowest one of their
 * piece. */
static uint32_t number(struct flow_particles *p, uint32_t *parent, const unsigned char *held)
{
    uint32_t n = 0;
    for (uint32_t v = 0; v < p->n; v++) {
        const uint32_t root = cloth_sets_root(parent, v);
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
    if (made)
        cloth_sets_start(parent, p->n);
    if (made)
        flow_springs_each(&source->springs, join, parent);
    for (uint32_t i = 0; made && i < p->welds.n; i++)
        join(parent, &(struct flow_spring){.a = p->welds.name[i][0], .b = p->welds.name[i][1]});
    for (uint32_t v = 0; made && v < p->n; v++)
        if (!p->free[v] || (p->slider && p->slider[v]))
            held[cloth_sets_root(parent, v)] = 1;
    if (made)
        p->n_pieces = number(p, parent, held);
    free(parent);
    free(held);
    return made ? CLOTH_OK : CLOTH_E_MEMORY;
}
