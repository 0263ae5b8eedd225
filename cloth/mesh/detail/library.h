#ifndef CLOTH_MESH_DETAIL_LIBRARY_H
#define CLOTH_MESH_DETAIL_LIBRARY_H

#include "cloth/base/memory.h"

/* The rest of a line `mtllib` of the file `path`: adds what it names to a list of char *, whose
 * items the caller frees. The line is one file, or each of its words is one. Those that are found
 * beside the file have absolute paths, others their names. Error: CLOTH_E_MEMORY. Local. */
int mesh_library_line(struct cloth_list *library, const char *path, const char *at,
                      struct cloth_error *error);

#endif
