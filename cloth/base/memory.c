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

void cloth_list_sort(struct cloth_list *list, size_t size,
                     int (*compare)(const void *a, const void *b))
{
    if (list->n) /* else there may be no items */
        qsort(list->items, list->n, size, compare);
}

void cloth_list_sort_once(struct cloth_list *list, size_t size,
                          int (*compare)(const void *a, const void *b))
{
    char *item = list->items;
    size_t n = 0;
    cloth_list_sort(list, size, compare);
    for (size_t i = 0; i < list->n; i++)
        if (!n || compare(item + (n - 1) * size, item + i * size))
            memmove(item + n++ * size, item + i * size, size);
    list->n = n;
}

void *cloth_take(struct cloth_pool *pool, size_t n, size_t size, struct cloth_error *error)
{
    enum { LINE = 64 }; /* bytes */
    const size_t more = n < SIZE_MAX / 2 ? LINE / size + 1 : 0;
    char *block = cloth_alloc(n + more, size, error);
    if (block && cloth_list_put(&pool->blocks, &block, sizeof block, error)) {
        free(block);
        block = NULL;
    }
    pool->lacks = pool->lacks || !block;
    return block ? block + (LINE - (uintptr_t)block % LINE) : NULL;
}

void cloth_pool_free(struct cloth_pool *pool)
{
    void **block = pool->blocks.items;
    for (size_t i = 0; i < pool->blocks.n; i++)
        free(block[i]);
    free(block);
    *pool = (struct cloth_pool){0};
}
