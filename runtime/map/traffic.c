/* What recorded tasks read from other blocks than their own: what would travel if these lived on
 * another rank. A value that two tasks of a block read counts twice, though it travels once. That
 * is accepted: the sums are compared with one another, and both reads tie the two blocks. */
#include "runtime/map/blocks.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <stdlib.h>

static bool traffic_add_edge(struct map_traffic *traffic, uint32_t from, uint32_t to, double bytes)
{
    void *moved =
        base_grow(traffic->edge, &traffic->capacity, traffic->n + 1, sizeof *traffic->edge);
    if (!moved)
        return false;
    traffic->edge = moved;
    traffic->edge[traffic->n++] = (struct map_edge){from, to, bytes};
    return true;
}

bool map_traffic_read(struct map_traffic *traffic, uint32_t own, uint32_t other, double bytes)
{
    return other == own || own == MAP_NO_BLOCK || other == MAP_NO_BLOCK ||
           (traffic_add_edge(traffic, own, other, bytes) &&
            traffic_add_edge(traffic, other, own, bytes));
}

int map_traffic_add(struct map_traffic *traffic, const struct map_blocks *blocks,
                    const struct plan_record *record, double rounds)
{
    const struct data_object *objects = record->graph->table.object;
    bool fine = true;
    for (size_t i = 0; i < record->n_forks && fine; i++) {
        const struct plan_recorded_fork *fork = &record->fork[i];
        uint32_t owner = plan_recorded_owner(record, fork);
        if (owner == PLAN_NONE)
            continue;
        uint32_t own = blocks->of[record->object[owner].bound.slot];
        for (uint32_t k = 0; k < fork->n && fine; k++) {
            const struct plan_access *access = &record->access[fork->first + k];
            uint32_t slot = record->object[access->object].bound.slot;
            if (access->mode != DUITE_W)
                fine = map_traffic_read(traffic, own, blocks->of[slot],
                                        rounds * (double)objects[slot].room);
        }
    }
    return fine ? DUITE_OK : base_no_memory("the blocks of objects");
}

static int edge_compare(const void *a, const void *b)
{
    const struct map_edge *x = a, *y = b;
    if (x->from != y->from)
        return x->from < y->from ? -1 : 1;
    return x->to < y->to ? -1 : x->to > y->to;
}

int map_traffic_end(struct map_traffic *traffic, const struct map_blocks *blocks)
{
    traffic->start = base_alloc_zero((blocks->n + 1) * sizeof *traffic->start);
    traffic->neighbour = base_alloc(traffic->n * sizeof *traffic->neighbour + 1);
    traffic->bytes = base_alloc(traffic->n * sizeof *traffic->bytes + 1);
    if (!traffic->start || !traffic->neighbour || !traffic->bytes)
        return base_no_memory("the blocks of objects");
    if (traffic->n)
        qsort(traffic->edge, traffic->n, sizeof *traffic->edge, edge_compare);
    size_t n = 0;
    for (size_t i = 0; i < traffic->n; i++) {
        const struct map_edge *edge = &traffic->edge[i];
        if (!i || edge_compare(edge, edge - 1)) {
            traffic->start[edge->from + 1]++;
            traffic->neighbour[n] = edge->to;
            traffic->bytes[n++] = 0;
        }
        traffic->bytes[n - 1] += edge->bytes;
    }
    for (size_t i = 0; i < blocks->n; i++)
        traffic->start[i + 1] += traffic->start[i];
    return DUITE_OK;
}

void map_traffic_free(struct map_traffic *traffic)
{
    free(traffic->edge);
    base_free(traffic->start);
    base_free(traffic->neighbour);
    base_free(traffic->bytes);
    *traffic = (struct map_traffic){0};
}
