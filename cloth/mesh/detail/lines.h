#ifndef CLOTH_MESH_DETAIL_LINES_H
#define CLOTH_MESH_DETAIL_LINES_H

#include "cloth/base/memory.h"

#include <stdio.h>

/* Reads a text file line by line, of any length, with LF or CR LF, the last one with or without. A
 * line that ends with
 * `\` goes on in the next one, unless it is a comment (#). Zeroed at first. Local. */
struct mesh_lines {
    const char *path;
    FILE *file;
    char *chunk; /* read and not yet taken: chunk[at .. end-1] */
    size_t at, end;
    struct cloth_list text; /* the line */
    size_t line, next; /* the number of its first line in the file, from 1; of the last one taken */
};

/* Errors: CLOTH_E_IO, CLOTH_E_MEMORY. */
int mesh_lines_open(struct mesh_lines *lines, const char *path, struct cloth_error *error);

/* *text: the next line, ended by a zero, without its line end; may be written to, valid until the
 * next call; NULL after the last one. Errors: CLOTH_E_INPUT for a zero byte (not a text file),
 * CLOTH_E_IO, CLOTH_E_MEMORY. */
int mesh_lines_next(struct mesh_lines *lines, char **text, struct cloth_error *error);

void mesh_lines_close(struct mesh_lines *lines);

#endif
