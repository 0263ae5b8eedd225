/* The point of a triangle that is nearest to a convex core, in the core's axes. Half the square of
 * the distance is a convex function F of the point. Its gradient is the way r from the core; the
 * metric below is the derivative of r. So F is nearly quadratic, and its minimum on the triangle is
 * the next point: Newton's method with a line search. A ball takes one round, a box a few, a
 * cylinder some more. Rounds are bounded. An inexact point makes only a force less good:
 * certificates hold along any direction. */
#include "cloth/contact/solid_core.h"

enum { ROUNDS = 24, SEARCHES = 6 };
/* Parts of a squared distance, and of its size, by which another round has to shorten it. */
static const double ENOUGH = 1e-13, NOISE = 32 * 0x1p-53;
/* Part of a metric: below it, F is straight along a direction of the triangle. */
static const double FLAT = 1e-10;

/* A point of the triangle. */
struct core_point {
    double weight[3];
    double x[3], away[3]; /* m; from the core */
    double square;        /* m^2: of the distance */
};

PHYS_INLINE void point_of(const struct contact_solid *solid, const struct contact_lanes *own,
                          struct core_point *point)
{
    const double *w = point->weight;
    for (int c = 0; c < 3; c++)
        point->x[c] = w[0] * own->c[c][0] + w[1] * own->c[c][1] + w[2] * own->c[c][2];
    contact_core_away(solid, point->x, point->away);
    point->square = contact_inner(point->away, point->away);
}

/* ---- The quadratic function ---- */

/* The change of the way from the core if the point goes along e. */
PHYS_INLINE void bend(const struct contact_solid *solid, const struct core_point *at,
                      const double e[3], double bent[3])
{
    const double *x = at->x, *half = solid->half;
    bent[0] = fabs(x[0]) > half[0] ? e[0] : 0;
    if (solid->round) {
        const double square = x[1] * x[1] + x[2] * x[2], far = sqrt(square);
        const bool out = far > half[1];
        const double part = out ? half[1] / far : 0, along = (x[1] * e[1] + x[2] * e[2]) / square;
        bent[1] = out ? (1 - part) * e[1] + part * along * x[1] : 0;
        bent[2] = out ? (1 - part) * e[2] + part * along * x[2] : 0;
        return;
    }
    bent[1] = fabs(x[1]) > half[1] ? e[1] : 0;
    bent[2] = fabs(x[2]) > half[2] ? e[2] : 0;
}

/* b.z + z.A z / 2, z from where it is made, along the edges from corner 0. */
struct quadratic {
    double a11, a12, a22, b1, b2;
    double u, v; /* that point's own */
};

PHYS_INLINE double quadratic_at(const struct quadratic *q, double u, double v)
{
    const double du = u - q->u, dv = v - q->v;
    return q->b1 * du + q->b2 * dv + (q->a11 * du * du + q->a22 * dv * dv) / 2 + q->a12 * du * dv;
}

PHYS_INLINE void quadratic_of(const struct contact_solid *solid, const struct contact_lanes *own,
                              const struct core_point *at, struct quadratic *q)
{
    double e[2][3], bent[2][3];
    for (int c = 0; c < 3; c++) {
        e[0][c] = own->c[c][1] - own->c[c][0];
        e[1][c] = own->c[c][2] - own->c[c][0];
    }
    bend(solid, at, e[0], bent[0]);
    bend(solid, at, e[1], bent[1]);
    *q = (struct quadratic){contact_inner(e[0], bent[0]),
                            contact_inner(e[0], bent[1]),
                            contact_inner(e[1], bent[1]),
                            contact_inner(e[0], at->away),
                            contact_inner(e[1], at->away),
                            at->weight[1],
                            at->weight[2]};
    /* If F is straight, the minimum lies at the end of the triangle. */
    const double flat = FLAT * (contact_inner(e[0], e[0]) + contact_inner(e[1], e[1]));
    q->a11 += flat;
    q->a22 += flat;
}

/* Its least on the edge between two corners, given by weights of corners 1 and 2. */
PHYS_INLINE void edge_least(const struct quadratic *q, int from, int to, double *least,
                            double weight[3])
{
    const double u = from == 1, v = from == 2, du = (to == 1) - u, dv = (to == 2) - v;
    const double g1 = q->b1 + q->a11 * (u - q->u) + q->a12 * (v - q->v);
    const double g2 = q->b2 + q->a12 * (u - q->u) + q->a22 * (v - q->v);
    const double slope = g1 * du + g2 * dv;
    const double bend = q->a11 * du * du + q->a22 * dv * dv + 2 * q->a12 * du * dv;
    const double part = slope >= 0 ? 0 : bend > -slope ? -slope / bend : 1;
    const double value = quadratic_at(q, u + part * du, v + part * dv);
    if (value < *least) {
        *least = value;
        weight[0] = weight[1] = weight[2] = 0;
        weight[from] = 1 - part;
        weight[to] = part;
    }
}

PHYS_INLINE void quadratic_least(const struct quadratic *q, double weight[3])
{
    const double det = q->a11 * q->a22 - q->a12 * q->a12;
    const double u = q->u + (q->a12 * q->b2 - q->a22 * q->b1) / det;
    const double v = q->v + (q->a12 * q->b1 - q->a11 * q->b2) / det;
    if (det > 0 && u > 0 && v > 0 && u + v < 1) {
        weight[0] = 1 - u - v;
        weight[1] = u;
        weight[2] = v;
        return;
    }
    double least = INFINITY;
    edge_least(q, 0, 1, &least, weight);
    edge_least(q, 1, 2, &least, weight);
    edge_least(q, 2, 0, &least, weight);
}

/* ---- Rounds ---- */

/* A line from a point, and where on it F stops to fall: between low and high. */
struct core_line {
    double way[3], from[3], weight[2][3]; /* weights of both ends */
    double low, high, falls, rises;       /* parts of the line; slopes of F there */
};

PHYS_INLINE double line_slope(const struct contact_solid *solid, const struct core_line *line,
                              double part)
{
    double x[3], away[3];
    for (int c = 0; c < 3; c++)
        x[c] = line->from[c] + part * line->way[c];
    contact_core_away(solid, x, away);
    return contact_inner(away, line->way);
}

/* Looks at a part of the line that may lie outside, or be none. */
PHYS_INLINE void line_look(const struct contact_solid *solid, struct core_line *line, double part)
{
    if (!(part > line->low && part < line->high))
        return;
    const double slope = line_slope(solid, line, part);
    if (slope > 0) {
        line->high = part;
        line->rises = slope;
    } else {
        line->low = part;
        line->falls = slope;
    }
}

/* Finds the points where the line crosses the planes of the faces. F is smooth between them, and
 * quadratic for a box. */
PHYS_INLINE void line_faces(const struct contact_solid *solid, struct core_line *line)
{
    const double *x = line->from, *way = line->way, *half = solid->half;
    for (int c = 0; c < (solid->round ? 1 : 3); c++) {
        line_look(solid, line, (half[c] - x[c]) / way[c]);
        line_look(solid, line, (-half[c] - x[c]) / way[c]);
    }
    if (!solid->round)
        return;
    const double a = way[1] * way[1] + way[2] * way[2], b = way[1] * x[1] + way[2] * x[2],
                 c = x[1] * x[1] + x[2] * x[2] - half[1] * half[1];
    const double root = sqrt(b * b - a * c); /* may be none */
    line_look(solid, line, (-b - root) / a);
    line_look(solid, line, (-b + root) / a);
}

PHYS_INLINE void line_point(const struct contact_solid *solid, const struct contact_lanes *own,
                            const struct core_line *line, double part, struct core_point *to)
{
    for (int k = 0; k < 3; k++)
        to->weight[k] = (1 - part) * line->weight[0][k] + part * line->weight[1][k];
    point_of(solid, own, to);
}

/* From a point to the next one: where F falls no more on the line to it. */
PHYS_INLINE void line_search(const struct contact_solid *solid, const struct contact_lanes *own,
                             const struct core_point *from, struct core_point *to)
{
    struct core_line line = {.high = 1};
    for (int c = 0; c < 3; c++) {
        line.from[c] = from->x[c];
        line.way[c] = to->x[c] - from->x[c];
        line.weight[0][c] = from->weight[c];
        line.weight[1][c] = to->weight[c];
    }
    line.falls = contact_inner(from->away, line.way);
    line.rises = contact_inner(to->away, line.way);
    if (!(line.rises > 0 && line.falls < 0))
        return;
    line_faces(solid, &line);
    for (int i = 0; i < (solid->round ? SEARCHES : 0); i++) {
        const double part = line.falls / (line.falls - line.rises);
        line_look(solid, &line, line.low + part * (line.high - line.low));
    }
    const double part = line.falls / (line.falls - line.rises);
    line_point(solid, own, &line, line.low + part * (line.high - line.low), to);
    if (!(to->square < from->square))
        line_point(solid, own, &line, line.low, to);
}

/* The corner that is nearest as seen from the middle. */
PHYS_INLINE void first_point(const struct contact_solid *solid, const struct contact_lanes *own,
                             struct core_point *point)
{
    const double middle[3] = {own->c[0][3], own->c[1][3], own->c[2][3]};
    double way[3];
    phys_vec along;
    contact_core_away(solid, middle, way);
    contact_heights(own, way, &along);
    const double least = contact_least(&along);
    const int corner = along[0] <= least ? 0 : along[1] <= least ? 1 : 2;
    for (int k = 0; k < 3; k++)
        point->weight[k] = k == corner;
    point_of(solid, own, point);
}

/* m^2: by how much rounding may be off in a product of a way from the core and one in the triangle;
 * noise: m, of a coordinate. */
PHYS_INLINE double product_noise(const struct contact_lanes *own, double noise, double length)
{
    double edges = 0;
    for (int c = 0; c < 3; c++)
        edges += fabs(own->c[c][1] - own->c[c][0]) + fabs(own->c[c][2] - own->c[c][0]);
    return noise * (edges + length);
}

PHYS_INLINE void nearest_point(const struct contact_solid *solid, const struct contact_lanes *own,
                               double noise, struct core_point *point)
{
    first_point(solid, own, point);
    for (int i = 0; i < ROUNDS; i++) {
        const double length = sqrt(point->square);
        struct core_point next;
        struct quadratic quadratic;
        phys_vec along;
        contact_heights(own, point->away, &along);
        const double gains = contact_inner(point->away, point->x) - contact_least(&along);
        if (!(gains > ENOUGH * point->square + product_noise(own, noise, length)))
            break;
        quadratic_of(solid, own, point, &quadratic);
        quadratic_least(&quadratic, next.weight);
        point_of(solid, own, &next);
        line_search(solid, own, point, &next);
        if (!(next.square <= point->square + noise * length))
            break;
        *point = next;
    }
}

/* ---- Inside ---- */

static void try_way(const struct contact_solid *solid, const struct contact_lanes *own,
                    const double way[3], struct contact_solid_point *best)
{
    const double square = contact_inner(way, way);
    phys_vec along;
    double normal[3];
    if (!(square > CONTACT_TINY))
        return;
    for (int c = 0; c < 3; c++)
        normal[c] = way[c] / sqrt(square);
    contact_heights(own, normal, &along);
    const double least = contact_least(&along);
    const double gap = least - contact_core_support(solid, normal) - solid->radius;
    if (!(gap > best->gap))
        return;
    const int corner = along[0] <= least ? 0 : along[1] <= least ? 1 : 2;
    best->gap = gap;
    best->normal = (phys_vec){normal[0], normal[1], normal[2], 0};
    for (int k = 0; k < 3; k++)
        best->weight[k] = k == corner;
}

/* The shortest way out of those along the axes, the triangle's normal and the radius of each
 * corner. */
static void nearest_inside(const struct contact_solid *solid, const struct contact_lanes *own,
                           struct contact_solid_point *to)
{
    const phys_vec *c = own->c;
    const double ab[3] = {c[0][1] - c[0][0], c[1][1] - c[1][0], c[2][1] - c[2][0]},
                 ac[3] = {c[0][2] - c[0][0], c[1][2] - c[1][0], c[2][2] - c[2][0]};
    double across[3];
    *to =
        (struct contact_solid_point){.weight = {1, 0, 0}, .normal = {1, 0, 0, 0}, .gap = -INFINITY};
    for (int i = 0; i < 3; i++)
        across[i] = ab[(i + 1) % 3] * ac[(i + 2) % 3] - ab[(i + 2) % 3] * ac[(i + 1) % 3];
    for (int side = -1; side <= 1; side += 2) {
        double way[3];
        for (int k = 0; k < 3; k++)
            way[k] = side * across[k];
        try_way(solid, own, way, to);
        for (int k = 0; k < 3; k++) {
            way[0] = way[1] = way[2] = 0;
            way[k] = side;
            try_way(solid, own, way, to);
        }
    }
    for (int k = 0; k < 3; k++)
        try_way(solid, own, (const double[3]){0, c[1][k], c[2][k]}, to);
}

/* ---- In all ---- */

PHYS_INLINE double lanes_size(const struct contact_lanes *own)
{
    double size = 0;
    for (int c = 0; c < 3; c++)
        size += fabs(own->c[c][0]) + fabs(own->c[c][1]) + fabs(own->c[c][2]);
    return size;
}

PHYS_INLINE void nearest_to_plane(const struct contact_lanes *own, struct contact_solid_point *to)
{
    const phys_vec height = own->c[0];
    to->gap = contact_least(&height);
    const int corner = height[0] <= to->gap ? 0 : height[1] <= to->gap ? 1 : 2;
    to->normal = (phys_vec){1, 0, 0, 0};
    for (int k = 0; k < 3; k++)
        to->weight[k] = k == corner;
}

PHYS_INLINE void core_nearest(const struct contact_solid *solid, const struct contact_lanes *own,
                              struct contact_solid_point *to)
{
    if (solid->endless) {
        nearest_to_plane(own, to);
        return;
    }
    const double size = lanes_size(own) + solid->half[0] + solid->half[1] + solid->half[2];
    struct core_point point;
    nearest_point(solid, own, NOISE * size, &point);
    const double length = sqrt(point.square);
    if (!(length > NOISE * size)) {
        nearest_inside(solid, own, to);
        return;
    }
    to->normal = (phys_vec){point.away[0], point.away[1], point.away[2], 0} / length;
    to->gap = length - solid->radius;
    for (int k = 0; k < 3; k++)
        to->weight[k] = point.weight[k];
}

PHYS_KERNEL(contact_core_nearest,
            (const struct contact_solid *solid, const struct contact_lanes *own,
             struct contact_solid_point *to),
            (solid, own, to))
{
    core_nearest(solid, own, to);
}

/* ---- In the room ---- */

PHYS_INLINE uint32_t feature_of(const double weight[3])
{
    uint32_t n = 0, last = 0, without = 0;
    for (uint32_t k = 0; k < 3; k++) {
        n += weight[k] > 0;
        last = weight[k] > 0 ? k : last;
        without = weight[k] > 0 ? without : k;
    }
    return n == 3   ? CONTACT_IN_TRIANGLE
           : n == 2 ? CONTACT_ON_EDGE + (without + 1) % 3
                    : CONTACT_ON_CORNER + last;
}

/* The way in the step of a point of the shape, given in the core's axes. */
PHYS_INLINE void shape_way(const struct contact_solid *solid, const double own[3], phys_vec *way)
{
    const struct contact_place *begin = solid->place + CONTACT_BEGIN,
                               *end = solid->place + CONTACT_END;
    double was[3], is[3];
    contact_way_out(begin, own, was);
    contact_way_out(end, own, is);
    *way = (phys_vec){is[0] - was[0], is[1] - was[1], is[2] - was[2], 0} + (end->at - begin->at);
}

PHYS_KERNEL(contact_solid_nearest,
            (const struct contact_solid *solid, enum contact_end end, const phys_vec x[3],
             struct contact_solid_point *to),
            (solid, end, x, to))
{
    struct contact_lanes own;
    double at[3], normal[3], out[3];
    contact_core_lanes(solid->place + end, x, &own);
    core_nearest(solid, &own, to);
    to->feature = feature_of(to->weight);
    for (int c = 0; c < 3; c++) {
        const double *w = to->weight;
        normal[c] = to->normal[c];
        at[c] = w[0] * own.c[c][0] + w[1] * own.c[c][1] + w[2] * own.c[c][2] - to->gap * normal[c];
    }
    contact_way_out(solid->place + end, normal, out);
    to->normal = (phys_vec){out[0], out[1], out[2], 0};
    to->velocity = (phys_vec){0};
    if (solid->moves)
        shape_way(solid, at, &to->velocity);
    to->velocity *= solid->rate;
}
