/* Both sides of a stitch have equally many divisions: those that the mean of their lengths wants,
 * but none much longer than the spacing. Their parts are equal read from either end, so that the
 * direction of the stitch does not matter. */
#include "cloth/base/memory.h"
#include "cloth/base/vector.h"
#include "cloth/garment/detail/meshing.h"

#include <stdlib.h>

static const double TURN = 0.8;         /* rad: a division turns no more */
static const double LONG = 1.5;         /* spacings: a division of a gathered edge is no longer */
static const double SHARP = 0.86602540; /* cos 30 degrees */
static const double MOST = 0x1p25;      /* divisions of all edges */
static const double JUMP = 1.35;        /* of divisions on both sides of a corner */
static const double GROWTH = 0.3;       /* of divisions, a length along their edge */
static const double LEAST = 0.25;       /* of the shortest division: none becomes shorter */
enum { SWEEPS = 8 };                    /* over all corners: sizes spread that far */

void meshing_make(struct meshing *meshing, const struct garment_pattern *pattern,
                  struct cloth_error *error)
{
    *meshing = (struct meshing){.pattern = pattern, .error = error};
    meshing->first =
        cloth_take(&meshing->memory, (size_t)pattern->n_panels + 1, sizeof *meshing->first, error);
    meshing->panel = cloth_take(&meshing->memory, pattern->n_panels, sizeof *meshing->panel, error);
    if (meshing->memory.lacks)
        return;
    for (uint32_t p = 0; p < pattern->n_panels; p++) {
        meshing->first[p + 1] = meshing->first[p] + pattern->panel[p].n_edges;
        meshing->panel[p].clockwise = garment_panel_area(&pattern->panel[p]) < 0;
    }
    meshing->edge = cloth_take(&meshing->memory, meshing->first[pattern->n_panels],
                               sizeof *meshing->edge, error);
    if (!meshing->edge)
        return;
    for (uint32_t p = 0; p < pattern->n_panels; p++)
        for (uint32_t e = 0; e < pattern->panel[p].n_edges; e++) {
            struct meshing_edge *edge = &meshing->edge[meshing->first[p] + e];
            curve_make(&edge->curve, &pattern->panel[p], e);
            edge->least = 1 + (uint32_t)(curve_turning(&edge->curve) / TURN);
            edge->partner = UINT32_MAX;
        }
    for (uint32_t s = 0; s < pattern->n_stitches; s++) {
        const struct garment_side *side = pattern->stitch[s].side;
        const uint32_t one = meshing->first[side[0].panel] + side[0].edge;
        const uint32_t two = meshing->first[side[1].panel] + side[1].edge;
        meshing->edge[one].partner = two;
        meshing->edge[two].partner = one;
        const struct garment_pleats *pleats = &pattern->stitch[s].pleats;
        if (pleats->count) {
            meshing->edge[one].pleats = meshing->edge[two].pleats = pleats;
            meshing->edge[pleats->side ? two : one].folded = true;
        }
    }
}

void meshing_free(struct meshing *meshing)
{
    for (uint32_t p = 0; meshing->panel && p < meshing->pattern->n_panels; p++) {
        delaunay_free(&meshing->panel[p].plane);
        cloth_pool_free(&meshing->panel[p].memory);
    }
    for (uint32_t e = 0; meshing->edge && e < meshing->first[meshing->pattern->n_panels]; e++)
        free(meshing->edge[e].part);
    cloth_pool_free(&meshing->memory);
    *meshing = (struct meshing){0};
}

/* As a number, since it may be beyond all integers. */
static double divide_wanted(const struct meshing *meshing, const struct meshing_edge *edge)
{
    const struct meshing_edge *other =
        edge->partner == UINT32_MAX ? edge : &meshing->edge[edge->partner];
    const double one = edge->curve.length / meshing->spacing,
                 two = other->curve.length / meshing->spacing;
    const double finer = fmax(edge->finer, other->finer);
    const double mean = floor(finer * 0.5 * (one + two) + 0.5);
    return fmax(fmax(mean, ceil(finer * fmax(one, two) / LONG)), fmax(edge->least, other->least));
}

/* At the corner between two edges neither's divisions are much longer than the other's. */
static void even_corner(struct meshing_edge *one, struct meshing_edge *two, double least)
{
    const double a = one->end[1] * one->curve.length, b = two->end[0] * two->curve.length;
    if (a > JUMP * b)
        one->end[1] = fmin(one->end[1], fmax(JUMP * b, least) / one->curve.length);
    if (b > JUMP * a)
        two->end[0] = fmin(two->end[0], fmax(JUMP * a, least) / two->curve.length);
}

/* Along an edge they grow slowly; both edges of a stitch are alike, and from both ends. */
static void even_edge(struct meshing *meshing, struct meshing_edge *edge)
{
    for (int k = 0; k < 2; k++)
        edge->end[k] = fmin(edge->end[k], edge->end[1 - k] + GROWTH);
    if (edge->partner == UINT32_MAX || edge->pleats)
        return;
    struct meshing_edge *other = &meshing->edge[edge->partner];
    const double least = fmin(fmin(edge->end[0], edge->end[1]), fmin(other->end[0], other->end[1]));
    edge->end[0] = edge->end[1] = other->end[0] = other->end[1] = least;
}

/* Where the partner of an edge is beside it, or stitches lead in a ring, and gather, each round
 * would ask for shorter divisions: none gets much shorter than the shortest one at the start. */
static double shortest(const struct meshing *meshing)
{
    double least = INFINITY;
    for (uint32_t e = 0; e < meshing->first[meshing->pattern->n_panels]; e++)
        least = fmin(least, meshing->edge[e].middle * meshing->edge[e].curve.length);
    return LEAST * least;
}

static void even_out(struct meshing *meshing)
{
    const double least = shortest(meshing);
    for (int k = 0; k < SWEEPS; k++)
        for (uint32_t p = 0; p < meshing->pattern->n_panels; p++) {
            const uint32_t first = meshing->first[p], n = meshing->first[p + 1] - first;
            for (uint32_t e = 0; e < n; e++)
                even_corner(&meshing->edge[first + e], &meshing->edge[first + (e + 1) % n], least);
            for (uint32_t e = 0; e < n; e++)
                even_edge(meshing, &meshing->edge[first + e]);
        }
}

/* How long a division is to be at a part of the length. */
static double size_at(const struct meshing_edge *edge, double t)
{
    const double begin = edge->end[0] + GROWTH * t, end = edge->end[1] + GROWTH * (1 - t);
    return fmin(edge->middle, fmin(begin, end));
}

/* Divisions that are not equal: goes along the edge by as many as fit best, and stretches them to
 * its end. Both ends of the list are exact. */
static void grade(struct meshing_edge *edge, struct cloth_error *error)
{
    struct cloth_list list = {0};
    double t = 0;
    int code = CLOTH_OK;
    for (bool more = true; more && !code;) {
        const double step = size_at(edge, fmin(t + 0.5 * size_at(edge, t), 1));
        code = cloth_list_put(&list, &t, sizeof t, error);
        more = t <= 0 || t + 0.5 * step < 1;
        t += step;
    }
    double *part = list.items;
    const uint32_t n = (uint32_t)list.n - 1;
    if (code || n < edge->least) {
        free(part);
        return;
    }
    const double reached = part[n];
    for (uint32_t k = 0; k <= n; k++)
        part[k] /= reached;
    for (uint32_t k = 0; edge->partner != UINT32_MAX && k <= n / 2; k++) {
        const double both = 0.5 * (part[k] + (1 - part[n - k]));
        part[k] = both;
        part[n - k] = 1 - both;
    }
    edge->part = part;
    edge->n = n;
}

static void divide_edge(struct meshing_edge *edge, double n, struct cloth_error *error)
{
    free(edge->part);
    edge->part = NULL;
    edge->n = (uint32_t)n;
    if (fmin(edge->end[0], edge->end[1]) <= 0.999 * edge->middle)
        grade(edge, error);
}

void meshing_divide(struct meshing *meshing)
{
    const uint32_t *first = meshing->first, n_panels = meshing->pattern->n_panels;
    double sum = 0;
    for (uint32_t e = 0; e < first[n_panels] && sum <= MOST; e++) {
        struct meshing_edge *edge = &meshing->edge[e];
        double size = 0; /* of the first part */
        const double parts =
            edge->pleats ? pleats_count(meshing, edge, &size) : divide_wanted(meshing, edge);
        sum += parts;
        edge->before = (struct meshing_divisions){edge->n, {edge->end[0], edge->end[1]}};
        edge->middle = edge->end[0] = edge->end[1] = edge->pleats ? size : 1 / parts;
    }
    if (!(sum <= MOST)) {
        cloth_fail(meshing->error, CLOTH_E_INPUT,
                   "edges of %g m would divide the boundary into more than %.0f parts",
                   meshing->spacing, MOST);
        return;
    }
    even_out(meshing);
    for (uint32_t p = 0; p < n_panels; p++)
        for (uint32_t e = first[p]; e < first[p + 1]; e++) {
            struct meshing_edge *edge = &meshing->edge[e];
            if (edge->pleats)
                pleats_divide(meshing, edge);
            else
                divide_edge(edge, 1 / edge->middle + 0.5, meshing->error);
            const bool same = edge->n == edge->before.n && edge->end[0] == edge->before.end[0] &&
                              edge->end[1] == edge->before.end[1];
            meshing->panel[p].meshed = meshing->panel[p].meshed && same;
        }
}

/* True if the loop, which is counterclockwise, has an angle below 30 degrees inside of place i. */
static bool is_sharp(const double (*place)[2], uint32_t n, uint32_t i)
{
    double sine, cosine;
    const double squares =
        cloth_angle(place[(i + n - 1) % n], place[i], place[(i + 1) % n], &sine, &cosine);
    return cosine > SHARP * sqrt(squares) && sine < 0;
}

bool meshing_outline(struct meshing *meshing, uint32_t panel)
{
    struct cloth_error *error = meshing->error;
    struct meshing_panel *of = &meshing->panel[panel];
    const struct meshing_edge *edge = meshing->edge + meshing->first[panel];
    const uint32_t n_edges = meshing->pattern->panel[panel].n_edges;
    uint32_t n = 0;
    cloth_pool_free(&of->memory);
    of->start = cloth_take(&of->memory, (size_t)n_edges + 1, sizeof *of->start, error);
    for (uint32_t e = 0; of->start && e < n_edges; e++) {
        n += edge[e].n;
        of->start[e + 1] = n;
    }
    of->sharp = cloth_take(&of->memory, n, 1, error);
    of->place = cloth_take(&of->memory, n, sizeof *of->place, error);
    if (error->code)
        return false;
    for (uint32_t e = 0; e < n_edges; e++)
        for (uint32_t k = 0; k < edge[e].n; k++) {
            double *at = of->place[of->start[e] + k];
            curve_at_length(&edge[e].curve, edge[e].part ? edge[e].part[k] : (double)k / edge[e].n,
                            at);
            at[0] = of->clockwise ? -at[0] : at[0];
        }
    for (uint32_t e = 0; e < n_edges; e++)
        of->sharp[of->start[e]] = is_sharp((const double(*)[2])of->place, n, of->start[e]);
    return true;
}
