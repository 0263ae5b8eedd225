/* A block is known by its home and its number there, which no other block ever had. */
#include "runtime/map/blocks.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#define HASH_NONFATAL_OOM          1
#define uthash_nonfatal_oom(entry) ((entry)->lost = true)
#include <uthash.h>

struct block_key {
    int home;
    uint32_t number;
};

/* A block in the table, which is there while blocks are found. */
struct block_entry {
    struct block_key key;
    bool lost; /* the table had no memory for it */
    UT_hash_handle hh;
};

/* `table`: of the n_blocks first entries, in the order of blocks. False without memory. */
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

int map_blocks_find(const struct data_table *table, struct map_blocks *blocks)
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

void map_blocks_free(struct map_blocks *blocks)
{
    base_free(blocks->block);
    base_free(blocks->of);
    *blocks = (struct map_blocks){0};
}

/* ---- Moves ---- */

int map_moves_new(const struct data_table *table, struct map_moves *moves)
{
    *moves = (struct map_moves){0};
    int code = map_blocks_find(table, &moves->blocks);
    if (code)
        return code;
    const size_t n = moves->blocks.n + 1;
    moves->seconds = base_alloc_zero(n * sizeof *moves->seconds);
    moves->bytes = base_alloc_zero(n * sizeof *moves->bytes);
    moves->fixed = base_alloc_zero(n);
    moves->home = base_alloc(n * sizeof *moves->home);
    moves->workers = base_alloc_zero((size_t)table->n_ranks * sizeof *moves->workers);
    if (!moves->seconds || !moves->bytes || !moves->fixed || !moves->home || !moves->workers)
        return base_no_memory("blocks that move");
    for (size_t i = 0; i < moves->blocks.n; i++) {
        moves->home[i] = moves->blocks.block[i].home;
        moves->fixed[i] = moves->blocks.block[i].fixed;
    }
    return DUITE_OK;
}

void map_moves_free(struct map_moves *moves)
{
    map_blocks_free(&moves->blocks);
    map_traffic_free(&moves->traffic);
    base_free(moves->seconds);
    base_free(moves->bytes);
    base_free(moves->fixed);
    base_free(moves->home);
    base_free(moves->workers);
}

bool map_moves_is_allowed(const struct map_moves *moves, size_t block, int n_ranks)
{
    const int from = moves->blocks.block[block].home, to = moves->home[block];
    return to == from || (to >= 0 && to < n_ranks && !moves->fixed[block]);
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
                          .workers = moves->workers};
}

void map_moves_number(struct map_moves *moves, struct data_table *table)
{
    for (size_t i = 0; i < moves->blocks.n; i++)
        if (moves->home[i] != moves->blocks.block[i].home)
            moves->blocks.block[i].number = table->blocks[moves->home[i]]++;
}
