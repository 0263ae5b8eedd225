/* Each vertex has the uv of its first corner. Corners that differ from it are sorted, so that equal
 * ones of a vertex share a number, however many there are. */
#include "cloth/base/order.h"
#include "cloth/mesh/detail/obj.h"

#include <stdlib.h>
#include <string.h>

/* A corner whose uv is not that of its vertex. */
struct other {
    uint32_t vertex, corner;
    double uv[2];
};

static int compare_uv(const struct other *a, const struct other *b)
{
    int order = cloth_compare_u32(a->vertex, b->vertex);
    for (int i = 0; i < 2 && !order; i++)
        order = (a->uv[i] > b->uv[i]) - (a->uv[i] < b->uv[i]);
    return order;
}

static int compare_others(const void *va, const void *vb)
{
    const struct other *a = va, *b = vb;
    const int order = compare_uv(a, b);
    return order ? order : cloth_compare_u32(a->corner, b->corner);
}

/* Counts the faces that have a corner without uv. */
static uint32_t count_without(const struct mesh *mesh, const uint32_t (*corner)[2])
{
    uint32_t without = 0;
    for (uint32_t f = 0; f < mesh->n_faces; f++) {
        uint32_t c = mesh->face_start[f];
        while (c < mesh->face_start[f + 1] && corner[c][1] != OBJ_NO_UV)
            c++;
        without += c < mesh->face_start[f + 1];
    }
    return without;
}

/* mesh->uv of the vertices; the others go to a list. */
static int take_first(struct mesh *mesh, const double (*uv)[2], const uint32_t (*corner)[2],
                      struct cloth_list *others, struct cloth_error *error)
{
    unsigned char *seen = cloth_alloc(mesh->n_vertices, 1, error);
    double(*to)[2] = cloth_alloc(mesh->n_vertices, sizeof *to, error);
    int code = seen && to ? CLOTH_OK : CLOTH_E_MEMORY;
    mesh->uv = (double *)to;
    for (uint32_t c = 0; !code && c < mesh->face_start[mesh->n_faces]; c++) {
        const uint32_t v = corner[c][0];
        const double *of = uv[corner[c][1]];
        if (!seen[v])
            memcpy(to[v], of, sizeof *to);
        seen[v] = 1;
        if (to[v][0] == of[0] && to[v][1] == of[1])
            continue;
        const struct other other = {v, c, {of[0], of[1]}};
        code = cloth_list_put(others, &other, sizeof other, error);
    }
    free(seen);
    return code;
}

/* The uv of the triangles' corners, from those of the faces'. */
static int number_triangles(struct mesh *mesh, struct cloth_error *error)
{
    uint32_t *number = cloth_alloc(mesh->n_vertices, sizeof *number, error);
    mesh->triangle_uv = cloth_alloc(3 * (size_t)mesh->n_triangles, sizeof *number, error);
    const bool made = number && mesh->triangle_uv;
    for (uint32_t f = 0; made && f < mesh->n_faces; f++) {
        const uint32_t first = mesh->face_start[f], end = mesh->face_start[f + 1];
        for (uint32_t c = first; c < end; c++)
            number[mesh->face_corner[c]] = mesh->face_uv[c];
        for (size_t i = 3 * (size_t)(first - 2 * f); i < 3 * (size_t)(end - 2 * (f + 1)); i++)
            mesh->triangle_uv[i] = number[mesh->triangle[i]];
    }
    free(number);
    return made ? CLOTH_OK : CLOTH_E_MEMORY;
}

static int obj_uv_add_others(struct mesh *mesh, struct other *other, size_t n,
                             struct cloth_error *error)
{
    const size_t n_vertices = mesh->n_vertices, n_corners = mesh->face_start[mesh->n_faces];
    double(*to)[2] = realloc(mesh->uv, (n_vertices + n) * sizeof *to);
    mesh->uv = to ? (double *)to : mesh->uv;
    mesh->face_uv = to ? cloth_alloc(n_corners, sizeof *mesh->face_uv, error) : NULL;
    if (!mesh->face_uv)
        return cloth_fail(error, CLOTH_E_MEMORY, "out of memory for the uv of %zu corners", n);
    memcpy(mesh->face_uv, mesh->face_corner, n_corners * sizeof *mesh->face_uv);
    qsort(other, n, sizeof *other, compare_others);
    for (size_t i = 0; i < n; i++) {
        if (!i || compare_uv(other + i - 1, other + i))
            memcpy(to[n_vertices + mesh->n_more_uv++], other[i].uv, sizeof *to);
        mesh->face_uv[other[i].corner] = (uint32_t)(n_vertices + mesh->n_more_uv - 1);
    }
    return number_triangles(mesh, error);
}

int obj_uv_put(struct mesh *mesh, const double (*uv)[2], const uint32_t (*corner)[2],
               struct cloth_error *error)
{
    struct cloth_list others = {0};
    const uint32_t without = count_without(mesh, corner);
    if (without) {
        mesh->n_without_uv = without < mesh->n_faces ? without : 0;
        return CLOTH_OK;
    }
    int code = take_first(mesh, uv, corner, &others, error);
    if (!code && others.n)
        code = obj_uv_add_others(mesh, others.items, others.n, error);
    free(others.items);
    return code;
}
