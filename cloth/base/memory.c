/* No request wraps around: a product that does not fit into size_t fails like memory that is not
 * there. */
#include "cloth/base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static void *base_memory_out_of(size_t n, size_t size, struct cloth_error *error)
{
    cloth_fail(error, CLOTH_E_MEMORY, "out of memory: %zu items of %zu bytes cannot be had", n,
               size);
    return NULL;
}

void *cloth_alloc(size_t n, size_t size, struct cloth_error *error)
{
    if (size && n > SIZE_MAX / size)
        return base_memory_out_of(n, size, error);
    void *block = calloc(n ? n : 1, size ? size : 1);
    return block ? block : base_memory_out_of(n, size, error);
}

void *cloth_list_add(struct cloth_list *list, size_t size, size_t count, struct cloth_error *error)
{
    size_t max = SIZE_MAX / size;
    if (count > max - list->n)
        return base_memory_out_of(count, size, error);
    size_t needed = list->n + count;
    if (needed > list->capacity || !list->items) {
        size_t capacity = needed < 16 ? 16 : needed;
        if (list->capacity <= max / 2 && capacity < 2 * list->capacity)
            capacity = 2 * list->capacity;
        void *items = capacity <= max ? realloc(list->items, capacity * size) : NULL;
        if (!items)
            return base_memory_out_of(capacity, size, error);
        list->items = items;
        list->capacity = capacity;
    }
    list->n = needed;
    return (char *)list->items + (needed - count) * size;
}

int cloth_list_put(struct cloth_list *list, const void *item, size_t size,
                   struct cloth_error *error)
{
    void *to = cloth_list_add(list, size, 1, error);
    if (to)
        memcpy(to, item, size);
    return to ? CLOTH_OK : CLOTH_E_MEMORY;
}
