#ifndef CLOTH_VIEW_OGAWA_H
#define CLOTH_VIEW_OGAWA_H

#include <stdint.h>
#include <stdio.h>

/* Ogawa, the container of Alembic's files: blocks of bytes, and groups of blocks and groups. A part
 * is written once, after all that it refers to, so only the head, which refers to the last group,
 * is gone back to. References are places in the file, with a mark on those of bytes. The form is
 * that of the Alembic project's library (lib/Alembic/Ogawa and AbcCoreOgawa, file version 0).
 * Failures are the file's: ferror. Local. */
struct ogawa {
    FILE *file;
    uint64_t end; /* bytes so far */
};

#define OGAWA_BYTES  (UINT64_C(1) << 63) /* of a reference: to bytes; alone: to none */
#define OGAWA_DIGEST 16                  /* bytes of a digest */

void ogawa_begin(struct ogawa *ogawa, FILE *file);
/* The bytes, n of them, or those of a sample with its digest before them. sum: the digest of
 * several samples, which takes this one in. Both return the reference. */
uint64_t ogawa_put_bytes(struct ogawa *ogawa, const void *bytes, size_t n);
uint64_t ogawa_put_sample(struct ogawa *ogawa, const void *bytes, size_t n,
                          unsigned char sum[OGAWA_DIGEST]);
uint64_t ogawa_put_group(struct ogawa *ogawa, const uint64_t *child, size_t n);
/* Makes a group the file's root, and the file whole. Returns what fseek does. */
int ogawa_end(struct ogawa *ogawa, uint64_t root);

#endif
