/* All memory of the runtime comes from here, on cache-line boundaries, so that no two allocations
 * share a line. */
#include "runtime/base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#define PAGE ((size_t)2 << 20) /* a large one */

void *base_alloc(size_t size)
{
    const size_t step = size < PAGE ? BASE_LINE : PAGE;
    if (size > SIZE_MAX - PAGE)
        return NULL;
    const size_t steps = (size + step - 1) / step;
    void *memory = aligned_alloc(step, (steps ? steps : 1) * step);
    if (memory &&
        size >= PAGE) /* advice: without it the pages are small, as those of the end are */
        madvise(memory, size / PAGE * PAGE, MADV_HUGEPAGE);
    return memory;
}

void *base_alloc_zero(size_t size)
{
    void *memory = base_alloc(size);
    if (memory)
        memset(memory, 0, size);
    return memory;
}

void base_free(void *memory)
{
    free(memory);
}

void *base_grow(void *array, size_t *capacity, size_t needed, size_t element)
{
    if (needed <= *capacity)
        return array;
    size_t wanted = *capacity ? *capacity : 16;
    while (wanted < needed)
        wanted *= 2;
    void *moved = wanted <= SIZE_MAX / element ? realloc(array, wanted * element) : NULL;
    if (moved)
        *capacity = wanted;
    return moved;
}
