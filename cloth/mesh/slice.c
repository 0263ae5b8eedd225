/* Segments are joined where they end on the same edge of the mesh. */
#include "cloth/mesh/slice.h"
#include "cloth/base/memory.h"
#include "cloth/base/sets.h"
#include "cloth/base/vector.h"

#include <stdlib.h>
#include <string.h>

/* part: where the plane is, from a on. */
static void cut_edge(struct slice_end *end, const struct slice_mesh *mesh, uint32_t a, uint32_t b,
                     double part)
{
    end->part = a < b ? part : 1 - part;
    end->edge = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
    end->open = true;
    for (int k = 0; k < 3; k++)
        end->place[k] = mesh->x[a][k] + part * (mesh->x[b][k] - mesh->x[a][k]);
}

/* height: of its corners over the plane. False: the plane does not cut the triangle. */
static bool slice_cut_triangle(struct slice_segment *segment, const struct slice_mesh *mesh,
                               uint32_t t, const double height[3])
{
    const uint32_t *v = mesh->triangle[t];
    int n = 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        if ((height[i] < 0) != (height[j] < 0))
            cut_edge(&segment->end[n++], mesh, v[i], v[j], height[i] / (height[i] - height[j]));
    }
    segment->length = n == 2 ? cloth_distance(segment->end[0].place, segment->end[1].place) : 0;
    return n == 2;
}

struct met {
    uint64_t edge;
    uint32_t segment, end;
};

static int compare_met(const void *a, const void *b)
{
    const struct met *one = a, *two = b;
    if (one->edge != two->edge)
        return one->edge < two->edge ? -1 : 1;
    return (one->segment > two->segment) - (one->segment < two->segment);
}

static int slice_join(struct slice *slice, struct cloth_error *error)
{
    struct met *met = cloth_alloc(2 * (size_t)slice->n, sizeof *met, error);
    slice->set = cloth_alloc(slice->n, sizeof *slice->set, error);
    if (!met || !slice->set) {
        free(met);
        return CLOTH_E_MEMORY;
    }
    cloth_sets_start(slice->set, slice->n);
    for (uint32_t s = 0; s < slice->n; s++)
        for (uint32_t k = 0; k < 2; k++)
            met[2 * s + k] = (struct met){slice->segment[s].end[k].edge, s, k};
    qsort(met, 2 * (size_t)slice->n, sizeof *met, compare_met);
    for (uint32_t i = 1; i < 2 * slice->n; i++)
        if (met[i].edge == met[i - 1].edge) {
            cloth_sets_join(slice->set, met[i].segment, met[i - 1].segment);
            slice->segment[met[i].segment].end[met[i].end].open = false;
            slice->segment[met[i - 1].segment].end[met[i - 1].end].open = false;
        }
    free(met);
    return CLOTH_OK;
}

int slice_make(struct slice *slice, const struct slice_mesh *mesh, const double normal[3],
               double level, struct cloth_error *error)
{
    struct cloth_list list = {0};
    struct slice_segment segment;
    int code = CLOTH_OK;
    for (uint32_t t = 0; t < mesh->n_triangles && !code; t++) {
        double height[3];
        for (int i = 0; i < 3; i++)
            height[i] = cloth_dot(mesh->x[mesh->triangle[t][i]], normal) - level;
        if (slice_cut_triangle(&segment, mesh, t, height))
            code = cloth_list_put(&list, &segment, sizeof segment, error);
    }
    *slice = (struct slice){.n = (uint32_t)list.n, .segment = list.items};
    return code ? code : slice_join(slice, error);
}

void slice_free(struct slice *slice)
{
    free(slice->segment);
    free(slice->set);
    *slice = (struct slice){0};
}

static int compare_points(const void *a, const void *b)
{
    const double *p = a, *q = b;
    if (p[0] != q[0])
        return p[0] < q[0] ? -1 : 1;
    return (p[1] > q[1]) - (p[1] < q[1]);
}

/* Goes on with a chain of k points, of which those from `lower` on may be dropped. */
static uint32_t extend(double (*chain)[2], uint32_t k, uint32_t lower, const double point[2])
{
    while (k >= lower && cloth_turn(chain[k - 2], chain[k - 1], point) <= 0)
        k--;
    memcpy(chain[k], point, sizeof *chain);
    return k + 1;
}

/* By Andrew's monotone chain: first below, then above. */
int slice_hull(double (*point)[2], uint32_t n, uint32_t *corners, struct cloth_error *error)
{
    *corners = n;
    if (n < 3)
        return CLOTH_OK;
    double(*chain)[2] = cloth_alloc(2 * (size_t)n + 1, sizeof *chain, error);
    uint32_t k = 0;
    if (!chain)
        return CLOTH_E_MEMORY;
    qsort(point, n, sizeof *point, compare_points);
    for (uint32_t i = 0; i < n; i++)
        k = extend(chain, k, 2, point[i]);
    const uint32_t lower = k + 1;
    for (uint32_t i = n - 1; i-- > 0;)
        k = extend(chain, k, lower, point[i]);
    *corners = k > 1 ? k - 1 : 1; /* the last is the first again */
    memcpy(point, chain, *corners * sizeof *chain);
    free(chain);
    return CLOTH_OK;
}

double slice_around(const double (*hull)[2], uint32_t n)
{
    double sum = 0;
    for (uint32_t i = 0; i < n; i++) {
        const double *a = hull[i], *b = hull[(i + 1) % n];
        sum += hypot(b[0] - a[0], b[1] - a[1]);
    }
    return sum;
}

bool slice_inside(const double (*hull)[2], uint32_t n, const double point[2])
{
    for (uint32_t i = 0; i < n; i++)
        if (cloth_turn(hull[i], hull[(i + 1) % n], point) < 0)
            return false;
    return n >= 3;
}
