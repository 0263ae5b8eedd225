/* Groups are runs of faces: a name may have several, and a face may be in several groups. */
#include "cloth/base/memory.h"
#include "cloth/mesh/mesh.h"

#include <stdlib.h>
#include <string.h>

uint32_t mesh_group_of(const struct mesh *mesh, const char *name)
{
    for (uint32_t g = 0; g < mesh->n_groups; g++)
        if (!strcmp(mesh->group[g], name))
            return g;
    return UINT32_MAX;
}

int mesh_group_add(struct mesh *mesh, const char *name, uint32_t first, uint32_t n,
                   struct cloth_error *error)
{
    const size_t size = strlen(name) + 1;
    char **group = realloc(mesh->group, ((size_t)mesh->n_groups + 1) * sizeof *group);
    mesh->group = group ? group : mesh->group;
    struct mesh_group_run *run =
        realloc(mesh->group_run, ((size_t)mesh->n_group_runs + 1) * sizeof *run);
    mesh->group_run = run ? run : mesh->group_run;
    char *copy = group && run ? cloth_alloc(size, 1, error) : NULL;
    if (!copy)
        return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for the groups of a mesh");
    memcpy(copy, name, size);
    uint32_t r = mesh->n_group_runs++;
    for (; r > 0 && run[r - 1].first > first; r--)
        run[r] = run[r - 1];
    run[r] = (struct mesh_group_run){mesh->n_groups, first, n};
    group[mesh->n_groups++] = copy;
    return CLOTH_OK;
}

void mesh_group_vertices(const struct mesh *mesh, uint32_t group, unsigned char *mark)
{
    for (uint32_t r = 0; r < mesh->n_group_runs; r++) {
        const struct mesh_group_run *run = mesh->group_run + r;
        if (run->group != group)
            continue;
        for (uint32_t c = mesh->face_start[run->first]; c < mesh->face_start[run->first + run->n];
             c++)
            mark[mesh->face_corner[c]] = 1;
    }
}

/* A polygon of k corners has k - 2 triangles, which stand in the order of the faces. */
void mesh_group_triangles(const struct mesh *mesh, uint32_t group, unsigned char *mark)
{
    for (uint32_t r = 0; r < mesh->n_group_runs; r++) {
        const struct mesh_group_run *run = mesh->group_run + r;
        const uint32_t end = run->first + run->n;
        if (run->group == group)
            for (uint32_t t = mesh->face_start[run->first] - 2 * run->first;
                 t < mesh->face_start[end] - 2 * end; t++)
                mark[t] = 1;
    }
}
