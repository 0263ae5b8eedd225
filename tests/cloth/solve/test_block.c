/* The product of two blocks against a dense matrix that is put together here from the same springs,
 * and conjugate gradients by these kernels against elimination. */
#include "cloth/solve/block.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Ten particles, two blocks of five; springs between all pairs but some. Every particle is in a
 * halo. */
enum { ROWS = 5, N = 2 * ROWS, DOFS = 3 * N };

struct half {
    uint32_t row[ROWS + 1], column[ROWS * ROWS], end[ROWS * ROWS][2], halo[ROWS], held[ROWS * N][2];
    double diagonal[ROWS], free[ROWS];
    phys_vec value[2 * ROWS * ROWS];
    uint32_t n_inner, n_cut, n_halo;
    struct solve_block block;
    struct solve_cut cut;
    struct solve_held hold;
};

static struct half half[2];
static double dense[DOFS][DOFS]; /* A, without the filter */

static double draw(void)
{
    return (double)(rand() % 20001 - 10000) / 10000;
}

static int joined(int a, int b)
{
    return a != b && (a + b) % 7 != 3;
}

/* alpha I + w w' into the rows and columns of a and b. */
static void add_dense(int a, int b, const phys_vec *value)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double k = (*value)[i] * (*value)[j] + (i == j ? (*value)[3] : 0);
            dense[3 * a + i][3 * a + j] += k;
            dense[3 * b + i][3 * b + j] += k;
            dense[3 * a + i][3 * b + j] -= k;
            dense[3 * b + i][3 * a + j] -= k;
        }
}

static void add_held(struct half *h, const struct half *far, int row, int other, uint32_t place)
{
    if (h->free[row] != 0 && far->free[other] == 0) {
        h->held[h->hold.n][0] = (uint32_t)row;
        h->held[h->hold.n++][1] = place;
    }
}

/* Cut springs follow the inner ones; the value of a spring between the halves is kept for both. */
static void build(void)
{
    phys_vec value[N][N];
    srand(7);
    memset(half, 0, sizeof half);
    memset(dense, 0, sizeof dense);
    for (int a = 0; a < N; a++) {
        half[a / ROWS].diagonal[a % ROWS] = 1 + 0.5 * draw();
        half[a / ROWS].free[a % ROWS] = a == 1 || a == 8 ? 0 : 1;
        for (int c = 0; c < 3; c++)
            dense[3 * a + c][3 * a + c] += half[a / ROWS].diagonal[a % ROWS];
        for (int b = a + 1; b < N; b++) {
            value[a][b] = (phys_vec){draw(), draw(), draw(), 1 + draw()};
            value[b][a] = value[a][b];
            if (joined(a, b))
                add_dense(a, b, &value[a][b]);
        }
    }
    for (int s = 0; s < 2; s++) {
        struct half *h = half + s;
        for (int a = 0; a < ROWS; a++) {
            h->row[a] = h->n_inner;
            for (int b = a + 1; b < ROWS; b++)
                if (joined(s * ROWS + a, s * ROWS + b)) {
                    add_held(h, h, a, b, h->n_inner);
                    add_held(h, h, b, a, h->n_inner);
                    h->value[h->n_inner] = value[s * ROWS + a][s * ROWS + b];
                    h->column[h->n_inner++] = (uint32_t)b;
                }
        }
        h->row[ROWS] = h->n_inner;
        for (int a = 0; a < ROWS; a++) {
            const uint32_t before = h->n_cut;
            for (int b = 0; b < ROWS; b++)
                if (joined(s * ROWS + a, (1 - s) * ROWS + b)) {
                    add_held(h, half + 1 - s, a, b, h->n_inner + h->n_cut);
                    h->value[h->n_inner + h->n_cut] = value[s * ROWS + a][(1 - s) * ROWS + b];
                    h->end[h->n_cut][0] = (uint32_t)a;
                    h->end[h->n_cut++][1] = (uint32_t)b;
                }
            if (h->n_cut > before)
                h->halo[h->n_halo++] = (uint32_t)a;
        }
        h->block = (struct solve_block){ROWS,      h->diagonal,   h->free, h->row,
                                        h->column, SOLVE_SPRINGS, NULL};
        h->cut = (struct solve_cut){.n = h->n_cut,
                                    .end = (const uint32_t(*)[2])h->end,
                                    .n_halo = h->n_halo,
                                    .halo = h->halo};
        h->hold.at = (const uint32_t(*)[2])h->held;
    }
}

/* Vectors of both halves, and ghosts: of half s those of the rows of the other one. */
struct vectors {
    phys_vec dv[N], r[N], p[N], q[N], ghost_r[N], ghost_p[N];
};

/* A pass over both halves, each with its ghosts of the other; the dots are added up. */
static void pass(struct vectors *x, double alpha, double beta, double dots[SOLVE_DOTS])
{
    static const uint32_t all[ROWS] = {0, 1, 2, 3, 4};
    double packed[2][3 * ROWS];
    memset(dots, 0, SOLVE_DOTS * sizeof *dots);
    for (int s = 0; s < 2; s++)
        solve_pack(ROWS, all, x->q + s * ROWS, packed[s]);
    for (int s = 0; s < 2; s++) {
        const struct half *h = half + s;
        const int at = s * ROWS;
        const struct solve_rows rows =
            solve_rows_plain(x->dv + at, x->r + at, x->p + at, x->q + at);
        double part[SOLVE_DOTS];
        solve_advance_ghosts(ROWS, alpha, beta, packed[1 - s], all, x->ghost_r + at,
                             x->ghost_p + at);
        solve_pass(&h->block, &h->cut, h->value, x->ghost_p + at, alpha, beta, &rows, part);
        for (int i = 0; i < SOLVE_DOTS; i++)
            dots[i] += part[i];
    }
    for (int i = 0; i < N; i++) {
        ck_assert_int_eq(memcmp(x->ghost_r + i, x->r + (i + ROWS) % N, sizeof *x->r), 0);
        ck_assert_int_eq(memcmp(x->ghost_p + i, x->p + (i + ROWS) % N, sizeof *x->p), 0);
    }
}

static void copy_rows(struct vectors *x)
{
    for (int i = 0; i < N; i++) {
        x->ghost_r[i] = x->r[(i + ROWS) % N];
        x->ghost_p[i] = x->p[(i + ROWS) % N];
    }
}

/* q = S A p and the dots, by a pass that leaves r and makes p of r and p - r. */
static void matvec(const phys_vec *p, const phys_vec *r, phys_vec *q, double dots[SOLVE_DOTS])
{
    struct vectors x = {0};
    for (int i = 0; i < N; i++) {
        x.r[i] = r[i];
        x.p[i] = p[i] - r[i];
    }
    copy_rows(&x);
    pass(&x, 0, 1, dots);
    memcpy(q, x.q, sizeof x.q);
}

static double is_free(int dof)
{
    const int particle = dof / 3;
    return half[particle / ROWS].free[particle % ROWS];
}

static void random_vector(phys_vec *p)
{
    for (int i = 0; i < N; i++)
        p[i] = (phys_vec){draw(), draw(), draw(), 0} * is_free(3 * i);
}

UNIT_TEST(matvec_is_the_dense_product)
{
    phys_vec p[N], r[N], q[N];
    double dots[SOLVE_DOTS];
    build();
    for (int trial = 0; trial < 20; trial++) {
        random_vector(p);
        random_vector(r);
        matvec(p, r, q, dots);
        double pq = 0, rq = 0, qq = 0;
        for (int i = 0; i < DOFS; i++) {
            double y = 0;
            for (int j = 0; j < DOFS; j++)
                y += dense[i][j] * p[j / 3][j % 3];
            y *= is_free(i);
            pq += y * p[i / 3][i % 3];
            rq += y * r[i / 3][i % 3];
            qq += y * y;
            ck_assert_double_eq_tol(q[i / 3][i % 3], y, 1e-13);
        }
        ck_assert_double_eq_tol(dots[SOLVE_PQ], pq, 1e-12);
        ck_assert_double_eq_tol(dots[SOLVE_RQ], rq, 1e-12);
        ck_assert_double_eq_tol(dots[SOLVE_QQ], qq, 1e-11);
        ck_assert_double_gt(pq, 0);
        for (int i = 0; i < N; i++)
            ck_assert_double_eq(q[i][3], 0);
    }
}

UNIT_TEST(matvec_is_symmetric)
{
    phys_vec p[N], q[N], ap[N], aq[N];
    double dots[SOLVE_DOTS];
    build();
    random_vector(p);
    random_vector(q);
    matvec(p, q, ap, dots);
    matvec(q, p, aq, dots);
    double one = 0, other = 0;
    for (int i = 0; i < N; i++) {
        one += phys_dot(q + i, ap + i);
        other += phys_dot(p + i, aq + i);
    }
    ck_assert_double_eq_tol(one, other, 1e-12);
}

/* Without pins, what moves as a whole feels its diagonal and nothing else, to the last bit. */
UNIT_TEST(rigid_motion_feels_the_mass_alone)
{
    phys_vec p[N], q[N];
    double dots[SOLVE_DOTS];
    build();
    for (int i = 0; i < N; i++) {
        half[i / ROWS].free[i % ROWS] = 1;
        p[i] = (phys_vec){0.1, 0.7, -0.3, 0};
    }
    matvec(p, p, q, dots);
    for (int i = 0; i < N; i++)
        for (int c = 0; c < 3; c++)
            ck_assert_double_eq(q[i][c], half[i / ROWS].diagonal[i % ROWS] * p[i][c]);
}

/* x of the free rows and columns of A x = S b, by elimination with row exchange; zero elsewhere. */
static void eliminate(const phys_vec *b, double *x)
{
    static double a[DOFS][DOFS + 1];
    for (int i = 0; i < DOFS; i++) {
        for (int j = 0; j < DOFS; j++)
            a[i][j] = is_free(i) != 0 && is_free(j) != 0 ? dense[i][j] : i == j;
        a[i][DOFS] = b[i / 3][i % 3] * is_free(i);
    }
    for (int k = 0; k < DOFS; k++) {
        int best = k;
        for (int i = k; i < DOFS; i++)
            best = fabs(a[i][k]) > fabs(a[best][k]) ? i : best;
        for (int j = 0; j <= DOFS; j++) {
            const double swap = a[k][j];
            a[k][j] = a[best][j];
            a[best][j] = swap;
        }
        for (int i = 0; i < DOFS; i++)
            for (int j = DOFS; j >= k && i != k; j--)
                a[i][j] -= a[i][k] / a[k][k] * a[k][j];
    }
    for (int i = 0; i < DOFS; i++)
        x[i] = a[i][DOFS] / a[i][i];
}

/* So many iterations of conjugate gradients from zero. Returns r . r. */
static double iterate(const phys_vec *b, phys_vec *dv, uint32_t count)
{
    struct vectors x;
    double dots[SOLVE_DOTS] = {0};
    const struct solve_stop stop = {.count = true, .max = count};
    struct solve_scalars scalars = solve_scalars_start(0, SOLVE_ON);
    memset(&x, 0x55, sizeof x);
    for (int at = 0; at < N; at += ROWS)
        solve_start(ROWS, half[at / ROWS].free, b + at, x.dv + at, x.r + at, x.p + at, x.q + at);
    copy_rows(&x);
    while (scalars.phase != SOLVE_DONE) {
        const struct solve_scalars now = scalars;
        if (now.phase == SOLVE_ON)
            pass(&x, now.alpha, now.beta, dots);
        else
            dots[SOLVE_RR] = solve_finish(N, now.alpha, x.q, x.p, x.dv, x.r);
        ck_assert_int_eq(solve_scalars_next(&stop, dots, &now, &scalars), SOLVE_OK);
    }
    ck_assert_double_eq(scalars.iterations, count);
    memcpy(dv, x.dv, sizeof x.dv);
    return scalars.square;
}

UNIT_TEST(cg_solves)
{
    phys_vec b[N], dv[N];
    double x[DOFS];
    build();
    for (int i = 0; i < N; i++)
        b[i] = (phys_vec){draw(), draw(), draw(), 0};
    eliminate(b, x);
    ck_assert_double_lt(iterate(b, dv, DOFS), 1e-20);
    for (int i = 0; i < DOFS; i++)
        ck_assert_double_eq_tol(dv[i / 3][i % 3], x[i], 1e-10);
    ck_assert_double_eq(dv[1][0], 0);
    ck_assert_double_eq(dv[8][2], 0);
}

/* An unfinished solve: the momentum it lost is the sum of b - A dv, with A applied in full. */
UNIT_TEST(lost_is_the_sum_of_the_residual)
{
    phys_vec b[N], dv[N], q[N];
    build();
    for (int i = 0; i < N; i++)
        b[i] = (phys_vec){draw(), draw(), draw(), 0};
    iterate(b, dv, 3);
    double dots[SOLVE_DOTS];
    matvec(dv, dv, q, dots);
    double lost[3] = {0}, sum[3] = {0};
    for (int s = 0; s < 2; s++)
        solve_lost(&half[s].block, &half[s].hold, half[s].value, b + s * ROWS, dv + s * ROWS, lost);
    for (int i = 0; i < N; i++)
        for (int c = 0; c < 3; c++)
            sum[c] += is_free(3 * i) * (b[i][c] - q[i][c]);
    for (int c = 0; c < 3; c++) {
        ck_assert_double_gt(fabs(sum[c]), 1e-3);
        ck_assert_double_eq_tol(lost[c], sum[c], 1e-13);
    }
}
