#ifndef CLOTH_MESH_DETAIL_NAMING_H
#define CLOTH_MESH_DETAIL_NAMING_H

#include "cloth/base/memory.h"
#include "cloth/mesh/mesh.h"

/* Lines that name what the faces after them are in, while a file is read: each opens its names and
 * closes those that were opened by a line of its kind. Zeroed at first. Local. */
enum mesh_naming_kind { MESH_GROUPS, MESH_OBJECTS, MESH_NAMINGS };
struct mesh_naming {
    struct cloth_list entry; /* a name with its faces, in the order of the file */
    size_t open[MESH_NAMINGS], end[MESH_NAMINGS]; /* entries open .. end - 1 are open */
};

/* A line of names, `at` the first of them, or none, after n faces. All words of an object are
 * one name. Error: CLOTH_E_MEMORY. */
int mesh_naming_line(struct mesh_naming *naming, enum mesh_naming_kind kind, const char *at,
                     uint32_t n_faces, struct cloth_error *error);

/* The names that have faces, in the order of the file, and their runs: of a mesh. */
struct mesh_names {
    uint32_t n, n_runs;
    char **name;
    struct mesh_group_run *run;
};
/* Those of all lines before, of n faces. After an error what is there belongs to the caller, too.
 * Error: CLOTH_E_MEMORY. */
int mesh_naming_end(struct mesh_naming *naming, uint32_t n_faces, struct mesh_names *names,
                    struct cloth_error *error);

void mesh_naming_free(struct mesh_naming *naming);

#endif
