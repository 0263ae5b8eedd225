#ifndef CLOTH_OUTPUT_FILES_FILES_H
#define CLOTH_OUTPUT_FILES_FILES_H

#include "cloth/base/error.h"

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Parts of the folder's formats that all share: paths, errors with errno's reason, whole files, and
 * files that grow. Local functions. */

/* ---- Paths ---- */

/* A path that is too long is cut to a length that the system refuses, and says so. */
struct output_path {
    char text[PATH_MAX + 1];
};
/* folder "/" name. */
struct output_path output_path(const char *folder, const char *name, ...)
    __attribute__((format(printf, 2, 3)));

/* The path that links lead to, even if nothing is there yet. 0, or -1 with errno set. */
int output_follow(const char *path, struct output_path *end);

/* Makes the folder and its parents. Errors: output_refuse. */
int output_make_folder(const char *folder, struct cloth_error *error);

/* Brings the names in a folder to the disk, so that a rename survives a power cut; best effort. */
void output_sync_folder(const char *folder);

/* ---- Errors ---- */

/* "cannot WHAT PATH: reason of errno", as CLOTH_E_IO. */
int output_fail(struct cloth_error *error, const char *what, const char *path);

/* The same before anything is written: CLOTH_E_INPUT unless the disk itself fails, since then the
 * path is one that cannot be used: not there, not allowed, something else in the way. */
int output_refuse(struct cloth_error *error, const char *what, const char *path);

/* How a sentence about a file that a resumed run cannot go on with ends. */
#define OUTPUT_CHANGED "the folder was changed since the checkpoint was written"

/* ---- Whole files ---- */

/* Opens a file, as open does, to be closed when a program is executed. Where the process has no
 * descriptor left it waits for one, a second at most: a crowd that comes to a live view is sent
 * away meanwhile. */
int output_open_file(const char *path, int flags);

/* All bytes of a plain file, followed by a '\0'; to be freed. NULL with errno set. */
unsigned char *output_read_file(const char *path, size_t *n);

/* Reads n bytes at an offset. False where there are fewer. */
bool output_read_at(int file, void *bytes, size_t n, uint64_t offset);

/* True if a file is there and begins with these bytes, as those of an earlier run do. */
bool output_begins(const char *path, const void *bytes, size_t n);

/* Removes a file of an earlier run, which begins with these bytes. Another one stays, and is an
 * error, CLOTH_E_INPUT: "PATH OTHER; give another folder, or move the file away"; other NULL: it is
 * none. Further errors: output_refuse. */
int output_remove_old(const char *path, const void *bytes, size_t n, const char *other,
                      struct cloth_error *error);

/* Writes all bytes at an offset, or fails with errno set (a short write counts as a full disk). */
int output_write_at(int file, const void *bytes, size_t n, uint64_t offset);

/* Brings what was written to a file to the disk. 0, or -1 with errno set. Pipes and some file
 * systems cannot be asked, and need not be. */
int output_sync(int file);

/* Writes a file's bytes. Returns 0, or nonzero with errno set or with an error of its own, which
 * `what` may lead to. */
typedef int output_fill(FILE *file, const void *what);

/* Creates or empties a file, has `fill` write it, and brings it to the disk. A file that could not
 * be written whole is removed. Errors: that of `fill`; output_refuse where it cannot be opened,
 * else output_fail. */
int output_write_file(const char *path, output_fill *fill, const void *what,
                      struct cloth_error *error);

/* The same beside its final name, then renamed, so that the path never holds half a file. A path
 * that is no plain file, such as a pipe, is written to as it is; a link stays one. */
int output_replace_file(const char *path, output_fill *fill, const void *what,
                        struct cloth_error *error);

/* ---- Files that grow by whole parts ---- */

struct output_file {
    struct output_path path;
    int file;      /* -1: it is not open */
    uint64_t size; /* bytes of whole parts */
};
/* One that is not open yet. */
struct output_file output_file(const char *folder, const char *name);

/* Opens it, as open does. Error: output_refuse, with this verb. */
int output_file_open(struct output_file *file, int flags, const char *verb,
                     struct cloth_error *error);

/* Goes on with the one of an earlier run, a table: it keeps its first lines, with the header. If it
 * has fewer it is refused, CLOTH_E_INPUT, before anything changes. Further errors: CLOTH_E_IO. */
int output_file_keep_lines(struct output_file *file, uint64_t n_lines, struct cloth_error *error);

/* Fails unless the open file is still the one at the path: another run, or the user, may have taken
 * it away, and its readers with it. Error: CLOTH_E_IO. */
int output_file_check(const struct output_file *file, struct cloth_error *error);

/* Cuts the file to so many bytes, which a resumed run keeps. Error: CLOTH_E_IO. */
int output_file_cut(const struct output_file *file, uint64_t size, struct cloth_error *error);

/* Appends a part to a file that is the one at its path; a part that fails is taken away again.
 * Error: CLOTH_E_IO, with this verb. */
int output_file_append(struct output_file *file, const void *bytes, size_t n, const char *verb,
                       struct cloth_error *error);

/* Closes it if it is open. Error: CLOTH_E_IO. */
int output_file_close(struct output_file *file, struct cloth_error *error);

#endif
