/* Heights are a lattice of levels, on which the body is cut once. A garment's cut is open where it
 * ends at a hem, or at a seam whose other side is not cut near the same place. */
#include "cloth/garment/girth.h"
#include "cloth/base/memory.h"
#include "cloth/base/order.h"
#include "cloth/base/sets.h"

#include <math.h>
#include <stdlib.h>

static const double STEP = 0.02;             /* m: between levels */
static const double NEAR = 0.03;             /* of a seam: how far cuts of both sides may be */
static const double MOST = 0.8, LEAST = 0.2; /* of a part's outline: surrounded, not surrounded */
enum { WINDOW = 2, LEVELS = 1000 };

struct girths {
    const struct slice_mesh *garment, *body;
    const struct girth_seam *seam;
    struct cloth_list edge; /* struct seam_edge: of all seams, sorted */
    double first;           /* m: the height of level 0, WINDOW below the garment */
    uint32_t n_levels;
    struct slice *level; /* of the body */
    struct girth_worst *worst;
    struct cloth_error error; /* the first one */
};

/* ---- Seams ---- */

struct seam_edge {
    uint64_t edge;
    uint32_t seam, side, k; /* from pair k to k + 1 of the seam's side */
    bool backward;          /* the lower vertex is that of pair k + 1 */
};

static void list_seams(struct girths *of, uint32_t n_seams)
{
    for (uint32_t s = 0; s < n_seams; s++)
        for (uint32_t k = 0; k + 1 < of->seam[s].n; k++)
            for (uint32_t side = 0; side < 2 && !of->error.code; side++) {
                const uint32_t a = of->seam[s].pair[k][side], b = of->seam[s].pair[k + 1][side];
                const uint64_t low = a < b ? a : b, high = a < b ? b : a;
                const struct seam_edge edge = {low << 32 | high, s, side, k, b < a};
                cloth_list_put(&of->edge, &edge, sizeof edge, &of->error);
            }
    cloth_list_sort(&of->edge, sizeof(struct seam_edge), cloth_by_u64);
}

/* An open end of a cut on a seam. */
struct loose {
    struct slice_end *end;
    uint32_t segment, seam, side;
    double at; /* pairs from the seam's begin */
};

static void list_loose(struct girths *of, struct cloth_list *list, const struct slice *slice)
{
    for (uint32_t s = 0; s < slice->n; s++)
        for (int k = 0; k < 2 && !of->error.code; k++) {
            struct slice_end *end = &slice->segment[s].end[k];
            const struct seam_edge key = {.edge = end->edge};
            const struct seam_edge *edge =
                end->open && of->edge.n
                    ? bsearch(&key, of->edge.items, of->edge.n, sizeof key, cloth_by_u64)
                    : NULL;
            if (!edge)
                continue;
            const struct loose loose = {end, s, edge->seam, edge->side,
                                        edge->k + (edge->backward ? 1 - end->part : end->part)};
            cloth_list_put(list, &loose, sizeof loose, &of->error);
        }
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

static void sew(struct girths *of, struct slice *slice)
{
    struct cloth_list list = {0};
    list_loose(of, &list, slice);
    struct loose *loose = list.items;
    for (size_t i = 0; i < list.n; i++) {
        const size_t k = nearest(loose, list.n, i);
        const double allowed = k < list.n ? fmax(1, NEAR * of->seam[loose[i].seam].n) : 0;
        if (k == list.n || nearest(loose, list.n, k) != i ||
            fabs(loose[k].at - loose[i].at) > allowed)
            continue;
        cloth_sets_join(slice->set, loose[i].segment, loose[k].segment);
        loose[i].end->open = false;
    }
    free(loose);
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

/* The loop of a set of segments; girth 0: it is open, or an error. */
static struct loop take_loop(struct girths *of, const struct slice *slice, uint32_t set)
{
    struct loop loop = {.hull = cloth_alloc(2 * (size_t)slice->n, sizeof *loop.hull, &of->error)};
    bool open = !loop.hull;
    for (uint32_t s = 0; s < slice->n && loop.hull; s++) {
        const struct slice_segment *segment = &slice->segment[s];
        if (cloth_sets_root(slice->set, s) != set)
            continue;
        for (int k = 0; k < 2; k++) {
            open = open || segment->end[k].open;
            flatten(loop.hull[loop.n++], &segment->end[k]);
        }
        loop.girth += segment->length;
    }
    if (open || slice_hull(loop.hull, loop.n, &loop.n, &of->error))
        loop.girth = 0;
    return loop;
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
static double body_girth(struct girths *of, const struct slice *body, const struct loop *loop)
{
    double(*part)[2] = cloth_alloc(body->n, sizeof *part, &of->error), girth = 0;
    double(*point)[2] = cloth_alloc(2 * (size_t)body->n, sizeof *point, &of->error);
    uint32_t n = 0;
    bool clear = part && point;
    if (clear)
        measure_inside(body, loop, part);
    for (uint32_t s = 0; s < body->n && clear; s++) {
        const double *in = part[cloth_sets_root(body->set, s)];
        const bool inside = in[1] >= MOST * in[0];
        clear = inside || in[1] <= LEAST * in[0];
        for (int k = 0; k < 2 && inside; k++)
            flatten(point[n++], &body->segment[s].end[k]);
    }
    if (clear && n > 2 && !slice_hull(point, n, &n, &of->error))
        girth = slice_around((const double(*)[2])point, n);
    free(part);
    free(point);
    return girth;
}

/* ---- Levels ---- */

/* Cuts a mesh at a height, m. */
static void slice_at(struct girths *of, struct slice *slice, const struct slice_mesh *mesh,
                     double y)
{
    static const double up[3] = {0, 1, 0};
    slice_make(slice, mesh, up, y, &of->error);
}

static void girth_cut_body(struct girths *of)
{
    const struct slice_mesh *garment = of->garment;
    double low = INFINITY, high = -INFINITY;
    for (uint32_t t = 0; t < garment->n_triangles; t++)
        for (int i = 0; i < 3; i++) {
            low = fmin(low, garment->x[garment->triangle[t][i]][1]);
            high = fmax(high, garment->x[garment->triangle[t][i]][1]);
        }
    const double n = ceil((high - low) / STEP) + 2 * WINDOW;
    of->first = low - (WINDOW - 0.5) * STEP;
    if (!(n >= 0 && n < LEVELS)) /* nothing that is worn */
        return;
    of->level = cloth_alloc((size_t)n, sizeof *of->level, &of->error);
    for (uint32_t l = 0; l < (uint32_t)n && !of->error.code; l++)
        slice_at(of, &of->level[of->n_levels++], of->body, of->first + l * STEP);
}

/* Compares a loop on a level with the body around this level. */
static void compare_loop(struct girths *of, const struct loop *loop, uint32_t level)
{
    struct girth_worst *worst = of->worst;
    double least = INFINITY;
    for (uint32_t l = level - WINDOW; l <= level + WINDOW; l++) {
        const double girth = body_girth(of, &of->level[l], loop);
        least = girth > 0 ? fmin(least, girth) : least;
    }
    if (least < INFINITY && (!worst->found || least * worst->garment > worst->body * loop->girth))
        *worst = (struct girth_worst){true, of->first + level * STEP, loop->girth, least};
}

static void compare_level(struct girths *of, uint32_t level)
{
    struct slice slice;
    slice_at(of, &slice, of->garment, of->first + level * STEP);
    if (!of->error.code)
        sew(of, &slice);
    for (uint32_t s = 0; s < slice.n && !of->error.code; s++) {
        if (cloth_sets_root(slice.set, s) != s)
            continue;
        const struct loop loop = take_loop(of, &slice, s);
        if (loop.girth > 0)
            compare_loop(of, &loop, level);
        free(loop.hull);
    }
    slice_free(&slice);
}

int girth_compare(struct girth_worst *worst, const struct slice_mesh *garment, uint32_t n_seams,
                  const struct girth_seam *seam, const struct slice_mesh *body,
                  struct cloth_error *error)
{
    struct girths of = {.garment = garment, .body = body, .seam = seam, .worst = worst};
    *worst = (struct girth_worst){0};
    list_seams(&of, n_seams);
    if (!of.error.code)
        girth_cut_body(&of);
    for (uint32_t l = WINDOW; l + WINDOW < of.n_levels && !of.error.code; l++)
        compare_level(&of, l);
    for (uint32_t l = 0; l < of.n_levels; l++)
        slice_free(&of.level[l]);
    free(of.level);
    free(of.edge.items);
    return of.error.code ? cloth_fail(error, of.error.code, "%s", of.error.text) : CLOTH_OK;
}
