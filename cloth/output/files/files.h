#ifndef CLOTH_OUTPUT_FILES_FILES_H
#define CLOTH_OUTPUT_FILES_FILES_H

#include "cloth/output/output.h"

#include <stdbool.h>

/* What the folder's formats share: paths, errors with errno's reason, whole writes. Local
 * functions. */

/* folder "/" name suffix, allocated; NULL when memory ran out. */
char *output_path(const char *folder, const char *name, const char *suffix);

/* "cannot WHAT PATH: reason of errno", as CLOTH_E_IO. */
int output_fail(struct cloth_error *error, const char *what, const char *path);

/* The same before anything is written: CLOTH_E_INPUT unless the disk itself fails, since then the
 * path is one that cannot be used: not there, not allowed, something else in the way. */
int output_refuse(struct cloth_error *error, const char *what, const char *path);

/* Makes the folder and its parents. Errors: output_refuse. */
int output_make_folder(const char *folder, struct cloth_error *error);

/* Opens a file, as open does, to be closed when a program is executed. Where the process has no
 * descriptor left it waits for one, a second at most: a crowd that comes to a live view is sent
 * away meanwhile. */
int output_open_file(const char *path, int flags);

/* Writes all bytes at an offset, or fails with errno set (a short write counts as a full disk). */
int output_write_at(int file, const void *bytes, size_t n, uint64_t offset);

/* Whether the open file is still the one at the path: nobody reads what is written to a file that
 * another run, or the user, took away. Error: CLOTH_E_IO. */
int output_check_same(int file, const char *path, struct cloth_error *error);

/* Brings what was written to a file to the disk. 0, or -1 with errno set. Pipes and some file
 * systems cannot be asked, and need not be. */
int output_sync(int file);

/* Creates or empties a file, has `fill` write it, and brings it to the disk. A file that could not
 * be written whole is removed. `fill` returns 0, or nonzero with errno set. Errors: output_refuse
 * where it cannot be opened, else output_fail. */
int output_write_file(const char *path, int (*fill)(FILE *file, const void *what), const void *what,
                      struct cloth_error *error);

/* The same beside its final name, then renamed, so that the path never holds half a file. A path
 * that is no plain file, such as a pipe, is written to as it is; a link stays one. */
int output_replace_file(const char *path, int (*fill)(FILE *file, const void *what),
                        const void *what, struct cloth_error *error);

/* Brings the names in a folder to the disk, so that a rename survives a power cut; best effort. */
void output_sync_folder(const char *folder);

/* The start as a Wavefront OBJ; `what` is the struct output_setup. */
int output_fill_obj(FILE *file, const void *what);

/* The PC2 header: 32 bytes, little-endian whatever the machine. */
enum { OUTPUT_PC2_HEADER = 32, OUTPUT_PC2_COUNT = 28 };
void output_pc2_header(unsigned char header[OUTPUT_PC2_HEADER], uint32_t n_points,
                       uint32_t n_frames);
/* False if it is not a header of version 1 with sane counts. */
bool output_pc2_parse(const unsigned char header[OUTPUT_PC2_HEADER], uint32_t *n_points,
                      uint32_t *n_frames);
void output_put_u32(unsigned char bytes[4], uint32_t value);
uint32_t output_get_u32(const unsigned char bytes[4]);
void output_put_float(unsigned char bytes[4], float value);
float output_get_float(const unsigned char bytes[4]);

#endif
