#ifndef CLOTH_OUTPUT_FILES_CUT_H
#define CLOTH_OUTPUT_FILES_CUT_H

#include "cloth/base/error.h"

#include <stdint.h>

/* A run goes on with the files of an earlier one: what lies beyond its checkpoint is cut off. A
 * file that has less is refused: CLOTH_E_INPUT, before anything changes. Files are open for reading
 * and writing; else errors are CLOTH_E_IO. Local functions. */

/* How a sentence about such a file ends. */
#define OUTPUT_CHANGED "the folder was changed since the checkpoint was written"

/* A PC2 cache of so many vertices keeps its first frames. The count of frames is changed before the
 * floats are cut off, so that a run which is killed here leaves whole frames, too. */
int output_cut_cache(int file, const char *path, uint32_t n_points, uint64_t n_frames,
                     struct cloth_error *error);

/* A table keeps its first lines, with the header. *size: bytes that are left. */
int output_cut_lines(int file, const char *path, uint64_t n_lines, uint64_t *size,
                     struct cloth_error *error);

/* Whether the first line of a table is this one. Error: CLOTH_E_INPUT if not. */
int output_cut_header(int file, const char *path, const char *header, struct cloth_error *error);

#endif
