#ifndef CLOTH_MESH_DETAIL_NAMING_H
#define CLOTH_MESH_DETAIL_NAMING_H

#include "cloth/base/memory.h"
#include "cloth/mesh/mesh.h"

/* Groups of faces while a file is read: each line of names opens its groups and closes those that
 * were open. Zeroed at first. Local. */
struct mesh_naming {
    struct cloth_list entry; /* a name with its faces, in the order of the file */
    size_t open;             /* entries from there on are open */
};

/* A line of names, `at` the first of them, or none, after n faces. Error: CLOTH_E_MEMORY. */
int mesh_naming_line(struct mesh_naming *naming, const char *at, uint32_t n_faces,
                     struct cloth_error *error);

/* Adds the groups to a mesh that has its faces. Error: CLOTH_E_MEMORY. */
int mesh_naming_end(struct mesh_naming *naming, struct mesh *mesh, struct cloth_error *error);

void mesh_naming_free(struct mesh_naming *naming);

#endif
