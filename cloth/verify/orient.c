/* A determinant is first computed in doubles. If rounding may have changed the sign, it is computed
 * again as an expansion: an exact sum of doubles that do not overlap, the largest last (Shewchuk,
 * Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates, 1997; theorems
 * 6, 7, 13, 18 and 19). Differences of coordinates are expansions of two parts, so nothing is lost
 * before the products. Every number here is a multiple of 2^-252 (of a difference), of 2^-504 or of
 * 2^-756 (of the determinants), and below 2^610. */
#include "cloth/verify/orient.h"

#include <math.h>

/* Half an ulp of 1. The bounds of Shewchuk 1997, section 4.4: of the error of the determinant in
 * doubles, against the same sum of magnitudes. */
#define EPSILON 0x1p-53
static const double BOUND_3 = (7 + 56 * EPSILON) * EPSILON;
static const double BOUND_2 = (3 + 16 * EPSILON) * EPSILON;

/* Parts of: a difference, a product of two of them, a 2 x 2 minor, its product with a difference,
 * the determinant. */
enum { PARTS_1 = 2, PARTS_PRODUCT = 8, PARTS_2 = 16, PARTS_TERM = 64, PARTS_3 = 192 };

/* ---- Expansions ---- */

static void add_two(double a, double b, double *sum, double *rest)
{
    const double x = a + b, of_b = x - a, of_a = x - of_b;
    *rest = (a - of_a) + (b - of_b);
    *sum = x;
}

static void split(double a, double *high, double *low)
{
    const double big = 0x8000001p0 * a; /* 2^27 + 1 */
    *high = big - (big - a);
    *low = a - *high;
}

static void multiply_two(double a, double b, double *product, double *rest)
{
    const double x = a * b;
    double a_high, a_low, b_high, b_low;
    split(a, &a_high, &a_low);
    split(b, &b_high, &b_low);
    *rest = a_low * b_low - (((x - a_high * b_high) - a_low * b_high) - a_high * b_low);
    *product = x;
}

/* Appends a part, unless it is 0; returns how many there are. */
static int put_part(double *to, int n, double part)
{
    to[n] = part;
    return n + (part < 0 || part > 0);
}

/* Sums of n and of m parts; at most n + m are left. */
static int orient_add_parts(int n, const double *e, int m, const double *f, double *to)
{
    int i = 0, j = 0, count = 0;
    double sum = 0, rest;
    while (i < n || j < m) {
        const int of_e = j == m || (i < n && fabs(e[i]) < fabs(f[j]));
        add_two(sum, of_e ? e[i] : f[j], &sum, &rest);
        count = put_part(to, count, rest);
        i += of_e;
        j += !of_e;
    }
    return put_part(to, count, sum);
}

/* n parts times b; at most 2 n are left. */
static int scale_parts(int n, const double *e, double b, double *to)
{
    int count = 0;
    double sum = 0, rest, high, low;
    for (int i = 0; i < n; i++) {
        multiply_two(e[i], b, &high, &low);
        add_two(sum, low, &sum, &rest);
        count = put_part(to, count, rest);
        add_two(high, sum, &sum, &rest);
        count = put_part(to, count, rest);
    }
    return put_part(to, count, sum);
}

/* n parts, at most PARTS_2, times a difference; at most 4 n are left. */
static int multiply_parts(int n, const double *e, int m, const double *difference, double *to)
{
    double low[2 * PARTS_2 + 1], high[2 * PARTS_2 + 1];
    if (!m)
        return 0;
    const int n_low = scale_parts(n, e, difference[0], low);
    const int n_high = m > 1 ? scale_parts(n, e, difference[1], high) : 0;
    return orient_add_parts(n_low, low, n_high, high, to);
}

static int sign_of_parts(int n, const double *e)
{
    return n ? (e[n - 1] > 0) - (e[n - 1] < 0) : 0;
}

/* ---- Determinants ---- */

/* A difference of two coordinates. */
struct difference {
    int n;
    double part[PARTS_1 + 1];
};

static void subtract(double a, double b, struct difference *to)
{
    double high, low;
    add_two(a, -b, &high, &low);
    to->n = put_part(to->part, put_part(to->part, 0, low), high);
}

/* a[0] b[1] - a[1] b[0]; returns the number of parts. */
static int minor_parts(const struct difference *a0, const struct difference *a1,
                       const struct difference *b0, const struct difference *b1, double *to)
{
    double left[PARTS_PRODUCT + 1], right[PARTS_PRODUCT + 1];
    const int n = multiply_parts(a0->n, a0->part, b1->n, b1->part, left);
    const int m = multiply_parts(a1->n, a1->part, b0->n, b0->part, right);
    for (int i = 0; i < m; i++)
        right[i] = -right[i];
    return orient_add_parts(n, left, m, right, to);
}

/* The rows are a - d, b - d, c - d. */
static int sign_of_3(const double *const from[3], const double d[3])
{
    struct difference row[3][3];
    double minor[PARTS_2 + 1], term[PARTS_TERM + 1];
    double sum[2][PARTS_3 + 1];
    int n = 0;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            subtract(from[r][c], d[c], &row[r][c]);
    for (int r = 0; r < 3; r++) {
        const struct difference *u = row[(r + 1) % 3], *v = row[(r + 2) % 3], *w = &row[r][2];
        const int n_minor = minor_parts(u, u + 1, v, v + 1, minor);
        const int n_term = multiply_parts(n_minor, minor, w->n, w->part, term);
        n = orient_add_parts(n, sum[r % 2], n_term, term, sum[(r + 1) % 2]);
    }
    return sign_of_parts(n, sum[1]);
}

int verify_orient(const double a[3], const double b[3], const double c[3], const double d[3])
{
    const double ax = a[0] - d[0], ay = a[1] - d[1], az = a[2] - d[2];
    const double bx = b[0] - d[0], by = b[1] - d[1], bz = b[2] - d[2];
    const double cx = c[0] - d[0], cy = c[1] - d[1], cz = c[2] - d[2];
    const double bxcy = bx * cy, cxby = cx * by, cxay = cx * ay;
    const double axcy = ax * cy, axby = ax * by, bxay = bx * ay;
    const double value = az * (bxcy - cxby) + bz * (cxay - axcy) + cz * (axby - bxay);
    const double most = (fabs(bxcy) + fabs(cxby)) * fabs(az) +
                        (fabs(cxay) + fabs(axcy)) * fabs(bz) + (fabs(axby) + fabs(bxay)) * fabs(cz);
    if (fabs(value) >= BOUND_3 * most)
        return (value > 0) - (value < 0);
    return sign_of_3((const double *const[3]){a, b, c}, d);
}

int verify_orient_seen(const double a[3], const double b[3], const double c[3], int i, int j)
{
    const double left = (a[i] - c[i]) * (b[j] - c[j]), right = (a[j] - c[j]) * (b[i] - c[i]);
    const double value = left - right;
    struct difference row[2][2];
    double minor[PARTS_2 + 1];
    if (fabs(value) >= BOUND_2 * (fabs(left) + fabs(right)))
        return (value > 0) - (value < 0);
    subtract(a[i], c[i], &row[0][0]);
    subtract(a[j], c[j], &row[0][1]);
    subtract(b[i], c[i], &row[1][0]);
    subtract(b[j], c[j], &row[1][1]);
    return sign_of_parts(minor_parts(row[0], row[0] + 1, row[1], row[1] + 1, minor), minor);
}
