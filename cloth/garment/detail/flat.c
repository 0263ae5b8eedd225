/* First the boundary, then a lattice of equilateral triangles inside it, then what is between the
 * two is made even. */
#include "cloth/garment/detail/flat.h"
#include "cloth/garment/detail/lattice.h"

#include <math.h>
#include <stdlib.h>

static int make_box(struct delaunay *plane, const struct flat_loop *loop, uint32_t n_inner,
                    struct cloth_error *error)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (uint32_t i = 0; i < loop->n; i++)
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], loop->place[i][k]);
            high[k] = fmax(high[k], loop->place[i][k]);
        }
    const uint64_t room = (uint64_t)4 * loop->n + n_inner + n_inner / 4 + 64;
    if (room > UINT32_MAX / 8)
        return cloth_fail(error, CLOTH_E_INPUT, "a panel of %ju vertices is too large",
                          (uintmax_t)room);
    return delaunay_make(plane, low, high, (uint32_t)room, error);
}

static int flat_put_loop(struct delaunay *plane, const struct flat_loop *loop, uint32_t *crossing,
                         struct cloth_error *error)
{
    for (uint32_t i = 0; i < loop->n; i++) {
        if (delaunay_insert(plane, loop->place[i], plane->last) == DELAUNAY_NONE) {
            *crossing = i;
            return cloth_fail(error, CLOTH_E_INPUT, "the boundary meets itself");
        }
        plane->n_fixed++;
    }
    for (uint32_t i = 0; i < loop->n; i++)
        if (!delaunay_fix(plane, DELAUNAY_BOX + i, DELAUNAY_BOX + (i + 1) % loop->n)) {
            *crossing = i;
            return cloth_fail(error, CLOTH_E_INPUT, "the boundary meets itself");
        }
    for (uint32_t t = 0; t < plane->n_triangles; t++)
        delaunay_suspect(plane, t);
    delaunay_legalise(plane);
    return CLOTH_OK;
}

int flat_make(struct delaunay *plane, const struct flat_loop *loop, double edge, uint32_t *crossing,
              struct cloth_error *error)
{
    uint32_t n_inner;
    double(*inner)[2];
    *plane = (struct delaunay){0};
    *crossing = DELAUNAY_NONE;
    int code = garment_lattice(loop->n, loop->place, edge, &n_inner, &inner, error);
    code = code ? code : make_box(plane, loop, n_inner, error);
    code = code ? code : flat_put_loop(plane, loop, crossing, error);
    for (uint32_t i = 0; i < n_inner && !code; i++)
        delaunay_insert(plane, inner[i], plane->last);
    free(inner);
    if (code)
        return code;
    delaunay_carve(plane);
    flat_smooth(plane, error);
    if (flat_refine(plane, loop->sharp)) {
        delaunay_pack(plane);
        flat_smooth(plane, error);
    }
    flat_improve(plane, loop->sharp);
    delaunay_pack(plane);
    return plane->failed ? cloth_fail(error, CLOTH_E_MEMORY, "out of memory for a panel's mesh")
                         : CLOTH_OK;
}
