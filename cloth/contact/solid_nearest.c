/* The point of a triangle that is nearest to a convex core, in the core's axes, by the algorithm of
 * Gilbert, Johnson & Keerthi (A Fast Procedure for Computing the Distance Between Complex Objects
 * in Three-Dimensional Space, 1988): ever nearer points of the differences triangle - core, each
 * that of the hull of at most four of them. It begins with the corner that is nearest, where it
 * often ends at once. A bounded number of rounds; what is left then costs the best of a force
 * alone, for certificates measure along whatever direction this finds. */
#include "cloth/contact/solid.h"

#include <math.h>

enum { ROUNDS = 32 };
/* Parts of a squared distance, and of its size, by which another round has to shorten it. */
static const double ENOUGH = 1e-13, NOISE = 16 * 0x1p-53;

/* ---- The core ---- */

PHYS_INLINE double clamp(double value, double half)
{
    return value < -half ? -half : value > half ? half : value;
}

void contact_core_clamp(const struct contact_solid *solid, const phys_vec *own, phys_vec *nearest)
{
    const phys_vec x = *own;
    const double *half = solid->half;
    phys_vec at = {clamp(x[0], half[0]), 0, 0, 0};
    if (solid->round) {
        const double far = sqrt(x[1] * x[1] + x[2] * x[2]),
                     part = far > half[1] ? half[1] / far : 1;
        at[1] = part * x[1];
        at[2] = part * x[2];
    } else {
        at[1] = clamp(x[1], half[1]);
        at[2] = clamp(x[2], half[2]);
    }
    *nearest = at;
}

double contact_core_support(const struct contact_solid *solid, const phys_vec *way)
{
    const phys_vec n = *way;
    const double *half = solid->half;
    const double along = fabs(n[0]) * half[0];
    if (solid->round)
        return along + half[1] * sqrt(n[1] * n[1] + n[2] * n[2]);
    return along + fabs(n[1]) * half[1] + fabs(n[2]) * half[2];
}

/* The point of the core that is farthest along a direction. */
static void core_farthest(const struct contact_solid *solid, const phys_vec *way, phys_vec *at)
{
    const phys_vec n = *way;
    const double *half = solid->half, across = sqrt(n[1] * n[1] + n[2] * n[2]);
    *at = (phys_vec){copysign(half[0], n[0]), copysign(half[1], n[1]), copysign(half[2], n[2]), 0};
    if (!solid->round)
        return;
    (*at)[1] = across > 0 ? half[1] * (n[1] / across) : half[1];
    (*at)[2] = across > 0 ? half[1] * (n[2] / across) : 0;
}

/* ---- The hull of up to four points ---- */

struct simplex {
    int n;
    phys_vec point[4]; /* corner - point of the core */
    int corner[4];
    double weight[4];
};

static void keep_one(const struct simplex *from, int a, struct simplex *to)
{
    *to = (struct simplex){.n = 1, .weight = {1}};
    to->point[0] = from->point[a];
    to->corner[0] = from->corner[a];
}

static void keep_two(const struct simplex *from, int a, int b, double part, struct simplex *to)
{
    *to = (struct simplex){.n = 2, .weight = {1 - part, part}};
    to->point[0] = from->point[a];
    to->point[1] = from->point[b];
    to->corner[0] = from->corner[a];
    to->corner[1] = from->corner[b];
}

static void simplex_at(const struct simplex *simplex, phys_vec *at)
{
    *at = (phys_vec){0};
    for (int i = 0; i < simplex->n; i++)
        *at += simplex->weight[i] * simplex->point[i];
}

/* The point that is nearest to the origin on the edge from a to b. */
static void edge_nearest(const struct simplex *from, int a, int b, struct simplex *to)
{
    const phys_vec ab = from->point[b] - from->point[a];
    const double along = -phys_dot(&ab, from->point + a), square = phys_dot(&ab, &ab);
    if (!(along > 0))
        keep_one(from, a, to);
    else if (along >= square)
        keep_one(from, b, to);
    else
        keep_two(from, a, b, along / square, to);
}

static void nearer_edge(const struct simplex *from, int a, int b, int c, struct simplex *to)
{
    const int edge[3][2] = {{a, b}, {b, c}, {c, a}};
    double least = INFINITY;
    keep_one(from, a, to);
    for (int i = 0; i < 3; i++) {
        struct simplex one;
        phys_vec at;
        edge_nearest(from, edge[i][0], edge[i][1], &one);
        simplex_at(&one, &at);
        const double square = phys_dot(&at, &at);
        if (square < least) {
            least = square;
            *to = one;
        }
    }
}

PHYS_INLINE void cross(const phys_vec *left, const phys_vec *right, phys_vec *product)
{
    const phys_vec u = *left, v = *right;
    *product = (phys_vec){u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                          u[0] * v[1] - u[1] * v[0], 0};
}

/* On the triangle of a, b and c: inside, where its three parts as seen from the foot of the origin
 * are all turned alike, else on an edge. */
static void face_nearest(const struct simplex *from, int a, int b, int c, struct simplex *to)
{
    const phys_vec *p = from->point, ab = p[b] - p[a], ac = p[c] - p[a];
    phys_vec normal, bc, ca;
    cross(&ab, &ac, &normal);
    cross(p + b, p + c, &bc);
    cross(p + c, p + a, &ca);
    const double square = phys_dot(&normal, &normal), of_a = phys_dot(&bc, &normal) / square,
                 of_b = phys_dot(&ca, &normal) / square, of_c = 1 - of_a - of_b;
    if (!(of_a > 0 && of_b > 0 && of_c > 0)) {
        nearer_edge(from, a, b, c, to);
        return;
    }
    *to = (struct simplex){.n = 3, .weight = {of_a, of_b, of_c}};
    const int kept[3] = {a, b, c};
    for (int i = 0; i < 3; i++) {
        to->point[i] = from->point[kept[i]];
        to->corner[i] = from->corner[kept[i]];
    }
}

/* Whether the origin lies on the same side of a face as the fourth point. */
static bool same_side(const phys_vec *p, int a, int b, int c, int d)
{
    const phys_vec ab = p[b] - p[a], ac = p[c] - p[a], ad = p[d] - p[a];
    phys_vec normal;
    cross(&ab, &ac, &normal);
    return -phys_dot(&normal, p + a) * phys_dot(&normal, &ad) > 0;
}

/* Of all four; false: the origin is inside. */
static bool solid_nearest(const struct simplex *from, struct simplex *to)
{
    static const int face[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
    double least = INFINITY;
    bool inside = true;
    keep_one(from, 0, to);
    for (int i = 0; i < 4; i++) {
        const int *f = face[i];
        struct simplex one;
        phys_vec at;
        inside = inside && same_side(from->point, f[0], f[1], f[2], f[3]);
        face_nearest(from, f[0], f[1], f[2], &one);
        simplex_at(&one, &at);
        const double square = phys_dot(&at, &at);
        if (square < least) {
            least = square;
            *to = one;
        }
    }
    return !inside && least < INFINITY;
}

static bool simplex_nearest(const struct simplex *from, struct simplex *to)
{
    if (from->n == 4)
        return solid_nearest(from, to);
    if (from->n == 3)
        face_nearest(from, 0, 1, 2, to);
    else
        edge_nearest(from, 0, 1, to);
    return true;
}

/* ---- The nearest point ---- */

/* The corner whose distance from the core is least, the first of equals. */
static void begin_simplex(const struct contact_solid *solid, const phys_vec own[3],
                          struct simplex *simplex)
{
    double least = INFINITY;
    *simplex = (struct simplex){.n = 1, .weight = {1}};
    for (int k = 0; k < 3; k++) {
        phys_vec at;
        contact_core_clamp(solid, own + k, &at);
        const phys_vec away = own[k] - at;
        const double square = phys_dot(&away, &away);
        if (square < least) {
            least = square;
            simplex->point[0] = away;
            simplex->corner[0] = k;
        }
    }
}

/* Adds the difference that is farthest against a direction; false: it is no nearer to the origin
 * along it than the direction's own end is. */
static bool add_point(const struct contact_solid *solid, const phys_vec own[3], const phys_vec *way,
                      double size, struct simplex *simplex)
{
    const double square = phys_dot(way, way);
    phys_vec at;
    int corner = 0;
    double least = INFINITY;
    for (int k = 0; k < 3; k++) {
        const double along = phys_dot(way, own + k);
        corner = along < least ? k : corner;
        least = fmin(along, least);
    }
    if (!(square - (least - contact_core_support(solid, way)) >
          ENOUGH * square + NOISE * size * sqrt(square)))
        return false;
    core_farthest(solid, way, &at);
    simplex->point[simplex->n] = own[corner] - at;
    simplex->corner[simplex->n] = corner;
    simplex->n++;
    return true;
}

/* Fills the weights; false: the triangle meets the core. */
static bool nearest_weights(const struct contact_solid *solid, const phys_vec own[3], double size,
                            double weight[3])
{
    struct simplex simplex;
    phys_vec way;
    bool apart = true;
    begin_simplex(solid, own, &simplex);
    simplex_at(&simplex, &way);
    for (int i = 0; i < ROUNDS && apart; i++) {
        struct simplex next, more = simplex;
        phys_vec shorter;
        if (!add_point(solid, own, &way, size, &more))
            break;
        apart = simplex_nearest(&more, &next);
        if (!apart)
            break;
        simplex_at(&next, &shorter);
        if (!(phys_dot(&shorter, &shorter) < phys_dot(&way, &way)))
            break;
        simplex = next;
        way = shorter;
    }
    for (int k = 0; k < 3; k++)
        weight[k] = 0;
    for (int i = 0; i < simplex.n; i++)
        weight[simplex.corner[i]] += simplex.weight[i];
    return apart;
}

/* ---- Inside ---- */

struct way_out {
    phys_vec normal;
    double gap;
    int corner;
};

static void try_way(const struct contact_solid *solid, const phys_vec own[3], const phys_vec *way,
                    struct way_out *best)
{
    const double square = phys_dot(way, way);
    if (!(square > CONTACT_TINY))
        return;
    const phys_vec normal = *way / sqrt(square);
    int corner = 0;
    double least = INFINITY;
    for (int k = 0; k < 3; k++) {
        const double along = phys_dot(&normal, own + k);
        corner = along < least ? k : corner;
        least = fmin(along, least);
    }
    const double gap = least - contact_core_support(solid, &normal) - solid->radius;
    if (gap > best->gap)
        *best = (struct way_out){normal, gap, corner};
}

/* The shortest way out of those along the axes, the triangle's normal and, of what is round, along
 * the radius of each corner. */
static void nearest_inside(const struct contact_solid *solid, const phys_vec own[3],
                           struct contact_solid_point *to)
{
    const phys_vec ab = own[1] - own[0], ac = own[2] - own[0];
    struct way_out best = {.normal = {1, 0, 0, 0}, .gap = -INFINITY};
    phys_vec way;
    cross(&ab, &ac, &way);
    try_way(solid, own, &way, &best);
    way = -way;
    try_way(solid, own, &way, &best);
    for (int c = 0; c < 3; c++) {
        way = (phys_vec){0};
        way[c] = 1;
        try_way(solid, own, &way, &best);
        way[c] = -1;
        try_way(solid, own, &way, &best);
        way = (phys_vec){0, own[c][1], own[c][2], 0};
        try_way(solid, own, &way, &best);
    }
    to->normal = best.normal;
    to->gap = best.gap;
    for (int k = 0; k < 3; k++)
        to->weight[k] = k == best.corner;
}

static void nearest_to_plane(const phys_vec own[3], struct contact_solid_point *to)
{
    int lowest = 0;
    for (int k = 1; k < 3; k++)
        lowest = own[k][0] < own[lowest][0] ? k : lowest;
    to->normal = (phys_vec){1, 0, 0, 0};
    to->gap = own[lowest][0];
    for (int k = 0; k < 3; k++)
        to->weight[k] = k == lowest;
}

void contact_core_nearest(const struct contact_solid *solid, const phys_vec own[3],
                          struct contact_solid_point *to)
{
    if (solid->endless) {
        nearest_to_plane(own, to);
        return;
    }
    double size = solid->half[0] + solid->half[1] + solid->half[2];
    for (int c = 0; c < 3; c++)
        size += fabs(own[0][c]) + fabs(own[1][c]) + fabs(own[2][c]);
    if (!nearest_weights(solid, own, size, to->weight)) {
        nearest_inside(solid, own, to);
        return;
    }
    phys_vec at = {0}, foot;
    for (int k = 0; k < 3; k++)
        at += to->weight[k] * own[k];
    contact_core_clamp(solid, &at, &foot);
    const phys_vec away = at - foot;
    const double length = sqrt(phys_dot(&away, &away));
    if (!(length > NOISE * size)) {
        nearest_inside(solid, own, to);
        return;
    }
    to->normal = away / length;
    to->gap = length - solid->radius;
}

/* ---- In the room ---- */

static uint32_t feature_of(const double weight[3])
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

void contact_solid_nearest(const struct contact_solid *solid, enum contact_end end,
                           const phys_vec x[3], struct contact_solid_point *to)
{
    const struct contact_place *begin = solid->place + CONTACT_BEGIN,
                               *last = solid->place + CONTACT_END;
    phys_vec own[3], at = {0}, was, is;
    for (int k = 0; k < 3; k++)
        contact_place_own(solid->place + end, x + k, own + k);
    contact_core_nearest(solid, own, to);
    to->feature = feature_of(to->weight);
    for (int k = 0; k < 3; k++)
        at += to->weight[k] * own[k];
    at -= to->gap * to->normal;
    contact_place_out(begin, &at, &was);
    contact_place_out(last, &at, &is);
    to->velocity = solid->rate * ((is - was) + (last->at - begin->at));
    contact_place_out(solid->place + end, &to->normal, &to->normal);
}
