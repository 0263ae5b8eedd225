#ifndef TESTS_FUZZ_FIT_H
#define TESTS_FUZZ_FIT_H

#include <stdint.h>
#include <string.h>
#include <xxhash.h>

/* Gives the bytes of a checkpoint (cloth/output/checkpoint.c) the length and the hash that they
 * should have, so that a reader looks at what the hash keeps away. */
static inline void fit_checkpoint(uint8_t *bytes, uint64_t size)
{
    enum { SIZE_AT = 24, HEADER = 56 }; /* bytes */
    uint64_t digest;
    if (size < HEADER + sizeof digest)
        return;
    memcpy(bytes + SIZE_AT, &size, sizeof size);
    digest = XXH64(bytes, size - sizeof digest, 0);
    memcpy(bytes + size - sizeof digest, &digest, sizeof digest);
}

#endif
