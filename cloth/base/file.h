#ifndef CLOTH_BASE_FILE_H
#define CLOTH_BASE_FILE_H

#include "cloth/base/error.h"

#include <stdio.h>

/* Opens a plain file to read it. NULL with errno set: it cannot be opened, or is a folder, or a
 * pipe, a device or the like, which could keep a reader waiting for ever. Local. */
FILE *cloth_file_open(const char *path);

/* Why, by errno, as the end of a sentence. Local. */
const char *cloth_file_why(void);

/* Reads the rest of a file into bytes that the caller frees in any case, a zero behind them; most:
 * bytes that it may have. No sentence. CLOTH_E_INPUT: it has more; CLOTH_E_MEMORY; CLOTH_E_IO, with
 * errno. Local. */
int cloth_file_read(FILE *file, size_t most, char **bytes, size_t *size);

#endif
