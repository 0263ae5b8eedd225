/* Weights go from each vertex to its neighbours in so many rounds that they are smooth over a few
 * centimetres, whatever the length of edges. */
#include "cloth/mannequin/detail/rig.h"
#include "cloth/base/memory.h"

#include <stdlib.h>
#include <string.h>

static const double WIDTH = 0.055; /* m */

/* Neighbours of vertices as pairs, in the order of triangles: each edge has both its directions. */
static void rig_add_neighbours(const struct mesh *mesh, const double (*from)[MANNEQUIN_BONES],
                               double (*to)[MANNEQUIN_BONES], double *count)
{
    for (size_t i = 0; i < 3 * (size_t)mesh->n_triangles; i++) {
        const uint32_t a = mesh->triangle[i], b = mesh->triangle[i - i % 3 + (i + 1) % 3];
        for (uint32_t k = 0; k < MANNEQUIN_BONES; k++)
            to[a][k] += from[b][k];
        count[a] += 1;
    }
}

static int rig_smooth(const struct mesh *mesh, double (*weight)[MANNEQUIN_BONES], uint32_t rounds,
                      struct cloth_error *error)
{
    double(*sum)[MANNEQUIN_BONES] = cloth_alloc(mesh->n_vertices, sizeof *sum, error);
    double *count = cloth_alloc(mesh->n_vertices, sizeof *count, error);
    for (uint32_t round = 0; sum && count && round < rounds; round++) {
        memset(sum, 0, mesh->n_vertices * sizeof *sum);
        memset(count, 0, mesh->n_vertices * sizeof *count);
        rig_add_neighbours(mesh, (const double(*)[MANNEQUIN_BONES])weight, sum, count);
        for (uint32_t v = 0; v < mesh->n_vertices; v++)
            for (uint32_t k = 0; k < MANNEQUIN_BONES; k++)
                weight[v][k] = sum[v][k] / count[v];
    }
    free(sum);
    free(count);
    return error->code;
}

int rig_make(struct mannequin_rig *rig, const struct mesh *mesh, const struct surface *half,
             const struct figure *figure, double edge, double low, const double scale[2],
             struct cloth_error *error)
{
    rig->weight = cloth_alloc(mesh->n_vertices, sizeof *rig->weight, error);
    if (!rig->weight)
        return error->code;
    for (uint32_t b = 1; b < FIGURE_BONES; b++) {
        double at[3];
        figure_joint(figure, b, at);
        for (uint32_t side = 0; side < 2; side++) {
            double *joint = rig->joint[rig_bones[side][b]];
            joint[0] = scale[1] * (side ? -at[0] : at[0]);
            joint[1] = scale[0] * (at[1] - low);
            joint[2] = scale[1] * at[2];
        }
    }
    uint32_t image = half->n;
    for (uint32_t v = 0; v < half->n; v++) {
        const enum figure_bone bone = figure_bone(figure, half->x[v]);
        rig->weight[v][rig_bones[0][bone]] = 1;
        if (!half->middle[v])
            rig->weight[image++][rig_bones[1][bone]] = 1;
    }
    return rig_smooth(mesh, rig->weight, (uint32_t)(WIDTH * WIDTH / (edge * edge)) + 1, error);
}
