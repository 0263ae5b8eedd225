/* Signs and pairs against rational numbers (GMP). Triangles that have an area are told apart here
 * once more, without signs of corners: two convex bodies are apart if and only if the normal of a
 * face, or what is normal to an edge of each, or in a plane to an edge of one, keeps them apart. */
#include "cloth/verify/orient.h"
#include "cloth/verify/verify.h"
#include "tests/support/random.h"
#include "tests/support/unit.h"

#include <gmp.h>
#include <math.h>

enum { SIGNS = 20000, PAIRS = 6000, KINDS = 6 };

static int pick(int n)
{
    return (int)uniform(0, n);
}

static int repeats(int n)
{
    return unit_quick() ? n / 10 : n;
}

/* ---- Rational vectors ---- */

typedef mpq_t rational_vec[3];

static void vec_init(rational_vec a)
{
    for (int c = 0; c < 3; c++)
        mpq_init(a[c]);
}

static void vec_clear(rational_vec a)
{
    for (int c = 0; c < 3; c++)
        mpq_clear(a[c]);
}

static void vec_subtract(rational_vec to, rational_vec a, rational_vec b)
{
    for (int c = 0; c < 3; c++)
        mpq_sub(to[c], a[c], b[c]);
}

static void vec_cross(rational_vec to, rational_vec a, rational_vec b)
{
    mpq_t left, right;
    mpq_inits(left, right, NULL);
    for (int c = 0; c < 3; c++) {
        mpq_mul(left, a[(c + 1) % 3], b[(c + 2) % 3]);
        mpq_mul(right, a[(c + 2) % 3], b[(c + 1) % 3]);
        mpq_sub(to[c], left, right);
    }
    mpq_clears(left, right, NULL);
}

static void vec_dot(mpq_t to, rational_vec a, rational_vec b)
{
    mpq_t product;
    mpq_init(product);
    mpq_set_ui(to, 0, 1);
    for (int c = 0; c < 3; c++) {
        mpq_mul(product, a[c], b[c]);
        mpq_add(to, to, product);
    }
    mpq_clear(product);
}

/* ---- Signs ---- */

static int sign_of(const double x[4][3])
{
    rational_vec row[4], normal;
    mpq_t value;
    mpq_init(value);
    vec_init(normal);
    for (int p = 0; p < 4; p++) {
        vec_init(row[p]);
        for (int c = 0; c < 3; c++)
            mpq_set_d(row[p][c], x[p][c]);
    }
    for (int p = 0; p < 3; p++)
        vec_subtract(row[p], row[p], row[3]);
    vec_cross(normal, row[1], row[2]);
    vec_dot(value, row[0], normal);
    const int sign = mpq_sgn(value);
    for (int p = 0; p < 4; p++)
        vec_clear(row[p]);
    vec_clear(normal);
    mpq_clear(value);
    return sign;
}

static int sign_seen(const double x[4][3], int i, int j)
{
    double flat[4][3] = {{0}};
    for (int p = 0; p < 3; p++) {
        flat[p][0] = x[p][i];
        flat[p][1] = x[p][j];
    }
    flat[3][0] = x[2][i];
    flat[3][1] = x[2][j];
    flat[3][2] = -1; /* of 1 above c, so that the third row is 0 0 1 */
    return sign_of((const double(*)[3])flat);
}

/* Four points that are nearly, or exactly, in a plane, or three on a line; of any sizes. */
static void make_flat(int k, double x[4][3])
{
    const double far = k % 3 ? 0 : ldexp(1, pick(40)), size = ldexp(1, -pick(k % 2 ? 2 : 60));
    const double u = k % 7 ? uniform(-1, 2) : 0, v = uniform(-1, 2);
    for (int c = 0; c < 3; c++) {
        for (int p = 0; p < 3; p++)
            x[p][c] = k % 5 ? far + size * uniform(-1, 1) : size * (pick(5) - 2) * 0.1 + far;
        if (k % 7 == 0)
            x[2][c] = x[0][c] + v * (x[1][c] - x[0][c]);
        x[3][c] = x[0][c] + u * (x[1][c] - x[0][c]) + v * (x[2][c] - x[0][c]);
        if (k % 11 == 0)
            x[3][c] = x[pick(3)][c];
    }
}

UNIT_TEST(signs)
{
    int count[3] = {0}, seen[3] = {0};
    for (int k = 0; k < repeats(SIGNS); k++) {
        double x[4][3];
        make_flat(k, x);
        const int sign = verify_orient(x[0], x[1], x[2], x[3]);
        ck_assert_int_eq(sign, sign_of((const double(*)[3])x));
        count[sign + 1]++;
        for (int c = 0; c < 3; c++) {
            const int i = (c + 1) % 3, j = (c + 2) % 3;
            const int flat = verify_orient_seen(x[0], x[1], x[2], i, j);
            ck_assert_int_eq(flat, sign_seen((const double(*)[3])x, i, j));
            seen[flat + 1]++;
        }
    }
    for (int i = 0; i < 3; i++)
        ck_assert(count[i] > repeats(SIGNS) / 50 && seen[i] > repeats(SIGNS) / 50);
}

/* At the ends of what is allowed, with differences that are 400 binary orders apart. */
UNIT_TEST(sizes)
{
    for (int k = 0; k < repeats(SIGNS); k++) {
        double x[4][3];
        for (int p = 0; p < 4; p++)
            for (int c = 0; c < 3; c++)
                x[p][c] = pick(4) ? ldexp(uniform(0.5, 1), pick(2)   ? pick(400) - 199
                                                           : pick(4) ? 200
                                                                     : -199)
                                  : 0;
        if (k % 2)
            for (int c = 0; c < 3; c++)
                x[3][c] = x[0][c] + (x[1][c] - x[0][c]) + (x[2][c] - x[0][c]);
        for (int p = 0; p < 4; p++)
            for (int c = 0; c < 3; c++)
                x[p][c] = fabs(x[p][c]) < VERIFY_LEAST ? 0 : fmin(x[p][c], VERIFY_MOST);
        ck_assert_int_eq(verify_orient(x[0], x[1], x[2], x[3]), sign_of((const double(*)[3])x));
    }
}

/* ---- Convex bodies ---- */

enum { MOST_DIRECTIONS = 32 };

/* A triangle or an edge. */
struct body {
    int n;
    rational_vec x[3], edge[3];
};

static void body_init(struct body *body, const double (*x)[3], int n, const uint32_t *corner)
{
    body->n = n;
    for (int i = 0; i < n; i++) {
        vec_init(body->x[i]);
        for (int c = 0; c < 3; c++)
            mpq_set_d(body->x[i][c], x[corner[i]][c]);
    }
    for (int i = 0; i < n; i++) {
        vec_init(body->edge[i]);
        vec_subtract(body->edge[i], body->x[(i + 1) % n], body->x[i]);
    }
}

static void body_clear(struct body *body)
{
    for (int i = 0; i < body->n; i++) {
        vec_clear(body->x[i]);
        vec_clear(body->edge[i]);
    }
}

static void body_reach(struct body *body, rational_vec direction, mpq_t low, mpq_t high)
{
    mpq_t at;
    mpq_init(at);
    for (int i = 0; i < body->n; i++) {
        vec_dot(at, body->x[i], direction);
        if (i == 0 || mpq_cmp(at, low) < 0)
            mpq_set(low, at);
        if (i == 0 || mpq_cmp(at, high) > 0)
            mpq_set(high, at);
    }
    mpq_clear(at);
}

static bool keeps_apart(struct body *a, struct body *b, rational_vec direction)
{
    mpq_t low[2], high[2];
    mpq_inits(low[0], low[1], high[0], high[1], NULL);
    body_reach(a, direction, low[0], high[0]);
    body_reach(b, direction, low[1], high[1]);
    const bool apart = mpq_cmp(high[0], low[1]) < 0 || mpq_cmp(high[1], low[0]) < 0;
    mpq_clears(low[0], low[1], high[0], high[1], NULL);
    return apart;
}

/* b is a triangle that has an area. */
static bool are_apart(struct body *a, struct body *b)
{
    rational_vec normal, direction;
    vec_init(normal);
    vec_init(direction);
    vec_cross(normal, b->edge[0], b->edge[1]);
    bool apart = keeps_apart(a, b, normal);
    for (int i = 0; i < a->n && !apart; i++) {
        vec_cross(direction, normal, a->edge[i]);
        apart = keeps_apart(a, b, direction);
        for (int j = 0; j < 3 && !apart; j++) {
            vec_cross(direction, a->edge[i], b->edge[j]);
            apart = keeps_apart(a, b, direction);
        }
    }
    for (int j = 0; j < 3 && !apart; j++) {
        vec_cross(direction, normal, b->edge[j]);
        apart = keeps_apart(a, b, direction);
    }
    if (a->n == 3 && !apart) {
        vec_cross(normal, a->edge[0], a->edge[1]);
        apart = keeps_apart(a, b, normal);
    }
    vec_clear(normal);
    vec_clear(direction);
    return apart;
}

static bool bodies_meet(const double (*x)[3], int n, const uint32_t *a, const uint32_t b[3])
{
    struct body one, other;
    body_init(&one, x, n, a);
    body_init(&other, x, 3, b);
    const bool meet = !are_apart(&one, &other);
    body_clear(&one);
    body_clear(&other);
    return meet;
}

static bool has_area(const double (*x)[3], const uint32_t corner[3])
{
    struct body body;
    rational_vec normal;
    bool is = false;
    body_init(&body, x, 3, corner);
    vec_init(normal);
    vec_cross(normal, body.edge[0], body.edge[1]);
    for (int c = 0; c < 3; c++)
        is = is || mpq_sgn(normal[c]);
    vec_clear(normal);
    body_clear(&body);
    return is;
}

/* ---- Pairs ---- */

/* By sixths of the count: anywhere; on a lattice that doubles do not have; the same, turned; with a
 * corner next to the other's face; with an edge next to the other's edge; of any sizes. */
static void make_pair(int kind, double x[6][3])
{
    const double turn[3][3] = {{.36, .48, -.8}, {-.8, .6, 0}, {.48, .64, .6}};
    double from[6][3];
    const double far = pick(2) ? 0 : ldexp(1, pick(20)), u = uniform(0, 1), v = uniform(0, 1);
    for (int p = 0; p < 6; p++)
        for (int c = 0; c < 3; c++) {
            from[p][c] = kind == 1 || kind == 2 ? 0.1 * pick(4) : uniform(-1, 1);
            x[p][c] = from[p][c] * (kind == 5 ? ldexp(1, -pick(20)) : 1);
        }
    for (int p = 0; p < 6; p++)
        for (int c = 0; c < 3 && kind == 2; c++)
            x[p][c] =
                turn[c][0] * from[p][0] + turn[c][1] * from[p][1] + turn[c][2] * from[p][2] + far;
    for (int c = 0; c < 3 && (kind == 3 || kind == 4); c++) {
        const double ab = x[1][c] - x[0][c], ac = x[2][c] - x[0][c];
        x[3][c] = x[0][c] + (kind == 3 ? (1 - v) * u * ab + v * ac : u * ab);
        if (kind == 4)
            x[4][c] = x[3][c] - (x[5][c] - x[3][c]) * v;
    }
}

UNIT_TEST(pairs)
{
    int count[KINDS][2] = {{0}};
    for (int k = 0; k < repeats(PAIRS); k++) {
        const int kind = k % KINDS;
        const uint32_t a[3] = {0, 1, 2}, b[3] = {k % 4 ? 3 : 0, 4, 5};
        double x[6][3];
        make_pair(kind, x);
        const double(*at)[3] = (const double(*)[3])x;
        if (!has_area(at, a) || !has_area(at, b))
            continue;
        const bool meet = b[0] ? bodies_meet(at, 3, a, b)
                               : bodies_meet(at, 2, a + 1, b) || bodies_meet(at, 2, b + 1, a);
        ck_assert_msg(verify_meet(at, a, b) == meet, "pair %d: %d is expected", k, meet);
        count[kind][meet]++;
    }
    for (int i = 0; i < KINDS; i++)
        ck_assert(count[i][0] > repeats(PAIRS) / 100 && count[i][1] > repeats(PAIRS) / 100);
}
