#ifndef CLOTH_OUTPUT_FILES_PC2_H
#define CLOTH_OUTPUT_FILES_PC2_H

#include "cloth/output/files/files.h"

/* PC2 point caches: char[12] "POINTCACHE2\0", int32 version, int32 points, float start frame, float
 * sample rate, int32 frames, then float x y z a point and frame; little-endian. Local functions. */
enum { OUTPUT_PC2_HEADER = 32, OUTPUT_PC2_COUNT = 28, OUTPUT_PC2_MAGIC = 16 };
extern const unsigned char output_pc2_magic[OUTPUT_PC2_MAGIC]; /* begins each of them */
void output_pc2_header(unsigned char header[OUTPUT_PC2_HEADER], uint32_t n_points,
                       uint32_t n_frames);
/* Writes the header of a cache without frames; what: uint32_t, its points. */
int output_pc2_fill(FILE *file, const void *what);

/* ---- Writing: one that grows frame by frame ---- */

struct output_pc2 {
    struct output_file of;
    uint32_t n_points;
    unsigned char *bytes; /* room for a frame */
};
/* Names it; it is not open yet. In any case output_pc2_close follows. Error: CLOTH_E_MEMORY. */
int output_pc2_make(struct output_pc2 *cache, const char *folder, const char *name,
                    uint32_t n_points, struct cloth_error *error);
/* Opens one that has a header and no frames; or, n_frames not NULL, goes on behind so many frames
 * of an earlier run. The count of frames is changed before further floats are cut off, so that a
 * run which is killed here leaves whole frames, too. Errors: CLOTH_E_INPUT, it has less, or is of
 * another mesh, before anything changes; CLOTH_E_IO. */
int output_pc2_open(struct output_pc2 *cache, const uint64_t *n_frames, struct cloth_error *error);
/* Writes frame number k, and does not count it yet; x: `stride` doubles a point. *finite: how many
 * points come before the first one that is not finite as float; then nothing is written, and the
 * caller says so. Error: CLOTH_E_IO. */
int output_pc2_write(struct output_pc2 *cache, uint64_t frame, const double *x, size_t stride,
                     size_t *finite, struct cloth_error *error);
/* Counts n frames, when their floats are on the disk. Error: CLOTH_E_IO. */
int output_pc2_count(const struct output_pc2 *cache, uint64_t n, struct cloth_error *error);
/* Cuts off all that follows n frames; best effort. counted: more may be counted, so their count is
 * put back. */
void output_pc2_cut(const struct output_pc2 *cache, uint64_t n, bool counted);
int output_pc2_close(struct output_pc2 *cache, struct cloth_error *error);

/* ---- Reading ---- */

/* Reads a header: false if it is none of version 1 with sane counts. */
bool output_pc2_read_header(FILE *file, uint32_t *n_points, uint32_t *n_frames);
/* Reads frame k. NULL, or why not: "the file ends early", or a reason of errno. */
const char *output_pc2_read(FILE *file, uint32_t n_points, uint64_t frame, double *x);

#endif
