/* Two triangles with a common point have one on an edge of one of them. The common part of two
 * triangles that share a corner is convex and has this corner. If it has more points, it ends at
 * the edge opposite to the corner in one of them. Every decision follows from signs of
 * verify/orient.h alone. */
#include "cloth/verify/orient.h"
#include "cloth/verify/verify.h"

/* ---- In a plane ---- */

/* True if two line segments meet as seen along an axis; i and j are the other axes. */
static bool lines_meet_seen(const double *p, const double *q, const double *a, const double *b,
                            int i, int j)
{
    const int of_a = verify_orient_seen(p, q, a, i, j), of_b = verify_orient_seen(p, q, b, i, j);
    const int of_p = verify_orient_seen(a, b, p, i, j), of_q = verify_orient_seen(a, b, q, i, j);
    return of_a * of_b <= 0 && of_p * of_q <= 0;
}

static bool spans_meet(double p, double q, double a, double b)
{
    const double low = p < q ? p : q, high = p < q ? q : p;
    return (a >= low || b >= low) && (a <= high || b <= high);
}

/* In a plane, two segments meet if they seem to along all three axes: one of these shows the
 * plane from its front. On one line, the spans of coordinates decide. */
static bool lines_meet(const double *p, const double *q, const double *a, const double *b)
{
    bool meet = true;
    for (int c = 0; c < 3 && meet; c++)
        meet = spans_meet(p[c], q[c], a[c], b[c]);
    meet = meet && verify_orient(p, q, a, b) == 0;
    for (int c = 0; c < 3 && meet; c++)
        meet = lines_meet_seen(p, q, a, b, (c + 1) % 3, (c + 2) % 3);
    return meet;
}

/* True if a line separates an edge from a triangle in the same plane, as seen along an axis. The
 * line of the edge or of a side of the triangle is enough. side: the sign of the triangle's area
 * in this view. */
static bool verify_meet_are_apart(const double *p, const double *q, const double *const x[3],
                                  int side, int i, int j)
{
    for (int k = 0; k < 3; k++) {
        const double *a = x[k], *b = x[(k + 1) % 3];
        if (side * verify_orient_seen(a, b, p, i, j) < 0 &&
            side * verify_orient_seen(a, b, q, i, j) < 0)
            return true;
    }
    const int of_a = verify_orient_seen(p, q, x[0], i, j);
    return of_a && verify_orient_seen(p, q, x[1], i, j) == of_a &&
           verify_orient_seen(p, q, x[2], i, j) == of_a;
}

/* The axis along which a triangle looks largest, up to rounding. */
static int find_front(const double *a, const double *b, const double *c)
{
    double most = -1;
    int front = 0;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const double area = (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
        const double size = area < 0 ? -area : area;
        front = size > most ? k : front;
        most = size > most ? size : most;
    }
    return front;
}

/* An edge and a triangle in one plane, or a triangle without area. */
static bool edge_meets_flat(const double *p, const double *q, const double *const x[3])
{
    const int front = find_front(x[0], x[1], x[2]);
    for (int n = 0; n < 3; n++) {
        const int k = (front + n) % 3, i = (k + 1) % 3, j = (k + 2) % 3;
        const int side = verify_orient_seen(x[0], x[1], x[2], i, j);
        if (side)
            return !verify_meet_are_apart(p, q, x, side, i, j);
    }
    return lines_meet(p, q, x[0], x[1]) || lines_meet(p, q, x[1], x[2]) ||
           lines_meet(p, q, x[2], x[0]);
}

/* ---- Edges and triangles ---- */

/* True if the edge p q meets the triangle. side: that of p and of q from its plane. */
static bool edge_meets(const double *p, const double *q, const int side[2],
                       const double *const x[3])
{
    if (side[0] * side[1] > 0)
        return false;
    if (!side[0] && !side[1])
        return edge_meets_flat(p, q, x);
    const int ab = verify_orient(p, q, x[0], x[1]), bc = verify_orient(p, q, x[1], x[2]);
    if (ab * bc < 0)
        return false;
    const int ca = verify_orient(p, q, x[2], x[0]);
    return ab * ca >= 0 && bc * ca >= 0;
}

/* One triangle of a pair: its corners, its box, and the corner that the other one shares, or -1. */
struct side {
    const double *x[3];
    double low[3], high[3];
    int shared;
};

static void verify_meet_take_side(const double (*x)[3], const uint32_t corner[3], int shared,
                                  struct side *to)
{
    to->shared = shared;
    for (int i = 0; i < 3; i++)
        to->x[i] = x[corner[i]];
    for (int c = 0; c < 3; c++) {
        const double u = to->x[0][c], v = to->x[1][c], w = to->x[2][c];
        const double low = u < v ? u : v, high = u < v ? v : u;
        to->low[c] = low < w ? low : w;
        to->high[c] = high < w ? w : high;
    }
}

/* Marks the edges that may meet the other triangle; edge i begins at corner i. Edges at a shared
 * corner do not count. Boxes, compared exactly, rule out most of the others. */
static int verify_meet_find_edges(const struct side *of, const struct side *other, bool edge[3])
{
    int n = 0;
    for (int i = 0; i < 3; i++) {
        const double *p = of->x[i], *q = of->x[(i + 1) % 3];
        edge[i] = of->shared < 0 || of->shared == (i + 2) % 3;
        for (int c = 0; c < 3 && edge[i]; c++)
            edge[i] = spans_meet(p[c], q[c], other->low[c], other->high[c]);
        n += edge[i];
    }
    return n;
}

/* Sides of the corners of a triangle from the plane of another; false if all but a shared one are
 * on one side of it. */
static bool find_sides(const struct side *of, const struct side *plane, int side[3])
{
    int sum = 0, n = 0;
    for (int i = 0; i < 3; i++) {
        side[i] =
            i == of->shared ? 0 : verify_orient(plane->x[0], plane->x[1], plane->x[2], of->x[i]);
        sum += side[i];
        n += i != of->shared;
    }
    return sum < n && sum > -n;
}

static bool edges_meet(const struct side *of, const struct side *other, const bool edge[3],
                       const int side[3])
{
    bool meet = false;
    for (int i = 0; i < 3 && !meet; i++) {
        const int j = (i + 1) % 3, ends[2] = {side[i], side[j]};
        meet = edge[i] && edge_meets(of->x[i], of->x[j], ends, other->x);
    }
    return meet;
}

/* The number of shared corners; of[]: the last one in each triangle. */
static int count_shared(const uint32_t a[3], const uint32_t b[3], int of[2])
{
    int n = 0;
    of[0] = of[1] = -1;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (a[i] == b[j]) {
                of[0] = i;
                of[1] = j;
                n++;
            }
    return n;
}

bool verify_meet(const double (*x)[3], const uint32_t a[3], const uint32_t b[3])
{
    int shared[2], side_a[3], side_b[3];
    struct side of_a, of_b;
    bool edge_a[3], edge_b[3];
    if (count_shared(a, b, shared) > 1)
        return false;
    verify_meet_take_side(x, a, shared[0], &of_a);
    verify_meet_take_side(x, b, shared[1], &of_b);
    const int n_a = verify_meet_find_edges(&of_a, &of_b, edge_a),
              n_b = verify_meet_find_edges(&of_b, &of_a, edge_b);
    return n_a + n_b && find_sides(&of_b, &of_a, side_b) && find_sides(&of_a, &of_b, side_a) &&
           (edges_meet(&of_b, &of_a, edge_b, side_b) || edges_meet(&of_a, &of_b, edge_a, side_a));
}
