/* Functions of every mesh, whatever its source. Sums run in triangle order, so they are the same
 * everywhere. */
#include "cloth/mesh/mesh.h"
#include "cloth/base/axes.h"
#include "cloth/base/memory.h"
#include "cloth/base/vector.h"

#include <stdlib.h>
#include <string.h>

const struct mesh_transform mesh_identity = {{1, 1, 1}, {1, 0, 0, 0}, {0, 0, 0}};

void mesh_apply(struct mesh *mesh, const struct mesh_transform *transform)
{
    const double *q = transform->rotate, *shift = transform->translate;
    double matrix[3][3];
    const bool turns = (q[1] != 0 || q[2] != 0 || q[3] != 0) && cloth_rotation(q, matrix);
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        double *x = mesh->position + 3 * v, scaled[3];
        for (size_t i = 0; i < 3; i++)
            scaled[i] = x[i] * transform->scale[i];
        for (size_t i = 0; i < 3; i++) {
            x[i] = turns ? cloth_dot(matrix[i], scaled) : scaled[i];
            if (shift[i] != 0) /* -0 + 0 would lose its sign */
                x[i] += shift[i];
        }
    }
}

void mesh_used(const struct mesh *mesh, unsigned char *used)
{
    memset(used, 0, mesh->n_vertices);
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        uint32_t corner[3];
        mesh_corners(mesh, t, corner);
        for (size_t i = 0; i < 3; i++)
            used[corner[i]] = 1;
    }
    for (size_t i = 0; i < 2 * (size_t)mesh->n_lone_edges; i++)
        used[mesh->lone_edge[i]] = 1;
}

void mesh_share_of(const struct mesh *mesh, uint32_t triangle, double density, bool by_cell,
                   struct mesh_share *share)
{
    const uint32_t fourth = by_cell ? mesh_fourth(mesh, triangle) : UINT32_MAX;
    mesh_corners(mesh, triangle, share->vertex);
    share->n = fourth == UINT32_MAX ? 3 : 4;
    share->vertex[3] = fourth;
    share->mass = mesh_triangle_area(mesh, triangle) * density / share->n;
}

void mesh_add_mass(const struct mesh *mesh, double density, bool by_cell, double *mass)
{
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        struct mesh_share share;
        mesh_share_of(mesh, t, density, by_cell, &share);
        for (uint32_t i = 0; i < share.n; i++)
            mass[share.vertex[i]] += share.mass;
    }
}

double mesh_box(const struct mesh *mesh, double low[3], double high[3])
{
    double longest = 0;
    for (size_t i = 0; i < 3; i++) {
        low[i] = INFINITY;
        high[i] = -INFINITY;
        for (size_t v = 0; v < mesh->n_vertices; v++) {
            low[i] = fmin(low[i], mesh->position[3 * v + i]);
            high[i] = fmax(high[i], mesh->position[3 * v + i]);
        }
        longest = fmax(longest, high[i] - low[i]);
    }
    return longest;
}

/* ---- Principal axes: those of the second moments ---- */

/* Second moments about the mean of all vertices. */
static void moments(const struct mesh *mesh, double m[3][3])
{
    double mean[3] = {0};
    memset(m, 0, 9 * sizeof(double));
    for (size_t v = 0; v < mesh->n_vertices; v++)
        for (size_t i = 0; i < 3; i++)
            mean[i] += mesh->position[3 * v + i] / mesh->n_vertices;
    for (size_t v = 0; v < mesh->n_vertices; v++)
        for (size_t i = 0; i < 3; i++)
            for (size_t j = 0; j < 3; j++)
                m[i][j] +=
                    (mesh->position[3 * v + i] - mean[i]) * (mesh->position[3 * v + j] - mean[j]);
}

/* Copies an axis, its largest component above 0. */
static void take_axis(const double axis[3], double to[3])
{
    int largest = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(axis[i]) > fabs(axis[largest]) * (1 + 1e-9))
            largest = i;
    for (int i = 0; i < 3; i++)
        to[i] = axis[largest] < 0 ? -axis[i] : axis[i];
}

void mesh_axes(const struct mesh *mesh, double u[3], double v[3])
{
    double m[3][3], axis[3][3];
    moments(mesh, m);
    cloth_axes(1e-15 * (m[0][0] + m[1][1] + m[2][2]), m, axis); /* less is rounding */
    int least = 2; /* of equals the last; the two others keep their order unless the later is longer
                    */
    for (int k = 1; k >= 0; k--)
        if (m[k][k] < m[least][least] * (1 - 1e-9))
            least = k;
    const int first = least == 0 ? 1 : 0, second = least == 2 ? 1 : 2;
    const bool later = m[second][second] > m[first][first] * (1 + 1e-9);
    take_axis(axis[later ? second : first], u);
    take_axis(axis[later ? first : second], v);
}

/* ---- Groups: runs of faces. A name may have several, and a face may be in several groups ---- */

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
    const uint32_t *start = mesh->face_start;
    for (uint32_t r = 0; r < mesh->n_group_runs; r++) {
        const struct mesh_group_run *run = mesh->group_run + r;
        for (uint32_t c = start[run->first]; run->group == group && c < start[run->first + run->n];
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
        const uint32_t from = mesh->face_start[run->first] - 2 * run->first;
        if (run->group == group)
            memset(mark + from, 1, mesh->face_start[end] - 2 * end - from);
    }
}

/* ---- The end ---- */

static void free_names(char **name, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++)
        free(name[i]);
    free(name);
}

void mesh_free(struct mesh *mesh)
{
    free(mesh->position);
    free(mesh->uv);
    free(mesh->face_start);
    free(mesh->face_corner);
    free(mesh->face_uv);
    free(mesh->triangle);
    free(mesh->triangle_uv);
    free(mesh->lone_edge);
    free_names(mesh->group, mesh->n_groups);
    free_names(mesh->material, mesh->n_materials);
    free_names(mesh->library, mesh->n_libraries);
    free(mesh->group_run);
    free(mesh->material_run);
    *mesh = (struct mesh){0};
}
