#ifndef DUITE_CHECK_REGION_H
#define DUITE_CHECK_REGION_H

#include <duite.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bytes on pages of their own, with a guard on either side. The bytes end as near to the second
 * guard as their alignment (64) allows. The rest of the pages is filled with a known byte;
 * comparing it later shows writes there. Reads there show when another fill byte changes the
 * outcome. */
struct check_region {
    char *base; /* of the mapping: guard, pages, guard; NULL: none */
    size_t mapped;
    char *data;
    size_t bytes;
    unsigned char rest; /* the byte that fills the pages */
    /* The owner: the task, its kernel, the parameter (CHECK_ARGS: the arguments); or an object in a
     * turn of the main program (CHECK_TURN). */
    uint64_t number;
    const char *kernel;
    size_t param;
    duite_object object;
};

#define CHECK_ARGS SIZE_MAX
#define CHECK_TURN (SIZE_MAX - 1)

/* Maps the region, all of it filled with `rest`, readable and writable. False without memory. */
bool check_region_map(struct check_region *region, size_t bytes, unsigned char rest);

/* From now on it can be read only. */
bool check_region_protect(const struct check_region *region);

/* From now on any access faults. Its address space stays taken, so that a stale pointer cannot
 * meet new bytes. */
void check_region_forbid(const struct check_region *region);

/* Gives the address space back. */
void check_region_unmap(struct check_region *region);

/* True if every byte around the data still is the fill byte. */
bool check_region_whole(const struct check_region *region);

/* True if the address is in the region or in a guard of it. Safe in a signal handler. */
bool check_region_has(const struct check_region *region, const void *address);

#endif
