/* A block is known by its home and its number there, which no other one ever has had. */
#include "runtime/map/blocks.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <string.h>

/* Open addressing; a place holds an index in `block`, plus 1. */
struct index {
    uint32_t *place;
    size_t mask;
};

static uint32_t *look_up(const struct index *index, const struct map_block *block,
                         const struct data_object *object)
{
    uint64_t key = (uint64_t)(uint32_t)object->home << 32 | object->block;
    size_t at = (size_t)(key * 0x9e3779b97f4a7c15u >> 20) & index->mask;
    for (;; at = (at + 1) & index->mask) {
        uint32_t found = index->place[at];
        if (!found ||
            (block[found - 1].home == object->home && block[found - 1].number == object->block))
            return &index->place[at];
    }
}

static void add(struct map_blocks *blocks, const struct index *index,
                const struct data_object *object, uint32_t slot)
{
    uint32_t *place = look_up(index, blocks->block, object);
    if (!*place) {
        blocks->block[blocks->n] =
            (struct map_block){.home = object->home, .number = object->block};
        *place = (uint32_t)++blocks->n;
    }
    struct map_block *block = &blocks->block[*place - 1];
    block->objects++;
    block->bytes += object->room;
    block->fixed |= object->stays;
    blocks->of[slot] = *place - 1;
}

int map_blocks_find(const struct data_table *table, struct map_blocks *blocks)
{
    struct index index = {.mask = 15};
    while (index.mask < 2 * (size_t)table->n_alive)
        index.mask = 2 * index.mask + 1;
    index.place = base_alloc_zero((index.mask + 1) * sizeof *index.place);
    *blocks = (struct map_blocks){.block = base_alloc((table->n_alive + 1) * sizeof *blocks->block),
                                  .of = base_alloc(table->n_slots * sizeof *blocks->of)};
    bool fine = index.place && blocks->block && blocks->of;
    for (uint32_t slot = 0; slot < table->n_slots && fine; slot++) {
        blocks->of[slot] = MAP_NO_BLOCK;
        if (table->object[slot].generation % 2)
            add(blocks, &index, &table->object[slot], slot);
    }
    base_free(index.place);
    return fine ? DUITE_OK : base_no_memory("the blocks of objects");
}

void map_blocks_free(struct map_blocks *blocks)
{
    base_free(blocks->block);
    base_free(blocks->of);
    *blocks = (struct map_blocks){0};
}
