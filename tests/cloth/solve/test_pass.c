/* A pass over a block of several stretches against the same sums one after the other: springs that
 * end near and far, rows without any, and halos of every kind. */
#include "cloth/solve/block.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX = 300, DEGREE = 5, GHOSTS = 20 };

struct whole {
    size_t n;
    uint32_t row[MAX + 1], column[DEGREE * MAX], end[MAX][2], halo[MAX];
    double diagonal[MAX], free[MAX];
    phys_vec value[(DEGREE + 1) * MAX], other[GHOSTS];
    phys_vec dv[MAX], r[MAX], p[MAX], q[MAX];
    struct solve_cut cut;
};

static struct whole whole;

static double draw(void)
{
    return (double)(rand() % 20001 - 10000) / 10000;
}

static void draw_vector(phys_vec *v, double size)
{
    *v = (phys_vec){size * draw(), size * draw(), size * draw(), 0};
}

/* Springs of row a end up to `far` rows further on; every seventh row has none. */
static uint32_t draw_springs(struct whole *w, uint32_t a, uint32_t far, uint32_t i)
{
    for (uint32_t b = a + 1; b < w->n && b <= a + far && a % 7 != 3; b++) {
        if ((uint32_t)rand() % far >= 3 || i - w->row[a] == DEGREE)
            continue;
        w->value[i] = (phys_vec){draw(), draw(), draw(), 1 + draw()};
        w->column[i++] = b;
    }
    return i;
}

/* halo: how many rows of a hundred have a spring into another block. */
static void make(struct whole *w, size_t n, uint32_t far, int halo)
{
    memset(w, 0, sizeof *w);
    w->n = n;
    for (uint32_t a = 0; a < n; a++) {
        w->row[a + 1] = draw_springs(w, a, far, w->row[a]);
        w->diagonal[a] = 2 + draw();
        w->free[a] = a % 31 != 30;
        draw_vector(w->dv + a, 1);
        draw_vector(w->r + a, w->free[a]);
        draw_vector(w->p + a, w->free[a]);
        draw_vector(w->q + a, w->free[a]);
    }
    for (int i = 0; i < GHOSTS; i++)
        draw_vector(w->other + i, 1);
    for (uint32_t a = 0; a < n; a++) {
        if (rand() % 100 >= halo)
            continue;
        w->value[w->row[n] + w->cut.n] = (phys_vec){draw(), draw(), draw(), 1 + draw()};
        w->end[w->cut.n][0] = a;
        w->end[w->cut.n++][1] = (uint32_t)rand() % GHOSTS;
        w->halo[w->cut.n_halo++] = a;
    }
    w->cut.end = (const uint32_t(*)[2])w->end;
    w->cut.halo = w->halo;
}

static void add_spring(const struct whole *w, uint32_t i, uint32_t a, const phys_vec *other,
                       double sum[MAX][3])
{
    double dot = 0;
    for (int c = 0; c < 3; c++)
        dot += w->value[i][c] * (w->p[a][c] - (*other)[c]);
    for (int c = 0; c < 3; c++)
        sum[a][c] += (w->value[i][3] * (w->p[a][c] - (*other)[c]) + w->value[i][c] * dot);
}

/* The pass in plain sums. */
static void expect(struct whole *w, double alpha, double beta, double dots[SOLVE_DOTS])
{
    static double sum[MAX][3];
    memset(sum, 0, sizeof sum);
    for (uint32_t a = 0; a < w->n; a++) {
        w->dv[a] += alpha * w->p[a];
        w->r[a] -= alpha * w->q[a];
        w->p[a] = w->r[a] + beta * w->p[a];
    }
    for (uint32_t a = 0; a < w->n; a++)
        for (uint32_t i = w->row[a]; i < w->row[a + 1]; i++) {
            add_spring(w, i, a, w->p + w->column[i], sum);
            add_spring(w, i, w->column[i], w->p + a, sum);
        }
    for (uint32_t i = 0; i < w->cut.n; i++)
        add_spring(w, w->row[w->n] + i, w->end[i][0], w->other + w->end[i][1], sum);
    memset(dots, 0, SOLVE_DOTS * sizeof *dots);
    for (uint32_t a = 0; a < w->n; a++)
        for (int c = 0; c < 3; c++) {
            const double q = w->free[a] * (sum[a][c] + w->diagonal[a] * w->p[a][c]);
            w->q[a][c] = q;
            dots[SOLVE_RR] += w->r[a][c] * w->r[a][c];
            dots[SOLVE_PQ] += w->p[a][c] * q;
            dots[SOLVE_RQ] += w->r[a][c] * q;
            dots[SOLVE_QQ] += q * q;
        }
    dots[SOLVE_RZ] = dots[SOLVE_RR];
}

static void compare(const char *what, const phys_vec *got, const phys_vec *wanted, size_t n)
{
    for (size_t a = 0; a < n; a++)
        for (int c = 0; c < 4; c++)
            ck_assert_msg(fabs(got[a][c] - wanted[a][c]) <= 1e-13 * (1 + fabs(wanted[a][c])),
                          "%s of row %zu, lane %d: %.17g, not %.17g", what, a, c, got[a][c],
                          wanted[a][c]);
}

static struct solve_block block_of(const struct whole *w)
{
    struct solve_block block = {.n = w->n,
                                .diagonal = w->diagonal,
                                .free = w->free,
                                .row = w->row,
                                .column = w->column,
                                .format = SOLVE_SPRINGS};
    for (uint32_t a = 0; a < w->n; a++)
        for (uint32_t i = w->row[a]; i < w->row[a + 1]; i++)
            block.span = w->column[i] - a > block.span ? w->column[i] - a : block.span;
    return block;
}

static void check(size_t n, uint32_t far, int halo)
{
    static struct whole wanted;
    double dots[SOLVE_DOTS] = {0}, right[SOLVE_DOTS];
    make(&whole, n, far, halo);
    wanted = whole;
    expect(&wanted, 0.3, 0.7, right);
    const struct solve_block block = block_of(&whole);
    const struct solve_rows rows = solve_rows_plain(whole.dv, whole.r, whole.p, whole.q);
    solve_pass(&block, &whole.cut, whole.value, whole.other, 0.3, 0.7, &rows, dots);
    compare("dv", whole.dv, wanted.dv, n);
    compare("r", whole.r, wanted.r, n);
    compare("p", whole.p, wanted.p, n);
    compare("q", whole.q, wanted.q, n);
    for (int i = 0; i < SOLVE_DOTS; i++)
        ck_assert_double_eq_tol(dots[i], right[i], 1e-12 * (1 + right[SOLVE_QQ]));
}

UNIT_TEST(pass_of_every_size)
{
    static const size_t n[] = {1, 2, 63, 64, 65, 127, 128, 129, 200, MAX};
    srand(11);
    for (size_t i = 0; i < sizeof n / sizeof *n; i++)
        check(n[i], 20, 10);
}

/* Springs that end beyond the next stretch, or nowhere but beside. */
UNIT_TEST(pass_of_every_reach)
{
    static const uint32_t far[] = {3, 30, 100, MAX};
    srand(12);
    for (size_t i = 0; i < sizeof far / sizeof *far; i++)
        check(MAX, far[i], 10);
}

UNIT_TEST(pass_of_every_halo)
{
    static const int halo[] = {0, 1, 50, 100};
    srand(13);
    for (size_t i = 0; i < sizeof halo / sizeof *halo; i++)
        check(MAX, 20, halo[i]);
}

/* Where M is the identity, with vectors z and s of their own, all is to the bit what it is without
 * a preconditioner, where z is r and s is q. */
UNIT_TEST(identity_is_none)
{
    static struct whole other;
    static phys_vec z[MAX], s[MAX];
    double none[SOLVE_DOTS] = {0}, identity[SOLVE_DOTS] = {0};
    srand(14);
    make(&whole, MAX, 20, 10);
    other = whole;
    memcpy(z, other.r, sizeof z);
    memcpy(s, other.q, sizeof s);
    const struct solve_block block = block_of(&whole);
    const struct solve_rows plain = solve_rows_plain(whole.dv, whole.r, whole.p, whole.q);
    const struct solve_rows rows = {other.dv, other.r, other.p, other.q, z, s};
    solve_pass(&block, &whole.cut, whole.value, whole.other, 0.3, 0.7, &plain, none);
    solve_pass(&block, &whole.cut, whole.value, whole.other, 0.3, 0.7, &rows, identity);
    identity[SOLVE_QQ] = none[SOLVE_QQ]; /* q.s, left to who makes s */
    ck_assert_mem_eq(identity, none, sizeof none);
    ck_assert_mem_eq(z, whole.r, sizeof z);
    ck_assert_mem_eq(other.dv, whole.dv, sizeof whole.dv);
    ck_assert_mem_eq(other.r, whole.r, sizeof whole.r);
    ck_assert_mem_eq(other.p, whole.p, sizeof whole.p);
    ck_assert_mem_eq(other.q, whole.q, sizeof whole.q);
}
