/* Pushes and edges are applied one after the other; each sees the moves of those before it. */
#include "cloth/untangle/state.h"

enum { SWEEPS = 6 };
static const double MOST = 5;                      /* thicknesses: of a push in a sweep */
static const double SHORTEST = 0.8, LONGEST = 1.2; /* of the length that an edge had */

int untangle_add(struct untangle *all, const struct untangle_push *push)
{
    return cloth_list_put(&all->pushes, push, sizeof *push, all->error);
}

/* The corners that move: those that are free and need not stay, else all that are free. */
static uint32_t find_movers(const struct untangle *all, const struct untangle_push *push)
{
    uint32_t freed = 0;
    for (uint32_t k = 0; k < push->n; k++)
        freed |= (uint32_t)(!all->held[push->point[k]] && push->weight[k] != 0) << k;
    return freed & ~push->still ? freed & ~push->still : freed;
}

static void apply(struct untangle *all, const struct untangle_push *push)
{
    const uint32_t movers = find_movers(all, push);
    double lacks = push->want, sum = 0;
    for (uint32_t k = 0; k < push->n; k++) {
        const double weight = push->weight[k];
        lacks -= weight * phys_dot(&push->normal, all->x + push->point[k]);
        sum += movers >> k & 1 ? weight * weight : 0;
    }
    if (!(lacks > 0) || !(sum > 0))
        return;
    lacks = fmin(lacks, MOST * all->of->thickness);
    for (uint32_t k = 0; k < push->n; k++)
        if (movers >> k & 1) {
            all->x[push->point[k]] += push->weight[k] / sum * lacks * push->normal;
            all->moved[push->point[k]] = 1;
        }
}

/* Limits the length of an edge; skips edges that were not moved. */
static void keep_length(struct untangle *all, const struct untangle_edge *edge)
{
    const uint32_t a = edge->end[0], b = edge->end[1];
    const double moves[2] = {!all->held[a], !all->held[b]};
    if (!(all->moved[a] || all->moved[b]) || !(moves[0] + moves[1] > 0))
        return;
    const phys_vec along = all->x[b] - all->x[a];
    const double length = sqrt(phys_dot(&along, &along));
    const double to = fmin(fmax(length, SHORTEST * edge->length), LONGEST * edge->length);
    if (!(length > CONTACT_TINY) || (to <= length && to >= length))
        return;
    const phys_vec way = (to - length) / length / (moves[0] + moves[1]) * along;
    all->x[a] -= moves[0] * way;
    all->x[b] += moves[1] * way;
    all->moved[a] |= moves[0] > 0;
    all->moved[b] |= moves[1] > 0;
}

void untangle_move(struct untangle *all)
{
    const struct untangle_push *push = all->pushes.items;
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        for (uint32_t e = 0; e < all->n_edges && sweep; e++)
            if (all->edge[e].owner < all->n_cloths)
                keep_length(all, all->edge + e);
        for (size_t i = 0; i < all->pushes.n; i++)
            apply(all, push + i);
    }
}
