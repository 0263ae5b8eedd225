/* Knife pleats: the longer edge of a stitch lies along the shorter one in a zig-zag, forward, back
 * by the depth and forward again, once each count-th part of the shorter edge, in its middle. Where
 * it lies so thrice, its divisions are those of the shorter edge, one upon the other; read from the
 * other end all of it is the same. A longer edge than the zig-zag is gathered evenly along it. */
#include "cloth/base/memory.h"
#include "cloth/garment/detail/meshing.h"

#include <stdlib.h>

static const double LONG = 1.5; /* spacings: a division of the longer edge is no longer */

struct pleats_layout {
    double flat, depth;    /* m: before and behind a fold, and of it, along the shorter edge */
    double n_flat, n_fold; /* their divisions */
};

/* Divisions of a pleat and what lies between it and the next, of one edge. */
static double pleats_unit(const struct pleats_layout *of, bool folded)
{
    return 2 * of->n_flat + (folded ? 3 : 1) * of->n_fold;
}

static struct pleats_layout pleats_lay_out(const struct meshing *meshing,
                                           const struct meshing_edge *edge)
{
    const struct meshing_edge *other = &meshing->edge[edge->partner];
    const struct meshing_edge *longer = edge->folded ? edge : other,
                              *shorter = edge->folded ? other : edge;
    const double count = edge->pleats->count, depth = edge->pleats->depth;
    const double pitch = shorter->curve.length / count;
    const double gather = longer->curve.length / (count * (pitch + 2 * depth));
    const double step =
        meshing->spacing / (fmax(edge->finer, other->finer) * fmax(1, gather / LONG));
    struct pleats_layout of = {.flat = fmax(0, 0.5 * (pitch - depth)), .depth = depth};
    of.n_fold = fmax(1, floor(depth / step + 0.5));
    of.n_flat = of.flat > PLEATS_NONE * pitch ? fmax(1, floor(of.flat / step + 0.5)) : 0;
    const double turns = fmax(longer->least, shorter->least);
    const double times = fmax(1, ceil(turns / (count * pleats_unit(&of, false))));
    of.n_fold *= times;
    of.n_flat *= times;
    return of;
}

double pleats_count(const struct meshing *meshing, const struct meshing_edge *edge, double *first)
{
    const struct pleats_layout of = pleats_lay_out(meshing, edge);
    const double unit = 2 * of.flat + (edge->folded ? 3 : 1) * of.depth,
                 count = edge->pleats->count;
    *first = (of.n_flat > 0 ? of.flat / of.n_flat : of.depth / of.n_fold) / (count * unit);
    return count * pleats_unit(&of, edge->folded);
}

void pleats_divide(const struct meshing *meshing, struct meshing_edge *edge)
{
    const struct pleats_layout of = pleats_lay_out(meshing, edge);
    const uint32_t unit = (uint32_t)pleats_unit(&of, edge->folded);
    const uint32_t flat = (uint32_t)of.n_flat, fold = unit - 2 * flat;
    const double folded = (edge->folded ? 3 : 1) * of.depth;
    const double length = edge->pleats->count * (2 * of.flat + folded);
    free(edge->part);
    edge->n = edge->pleats->count * unit;
    edge->part = cloth_alloc((size_t)edge->n + 1, sizeof *edge->part, meshing->error);
    for (uint32_t k = 0; edge->part && k <= edge->n; k++) {
        const uint32_t i = k / unit, r = k % unit;
        const double before = r < flat ? r : flat, behind = r > flat + fold ? r - flat - fold : 0;
        const double at = r < flat ? 0 : r > flat + fold ? fold : r - flat;
        edge->part[k] = (i * (2 * of.flat + folded) +
                         (flat ? of.flat * (before + behind) / flat : 0) + folded * at / fold) /
                        length;
    }
    if (edge->part)
        edge->part[edge->n] = 1;
}

uint32_t pleats_place(uint32_t count, uint32_t n_folded, uint32_t n, uint32_t k)
{
    const uint32_t fold = (n_folded - n) / (2 * count), unit = n_folded / count;
    const uint32_t flat = (unit - 3 * fold) / 2, r = k % unit;
    const uint32_t at = r <= flat + fold       ? r
                        : r <= flat + 2 * fold ? 2 * (flat + fold) - r
                                               : r - 2 * fold;
    return k / unit * (unit - 2 * fold) + at;
}
