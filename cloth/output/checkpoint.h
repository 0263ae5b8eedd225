#ifndef CLOTH_OUTPUT_CHECKPOINT_H
#define CLOTH_OUTPUT_CHECKPOINT_H

#include "cloth/base/error.h"

#include <stddef.h>

/* Checkpoints in a folder of frames: DIR/checkpoints/000001.checkpoint and so on, the last
 * OUTPUT_CHECKPOINTS_KEPT of them. A file holds opaque parts. It is written beside its name,
 * brought to the disk and renamed; only then the oldest one is removed, or renamed to be written
 * over by the next. So the folder never holds less than it did. Local functions, on rank 0; a
 * struct output_checkpoints may be used by another thread than the one that opened it.
 *
 * A file: the numbers of struct header (checkpoint.c), the parts, each up to a multiple of 8 bytes,
 * and the XXH64 of all that. Numbers are as the machine has them. */
enum { OUTPUT_CHECKPOINT_PARTS = 3, OUTPUT_CHECKPOINTS_KEPT = 3 };
struct output_part {
    const void *bytes;
    size_t n;
};

struct output_checkpoints;

/* Opens the folder, which is made; half a file of a run that was killed is removed. Errors:
 * CLOTH_E_INPUT where it cannot be written to, CLOTH_E_IO, CLOTH_E_MEMORY. */
int output_checkpoints_open(struct output_checkpoints **checkpoints, const char *folder,
                            struct cloth_error *error);

/* Writes the next one. One that fails leaves those before it. Errors: CLOTH_E_IO, CLOTH_E_MEMORY.
 */
int output_checkpoints_write(struct output_checkpoints *checkpoints,
                             const struct output_part part[OUTPUT_CHECKPOINT_PARTS],
                             struct cloth_error *error);
/* The path of the last one that was written. */
const char *output_checkpoints_last(const struct output_checkpoints *checkpoints);
/* *checkpoints becomes NULL. */
void output_checkpoints_close(struct output_checkpoints **checkpoints);

/* Removes those of an earlier run from a folder of frames. Error: CLOTH_E_INPUT, CLOTH_E_IO. */
int output_checkpoints_forget(const char *folder, struct cloth_error *error);

/* A checkpoint that was read: parts begin at multiples of 8 bytes. */
struct output_checkpoint {
    char *path;
    unsigned char *bytes;
    struct output_part part[OUTPUT_CHECKPOINT_PARTS];
};

/* Reads a file. Errors: CLOTH_E_IO, it is damaged, no checkpoint, or cannot be read; CLOTH_E_INPUT,
 * it is one of another version; CLOTH_E_MEMORY. */
int output_checkpoint_read(struct output_checkpoint *checkpoint, const char *path,
                           struct cloth_error *error);
/* Reads the newest whole checkpoint of a folder of frames; note: the faults of newer ones. Errors:
 * CLOTH_E_INPUT, there is none; as above. */
int output_checkpoint_newest(struct output_checkpoint *checkpoint, const char *folder,
                             struct cloth_error *note, struct cloth_error *error);
void output_checkpoint_free(struct output_checkpoint *checkpoint);

#endif
