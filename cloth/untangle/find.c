/* The nearest point of the cloths' triangles to a point, by the tree. */
#include "cloth/untangle/state.h"

enum { STACK = 64 }; /* nodes: three more for each of at most 15 levels */

/* The square of the distance of a point from a part of a node; infinite if the part is empty. */
static double part_square(const struct contact_node *node, int part, const phys_vec *x)
{
    double square = 0;
    for (int c = 0; c < 3; c++) {
        const double under = (double)node->low[c][part] - (*x)[c];
        const double over = (*x)[c] - (double)node->high[c][part];
        const double out = fmax(fmax(under, over), 0);
        square += out * out;
    }
    return square;
}

static void try_leaf(const struct untangle *all, const phys_vec *x, uint32_t child,
                     untangle_allows *allows, const void *context, struct untangle_nearest *best)
{
    const struct contact_facet *facet = all->facet + contact_leaf_first(child);
    for (uint32_t i = 0; i < contact_leaf_n(child); i++) {
        struct contact_nearest nearest;
        if (!allows(all, facet[i].number, context))
            continue;
        const phys_vec corners[4] = {*x, all->x[facet[i].corner[0]], all->x[facet[i].corner[1]],
                                     all->x[facet[i].corner[2]]};
        contact_nearest_of(CONTACT_VT, corners, &nearest);
        if (nearest.gap < best->at.gap)
            *best = (struct untangle_nearest){facet[i].number, nearest};
    }
}

struct visit {
    double square;
    uint32_t child;
};

/* Puts the parts that may hold something nearer on the stack, the nearest on top. */
static uint32_t push_parts(const struct contact_node *node, const phys_vec *x, double reach,
                           struct visit *stack, uint32_t n)
{
    const uint32_t first = n;
    for (int part = 0; part < 4; part++) {
        const struct visit visit = {part_square(node, part, x), node->child[part]};
        if (visit.square > reach * reach)
            continue;
        uint32_t at = n++;
        for (; at > first && stack[at - 1].square < visit.square; at--)
            stack[at] = stack[at - 1];
        stack[at] = visit;
    }
    return n;
}

bool untangle_find(const struct untangle *all, const phys_vec *x, double reach,
                   untangle_allows *allows, const void *context, struct untangle_nearest *found)
{
    struct visit stack[STACK] = {{0, 0}};
    uint32_t n = 1;
    *found = (struct untangle_nearest){.triangle = UNTANGLE_NONE, .at = {.gap = reach}};
    while (n) {
        const struct visit visit = stack[--n];
        if (visit.square > found->at.gap * found->at.gap)
            continue;
        if (visit.child & CONTACT_IS_LEAF)
            try_leaf(all, x, visit.child, allows, context, found);
        else
            n = push_parts(all->node + visit.child, x, found->at.gap, stack, n);
    }
    return found->triangle != UNTANGLE_NONE;
}
