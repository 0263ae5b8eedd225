#ifndef CLOTH_VIEW_ABC_H
#define CLOTH_VIEW_ABC_H

#include "cloth/view/export.h"
#include "cloth/view/ogawa.h"

/* A file of Alembic while it is written: abc.c writes the samples, then abc_groups.c the groups
 * that refer to them. Private to both. */

enum { ABC_BOX = 6 }; /* numbers: the least x, y, z, the greatest ones */

/* A cloth, or all obstacles as one mesh. References are those of samples. */
struct abc_mesh {
    struct view_export_cloth part; /* its ranges of vertices and faces */
    bool is_cloth, moves, has_uv;
    uint32_t first_uv, n_uv;  /* uv of the part among those that follow one a vertex */
    uint64_t *points, *boxes; /* of each frame, or the first if it does not move */
    uint64_t counts, corners, uv, uv_numbers;
    unsigned char sum[OGAWA_DIGEST]; /* of all samples */
};

struct abc {
    struct view_export from;
    uint64_t first, last;
    struct ogawa out;
    uint32_t n_meshes;
    struct abc_mesh *mesh;
    unsigned char *bytes; /* room for a sample */
    size_t room;
    uint64_t *child; /* room for the largest group */
};

static inline uint32_t abc_frames(const struct abc *abc)
{
    return (uint32_t)(abc->last - abc->first + 1);
}

/* Writes all groups, and the file is whole; path: for errors, which are CLOTH_E_INPUT where it is a
 * pipe, CLOTH_E_IO, CLOTH_E_MEMORY. */
int abc_put_root(struct abc *abc, const char *path, struct cloth_error *error);

#endif
