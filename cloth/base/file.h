#ifndef CLOTH_BASE_FILE_H
#define CLOTH_BASE_FILE_H

#include <stdio.h>

/* Opens a plain file to read it. NULL with errno set: it cannot be opened, or is a folder, or a
 * pipe, a device or the like, which could keep a reader waiting for ever. Local. */
FILE *cloth_file_open(const char *path);

/* Why, by errno, as the end of a sentence. Local. */
const char *cloth_file_why(void);

#endif
