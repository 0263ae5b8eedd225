/* Parts are appended, each with the number of its bytes or children before them. */
#include "cloth/view/ogawa.h"

#include "cloth/base/bytes.h"

#include <string.h>
#include <xxhash.h>

enum { OGAWA_HEAD = 16, OGAWA_WHOLE = 5, OGAWA_ROOT = 8 }; /* bytes, and where two of them are */

static void ogawa_put(struct ogawa *ogawa, const void *bytes, size_t n)
{
    fwrite(bytes, 1, n, ogawa->file);
    ogawa->end += n;
}

static void ogawa_put_u64(struct ogawa *ogawa, uint64_t value)
{
    unsigned char bytes[8];
    cloth_put_u64(bytes, value);
    ogawa_put(ogawa, bytes, sizeof bytes);
}

void ogawa_begin(struct ogawa *ogawa, FILE *file)
{
    static const unsigned char head[OGAWA_HEAD] = {'O', 'g', 'a', 'w', 'a', 0, 0, 1};
    *ogawa = (struct ogawa){.file = file};
    ogawa_put(ogawa, head, sizeof head);
}

uint64_t ogawa_put_bytes(struct ogawa *ogawa, const void *bytes, size_t n)
{
    const uint64_t place = ogawa->end;
    if (n == 0)
        return OGAWA_BYTES;
    ogawa_put_u64(ogawa, n);
    ogawa_put(ogawa, bytes, n);
    return place | OGAWA_BYTES;
}

/* Readers compare digests and never compute them: any good hash will do. */
static void ogawa_digest(unsigned char digest[OGAWA_DIGEST], const void *bytes, size_t n)
{
    cloth_put_u64(digest, XXH64(bytes, n, 0));
    cloth_put_u64(digest + 8, XXH64(bytes, n, 1));
}

uint64_t ogawa_put_sample(struct ogawa *ogawa, const void *bytes, size_t n,
                          unsigned char sum[OGAWA_DIGEST])
{
    const uint64_t place = ogawa->end;
    unsigned char both[2 * OGAWA_DIGEST];
    memcpy(both, sum, OGAWA_DIGEST);
    ogawa_digest(both + OGAWA_DIGEST, bytes, n);
    ogawa_digest(sum, both, sizeof both);
    ogawa_put_u64(ogawa, OGAWA_DIGEST + n);
    ogawa_put(ogawa, both + OGAWA_DIGEST, OGAWA_DIGEST);
    ogawa_put(ogawa, bytes, n);
    return place | OGAWA_BYTES;
}

uint64_t ogawa_put_group(struct ogawa *ogawa, const uint64_t *child, size_t n)
{
    const uint64_t place = ogawa->end;
    if (n == 0)
        return 0;
    ogawa_put_u64(ogawa, n);
    for (size_t i = 0; i < n; i++)
        ogawa_put_u64(ogawa, child[i]);
    return place;
}

int ogawa_end(struct ogawa *ogawa, uint64_t root)
{
    if (fseek(ogawa->file, OGAWA_ROOT, SEEK_SET))
        return -1;
    ogawa_put_u64(ogawa, root);
    if (fseek(ogawa->file, OGAWA_WHOLE, SEEK_SET))
        return -1;
    fputc(0xff, ogawa->file);
    return 0;
}
