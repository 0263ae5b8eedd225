/* One axis is cut into strips; a box of a triangle has an entry in each strip that it meets.
 * Entries are sorted by strip and by their begin along another axis, and boxes whose spans meet
 * there are compared. A pair that is in several strips counts in the first of them. Strips are as
 * wide as the mean box, so a box is in three of them on average at most. */
#include "cloth/verify/orient.h"
#include "cloth/verify/verify.h"

#include <math.h>
#include <stdlib.h>

struct box {
    double low[3], high[3];
    uint32_t strip[2]; /* the first and the last */
};

struct entry {
    double low; /* along the axis that is swept */
    uint32_t strip, triangle;
};

struct sweep {
    const struct verify_soup *soup;
    double (*x)[3];
    struct box *box;
    struct entry *entry;
    size_t n_entries;
    uint32_t n_strips;
    int along, across, third; /* axes: swept, cut in strips, the last */
    struct cloth_list *pairs;
    struct cloth_error *error;
};

/* ---- Boxes ---- */

static int sweep_take_points(struct sweep *sweep)
{
    const struct verify_soup *soup = sweep->soup;
    for (uint32_t p = 0; p < soup->n_points; p++)
        for (int c = 0; c < 3; c++) {
            const double x = soup->x[p][c];
            if (!(fabs(x) <= VERIFY_MOST))
                return cloth_fail(sweep->error, CLOTH_E_RUN,
                                  "intersections: point %u has no place that can be checked", p);
            sweep->x[p][c] = verify_coordinate(x);
        }
    return CLOTH_OK;
}

static void take_boxes(struct sweep *sweep)
{
    for (uint32_t t = 0; t < sweep->soup->n_triangles; t++) {
        const uint32_t *corner = sweep->soup->corner[t];
        struct box *box = sweep->box + t;
        for (int c = 0; c < 3; c++) {
            const double u = sweep->x[corner[0]][c], v = sweep->x[corner[1]][c];
            const double w = sweep->x[corner[2]][c];
            box->low[c] = fmin(u, fmin(v, w));
            box->high[c] = fmax(u, fmax(v, w));
        }
    }
}

/* The span of all boxes along an axis, and their mean extent. */
struct span {
    double low, size, mean;
};

static void find_span(const struct sweep *sweep, int axis, struct span *span)
{
    const uint32_t n = sweep->soup->n_triangles;
    double low = INFINITY, high = -INFINITY, sum = 0;
    for (uint32_t t = 0; t < n; t++) {
        low = fmin(low, sweep->box[t].low[axis]);
        high = fmax(high, sweep->box[t].high[axis]);
        sum += sweep->box[t].high[axis] - sweep->box[t].low[axis];
    }
    *span = (struct span){low, high - low, sum / n};
}

/* ---- Strips ---- */

/* Must only be monotonous in x. */
static uint32_t strip_of(const struct sweep *sweep, const struct span *span, double x)
{
    const double at = span->size > 0 ? (x - span->low) / span->size * sweep->n_strips : 0;
    return at < sweep->n_strips ? (uint32_t)at : sweep->n_strips - 1;
}

/* The two axes along which boxes are smallest against all of them. */
static void choose_axes(struct sweep *sweep, struct span *across)
{
    struct span span[3];
    double part[3];
    for (int c = 0; c < 3; c++) {
        find_span(sweep, c, span + c);
        part[c] = span[c].size > 0 ? span[c].mean / span[c].size : 1;
    }
    for (int c = 0; c < 3; c++) {
        sweep->along = part[c] < part[sweep->along] ? c : sweep->along;
        sweep->third = part[c] >= part[sweep->third] ? c : sweep->third;
    }
    sweep->across = 3 - sweep->along - sweep->third;
    *across = span[sweep->across];
    const double n = sweep->soup->n_triangles, strips = 1 / part[sweep->across];
    sweep->n_strips = strips < n ? (uint32_t)fmax(strips, 1) : (uint32_t)n;
}

static int by_strip(const void *left, const void *right)
{
    const struct entry *a = left, *b = right;
    if (a->strip != b->strip)
        return a->strip < b->strip ? -1 : 1;
    if (a->low < b->low || a->low > b->low)
        return a->low < b->low ? -1 : 1;
    return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

static int fill_strips(struct sweep *sweep, const struct span *across)
{
    const uint32_t n = sweep->soup->n_triangles;
    for (uint32_t t = 0; t < n; t++) {
        struct box *box = sweep->box + t;
        box->strip[0] = strip_of(sweep, across, box->low[sweep->across]);
        box->strip[1] = strip_of(sweep, across, box->high[sweep->across]);
        sweep->n_entries += box->strip[1] - box->strip[0] + 1;
    }
    struct entry *next = sweep->entry =
        cloth_alloc(sweep->n_entries, sizeof *sweep->entry, sweep->error);
    if (!next)
        return CLOTH_E_MEMORY;
    for (uint32_t t = 0; t < n; t++)
        for (uint32_t s = sweep->box[t].strip[0]; s <= sweep->box[t].strip[1]; s++)
            *next++ = (struct entry){sweep->box[t].low[sweep->along], s, t};
    qsort(sweep->entry, sweep->n_entries, sizeof *sweep->entry, by_strip);
    return CLOTH_OK;
}

/* ---- Pairs ---- */

/* True if two boxes meet along the axes that are not swept, the strip is the first with both,
 * and one of them is of the first triangles. */
static bool sweep_boxes_meet(const struct sweep *sweep, uint32_t a, uint32_t b, uint32_t strip)
{
    const struct box *p = sweep->box + a, *q = sweep->box + b;
    const int i = sweep->across, j = sweep->third;
    return p->low[i] <= q->high[i] && q->low[i] <= p->high[i] && p->low[j] <= q->high[j] &&
           q->low[j] <= p->high[j] && (p->strip[0] == strip || q->strip[0] == strip) &&
           (a < sweep->soup->n_first || b < sweep->soup->n_first);
}

/* True if a corner of one triangle is sewn to a corner of the other. Until the seam is closed,
 * it may be on either side. */
static bool are_sewn(const struct verify_soup *soup, const uint32_t a[3], const uint32_t b[3])
{
    bool sewn = false;
    for (int i = 0; i < 3 && soup->joined; i++)
        for (int k = 0; k < 3; k++)
            sewn = sewn || (a[i] != b[k] && soup->joined[a[i]] == soup->joined[b[k]]);
    return sewn;
}

static int try_pair(struct sweep *sweep, uint32_t a, uint32_t b)
{
    const uint32_t(*corner)[3] = sweep->soup->corner;
    if (are_sewn(sweep->soup, corner[a], corner[b]) ||
        !verify_meet((const double(*)[3])sweep->x, corner[a], corner[b]))
        return CLOTH_OK;
    struct verify_pair *pair = cloth_list_add(sweep->pairs, sizeof *pair, 1, sweep->error);
    if (!pair)
        return CLOTH_E_MEMORY;
    *pair = a < b ? (struct verify_pair){{a, b}} : (struct verify_pair){{b, a}};
    return CLOTH_OK;
}

static int sweep_strips(struct sweep *sweep)
{
    const struct entry *end = sweep->entry + sweep->n_entries;
    for (const struct entry *a = sweep->entry; a < end; a++) {
        const double high = sweep->box[a->triangle].high[sweep->along];
        for (const struct entry *b = a + 1; b < end && b->strip == a->strip && b->low <= high; b++)
            if (sweep_boxes_meet(sweep, a->triangle, b->triangle, a->strip) &&
                try_pair(sweep, a->triangle, b->triangle))
                return CLOTH_E_MEMORY;
    }
    return CLOTH_OK;
}

static int by_triangles(const void *left, const void *right)
{
    const struct verify_pair *a = left, *b = right;
    const int k = a->triangle[0] == b->triangle[0];
    return (a->triangle[k] > b->triangle[k]) - (a->triangle[k] < b->triangle[k]);
}

static int sweep_all(struct sweep *sweep)
{
    struct span across;
    const size_t before = sweep->pairs->n;
    int code = sweep_take_points(sweep);
    if (code)
        return code;
    take_boxes(sweep);
    choose_axes(sweep, &across);
    code = fill_strips(sweep, &across);
    code = code ? code : sweep_strips(sweep);
    struct verify_pair *found = sweep->pairs->items;
    if (sweep->pairs->n > before)
        qsort(found + before, sweep->pairs->n - before, sizeof *found, by_triangles);
    return code;
}

int verify_pairs(const struct verify_soup *soup, struct cloth_list *pairs,
                 struct cloth_error *error)
{
    struct sweep sweep = {.soup = soup, .pairs = pairs, .error = error};
    int code = CLOTH_OK;
    if (!soup->n_triangles)
        return code;
    sweep.x = cloth_alloc(soup->n_points, sizeof *sweep.x, error);
    sweep.box = cloth_alloc(soup->n_triangles, sizeof *sweep.box, error);
    code = sweep.x && sweep.box ? sweep_all(&sweep) : CLOTH_E_MEMORY;
    free(sweep.x);
    free(sweep.box);
    free(sweep.entry);
    return code;
}
