/* A mapping is a guard, whole pages, and a guard; the data ends on the last line of the pages that
 * has room for it. */
#include "runtime/check/region.h"

#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { GUARD = 1 << 18 }; /* bytes, a multiple of every page size; they take address space only */

static size_t page_bytes(void)
{
    return (size_t)sysconf(_SC_PAGESIZE);
}

bool check_region_map(struct check_region *region, size_t bytes, unsigned char rest)
{
    size_t pages = (bytes + page_bytes() - 1) / page_bytes() * page_bytes();
    region->mapped = pages + 2 * (size_t)GUARD;
    region->base = mmap(NULL, region->mapped, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (region->base == MAP_FAILED) {
        region->base = NULL;
        return false;
    }
    region->bytes = bytes;
    region->rest = rest;
    region->data = region->base + GUARD + (pages - bytes) / 64 * 64;
    if (pages && mprotect(region->base + GUARD, pages, PROT_READ | PROT_WRITE))
        return false;
    memset(region->base + GUARD, rest, pages);
    return true;
}

static size_t region_inner(const struct check_region *region)
{
    return region->mapped - 2 * (size_t)GUARD;
}

bool check_region_protect(const struct check_region *region)
{
    return !region_inner(region) ||
           !mprotect(region->base + GUARD, region_inner(region), PROT_READ);
}

void check_region_forbid(const struct check_region *region)
{
    if (!region_inner(region))
        return;
    madvise(region->base + GUARD, region_inner(region), MADV_DONTNEED);
    mprotect(region->base + GUARD, region_inner(region), PROT_NONE);
}

void check_region_unmap(struct check_region *region)
{
    if (region->base)
        munmap(region->base, region->mapped);
    region->base = NULL;
}

bool check_region_whole(const struct check_region *region)
{
    const char *end = region->base + GUARD + region_inner(region);
    for (const char *at = region->base + GUARD; at < region->data; at++)
        if ((unsigned char)*at != region->rest)
            return false;
    for (const char *at = region->data + region->bytes; at < end; at++)
        if ((unsigned char)*at != region->rest)
            return false;
    return true;
}

bool check_region_has(const struct check_region *region, const void *address)
{
    const char *at = address;
    return region->base && at >= region->base && at < region->base + region->mapped;
}
