/* mutate SEED FROM TO: copies a file with one to four changes, the same for the same seed: a
 * bit turned over, a number of four bytes replaced by an extreme one, a piece left out, doubled or
 * moved, or the end cut off. */
#include "tests/support/random.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX = 1 << 24 }; /* bytes of a file */

static size_t below(size_t n)
{
    return n ? (size_t)uniform(0, (double)n) % n : 0;
}

static size_t change(uint8_t *bytes, size_t n)
{
    static const uint32_t extreme[] = {0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0x7fc00000};
    const size_t at = below(n), most = n - at < 64 ? n - at : 64, piece = below(most + 1);
    switch (below(n > 4 ? 6 : 1)) {
    case 0:
        if (n)
            bytes[at] ^= (uint8_t)(1 << below(8));
        return n;
    case 1:
        memcpy(bytes + below(n - 3), extreme + below(6), 4);
        return n;
    case 2:
        memmove(bytes + at, bytes + at + piece, n - at - piece);
        return n - piece;
    case 3:
        memmove(bytes + at + piece, bytes + at, n - at);
        return n + piece;
    case 4:
        memmove(bytes + below(n - piece), bytes + at, piece);
        return n;
    default:
        return below(4) ? n : at;
    }
}

int main(int argc, char **argv)
{
    uint8_t *bytes = malloc(MAX + 512);
    FILE *from = argc > 3 ? fopen(argv[2], "rb") : NULL;
    FILE *to = from && bytes ? fopen(argv[3], "wb") : NULL;
    if (!to) {
        fprintf(stderr, "usage: mutate SEED FROM TO, both of them files\n");
        return 99;
    }
    size_t n = fread(bytes, 1, MAX, from);
    random_seed = strtoull(argv[1], NULL, 10) * 2654435761u + 1;
    uniform(0, 1);
    for (size_t i = 1 + below(4); i > 0; i--)
        n = change(bytes, n);
    const int bad = ferror(from) || fwrite(bytes, 1, n, to) != n;
    free(bytes);
    return fclose(from) || fclose(to) || bad ? 99 : 0;
}
