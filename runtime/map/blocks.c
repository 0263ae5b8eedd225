/* Blocks found in the table, the traffic between them, and blocks that move. A block is known by
 * its home and its number there, which no other block ever had. */
#include "runtime/map/blocks.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <stdlib.h>

#define HASH_NONFATAL_OOM          1
#define uthash_nonfatal_oom(entry) ((entry)->lost = true)
#include <uthash.h>

struct block_key {
    int home;
    uint32_t number;
};

/* An entry of the hash table that lives while blocks are found. */
struct block_entry {
    struct block_key key;
    bool lost; /* the table had no memory for it */
    UT_hash_handle hh;
};

/* `table`: the hash table of the first blocks->n entries, in the order of blocks. False without
 * memory. */
static bool block_add(struct map_blocks *blocks, struct block_entry **table,
                      struct block_entry *entries, const struct data_object *object, uint32_t slot)
{
    const struct block_key key = {object->home, object->block};
    struct block_entry *entry;
    HASH_FIND(hh, *table, &key, sizeof key, entry);
    if (!entry) {
        blocks->block[blocks->n] = (struct map_block){.home = key.home, .number = key.number};
        entry = &entries[blocks->n++];
        *entry = (struct block_entry){.key = key};
        HASH_ADD(hh, *table, key, sizeof key, entry);
        if (entry->lost)
            return false;
    }
    blocks->of[slot] = (uint32_t)(entry - entries);
    struct map_block *block = &blocks->block[blocks->of[slot]];
    block->objects++;
    block->bytes += object->room;
    block->fixed |= object->fixed;
    return true;
}

static int blocks_find(const struct data_table *table, struct map_blocks *blocks)
{
    struct block_entry *entries = base_alloc((table->n_alive + 1) * sizeof *entries),
                       *by_key = NULL;
    *blocks = (struct map_blocks){.block = base_alloc((table->n_alive + 1) * sizeof *blocks->block),
                                  .of = base_alloc(table->n_slots * sizeof *blocks->of)};
    bool fine = entries && blocks->block && blocks->of;
    for (uint32_t slot = 0; slot < table->n_slots && fine; slot++) {
        blocks->of[slot] = MAP_NO_BLOCK;
        if (table->object[slot].generation % 2)
            fine = block_add(blocks, &by_key, entries, &table->object[slot], slot);
    }
    HASH_CLEAR(hh, by_key);
    base_free(entries);
    return fine ? DUITE_OK : base_no_memory("the blocks of objects");
}

/* ---- Traffic ---- */

/* The bytes that recorded tasks read from blocks other than their own, and that would travel from
 * another rank. A value that two tasks of a block read counts twice, though it travels once. That
 * is accepted: only sums are compared, and both reads tie the two blocks. */

static bool traffic_add_edge(struct map_traffic *traffic, uint32_t from, uint32_t to, double bytes)
{
    if (!BASE_GROW(traffic->edge, traffic->capacity, traffic->n + 1))
        return false;
    traffic->edge[traffic->n++] = (struct map_edge){from, to, bytes};
    return true;
}

bool map_traffic_read(struct map_traffic *traffic, uint32_t own, uint32_t other, double bytes)
{
    return other == own || own == MAP_NO_BLOCK || other == MAP_NO_BLOCK ||
           (traffic_add_edge(traffic, own, other, bytes) &&
            traffic_add_edge(traffic, other, own, bytes));
}

int map_traffic_add(struct map_traffic *traffic, const struct plan_source *source,
                    const uint32_t *block, double rounds)
{
    bool fine = true;
    for (size_t i = 0; i < source->n_forks && fine; i++) {
        const struct plan_source_fork *fork = &source->fork[i];
        const struct plan_access *access = source->access + fork->first;
        if (fork->owner == PLAN_NONE || fork->replicated || fork->rank != PLAN_BY_OWNER)
            continue;
        for (uint32_t k = 0; k < fork->n && fine; k++)
            if (access[k].mode != DUITE_W)
                fine = map_traffic_read(traffic, block[fork->owner], block[access[k].object],
                                        rounds * (double)source->bytes[access[k].object]);
    }
    return fine ? DUITE_OK : base_no_memory("the blocks of objects");
}

/* By bytes last: so the sum of equal edges has the same bits on every rank. */
static int edge_compare(const void *a, const void *b)
{
    const struct map_edge *x = a, *y = b;
    if (x->from != y->from)
        return x->from < y->from ? -1 : 1;
    if (x->to != y->to)
        return x->to < y->to ? -1 : 1;
    return x->bytes < y->bytes ? -1 : x->bytes > y->bytes;
}

int map_traffic_end(struct map_traffic *traffic, size_t n_blocks)
{
    const struct base_array arrays[] = {BASE_ZEROS(traffic->start, n_blocks + 1),
                                        BASE_ARRAY(traffic->neighbour, traffic->n),
                                        BASE_ARRAY(traffic->bytes, traffic->n),
                                        {0}};
    traffic->memory = base_arrays(arrays);
    if (!traffic->memory)
        return base_no_memory("the blocks of objects");
    if (traffic->n)
        qsort(traffic->edge, traffic->n, sizeof *traffic->edge, edge_compare);
    size_t n = 0;
    for (size_t i = 0; i < traffic->n; i++) {
        const struct map_edge *edge = &traffic->edge[i];
        if (!i || edge->from != edge[-1].from || edge->to != edge[-1].to) {
            traffic->start[edge->from + 1]++;
            traffic->neighbour[n] = edge->to;
            traffic->bytes[n++] = 0;
        }
        traffic->bytes[n - 1] += edge->bytes;
    }
    for (size_t i = 0; i < n_blocks; i++)
        traffic->start[i + 1] += traffic->start[i];
    return DUITE_OK;
}

void map_traffic_free(struct map_traffic *traffic)
{
    free(traffic->edge);
    base_free(traffic->memory);
    *traffic = (struct map_traffic){0};
}

/* ---- Moves ---- */

int map_moves_new(const struct data_table *table, struct map_moves *moves)
{
    *moves = (struct map_moves){.n_ranks = table->n_ranks};
    int code = blocks_find(table, &moves->blocks);
    if (code)
        return code;
    const size_t n = moves->blocks.n + 1;
    const struct base_array arrays[] = {BASE_ZEROS(moves->seconds, n),
                                        BASE_ZEROS(moves->bytes, n),
                                        BASE_ZEROS(moves->fixed, n),
                                        BASE_ARRAY(moves->home, n),
                                        BASE_ZEROS(moves->workers, (size_t)table->n_ranks),
                                        {0}};
    moves->memory = base_arrays(arrays);
    if (!moves->memory)
        return base_no_memory("blocks that move");
    for (size_t i = 0; i < moves->blocks.n; i++) {
        moves->home[i] = moves->blocks.block[i].home;
        moves->fixed[i] = moves->blocks.block[i].fixed;
    }
    return DUITE_OK;
}

void map_moves_free(struct map_moves *moves)
{
    base_free(moves->blocks.block);
    base_free(moves->blocks.of);
    map_traffic_free(&moves->traffic);
    base_free(moves->memory);
}

bool map_moves_is_allowed(const struct map_moves *moves, size_t block)
{
    const int from = moves->blocks.block[block].home, to = moves->home[block];
    return to == from || (to >= 0 && to < moves->n_ranks && !moves->fixed[block]);
}

int map_moves_refused(const char *kind, const char *name)
{
    return base_error(DUITE_E_ARGUMENT,
                      "%s %s moves a block to a rank that does not exist, or moves a fixed block",
                      kind, name);
}

duite_blocks map_moves_shown(const struct map_moves *moves)
{
    return (duite_blocks){.graph = {.n = moves->blocks.n,
                                    .weight = moves->seconds,
                                    .start = moves->traffic.start,
                                    .neighbour = moves->traffic.neighbour,
                                    .edge_weight = moves->traffic.bytes},
                          .bytes = moves->bytes,
                          .fixed = moves->fixed,
                          .n_ranks = moves->n_ranks,
                          .workers = moves->workers,
                          .byte_seconds = moves->byte_seconds,
                          .mapping = moves->mapping->own,
                          .seed = moves->seed};
}

void map_moves_number(struct map_moves *moves, struct data_table *table)
{
    for (size_t i = 0; i < moves->blocks.n; i++)
        if (moves->home[i] != moves->blocks.block[i].home)
            moves->blocks.block[i].number = table->blocks[moves->home[i]]++;
}
