#ifndef DUITE_BASE_HEAP_H
#define DUITE_BASE_HEAP_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* The binary heap, in an array of its owner: no entry comes before its parent, (i - 1) / 2. `size`:
 * of an entry. `before`: an order without equal entries. Callers pass both as constants, so that
 * each heap is compiled for its own entries. Not for several threads at a time. */

/* True if a comes before b. `context`: data for the order, or NULL. */
typedef bool base_before(const void *a, const void *b, const void *context);

/* Adds an entry to n others; the array has room for it and does not contain it. */
static inline __attribute__((always_inline)) void base_heap_push(void *array, size_t n,
                                                                 const void *entry, size_t size,
                                                                 base_before *before,
                                                                 const void *context)
{
    char *at = array;
    size_t i = n;
    for (; i && before(entry, at + (i - 1) / 2 * size, context); i = (i - 1) / 2)
        memcpy(at + i * size, at + (i - 1) / 2 * size, size);
    memcpy(at + i * size, entry, size);
}

/* Removes the first of n > 0 entries and copies it to *first. */
static inline __attribute__((always_inline)) void base_heap_pop(void *array, size_t n, void *first,
                                                                size_t size, base_before *before,
                                                                const void *context)
{
    char *at = array;
    const char *last = at + (n - 1) * size;
    size_t i = 0;
    memcpy(first, at, size);
    for (size_t child = 1; child < n - 1; child = 2 * i + 1) {
        if (child + 1 < n - 1 && before(at + (child + 1) * size, at + child * size, context))
            child++;
        if (before(last, at + child * size, context))
            break;
        memcpy(at + i * size, at + child * size, size);
        i = child;
    }
    if (i != n - 1)
        memcpy(at + i * size, last, size);
}

#endif
