/* A name is a slot of a table and its generation; free slots form a list. Generations begin with 1,
 * so that no name is 0. */
#include "runtime/offload/names.h"

#include "runtime/base/memory.h"

#include <stdlib.h>

uint64_t offload_name_give(struct offload_names *names, struct offload_pending *pending)
{
    uint32_t i = names->free - 1;
    if (!names->free) {
        i = names->n;
        struct offload_name *slot =
            base_grow(names->slot, &names->capacity, (size_t)i + 1, sizeof *slot);
        if (!slot)
            return 0;
        names->slot = slot;
        names->slot[i] = (struct offload_name){.generation = 1};
        names->n++;
    }
    struct offload_name *slot = &names->slot[i];
    names->free = slot->next;
    slot->pending = pending;
    return (uint64_t)slot->generation << 32 | i;
}

struct offload_pending *offload_name_take(struct offload_names *names, uint64_t name)
{
    uint32_t i = (uint32_t)name;
    struct offload_name *slot = i < names->n ? &names->slot[i] : NULL;
    if (!slot || !slot->pending || slot->generation != name >> 32) {
        names->refused++;
        return NULL;
    }
    struct offload_pending *pending = slot->pending;
    slot->pending = NULL;
    slot->generation += slot->generation == UINT32_MAX ? 2 : 1; /* never 0 */
    slot->next = names->free;
    names->free = i + 1;
    return pending;
}

void offload_names_free(struct offload_names *names)
{
    free(names->slot);
    *names = (struct offload_names){0};
}
