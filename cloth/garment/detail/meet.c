/* Segments are sorted along the longer axis of the loop; each is tried with those that it overlaps
 * there. */
#include "cloth/base/memory.h"
#include "cloth/base/vector.h"
#include "cloth/garment/detail/curve.h"

#include <stdlib.h>

struct box {
    double low[2], high[2];
};

static const double *place_of(const struct meet_loop *loop, uint32_t i)
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

static struct box box_of(const double *a, const double *b)
{
    return (struct box){{fmin(a[0], b[0]), fmin(a[1], b[1])}, {fmax(a[0], b[0]), fmax(a[1], b[1])}};
}

static bool segments_meet(const double *a, const double *b, const double *c, const double *d,
                          double near)
{
    const struct box one = box_of(a, b), two = box_of(c, d);
    if (apart(&one, &two, near))
        return false;
    const bool across = (cloth_turn(a, b, c) > 0) != (cloth_turn(a, b, d) > 0);
    const bool along = (cloth_turn(c, d, a) > 0) != (cloth_turn(c, d, b) > 0);
    const double least = fmin(fmin(cloth_segment_square(a, c, d), cloth_segment_square(b, c, d)),
                              fmin(cloth_segment_square(c, a, b), cloth_segment_square(d, a, b)));
    return (across && along) || least < near * near;
}

/* True if the way from a over b to c goes back where it came from. */
static bool folds_back(const double *a, const double *b, const double *c)
{
    double sine, cosine;
    cloth_angle(a, b, c, &sine, &cosine);
    return cosine > 0 && fabs(sine) <= 1e-6 * cosine;
}

static bool pair_meets(const struct meet_loop *loop, uint32_t i, uint32_t j, double near)
{
    const uint32_t n = loop->start[loop->n_edges];
    const double *a = place_of(loop, i), *b = place_of(loop, i + 1);
    const double *c = place_of(loop, j), *d = place_of(loop, j + 1);
    const bool next = i + 1 == j, last = i == 0 && j + 1 == n;
    if (next || last)
        return (next && folds_back(a, b, d)) || (last && folds_back(c, d, b));
    return segments_meet(a, b, c, d, near);
}

/* A segment of the loop, from its number i on. */
struct segment {
    struct box box;
    uint32_t i, edge;
};

static int by_low(const void *va, const void *vb, void *context)
{
    const int axis = *(const int *)context;
    const struct segment *a = va, *b = vb;
    const double x = a->box.low[axis], y = b->box.low[axis];
    return x < y ? -1 : x > y ? 1 : (a->i > b->i) - (a->i < b->i);
}

/* Makes the segments. Returns the axis along which the loop is longer. */
static int take_segments(const struct meet_loop *loop, struct segment *segment)
{
    double low[2], high[2];
    for (uint32_t e = 0; e < loop->n_edges; e++)
        for (uint32_t i = loop->start[e]; i < loop->start[e + 1]; i++)
            segment[i] = (struct segment){box_of(place_of(loop, i), place_of(loop, i + 1)), i, e};
    cloth_box(loop->start[loop->n_edges], loop->place, low, high);
    return high[1] - low[1] > high[0] - low[0];
}

/* Keeps the first pair of edges that meets. */
static void note_edges(const struct segment *a, const struct segment *b, bool *found,
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
    qsort_r(segment, n, sizeof *segment, by_low, &axis);
    for (uint32_t k = 0; k < n; k++)
        for (uint32_t m = k + 1;
             m < n && segment[m].box.low[axis] - near <= segment[k].box.high[axis]; m++) {
            const struct segment *a = segment + k, *b = segment + m;
            if (!apart(&a->box, &b->box, near) &&
                pair_meets(loop, a->i < b->i ? a->i : b->i, a->i < b->i ? b->i : a->i, near))
                note_edges(a, b, found, edge);
        }
    free(segment);
    return CLOTH_OK;
}
