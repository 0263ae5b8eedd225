/* Heights are a lattice of levels, on which the body is cut once. A garment's cut is open where it
 * ends at a hem, or at a seam whose other side is not cut near the same place. */
#include "cloth/garment/girth.h"
#include "cloth/base/memory.h"
#include "cloth/base/sets.h"
#include "cloth/mesh/slice.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double STEP = 0.02;             /* m: between levels */
static const double NEAR = 0.03;             /* of a seam: how far cuts of both sides may be */
static const double MOST = 0.8, LEAST = 0.2; /* of a part's outline: surrounded, not surrounded */
enum { WINDOW = 2, LEVELS = 1000 };

/* ---- Seams ---- */

struct seam_edge {
    uint64_t edge;
    uint32_t seam, side, k; /* from pair k to k + 1 of the seam's side */
    bool backward;          /* the lower vertex is that of pair k + 1 */
};

static int compare_edges(const void *a, const void *b)
{
    const struct seam_edge *one = a, *two = b;
    return (one->edge > two->edge) - (one->edge < two->edge);
}

struct seams {
    struct cloth_list edge; /* struct seam_edge, sorted */
    const struct girth_seam *seam;
};

static int list_seams(struct seams *seams, uint32_t n_seams, const struct girth_seam *seam,
                      struct cloth_error *error)
{
    int code = CLOTH_OK;
    seams->seam = seam;
    for (uint32_t s = 0; s < n_seams; s++)
        for (uint32_t k = 0; k + 1 < seam[s].n; k++)
            for (uint32_t side = 0; side < 2 && !code; side++) {
                const uint32_t a = seam[s].pair[k][side], b = seam[s].pair[k + 1][side];
                const uint64_t low = a < b ? a : b, high = a < b ? b : a;
                const struct seam_edge edge = {low << 32 | high, s, side, k, b < a};
                code = cloth_list_put(&seams->edge, &edge, sizeof edge, error);
            }
    if (seams->edge.n)
        qsort(seams->edge.items, seams->edge.n, sizeof(struct seam_edge), compare_edges);
    return code;
}

/* An open end of a cut on a seam. */
struct loose {
    struct slice_end *end;
    uint32_t segment, seam, side;
    double at; /* pairs from the seam's begin */
};

static int list_loose(struct cloth_list *list, const struct slice *slice, const struct seams *seams,
                      struct cloth_error *error)
{
    for (uint32_t s = 0; s < slice->n; s++)
        for (int k = 0; k < 2; k++) {
            struct slice_end *end = &slice->segment[s].end[k];
            const struct seam_edge key = {.edge = end->edge};
            const struct seam_edge *edge =
                end->open && seams->edge.n
                    ? bsearch(&key, seams->edge.items, seams->edge.n, sizeof key, compare_edges)
                    : NULL;
            if (!edge)
                continue;
            const struct loose loose = {end, s, edge->seam, edge->side,
                                        edge->k + (edge->backward ? 1 - end->part : end->part)};
            const int code = cloth_list_put(list, &loose, sizeof loose, error);
            if (code)
                return code;
        }
    return CLOTH_OK;
}

/* The nearest of the seam's other side; n: there is none. */
static size_t nearest(const struct loose *loose, size_t n, size_t i)
{
    size_t best = n;
    for (size_t k = 0; k < n; k++)
        if (loose[k].seam == loose[i].seam && loose[k].side != loose[i].side &&
            (best == n || fabs(loose[k].at - loose[i].at) < fabs(loose[best].at - loose[i].at)))
            best = k;
    return best;
}

static int sew(struct slice *slice, const struct seams *seams, struct cloth_error *error)
{
    struct cloth_list list = {0};
    const int code = list_loose(&list, slice, seams, error);
    struct loose *loose = list.items;
    for (size_t i = 0; i < list.n && !code; i++) {
        const size_t k = nearest(loose, list.n, i);
        const double allowed = k < list.n ? fmax(1, NEAR * seams->seam[loose[i].seam].n) : 0;
        if (k == list.n || nearest(loose, list.n, k) != i ||
            fabs(loose[k].at - loose[i].at) > allowed)
            continue;
        cloth_sets_join(slice->set, loose[i].segment, loose[k].segment);
        loose[i].end->open = false;
    }
    free(loose);
    return code;
}

/* ---- Loops and the bodies inside ---- */

struct loop {
    double girth;
    double (*hull)[2]; /* around it, as the panels stand */
    uint32_t n;
};

/* A place as seen from above. */
static void flatten(double point[2], const struct slice_end *end)
{
    point[0] = end->place[0];
    point[1] = end->place[2];
}

/* The loop of a set of segments; girth 0: it is open. */
static int take_loop(struct loop *loop, const struct slice *slice, uint32_t set,
                     struct cloth_error *error)
{
    uint32_t n = 0;
    bool open = false;
    *loop = (struct loop){.hull = cloth_alloc(2 * (size_t)slice->n, sizeof *loop->hull, error)};
    if (!loop->hull)
        return CLOTH_E_MEMORY;
    for (uint32_t s = 0; s < slice->n; s++) {
        const struct slice_segment *segment = &slice->segment[s];
        if (cloth_sets_root(slice->set, s) != set)
            continue;
        for (int k = 0; k < 2; k++) {
            open = open || segment->end[k].open;
            flatten(loop->hull[n++], &segment->end[k]);
        }
        loop->girth += segment->length;
    }
    loop->girth = open ? 0 : loop->girth;
    return slice_hull(loop->hull, n, &loop->n, error);
}

/* How much of each part of a body's slice is inside of a loop. */
static void measure_inside(const struct slice *body, const struct loop *loop, double (*part)[2])
{
    for (uint32_t s = 0; s < body->n; s++) {
        const struct slice_segment *segment = &body->segment[s];
        const double *one = segment->end[0].place, *two = segment->end[1].place;
        const double middle[2] = {0.5 * (one[0] + two[0]), 0.5 * (one[2] + two[2])};
        const uint32_t root = cloth_sets_root(body->set, s);
        part[root][0] += segment->length;
        if (slice_inside((const double(*)[2])loop->hull, loop->n, middle))
            part[root][1] += segment->length;
    }
}

/* The girth of the body inside a loop; 0: none, or it cannot be told. */
static int body_girth(double *girth, const struct slice *body, const struct loop *loop,
                      struct cloth_error *error)
{
    double(*part)[2] = cloth_alloc(body->n, sizeof *part, error);
    double(*point)[2] = cloth_alloc(2 * (size_t)body->n, sizeof *point, error);
    uint32_t n = 0;
    bool clear = true;
    int code = part && point ? CLOTH_OK : CLOTH_E_MEMORY;
    *girth = 0;
    if (!code)
        measure_inside(body, loop, part);
    for (uint32_t s = 0; s < body->n && !code; s++) {
        const double *of = part[cloth_sets_root(body->set, s)];
        const bool inside = of[1] >= MOST * of[0];
        clear = clear && (inside || of[1] <= LEAST * of[0]);
        for (int k = 0; k < 2 && inside; k++)
            flatten(point[n++], &body->segment[s].end[k]);
    }
    if (!code && clear && n > 2) {
        code = slice_hull(point, n, &n, error);
        *girth = code ? 0 : slice_around((const double(*)[2])point, n);
    }
    free(part);
    free(point);
    return code;
}

/* ---- Levels ---- */

/* Cuts a mesh at a height, m. */
static int slice_at(struct slice *slice, const struct girth_mesh *mesh, double y,
                    struct cloth_error *error)
{
    static const double up[3] = {0, 1, 0};
    const struct slice_mesh cut = {mesh->n_triangles, mesh->triangle, mesh->x};
    return slice_make(slice, &cut, up, y, error);
}

struct levels {
    double first; /* m: the height of level 0, WINDOW below the garment */
    uint32_t n;
    struct slice *body;
};

static int cut_body(struct levels *levels, const struct girth_mesh *garment,
                    const struct girth_mesh *body, struct cloth_error *error)
{
    double low = INFINITY, high = -INFINITY;
    for (uint32_t t = 0; t < garment->n_triangles; t++)
        for (int i = 0; i < 3; i++) {
            low = fmin(low, garment->x[garment->triangle[t][i]][1]);
            high = fmax(high, garment->x[garment->triangle[t][i]][1]);
        }
    const double n = ceil((high - low) / STEP) + 2 * WINDOW;
    *levels = (struct levels){.first = low - (WINDOW - 0.5) * STEP};
    if (!(n >= 0 && n < LEVELS)) /* nothing that is worn */
        return CLOTH_OK;
    levels->body = cloth_alloc((size_t)n, sizeof *levels->body, error);
    int code = levels->body ? CLOTH_OK : CLOTH_E_MEMORY;
    while (!code && levels->n < (uint32_t)n) {
        const double y = levels->first + levels->n * STEP;
        code = slice_at(&levels->body[levels->n++], body, y, error);
    }
    return code;
}

/* Compares a loop on a level with the body around this level. */
static int compare_loop(struct girth_worst *worst, const struct loop *loop,
                        const struct levels *levels, uint32_t level, struct cloth_error *error)
{
    double least = INFINITY;
    for (uint32_t l = level - WINDOW; l <= level + WINDOW; l++) {
        double girth;
        const int code = body_girth(&girth, &levels->body[l], loop, error);
        if (code)
            return code;
        least = girth > 0 ? fmin(least, girth) : least;
    }
    if (least < INFINITY && (!worst->found || least * worst->garment > worst->body * loop->girth))
        *worst = (struct girth_worst){true, levels->first + level * STEP, loop->girth, least};
    return CLOTH_OK;
}

static int compare_level(struct girth_worst *worst, const struct girth_mesh *garment,
                         const struct seams *seams, const struct levels *levels, uint32_t level,
                         struct cloth_error *error)
{
    struct slice slice;
    int code = slice_at(&slice, garment, levels->first + level * STEP, error);
    code = code ? code : sew(&slice, seams, error);
    for (uint32_t s = 0; s < slice.n && !code; s++) {
        struct loop loop;
        if (cloth_sets_root(slice.set, s) != s)
            continue;
        code = take_loop(&loop, &slice, s, error);
        if (!code && loop.girth > 0)
            code = compare_loop(worst, &loop, levels, level, error);
        free(loop.hull);
    }
    slice_free(&slice);
    return code;
}

int girth_compare(struct girth_worst *worst, const struct girth_mesh *garment, uint32_t n_seams,
                  const struct girth_seam *seam, const struct girth_mesh *body,
                  struct cloth_error *error)
{
    struct levels levels = {0};
    struct seams seams = {0};
    *worst = (struct girth_worst){0};
    int code = list_seams(&seams, n_seams, seam, error);
    code = code ? code : cut_body(&levels, garment, body, error);
    for (uint32_t l = WINDOW; l + WINDOW < levels.n && !code; l++)
        code = compare_level(worst, garment, &seams, &levels, l, error);
    for (uint32_t l = 0; l < levels.n; l++)
        slice_free(&levels.body[l]);
    free(levels.body);
    free(seams.edge.items);
    return code;
}
