/* The code of a path: an index below 0x80 is one byte; a larger one is its bytes, highest first,
 * behind 0x80 plus their number. No byte of an index is a zero at its beginning, so that a path is
 * smaller than all that continue it. */
#include "runtime/data/failure.h"

#include <stdio.h>

static unsigned path_index_bytes(uint64_t index)
{
    unsigned n = 1;
    while (n < 8 && index >> (8 * n))
        n++;
    return n;
}

void data_path_add(struct data_failure *failure, uint64_t index)
{
    unsigned n = index < 0x80 ? 0 : path_index_bytes(index);
    uint32_t at = failure->path_length;
    if (at + 1 + n > sizeof failure->path) {
        failure->path_length = sizeof failure->path; /* nothing may follow what was left out */
        return;
    }
    failure->path[at++] = (uint8_t)(n ? 0x80 + n : index);
    for (unsigned i = n; i-- > 0;)
        failure->path[at++] = (uint8_t)(index >> (8 * i));
    failure->path_length = at;
}

void data_path_print(const struct data_failure *failure, char *text, size_t size)
{
    size_t used = (size_t)snprintf(text, size, "%llu", (unsigned long long)failure->number);
    const uint8_t *at = failure->path, *end = at + sizeof failure->path;
    while (at < end && *at && used + 24 < size) {
        unsigned n = *at >= 0x80 ? *at - 0x80u : 0;
        uint64_t index = n ? 0 : *at;
        for (at++; n && at < end; n--)
            index = index << 8 | *at++;
        used += (size_t)snprintf(text + used, size - used, ".%llu", (unsigned long long)index);
    }
    if (at < end && *at)
        snprintf(text + used, size - used, "...");
}
