/* The gap of a body is the distance to its nearest triangle; of equally near ones, the first of the
 * mesh. The pseudo-normal there gives the sign (Baerentzen & Aanaes, Signed Distance Computation
 * Using the Angle Weighted Pseudonormal, 2005). It is also the normal of points on an edge or a
 * corner. No result depends on the order in which the tree is walked. */
#include "cloth/contact/body.h"
#include "cloth/contact/shape.h"

#include <math.h>
#include <string.h>

enum { STACK = 64 }; /* nodes: three more for each of at most 15 levels */
/* A box holds nothing nearer if its squared distance exceeds the nearest one by this part: both may
 * be rounded, or have lost two bits. */
static const double MORE = 1 + 1e-12;
/* m^2: from farther away a body is a point, and products of differences may be infinite. */
static const double FAR = 1e60;

typedef float float_lanes __attribute__((vector_size(16)));
typedef int64_t lane_mask __attribute__((vector_size(32)));

/* The place of a triangle's nearest point: in it, on the edge after a corner, on a corner. */
enum feature { FACE, EDGE = 1, CORNER = EDGE + 3 };

struct nearest {
    double square; /* m^2, of the distance */
    uint32_t facet, number;
    uint32_t feature;
    phys_vec at; /* m */
};

const struct contact_body *contact_bodies_at(const struct contact_bodies *bodies, uint32_t number)
{
    const char *at = number ? bodies->memory : NULL;
    for (uint32_t i = 1; i < number; i++)
        at += ((const struct contact_body *)(const void *)at)->bytes;
    return (const void *)at;
}

/* ---- The nearest point ---- */

/* The nearest point of a triangle, by the regions of its plane (Ericson, Real-Time Collision
 * Detection, 5.1.5). */
PHYS_INLINE uint32_t facet_nearest(const phys_vec *a, const phys_vec *b, const phys_vec *c,
                                   const phys_vec *x, phys_vec *at)
{
    const phys_vec ab = *b - *a, ac = *c - *a, ax = *x - *a, bx = *x - *b, cx = *x - *c;
    const double ab_a = phys_dot(&ab, &ax), ac_a = phys_dot(&ac, &ax);
    if (ab_a <= 0 && ac_a <= 0)
        return *at = *a, CORNER;
    const double ab_b = phys_dot(&ab, &bx), ac_b = phys_dot(&ac, &bx);
    if (ab_b >= 0 && ac_b <= ab_b)
        return *at = *b, CORNER + 1;
    const double of_c = ab_a * ac_b - ab_b * ac_a;
    if (of_c <= 0 && ab_a >= 0 && ab_b <= 0)
        return *at = *a + ab_a / (ab_a - ab_b) * ab, EDGE;
    const double ab_c = phys_dot(&ab, &cx), ac_c = phys_dot(&ac, &cx);
    if (ac_c >= 0 && ab_c <= ac_c)
        return *at = *c, CORNER + 2;
    const double of_b = ab_c * ac_a - ab_a * ac_c;
    if (of_b <= 0 && ac_a >= 0 && ac_c <= 0)
        return *at = *a + ac_a / (ac_a - ac_c) * ac, EDGE + 2;
    const double of_a = ab_b * ac_c - ab_c * ac_b, to_c = ac_b - ab_b, to_b = ab_c - ac_c;
    if (of_a <= 0 && to_c >= 0 && to_b >= 0)
        return *at = *b + to_c / (to_c + to_b) * (*c - *b), EDGE + 1;
    const double part = 1 / (of_a + of_b + of_c);
    return *at = *a + of_b * part * ab + of_c * part * ac, FACE;
}

PHYS_INLINE void try_facet(const struct contact_body *body, uint32_t f, const phys_vec *x,
                           struct nearest *best)
{
    const phys_vec *vertex = contact_body_vertices(body);
    const struct contact_facet *facet = contact_body_facets(body) + f;
    phys_vec at;
    const uint32_t feature = facet_nearest(vertex + facet->corner[0], vertex + facet->corner[1],
                                           vertex + facet->corner[2], x, &at);
    const phys_vec away = *x - at;
    const double square = phys_dot(&away, &away);
    if (square < best->square || (square <= best->square && facet->number < best->number))
        *best = (struct nearest){square, f, facet->number, feature, at};
}

PHYS_INLINE void larger(const phys_vec *a, const phys_vec *b, phys_vec *most)
{
    const lane_mask is = *a > *b;
    *most = (phys_vec)(((lane_mask)*a & is) | ((lane_mask)*b & ~is));
}

PHYS_INLINE void load_lanes(const float from[4], phys_vec *to)
{
    *to = __builtin_convertvector(*(const float_lanes *)(const void *)from, phys_vec);
}

/* Squares of the distances of a point from the four boxes of a node. */
PHYS_INLINE void node_squares(const struct contact_node *node, const phys_vec *x, phys_vec *square)
{
    *square = (phys_vec){0};
    PHYS_UNROLL
    for (int c = 0; c < 3; c++) {
        phys_vec low, high, out;
        const phys_vec here = {(*x)[c], (*x)[c], (*x)[c], (*x)[c]}, zero = {0};
        load_lanes(node->low[c], &low);
        load_lanes(node->high[c], &high);
        const phys_vec under = low - here, over = here - high;
        larger(&under, &over, &out);
        larger(&out, &zero, &out);
        *square += out * out;
    }
}

struct visit {
    double square;
    uint32_t child;
};

PHYS_INLINE void sort_pair(uint64_t *a, uint64_t *b)
{
    const uint64_t less = *a < *b ? *a : *b, more = *a < *b ? *b : *a;
    *a = more;
    *b = less;
}

/* Puts those parts of a node that may hold something nearer on the stack, the nearest on top. No
 * branch depends on which they are: squares are sorted as the whole numbers that their bits are,
 * with the number of the part in place of the last two. */
PHYS_INLINE uint32_t push_parts(const struct contact_node *node, const phys_vec *square,
                                double bound, struct visit *stack, uint32_t n)
{
    uint64_t key[4];
    memcpy(key, square, sizeof key);
    PHYS_UNROLL
    for (uint32_t i = 0; i < 4; i++)
        key[i] = (key[i] & ~UINT64_C(3)) | i;
    sort_pair(key, key + 1);
    sort_pair(key + 2, key + 3);
    sort_pair(key, key + 2);
    sort_pair(key + 1, key + 3);
    sort_pair(key + 1, key + 2);
    PHYS_UNROLL
    for (uint32_t i = 0; i < 4; i++) {
        const uint64_t bits = key[i] & ~UINT64_C(3);
        memcpy(&stack[n].square, &bits, sizeof bits);
        stack[n].child = node->child[key[i] & 3];
        n += stack[n].square <= bound;
    }
    return n;
}

/* The nearest point of a body; *best is the nearest so far. */
PHYS_INLINE void body_nearest(const struct contact_body *body, const phys_vec *x,
                              struct nearest *best)
{
    const struct contact_node *nodes = contact_body_nodes(body);
    struct visit stack[STACK];
    uint32_t n = 0;
    stack[n++] = (struct visit){0, 0};
    while (n) {
        const struct visit visit = stack[--n];
        phys_vec square;
        if (visit.square > best->square * MORE)
            continue;
        if (visit.child & CONTACT_IS_LEAF) {
            const uint32_t first = contact_leaf_first(visit.child);
            for (uint32_t i = 0; i < contact_leaf_n(visit.child); i++)
                try_facet(body, first + i, x, best);
            continue;
        }
        node_squares(nodes + visit.child, x, &square);
        n = push_parts(nodes + visit.child, &square, best->square * MORE, stack, n);
    }
}

/* ---- The gap ---- */

PHYS_INLINE void feature_normal(const struct contact_body *body, const struct nearest *nearest,
                                phys_vec *normal)
{
    const struct contact_facet *facet = contact_body_facets(body) + nearest->facet;
    const phys_vec *of_facet = contact_facet_normals(body);
    *normal = of_facet[nearest->facet];
    if (nearest->feature >= CORNER) {
        *normal = contact_body_normals(body)[facet->corner[nearest->feature - CORNER]];
    } else if (nearest->feature >= EDGE) {
        const phys_vec sum = *normal + of_facet[facet->neighbour[nearest->feature - EDGE]];
        const double square = phys_dot(&sum, &sum);
        *normal = square > CONTACT_TINY ? sum / sqrt(square) : *normal;
    }
}

/* The velocity of the nearest point of a body with frames: those of the corners by its weights. */
static void feature_velocity(const struct contact_body *body, const struct nearest *nearest,
                             phys_vec *velocity)
{
    const uint32_t *corner = contact_body_facets(body)[nearest->facet].corner;
    const phys_vec *x = contact_body_vertices(body), *v = contact_body_velocities(body);
    const phys_vec ab = x[corner[1]] - x[corner[0]], ac = x[corner[2]] - x[corner[0]];
    const phys_vec to = nearest->at - x[corner[0]];
    const double bb = phys_dot(&ab, &ab), bc = phys_dot(&ab, &ac), cc = phys_dot(&ac, &ac);
    const double pb = phys_dot(&to, &ab), pc = phys_dot(&to, &ac), area = bb * cc - bc * bc;
    const double b = area > 0 ? (cc * pb - bc * pc) / area : 0;
    const double c = area > 0 ? (bb * pc - bc * pb) / area : 0;
    *velocity =
        v[corner[0]] + b * (v[corner[1]] - v[corner[0]]) + c * (v[corner[2]] - v[corner[0]]);
}

PHYS_INLINE void nearest_hit(const struct contact_body *body, const struct nearest *nearest,
                             const phys_vec *x, struct contact_hit *hit)
{
    const phys_vec away = *x - nearest->at;
    const double length = sqrt(nearest->square);
    phys_vec normal;
    feature_normal(body, nearest, &normal);
    const double out = phys_dot(&away, &normal);
    hit->gap = nearest->feature == FACE ? out : out < 0 ? -length : length;
    hit->normal = nearest->feature == FACE || length <= body->near ? normal : away / hit->gap;
    if (body->n_frames)
        feature_velocity(body, nearest, &hit->velocity);
}

/* Points that follow each other are near to each other: the facet of one bounds the next. */
PHYS_KERNEL(contact_body_closest,
            (const struct contact_body *body, size_t n, const phys_vec *x, struct contact_hit *hit),
            (body, n, x, hit))
{
    uint32_t last = 0;
    for (size_t i = 0; i < n; i++) {
        const double far = phys_dot(x + i, x + i);
        struct nearest nearest = {.square = INFINITY, .number = UINT32_MAX};
        if (!(far < FAR)) { /* so is NaN */
            hit[i].gap = sqrt(far);
            hit[i].normal = (phys_vec){0, 1, 0, 0};
            continue;
        }
        try_facet(body, last, x + i, &nearest);
        body_nearest(body, x + i, &nearest);
        nearest_hit(body, &nearest, x + i, hit + i);
        last = nearest.facet;
    }
}

static void body_closest(const double *value, const struct contact_body *body, size_t n,
                         const phys_vec *x, struct contact_hit *hit)
{
    (void)value;
    contact_body_closest(body, n, x, hit);
}

/* ---- Apart ---- */

struct box {
    double low[3], high[3];
};

static bool contact_body_boxes_meet(const struct box *box, const struct contact_node *node,
                                    int part)
{
    bool meet = true;
    for (int c = 0; c < 3; c++)
        meet = meet && box->low[c] <= (double)node->high[c][part] &&
               box->high[c] >= (double)node->low[c][part];
    return meet;
}

/* True if no leaf of the tree meets a box. */
static bool body_leaves(const struct contact_body *body, const struct box *box)
{
    const struct contact_node *nodes = contact_body_nodes(body);
    uint32_t stack[STACK], n = 0;
    stack[n++] = 0;
    while (n) {
        const struct contact_node *node = nodes + stack[--n];
        for (int i = 0; i < 4; i++) {
            if (!contact_body_boxes_meet(box, node, i))
                continue;
            if (node->child[i] & CONTACT_IS_LEAF)
                return false;
            stack[n++] = node->child[i];
        }
    }
    return true;
}

/* A box that no triangle meets is all outside if one of its points is. */
static bool body_apart(const double *value, const struct contact_body *body, size_t n,
                       const phys_vec *x)
{
    struct box box;
    struct contact_hit hit;
    bool beside = false;
    (void)value;
    for (int c = 0; c < 3; c++) {
        box.low[c] = box.high[c] = x[0][c];
        for (size_t i = 0; i < n; i++) {
            if (!(fabs(x[i][c]) < INFINITY))
                return false;
            box.low[c] = fmin(box.low[c], x[i][c]);
            box.high[c] = fmax(box.high[c], x[i][c]);
        }
        beside = beside || box.low[c] > body->high[c] || box.high[c] < body->low[c];
    }
    if (beside)
        return true;
    if (!body_leaves(body, &box))
        return false;
    contact_body_closest(body, 1, x, &hit);
    return hit.gap > 0;
}

static void body_core(const double *value, const struct contact_body *body,
                      struct contact_core *core)
{
    struct phys_key middle = {.rotate = {1, 0, 0, 0}};
    (void)value;
    *core = (struct contact_core){0};
    for (int c = 0; c < 3; c++) {
        middle.translate[c] = (body->low[c] + body->high[c]) / 2;
        core->half[c] = (body->high[c] - body->low[c]) / 2;
    }
    phys_pose_at(1, &middle, (const double[3]){0}, 0, &core->axes);
}

static const struct contact_parameter parameters[] = {{NULL, 0}};
const struct contact_kind contact_body_kind = {.name = "body",
                                               .parameter = parameters,
                                               .closest = body_closest,
                                               .apart = body_apart,
                                               .core = body_core};
