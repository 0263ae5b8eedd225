#ifndef CLOTH_BASE_MEMORY_H
#define CLOTH_BASE_MEMORY_H

#include "cloth/base/error.h"

#include <stdbool.h>
#include <stddef.h>

/* Memory whose failure is an error with a message. Everything is freed with free(). Local. */

/* A zeroed array of n items; also for n = 0 a block that can be freed. NULL and CLOTH_E_MEMORY when
 * there is none. */
void *cloth_alloc(size_t n, size_t size, struct cloth_error *error);

/* A list that grows. It is zeroed at first; the owner of the list frees `items`. */
struct cloth_list {
    void *items;
    size_t n, capacity; /* items */
};

/* Makes room for `count` more items of `size` bytes at the end of the list, not initialised, and
 * adds them to n at once. The pointer is valid until the next call. The size is the same on every
 * call. NULL and CLOTH_E_MEMORY leave the list as it was. */
void *cloth_list_add(struct cloth_list *list, size_t size, size_t count, struct cloth_error *error);

/* Adds a copy of one item. Error: CLOTH_E_MEMORY. */
int cloth_list_put(struct cloth_list *list, const void *item, size_t size,
                   struct cloth_error *error);

/* Sorts the items. The second then keeps one of those that are equal. */
void cloth_list_sort(struct cloth_list *list, size_t size,
                     int (*compare)(const void *a, const void *b));
void cloth_list_sort_once(struct cloth_list *list, size_t size,
                          int (*compare)(const void *a, const void *b));

/* Arrays that are freed together. Zeroed at first. */
struct cloth_pool {
    struct cloth_list blocks; /* void *: those that free() wants */
    bool lacks;               /* one that was asked for */
};

/* The same as cloth_alloc, on cache lines of its own: it belongs to the pool. */
void *cloth_take(struct cloth_pool *pool, size_t n, size_t size, struct cloth_error *error);
void cloth_pool_free(struct cloth_pool *pool);

#endif
