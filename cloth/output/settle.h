#ifndef CLOTH_OUTPUT_SETTLE_H
#define CLOTH_OUTPUT_SETTLE_H

#include "cloth/base/error.h"

#include <stdbool.h>
#include <stdint.h>

/* A thread that brings frames to the disk, so that no worker of a run waits for it. Workers write
 * the frames, or copy them; the thread syncs and counts them, and makes those of HDF5. Checkpoints
 * have their turn, too. On rank 0 alone; local functions. */
struct output_settler;

/* Before the runtime binds its threads to cores. Errors: CLOTH_E_MEMORY; CLOTH_E_LIBRARY, no
 * thread. */
int output_settler_open(struct output_settler **settler, struct cloth_error *error);

/* Waits until all frames so far are counted, on the disk. From any thread. NULL: there is nothing
 * to wait for. Errors: of the first frame that could not be; nothing is counted after it. */
int output_settler_wait(struct output_settler *settler, struct cloth_error *error);

/* Waits alike, before its members are closed; *settler becomes NULL. */
int output_settler_close(struct output_settler **settler, struct cloth_error *error);

/* --- For writers --- */

/* A file, or files that belong together. Its frames are settled after those of members that were
 * added before. */
struct output_member {
    /* Brings the first n frames to the disk, which were written, and counts them; from the thread,
     * or the caller of output_member_wrote where there is no thread. */
    int (*settle)(void *context, uint32_t n, struct cloth_error *error);
    void *context;
    struct output_settler *settler; /* NULL: there is no thread */
    uint32_t place;                 /* among the members */
};
enum { OUTPUT_MEMBERS = 4 };

/* Adds it, whose first n frames are settled. settler may be NULL. */
void output_member_add(struct output_member *member, struct output_settler *settler, uint32_t n);
/* Waits until its first n frames are settled. False: they are not, and will not be, since the
 * settler failed. */
bool output_member_wait(const struct output_member *member, uint32_t n);
/* Its first n frames are written. Waits while the disk is some frames behind. Errors: of a frame
 * that could not be settled, of any member, this one or one before it. */
int output_member_wrote(const struct output_member *member, uint32_t n, struct cloth_error *error);

#endif
