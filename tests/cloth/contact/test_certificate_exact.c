/* Verdicts of contact_certify and contact_cut against exact arithmetic that knows nothing of
 * directions. A pair may touch only where its corners lie in a plane, and where its features are no
 * farther apart than it still moves. Halves of the step are looked at in the same way until one of
 * the two is excluded, or they are 2^-100 of the step.
 *
 * A coordinate is an integer of units of 2^-SCALE m, doubled at each halving, so that nothing is
 * ever rounded. All lie against corner 0, whose motion is that of the frame. */
#include "cloth/contact/certificate.h"
#include "tests/cloth/contact/pairs.h"
#include "tests/support/unit.h"

#include <gmp.h>
#include <stdio.h>

enum { SCALE = 200, DEPTH = 100 };

typedef mpz_t exact_vec[3];

static void exact_init(exact_vec a)
{
    for (int c = 0; c < 3; c++)
        mpz_init(a[c]);
}

static void exact_sub(exact_vec a, exact_vec b, exact_vec to)
{
    for (int c = 0; c < 3; c++)
        mpz_sub(to[c], a[c], b[c]);
}

static mpz_t sum;
static exact_vec product;

static void exact_dot(exact_vec a, exact_vec b, mpz_t to)
{
    mpz_mul(sum, a[0], b[0]);
    mpz_addmul(sum, a[1], b[1]);
    mpz_addmul(sum, a[2], b[2]);
    mpz_set(to, sum);
}

/* to is neither a nor b. */
static void exact_cross(exact_vec a, exact_vec b, exact_vec to)
{
    for (int c = 0; c < 3; c++) {
        const int d = (c + 1) % 3, e = (c + 2) % 3;
        mpz_mul(to[c], a[d], b[e]);
        mpz_submul(to[c], a[e], b[d]);
    }
}

static void exact_det(exact_vec a, exact_vec b, exact_vec c, mpz_t to)
{
    exact_cross(a, b, product);
    exact_dot(product, c, to);
}

/* ---- Corners of a part of the step ---- */

struct part {
    exact_vec begin[4], end[4];
};

/* The pair at each depth of halving; and room to compute in. */
static struct part part_at[DEPTH + 1];
static exact_vec way_a, way_b, way_n, way_w, side;
static mpz_t num, den, one, two, reach;

static void prepare(void)
{
    exact_vec *const vectors[] = {&way_a, &way_b, &way_n, &way_w, &side, &product};
    mpz_t *const numbers[] = {&num, &den, &one, &two, &reach, &sum};
    for (int d = 0; d <= DEPTH; d++)
        for (int k = 0; k < 4; k++) {
            exact_init(part_at[d].begin[k]);
            exact_init(part_at[d].end[k]);
        }
    for (int i = 0; i < 6; i++) {
        exact_init(*vectors[i]);
        mpz_init(*numbers[i]);
    }
}

/* Fails for what is no multiple of the unit. */
static void exact_set(double value, mpz_t to)
{
    int exponent;
    const double mantissa = frexp(value, &exponent);
    PAIRS_CHECK(value == 0 || exponent - 53 + SCALE >= 0);
    mpz_set_d(to, ldexp(mantissa, 53));
    if (value != 0)
        mpz_mul_2exp(to, to, (mp_bitcnt_t)(exponent - 53 + SCALE));
}

static void set_corners(const phys_vec x[4], exact_vec to[4])
{
    for (int k = 0; k < 4; k++)
        for (int c = 0; c < 3; c++) {
            exact_set(x[k][c], to[k][c]);
            exact_set(x[0][c], num);
            mpz_sub(to[k][c], to[k][c], num);
        }
}

/* From the begin to the middle, or from the end back to it; doubled, so that the middle is an
 * integer, too. */
static void set_half(const struct part *from, int half, struct part *to)
{
    for (int k = 0; k < 4; k++)
        for (int c = 0; c < 3; c++) {
            mpz_mul_2exp(to->begin[k][c], half ? from->end[k][c] : from->begin[k][c], 1);
            mpz_add(to->end[k][c], from->begin[k][c], from->end[k][c]);
        }
}

/* ---- In a plane ---- */

/* One of the Bernstein coefficients of the determinant of the corners against corner 0, three
 * times, at the ends itself: the sum over which of the factors are taken at the end. */
static int coefficient_sign(struct part *p, int i)
{
    static const int AT_END[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}, {1, 1, 1}};
    mpz_set_ui(one, 0);
    for (int turn = 0; turn < 3; turn++) {
        exact_vec *factor[3];
        for (int k = 0; k < 3; k++)
            factor[k] = AT_END[i][(k + turn) % 3] ? p->end + 1 + k : p->begin + 1 + k;
        exact_det(*factor[0], *factor[1], *factor[2], two);
        mpz_add(one, one, two);
    }
    return mpz_sgn(one);
}

/* True if the corners never lie in a plane. */
static bool never_flat(struct part *p)
{
    const int first = coefficient_sign(p, 0);
    for (int i = 1; i < 4; i++)
        if (coefficient_sign(p, i) != first)
            return false;
    return first != 0;
}

/* ---- Farther apart than so much: `reach`, its square ---- */

static bool vertex_beyond(exact_vec vertex, exact_vec begin, exact_vec end)
{
    exact_sub(end, begin, way_a);
    exact_sub(vertex, begin, way_w);
    exact_dot(way_a, way_w, num);
    exact_dot(way_a, way_a, den);
    exact_dot(way_w, way_w, one);
    if (mpz_sgn(num) <= 0)
        return mpz_cmp(one, reach) > 0;
    if (mpz_cmp(num, den) >= 0) {
        exact_sub(vertex, end, way_w);
        exact_dot(way_w, way_w, one);
        return mpz_cmp(one, reach) > 0;
    }
    mpz_sub(one, one, reach); /* w.w - num^2 / den > reach */
    mpz_mul(one, one, den);
    mpz_mul(two, num, num);
    return mpz_cmp(one, two) > 0;
}

/* The same across both; true where the feet do not lie inside. */
static bool inner_beyond(enum contact_pair pair, exact_vec p[4])
{
    const bool is_vt = pair == CONTACT_VT;
    exact_sub(is_vt ? p[2] : p[1], is_vt ? p[1] : p[0], way_a);
    exact_sub(p[3], is_vt ? p[1] : p[2], way_b);
    exact_sub(is_vt ? p[0] : p[2], is_vt ? p[1] : p[0], way_w);
    exact_cross(way_a, way_b, way_n);
    exact_dot(way_n, way_n, den);
    exact_cross(way_w, way_b, side);
    exact_dot(side, way_n, one);
    exact_cross(way_a, way_w, side);
    exact_dot(side, way_n, two);
    if (!is_vt)
        mpz_neg(two, two);
    if (mpz_sgn(one) < 0 || mpz_sgn(two) < 0 || mpz_sgn(den) == 0)
        return true;
    if (is_vt)
        mpz_add(one, one, two);
    if (mpz_cmp(one, den) > 0 || mpz_cmp(two, den) > 0)
        return true;
    exact_dot(way_w, way_n, num);
    mpz_mul(num, num, num);
    mpz_mul(two, reach, den);
    return mpz_cmp(num, two) > 0;
}

static bool beyond(enum contact_pair pair, exact_vec p[4])
{
    if (pair == CONTACT_VT)
        return vertex_beyond(p[0], p[1], p[2]) && vertex_beyond(p[0], p[2], p[3]) &&
               vertex_beyond(p[0], p[3], p[1]) && inner_beyond(pair, p);
    return vertex_beyond(p[0], p[2], p[3]) && vertex_beyond(p[1], p[2], p[3]) &&
           vertex_beyond(p[2], p[0], p[1]) && vertex_beyond(p[3], p[0], p[1]) &&
           inner_beyond(pair, p);
}

/* The square of what the features may come nearer over the part, (a + b)^2 <= 2 (a^2 + b^2). */
static void find_reach(enum contact_pair pair, struct part *p)
{
    mpz_t *const most[2] = {&one, &reach};
    mpz_set_ui(one, 0);
    mpz_set_ui(reach, 0);
    for (int k = 0; k < 4; k++) {
        mpz_t *of = most[k >= (pair == CONTACT_VT ? 1 : 2)];
        exact_sub(p->end[k], p->begin[k], way_a);
        exact_dot(way_a, way_a, two);
        if (mpz_cmp(two, *of) > 0)
            mpz_set(*of, two);
    }
    mpz_add(reach, reach, one);
    mpz_mul_2exp(reach, reach, 1);
}

/* True if the pair provably never touches in the part of the step at this depth. */
static bool never_touches(enum contact_pair pair, int depth)
{
    struct part *p = part_at + depth;
    if (never_flat(p))
        return true;
    find_reach(pair, p);
    if (beyond(pair, p->begin))
        return true;
    if (depth == DEPTH)
        return false;
    for (int half = 0; half < 2; half++) {
        set_half(p, half, p + 1);
        if (!never_touches(pair, depth + 1))
            return false;
    }
    return true;
}

static bool truly_apart(enum contact_pair pair, const phys_vec x[4], const phys_vec y[4])
{
    set_corners(x, part_at->begin);
    set_corners(y, part_at->end);
    return never_touches(pair, 0);
}

/* ---- Tests ---- */

UNIT_LOOP(certain_is_true, 0, PAIRS_SORTS_N)
{
    const struct pairs_sort *sort = PAIRS_SORTS + _i;
    int certain = 0, cut = 0, n = pairs_count();
    prepare();
    for (int i = 0; i < n; i++) {
        const enum contact_pair pair = KINDS[i & 1];
        const unsigned held = i % 3 ? 0 : (unsigned)uniform(0, 16);
        double t[4] = {1, 1, 1, 1};
        phys_vec x[4], y[4], end[4];
        pairs_draw(pair, sort, x, y);
        if (contact_certify(pair, x, y, THICKNESS)) {
            PAIRS_CHECK(truly_apart(pair, x, y));
            certain++;
        } else if (contact_cut(pair, x, y, THICKNESS, held, t)) {
            pairs_end(x, y, held, t, end);
            PAIRS_CHECK(truly_apart(pair, x, end));
            cut++;
        }
    }
    printf("# %s: %d certain, %d cut, of %d\n", sort->name, certain, cut, n);
}

/* The exact arithmetic sees what touches, be it at one moment and by the last digit. Two pairs that
 * meet in a point at the middle of the step; then one corner is moved by so much. */
UNIT_TEST(touch_is_seen)
{
    static const double CORNER[2][4][3] = {{{1, 1, 1}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
                                           {{-1, 0, 1}, {3, 0, 1}, {0, -1, 0}, {0, 1, 0}}};
    prepare();
    for (int i = 0; i < 2; i++)
        for (int lift = 0; lift < 3; lift++) {
            const double off = lift == 0 ? 0 : lift == 1 ? 0x1p-52 : -0x1p-52;
            phys_vec x[4], y[4];
            for (int k = 0; k < 4; k++) {
                x[k] = (phys_vec){CORNER[i][k][0], CORNER[i][k][1], CORNER[i][k][2], 0};
                y[k] = x[k];
            }
            for (int k = 0; k < 1 + i; k++) {
                x[k][2] += off;
                y[k] = x[k] - (phys_vec){0, 0, 1, 0};
            }
            ck_assert(truly_apart(KINDS[i], x, y) == (lift == 1));
            y[0][2] = y[1][2] = -1;
            ck_assert(!truly_apart(KINDS[i], x, y));
        }
}

/* Many pairs that are not certain do touch. */
UNIT_TEST(many_touch)
{
    int touch = 0;
    prepare();
    for (int i = 0; i < 1000; i++) {
        const enum contact_pair pair = KINDS[i & 1];
        phys_vec x[4], y[4];
        pairs_draw(pair, PAIRS_SORTS + 1, x, y);
        touch += !contact_certify(pair, x, y, THICKNESS) && !truly_apart(pair, x, y);
    }
    ck_assert_int_ge(touch, 50);
}
