#ifndef TESTS_MODEL_RUNTIME_H
#define TESTS_MODEL_RUNTIME_H

/* Included before all headers and source files of the runtime that a test explores: their atomic
 * operations, and what may block, go to the explorer. The runtime's memory is the explorer's too,
 * which forgets it with each execution. */
#include <mpi.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

#include "tests/model/atomics.h"

#define BASE_POOL_DIRECT 1
#include "runtime/base/memory.h"

void *base_alloc(size_t size)
{
    return explore_alloc(size);
}

void *base_alloc_zero(size_t size)
{
    return explore_alloc(size);
}

void base_free(void *memory)
{
    (void)memory;
}

void *base_grow_more(void *array, size_t *capacity, size_t needed, size_t element)
{
    void *larger = explore_alloc(2 * needed * element);
    if (array)
        memcpy(larger, array, *capacity * element);
    *capacity = 2 * needed;
    return larger;
}

void *base_grow_lines(void *array, size_t *capacity, size_t needed, size_t element)
{
    return base_grow(array, capacity, needed, element);
}

/* No model compiles a plan. */
void *base_arrays(const struct base_array *list)
{
    (void)list;
    return NULL;
}

/* Parts of the library that are linked as they are find no shelves. */
static struct base_shelf no_shelves[BASE_POOL_LARGEST / BASE_POOL_GRAIN + 1];
_Thread_local struct base_shelf *base_shelves = no_shelves;

void *base_pool_take_more(size_t size)
{
    return explore_alloc(size * BASE_POOL_GRAIN);
}

void base_pool_give_more(void *memory, size_t size)
{
    (void)memory;
    (void)size;
}

void base_pool_thread_end(void)
{
}

#endif
