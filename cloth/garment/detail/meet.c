/* Segments are sorted along the longer axis of the loop; each is tried with those that it overlaps
 * there. */
#include "cloth/garment/detail/meet.h"
#include "cloth/base/memory.h"

#include <math.h>
#include <stdlib.h>

struct box {
    double low[2], high[2];
};

static const double *detail_meet_place_of(const struct meet_loop *loop, uint32_t i)
{
    return loop->place[i == loop->start[loop->n_edges] ? 0 : i];
}

static bool apart(const struct box *a, const struct box *b, double near)
{
    for (int k = 0; k < 2; k++)
        if (a->low[k] - near > b->high[k] || b->low[k] - near > a->high[k])
            return true;
    return false;
}

static struct box detail_meet_box_of(const double *a, const double *b)
{
    return (struct box){{fmin(a[0], b[0]), fmin(a[1], b[1])}, {fmax(a[0], b[0]), fmax(a[1], b[1])}};
}

static double area(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Square of the distance from x to the segment from a to b. */
static double detail_meet_distance(const double *x, const double *a, const double *b)
{
    const double along[2] = {b[0] - a[0], b[1] - a[1]}, to[2] = {x[0] - a[0], x[1] - a[1]};
    const double length = along[0] * along[0] + along[1] * along[1];
    double s = length > 0 ? (to[0] * along[0] + to[1] * along[1]) / length : 0;
    s = s < 0 ? 0 : s > 1 ? 1 : s;
    const double d[2] = {to[0] - s * along[0], to[1] - s * along[1]};
    return d[0] * d[0] + d[1] * d[1];
}

static bool segments_meet(const double *a, const double *b, const double *c, const double *d,
                          double near)
{
    const struct box one = detail_meet_box_of(a, b), two = detail_meet_box_of(c, d);
    if (apart(&one, &two, near))
        return false;
    const bool across = (area(a, b, c) > 0) != (area(a, b, d) > 0);
    const bool along = (area(c, d, a) > 0) != (area(c, d, b) > 0);
    const double least = fmin(fmin(detail_meet_distance(a, c, d), detail_meet_distance(b, c, d)),
                              fmin(detail_meet_distance(c, a, b), detail_meet_distance(d, a, b)));
    return (across && along) || least < near * near;
}

/* Whether the way from a over b to c goes back where it came from. */
static bool detail_meet_folds(const double *a, const double *b, const double *c)
{
    const double from[2] = {a[0] - b[0], a[1] - b[1]}, to[2] = {c[0] - b[0], c[1] - b[1]};
    const double cosine = from[0] * to[0] + from[1] * to[1];
    return cosine > 0 && fabs(from[0] * to[1] - from[1] * to[0]) <= 1e-6 * cosine;
}

static bool detail_meet_pair(const struct meet_loop *loop, uint32_t i, uint32_t j, double near)
{
    const uint32_t n = loop->start[loop->n_edges];
    const double *a = detail_meet_place_of(loop, i), *b = detail_meet_place_of(loop, i + 1);
    const double *c = detail_meet_place_of(loop, j), *d = detail_meet_place_of(loop, j + 1);
    const bool next = i + 1 == j, last = i == 0 && j + 1 == n;
    if (next || last)
        return (next && detail_meet_folds(a, b, d)) || (last && detail_meet_folds(c, d, b));
    return segments_meet(a, b, c, d, near);
}

/* A segment of the loop, from its number i on. */
struct segment {
    struct box box;
    uint32_t i, edge;
};

static int detail_meet_by_low(const void *va, const void *vb, void *context)
{
    const int axis = *(const int *)context;
    const struct segment *a = va, *b = vb;
    const double x = a->box.low[axis], y = b->box.low[axis];
    return x < y ? -1 : x > y ? 1 : (a->i > b->i) - (a->i < b->i);
}

/* Makes the segments. Returns the axis along which the loop is longer. */
static int take_segments(const struct meet_loop *loop, struct segment *segment)
{
    struct box all = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (uint32_t e = 0; e < loop->n_edges; e++)
        for (uint32_t i = loop->start[e]; i < loop->start[e + 1]; i++) {
            const struct box box = detail_meet_box_of(detail_meet_place_of(loop, i),
                                                      detail_meet_place_of(loop, i + 1));
            segment[i] = (struct segment){box, i, e};
            for (int k = 0; k < 2; k++) {
                all.low[k] = fmin(all.low[k], box.low[k]);
                all.high[k] = fmax(all.high[k], box.high[k]);
            }
        }
    return all.high[1] - all.low[1] > all.high[0] - all.low[0];
}

/* Keeps the first pair of edges that meets. */
static void detail_meet_note(const struct segment *a, const struct segment *b, bool *found,
                             uint32_t edge[2])
{
    const uint32_t e = a->edge < b->edge ? a->edge : b->edge, f = a->edge + b->edge - e;
    if (*found && (edge[0] < e || (edge[0] == e && edge[1] <= f)))
        return;
    *found = true;
    edge[0] = e;
    edge[1] = f;
}

int meet_find(const struct meet_loop *loop, double near, bool *found, uint32_t edge[2],
              struct cloth_error *error)
{
    const uint32_t n = loop->start[loop->n_edges];
    struct segment *segment = cloth_alloc(n, sizeof *segment, error);
    *found = false;
    if (!segment)
        return CLOTH_E_MEMORY;
    int axis = take_segments(loop, segment);
    qsort_r(segment, n, sizeof *segment, detail_meet_by_low, &axis);
    for (uint32_t k = 0; k < n; k++)
        for (uint32_t m = k + 1;
             m < n && segment[m].box.low[axis] - near <= segment[k].box.high[axis]; m++) {
            const struct segment *a = segment + k, *b = segment + m;
            if (!apart(&a->box, &b->box, near) &&
                detail_meet_pair(loop, a->i < b->i ? a->i : b->i, a->i < b->i ? b->i : a->i, near))
                detail_meet_note(a, b, found, edge);
        }
    free(segment);
    return CLOTH_OK;
}
