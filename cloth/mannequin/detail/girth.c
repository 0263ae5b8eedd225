/* A girth is a loop of the half's section. */
#include "cloth/base/memory.h"
#include "cloth/base/sets.h"
#include "cloth/mannequin/detail/surface.h"
#include "cloth/mannequin/detail/vector.h"
#include "cloth/mesh/slice.h"

#include <stdlib.h>

/* By set: its length, and the sum of its places weighted by length. */
static void sum_loops(const struct slice *slice, double (*sum)[4])
{
    for (uint32_t s = 0; s < slice->n; s++) {
        const struct slice_segment *segment = slice->segment + s;
        double *to = sum[cloth_sets_root(slice->set, s)];
        for (int c = 0; c < 3; c++)
            to[c] += 0.5 * segment->length * (segment->end[0].place[c] + segment->end[1].place[c]);
        to[3] += segment->length;
    }
}

/* The length of the loop whose middle is nearest to a point; one that is open goes on in the mirror
 * image. */
static double nearest_loop(const struct slice *slice, const double (*sums)[4],
                           const double point[3], bool half)
{
    double best = INFINITY, length = 0;
    for (uint32_t s = 0; s < slice->n; s++) {
        const double *sum = sums[s];
        if (!(sum[3] > 0))
            continue;
        const double middle[3] = {half ? 0 : sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]};
        const double far = vector_distance(middle, point) + (half ? sum[0] / sum[3] : 0);
        if (far < best) {
            best = far;
            length = half ? 2 * sum[3] : sum[3];
        }
    }
    return length;
}

int surface_girth(const struct surface *surface, const struct figure *figure, uint32_t measured,
                  double *girth, struct cloth_error *error)
{
    double point[3], normal[3], (*sum)[4] = NULL;
    double *height = cloth_alloc(surface->n, sizeof *height, error);
    const struct slice_mesh mesh = {surface->m, (const uint32_t(*)[3])surface->triangle,
                                    (const double(*)[3])surface->x, height};
    struct slice slice = {0};
    figure_section(figure, measured, point, normal);
    const double level = vector_dot(point, normal);
    for (uint32_t v = 0; v < surface->n && height; v++)
        height[v] = vector_dot(surface->x[v], normal) - level;
    if (height && !slice_make(&slice, &mesh, error))
        sum = cloth_alloc(slice.n, sizeof *sum, error);
    if (sum) {
        sum_loops(&slice, sum);
        *girth = nearest_loop(&slice, (const double(*)[4])sum, point, measured < MANNEQUIN_THIGH);
    }
    free(sum);
    free(height);
    slice_free(&slice);
    return error->code;
}
