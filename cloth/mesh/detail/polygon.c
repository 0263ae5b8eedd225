/* A polygon that leaves here without a fault is simple, so that it has an ear until three corners
 * are left. */
#include "cloth/mesh/detail/finish.h"

#include "cloth/base/memory.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct polygon {
    const double *position;
    const uint32_t *corner;
    uint32_t n;
    size_t u, v; /* the two axes that are looked at, such that it is wound from u to v */
};

struct point {
    double u, v;
};

/* Sines of angles: what is less is taken for flat; and ears that are less acute come first. */
static const double FLAT = 1e-9, ACUTE = 1e-3;

static struct point at(const struct polygon *p, uint32_t i)
{
    const double *x = p->position + 3 * (size_t)p->corner[i];
    return (struct point){x[p->u], x[p->v]};
}

static double polygon_distance(struct point a, struct point b)
{
    return fmax(fabs(b.u - a.u), fabs(b.v - a.v));
}

/* Which way a, b, c turn: 1, -1, or 0 where the angle at a is below `least`. */
static int turn_by(double least, struct point a, struct point b, struct point c)
{
    const double area = (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
    const double unsure = least * polygon_distance(a, b) * polygon_distance(a, c);
    return area > unsure ? 1 : area < -unsure ? -1 : 0;
}

/* The same where rounding, also of a polygon that was turned in space, may hide it. */
static int polygon_turn(struct point a, struct point b, struct point c)
{
    return turn_by(FLAT, a, b, c);
}

static uint32_t next(const struct polygon *p, uint32_t i)
{
    return i + 1 < p->n ? i + 1 : 0;
}

/* ---- Where to look from ---- */

/* Chooses the axes by the normal; false if it has none. */
static bool polygon_look(struct polygon *p)
{
    const double *o = p->position + 3 * (size_t)p->corner[0];
    double normal[3] = {0}, size[3] = {0};
    for (uint32_t i = 1; i + 1 < p->n; i++) {
        const double *a = p->position + 3 * (size_t)p->corner[i];
        const double *b = p->position + 3 * (size_t)p->corner[i + 1];
        for (size_t k = 0; k < 3; k++) {
            const size_t u = (k + 1) % 3, v = (k + 2) % 3;
            const double left = (a[u] - o[u]) * (b[v] - o[v]);
            const double right = (a[v] - o[v]) * (b[u] - o[u]);
            normal[k] += left - right;
            size[k] += fabs(left) + fabs(right);
        }
    }
    size_t k = 0;
    for (size_t i = 1; i < 3; i++)
        k = fabs(normal[i]) > fabs(normal[k]) ? i : k;
    p->u = (k + 1 + (normal[k] < 0)) % 3;
    p->v = (k + 2 - (normal[k] < 0)) % 3;
    return fabs(normal[k]) > 4 * DBL_EPSILON * p->n * size[k];
}

/* ---- Whether the fan will do ---- */

/* Every corner turns left, and once round in all: u turns back twice only. */
static bool is_convex(const struct polygon *p)
{
    uint32_t backs = 0;
    int way = 0, first = 0;
    for (uint32_t i = 0; i < p->n; i++) {
        const uint32_t j = next(p, i);
        const struct point a = at(p, i), b = at(p, j);
        const int now = (b.u > a.u) - (b.u < a.u);
        if (polygon_turn(a, b, at(p, next(p, j))) <= 0)
            return false;
        backs += now && way && now != way;
        way = now ? now : way;
        first = first ? first : now;
    }
    return backs + (way != first) <= 2;
}

static bool fans(const struct polygon *p)
{
    for (uint32_t i = 2; i < p->n; i++)
        if (polygon_turn(at(p, 0), at(p, i - 1), at(p, i)) <= 0)
            return false;
    return true;
}

void mesh_polygon_fan(uint32_t n, const uint32_t *corner, uint32_t *triangle)
{
    for (uint32_t i = 2; i < n; i++, triangle += 3) {
        triangle[0] = corner[0];
        triangle[1] = corner[i - 1];
        triangle[2] = corner[i];
    }
}

/* ---- Whether it is simple ---- */

/* c, on the line of a and b: between them, or one of them. */
static bool polygon_is_between(struct point a, struct point b, struct point c)
{
    return fmin(a.u, b.u) <= c.u && c.u <= fmax(a.u, b.u) && fmin(a.v, b.v) <= c.v &&
           c.v <= fmax(a.v, b.v);
}

static bool polygon_cross(struct point a, struct point b, struct point c, struct point d)
{
    if (fmax(a.u, b.u) < fmin(c.u, d.u) || fmax(c.u, d.u) < fmin(a.u, b.u) ||
        fmax(a.v, b.v) < fmin(c.v, d.v) || fmax(c.v, d.v) < fmin(a.v, b.v))
        return false;
    const int abc = polygon_turn(a, b, c), abd = polygon_turn(a, b, d), cda = polygon_turn(c, d, a),
              cdb = polygon_turn(c, d, b);
    if (abc * abd < 0 && cda * cdb < 0)
        return true;
    return (!abc && polygon_is_between(a, b, c)) || (!abd && polygon_is_between(a, b, d)) ||
           (!cda && polygon_is_between(c, d, a)) || (!cdb && polygon_is_between(c, d, b));
}

/* The side from b on lies on the side from a to b, which may have no length. */
static bool polygon_folds(struct point a, struct point b, struct point c)
{
    return polygon_turn(a, b, c) == 0 && (b.u - a.u) * (c.u - b.u) + (b.v - a.v) * (c.v - b.v) <= 0;
}

static bool is_simple(const struct polygon *p, uint32_t side[2])
{
    for (uint32_t i = 0; i < p->n; i++) {
        const struct point a = at(p, i), b = at(p, next(p, i));
        side[0] = i;
        side[1] = next(p, i);
        if (polygon_folds(a, b, at(p, next(p, side[1]))))
            return false;
        for (side[1]++; side[1] < p->n && side[1] > i; side[1]++)
            if (next(p, side[1]) != i &&
                polygon_cross(a, b, at(p, side[1]), at(p, next(p, side[1]))))
                return false;
    }
    return true;
}

/* ---- Ears ---- */

/* True if c is in the triangle or on its border. */
static bool polygon_is_inside(const struct point t[3], struct point c)
{
    return polygon_turn(t[0], t[1], c) >= 0 && polygon_turn(t[1], t[2], c) >= 0 &&
           polygon_turn(t[2], t[0], c) >= 0;
}

/* left: n corners that are left, in order. Corner i of them with its neighbours; no angle of theirs
 * is below `least`. */
static bool polygon_is_ear(const struct polygon *p, double least, uint32_t n, const uint32_t *left,
                           uint32_t i)
{
    const uint32_t before = (i + n - 1) % n, after = (i + 1) % n;
    const struct point t[3] = {at(p, left[before]), at(p, left[i]), at(p, left[after])};
    for (int k = 0; k < 3; k++)
        if (turn_by(least, t[k], t[(k + 1) % 3], t[(k + 2) % 3]) <= 0)
            return false;
    for (uint32_t k = 0; k < n; k++)
        if (k != before && k != i && k != after && polygon_is_inside(t, at(p, left[k])))
            return false;
    return true;
}

/* The first ear at or after corner *i. */
static bool find_ear(const struct polygon *p, double least, uint32_t n, const uint32_t *left,
                     uint32_t *i)
{
    for (uint32_t tried = 0; tried < n; tried++, *i = (*i + 1) % n)
        if (polygon_is_ear(p, least, n, left, *i))
            return true;
    return false;
}

/* Returns false if no ear is found where one must be, since doubles cannot tell. */
static bool clip(const struct polygon *p, uint32_t *left, uint32_t *triangle)
{
    uint32_t n = p->n, i = 0;
    for (uint32_t k = 0; k < n; k++)
        left[k] = k;
    for (; n > 2; triangle += 3) {
        if (!find_ear(p, ACUTE, n, left, &i) && !find_ear(p, FLAT, n, left, &i))
            return false;
        triangle[0] = p->corner[left[(i + n - 1) % n]];
        triangle[1] = p->corner[left[i]];
        triangle[2] = p->corner[left[(i + 1) % n]];
        n--;
        memmove(left + i, left + i + 1, (n - i) * sizeof *left);
        i = i < n ? i : 0;
    }
    return true;
}

enum mesh_polygon mesh_polygon_cut(const double *position, uint32_t n, const uint32_t *corner,
                                   uint32_t *triangle, uint32_t side[2], struct cloth_error *error)
{
    struct polygon p = {.position = position, .corner = corner, .n = n};
    if (n > 3 && !polygon_look(&p))
        return MESH_POLYGON_NO_AREA;
    const bool convex = n == 3 || is_convex(&p);
    if (!convex && n > MESH_MAX_CORNERS)
        return MESH_POLYGON_TOO_LARGE;
    if (!convex && !is_simple(&p, side))
        return MESH_POLYGON_CROSSES;
    if (convex || fans(&p)) {
        mesh_polygon_fan(n, corner, triangle);
        return MESH_POLYGON_CUT;
    }
    uint32_t *left = cloth_alloc(n, sizeof *left, error);
    if (!left)
        return MESH_POLYGON_NO_MEMORY;
    const bool found = clip(&p, left, triangle);
    free(left);
    return found ? MESH_POLYGON_CUT : MESH_POLYGON_NO_AREA;
}
