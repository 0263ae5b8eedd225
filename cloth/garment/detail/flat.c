/* First the boundary, then a lattice of equilateral triangles inside it, then what is between the
 * two is made even:
 *
 * The lattice ends at some distance from the boundary, which varies along it. Laplacian smoothing
 * spreads that over the next rows; where it would make an angle worse than it is good for, the
 * vertex stays. Then comes Delaunay refinement (Chew, 1993; Ruppert, 1995) of the inside alone: the
 * centre of a sharp triangle's circumcircle becomes a vertex, where that is not too near to the
 * boundary. So sizes grow step by step from a boundary that is much finer than the lattice. */
#include "cloth/garment/detail/flat.h"

#include <stdlib.h>
#include <string.h>

enum { ROWS = 4, PASSES = 8, ROUNDS = 12, MOST_AROUND = 24, MOST_SEEN = 48 };

static const double FINE = 0.766;      /* cos 40 degrees: an angle from there on may become worse */
static const double POOR = 0.93969262; /* cos 20 degrees: one such triangle calls for refinement */
static const double SHARP = 0.88294759; /* cos 28 degrees: above that the insertions may not end */
static const double WIDE = -0.5; /* cos 120 degrees: of a boundary's edge seen from a vertex */

/* ---- The boundary ---- */

static int make_box(struct delaunay *plane, const struct flat_loop *loop, uint32_t n_inner,
                    struct cloth_error *error)
{
    double low[2], high[2];
    cloth_box(loop->n, loop->place, low, high);
    const uint64_t room = (uint64_t)4 * loop->n + n_inner + n_inner / 4 + 64;
    if (room > UINT32_MAX / 8)
        return cloth_fail(error, CLOTH_E_INPUT, "a panel of %ju vertices is too large",
                          (uintmax_t)room);
    return delaunay_make(plane, low, high, (uint32_t)room, error);
}

static int flat_put_loop(struct delaunay *plane, const struct flat_loop *loop, uint32_t *crossing,
                         struct cloth_error *error)
{
    uint32_t n = 0, fixed = 0;
    while (n < loop->n && delaunay_insert(plane, loop->place[n], plane->last) != DELAUNAY_NONE)
        n++;
    plane->n_fixed += n;
    while (n == loop->n && fixed < n &&
           delaunay_fix(plane, DELAUNAY_BOX + fixed, DELAUNAY_BOX + (fixed + 1) % n))
        fixed++;
    if (fixed < loop->n) {
        *crossing = n < loop->n ? n : fixed;
        return cloth_fail(error, CLOTH_E_INPUT, "the boundary meets itself");
    }
    for (uint32_t t = 0; t < plane->n_triangles; t++)
        delaunay_suspect(plane, t);
    delaunay_legalise(plane);
    return CLOTH_OK;
}

/* ---- Smoothing ---- */

/* How many edges each vertex is from the boundary, at most ROWS + 1. */
static void find_rows(const struct delaunay *plane, unsigned char *row)
{
    memset(row, ROWS + 1, plane->n);
    memset(row, 0, plane->n_fixed);
    for (unsigned char depth = 1; depth <= ROWS; depth++)
        for (uint32_t t = 0; t < plane->n_triangles; t++) {
            const uint32_t *v = plane->triangle[t].vertex;
            bool near = false;
            for (int i = 0; i < 3; i++)
                near = near || row[v[i]] == depth - 1;
            for (int i = 0; near && i < 3; i++)
                row[v[i]] = row[v[i]] > depth ? depth : row[v[i]];
        }
}

static double worst_of(const struct delaunay *plane, uint32_t n, const uint32_t *around)
{
    double worst = 0;
    for (uint32_t k = 0; k < n; k++)
        worst = fmax(worst, delaunay_sharpness_of(plane, around[k]));
    return worst;
}

static void flat_smooth_move(struct delaunay *plane, uint32_t vertex)
{
    uint32_t around[MOST_AROUND];
    const uint32_t n = delaunay_around(plane, vertex, MOST_AROUND, around);
    if (n == 0)
        return;
    double *place = plane->place[vertex], sum[2] = {0, 0};
    for (uint32_t k = 0; k < n; k++) {
        const double *next = plane->place[delaunay_after(&plane->triangle[around[k]], vertex, 1)];
        sum[0] += next[0];
        sum[1] += next[1];
    }
    const double before = worst_of(plane, n, around), old[2] = {place[0], place[1]};
    place[0] = sum[0] / n;
    place[1] = sum[1] / n;
    if (worst_of(plane, n, around) > fmax(before, FINE))
        memcpy(place, old, sizeof old);
    for (uint32_t k = 0; k < n; k++)
        delaunay_suspect(plane, around[k]);
}

static void flat_smooth(struct delaunay *plane, struct cloth_error *error)
{
    unsigned char *row = cloth_alloc(plane->n, 1, error);
    if (!row) {
        plane->failed = true;
        return;
    }
    find_rows(plane, row);
    for (int pass = 0; pass < PASSES; pass++) {
        for (uint32_t v = plane->n_fixed; v < plane->n; v++)
            if (row[v] <= ROWS)
                flat_smooth_move(plane, v);
        delaunay_legalise(plane);
    }
    free(row);
}

/* ---- Refinement ---- */

static bool is_sharper(const struct delaunay *plane, const unsigned char *sharp, uint32_t triangle,
                       double cosine)
{
    return plane->triangle[triangle].vertex[0] != DELAUNAY_NONE &&
           delaunay_sharpness_of(plane, triangle) > cosine && !flat_excused(plane, sharp, triangle);
}

void flat_centre(const struct delaunay *plane, uint32_t triangle, double centre[2])
{
    const uint32_t *v = plane->triangle[triangle].vertex;
    const double *a = plane->place[v[0]], *b = plane->place[v[1]], *c = plane->place[v[2]];
    const double ab[2] = {b[0] - a[0], b[1] - a[1]}, ac[2] = {c[0] - a[0], c[1] - a[1]};
    const double area = 2 * cloth_turn(a, b, c);
    const double bb = ab[0] * ab[0] + ab[1] * ab[1], cc = ac[0] * ac[0] + ac[1] * ac[1];
    centre[0] = a[0] + (ac[1] * bb - ab[1] * cc) / area;
    centre[1] = a[1] + (ab[0] * cc - ac[0] * bb) / area;
}

/* True if a vertex sees an edge of the boundary under so wide an angle that a flat triangle is
 * between the two. */
static bool crowds(const struct delaunay *plane, uint32_t vertex)
{
    uint32_t around[MOST_SEEN];
    const uint32_t n = delaunay_around(plane, vertex, MOST_SEEN, around);
    for (uint32_t k = 0; k < n; k++) {
        const struct delaunay_triangle *of = &plane->triangle[around[k]];
        double sine, cosine;
        const double squares =
            cloth_angle(plane->place[delaunay_after(of, vertex, 1)], plane->place[vertex],
                        plane->place[delaunay_after(of, vertex, 2)], &sine, &cosine);
        if (of->beside[delaunay_corner(of, vertex)] == DELAUNAY_NONE &&
            cosine / sqrt(squares) < WIDE)
            return true;
    }
    return n == 0;
}

static bool insert_centre(struct delaunay *plane, uint32_t triangle)
{
    double centre[2];
    flat_centre(plane, triangle, centre);
    delaunay_log(plane);
    const uint32_t vertex = delaunay_insert(plane, centre, triangle);
    return delaunay_decide(plane,
                           vertex != DELAUNAY_NONE && !plane->failed && !crowds(plane, vertex));
}

/* Adds inner vertices where a triangle is sharp, if one is poor. Returns whether any was poor; if
 * none was, it changes nothing. sharp: of the boundary's vertices. */
static bool flat_refine(struct delaunay *plane, const unsigned char *sharp)
{
    bool any = false;
    for (uint32_t t = 0; t < plane->n_triangles && !any; t++)
        any = is_sharper(plane, sharp, t, POOR);
    const bool called = any;
    for (int round = 0; round < ROUNDS && any && !plane->failed; round++) {
        any = false;
        for (uint32_t t = 0; t < plane->n_triangles; t++)
            if (is_sharper(plane, sharp, t, SHARP) && insert_centre(plane, t))
                any = true;
    }
    return called;
}

int flat_make(struct delaunay *plane, const struct flat_loop *loop, double edge, uint32_t *crossing,
              struct cloth_error *error)
{
    struct cloth_list inner = {0};
    *plane = (struct delaunay){0};
    *crossing = DELAUNAY_NONE;
    int code = garment_lattice(loop->n, loop->place, edge, &inner, error);
    code = code ? code : make_box(plane, loop, (uint32_t)inner.n, error);
    code = code ? code : flat_put_loop(plane, loop, crossing, error);
    for (size_t i = 0; i < inner.n && !code; i++)
        delaunay_insert(plane, ((const double(*)[2])inner.items)[i], plane->last);
    free(inner.items);
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
