/* Rounds go on until there are no faults. They fail after a limit, or if a few dozen have not
 * reduced the faults. */
#include "cloth/untangle/state.h"

#include <string.h>

enum { ROUNDS = 300, PATIENCE = 60 };

static int untangle_find_wrong(struct untangle *all)
{
    all->pushes.n = 0;
    untangle_refit(all);
    int code = untangle_cross(all);
    code = code ? code : untangle_obstacles(all);
    code = code ? code : untangle_parts(all);
    code = code ? code : untangle_layers(all);
    code = code ? code : untangle_shorten(all);
    return code ? code : untangle_near(all);
}

/* The round with the least wrong so far. */
static void untangle_keep(struct untangle *all, struct untangle_result *result)
{
    memcpy(all->best, all->x, all->n_points * sizeof *all->best);
    memcpy(result->near, all->near, sizeof result->near);
    result->left = all->count;
}

/* Finds the edge that became longest by a factor. */
static void find_stretch(const struct untangle *all, struct untangle_result *result)
{
    for (uint32_t e = 0; e < all->n_edges; e++) {
        const struct untangle_edge *edge = all->edge + e;
        const phys_vec along = all->best[edge->end[1]] - all->best[edge->end[0]];
        const double stretch = sqrt(phys_dot(&along, &along)) / edge->length;
        if (edge->owner >= all->n_cloths || !(edge->length > CONTACT_TINY) ||
            !(stretch > result->stretch))
            continue;
        result->stretch = stretch;
        memcpy(result->stretched, edge->end, sizeof result->stretched);
    }
}

static void untangle_conclude(const struct untangle *all, phys_vec *x,
                              struct untangle_result *result)
{
    for (uint32_t p = 0; p < all->n_cloth_points; p++) {
        const phys_vec way = all->best[p] - all->start[p];
        const double square = phys_dot(&way, &way);
        if (!(square > 0))
            continue;
        x[p] = all->best[p];
        result->moved++;
        result->largest = fmax(result->largest, sqrt(square));
    }
    if (result->moved)
        find_stretch(all, result);
}

static int go_round(struct untangle *all, const struct untangle_listener *listener,
                    struct untangle_result *result)
{
    uint64_t least = UINT64_MAX;
    uint32_t since = 0;
    int code;
    while (!(code = untangle_find_wrong(all))) {
        const uint64_t wrong = untangle_faults(&all->count);
        if (!result->rounds)
            untangle_turned(all, result);
        since++;
        if (wrong < least) {
            untangle_keep(all, result);
            least = wrong;
            since = 0;
        }
        if (listener)
            listener->round(listener->context, result->rounds, &all->count);
        if (!wrong || result->rounds == ROUNDS || since == PATIENCE)
            break;
        untangle_move(all);
        result->rounds++;
    }
    return code;
}

int untangle(const struct untangle_cloths *cloths, phys_vec *x,
             const struct untangle_listener *listener, struct untangle_result *result,
             struct cloth_error *error)
{
    struct untangle all = {.of = cloths, .error = error};
    *result = (struct untangle_result){0};
    if (!contact_soup_cloths(cloths->soup).triangle)
        return CLOTH_OK;
    int code = untangle_open(&all, x);
    if (!code)
        untangle_pieces(&all);
    code = code ? code : go_round(&all, listener, result);
    if (!code)
        untangle_conclude(&all, x, result);
    untangle_close(&all);
    return code;
}
