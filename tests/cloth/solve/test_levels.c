/* The coarse system by groups: it is the system itself where one group covers all, symmetric and
 * positive definite otherwise, with held nodes, too; its matrix of groups is Q' C Q, and Q is
 * exact for motions that are affine on what is flat. */
#include "cloth/solve/frame.h"
#include "cloth/solve/levels.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A grid of nodes; each meets the eight around it. */
enum { SIDE = 8, NODES = SIDE * SIDE, ALL = SOLVE_COARSE * NODES, GROUP = 16 };
static uint32_t first[NODES + 1], neighbour[8 * NODES];
static double coupling[NODES][9][SOLVE_COUPLING]; /* of a node: its own, those of later ones */
static double dense[ALL][ALL], lift[NODES][9];
static struct solve_level level;

static double draw(void)
{
    return 2.0 * rand() / RAND_MAX - 1;
}

static void join(void)
{
    uint32_t n = 0;
    for (int p = 0; p < NODES; p++) {
        for (int q = 0; q < NODES; q++)
            if (p != q && abs(p / SIDE - q / SIDE) <= 1 && abs(p % SIDE - q % SIDE) <= 1)
                neighbour[n++] = (uint32_t)q;
        first[p + 1] = n;
    }
}

/* Adds a block to the dense matrix, and its transpose. */
static void put(uint32_t p, uint32_t q, const double *block)
{
    for (uint32_t i = 0; i < SOLVE_COARSE; i++)
        for (uint32_t j = 0; j < SOLVE_COARSE; j++) {
            dense[SOLVE_COARSE * p + i][SOLVE_COARSE * q + j] = block[SOLVE_COARSE * i + j];
            dense[SOLVE_COARSE * q + j][SOLVE_COARSE * p + i] = block[SOLVE_COARSE * i + j];
        }
}

/* Nodes `held` on, by steps, have no unknowns: zero rows and columns. */
static void draw_matrix(uint32_t held)
{
    memset(dense, 0, sizeof dense);
    memset(coupling, 0, sizeof coupling);
    for (uint32_t p = 0; p < NODES; p++) {
        uint32_t later = 1;
        for (uint32_t i = 0; i < SOLVE_COARSE && p % held; i++)
            for (uint32_t j = 0; j <= i; j++)
                coupling[p][0][SOLVE_COARSE * i + j] = coupling[p][0][SOLVE_COARSE * j + i] =
                    0.3 * draw() + (i == j ? 80 : 0);
        put(p, p, coupling[p][0]);
        for (uint32_t k = first[p]; k < first[p + 1]; k++) {
            if (neighbour[k] < p)
                continue;
            for (uint32_t i = 0; i < SOLVE_COUPLING && p % held && neighbour[k] % held; i++)
                coupling[p][later][i] = draw();
            put(p, neighbour[k], coupling[p][later++]);
        }
        for (int i = 0; i < 9; i++)
            lift[p][i] = draw();
    }
}

/* Groups of so many nodes. */
static void make_level(uint32_t of_group, bool lowest)
{
    uint32_t start[NODES + 1];
    for (uint32_t g = 0; g <= NODES / of_group; g++)
        start[g] = of_group * g;
    UNIT_FINE(
        solve_level_make(&level, NODES, first, neighbour, NODES / of_group, start, lowest, &error));
}

static void make(uint32_t of_group)
{
    make_level(of_group, true);
}

/* y += the sum over groups of what they solve; top: as the topmost level solves for what they
 * cover. */
static void add_solved(const double *x, bool top, double *y)
{
    for (uint32_t g = 0; g < level.n_groups; g++) {
        const struct solve_cover *cover = level.cover + g;
        double *factor = aligned_alloc(32, solve_coarse_doubles(&cover->pattern) * sizeof *factor);
        double *z = aligned_alloc(32, SOLVE_COARSE_STRIDE * cover->n * sizeof *z);
        ck_assert(factor && z);
        memset(z, 0, SOLVE_COARSE_STRIDE * cover->n * sizeof *z);
        solve_coarse_clear(&cover->pattern, factor);
        for (uint32_t i = 0; i < cover->n; i++) {
            solve_coarse_fill(&cover->pattern, cover->first, cover->neighbour, i,
                              coupling[cover->node[i]][0], factor);
            memcpy(z + solve_coarse_at(&cover->pattern, i), x + SOLVE_COARSE * cover->node[i],
                   SOLVE_COARSE * sizeof *z);
        }
        solve_coarse_factor(&cover->pattern, factor);
        if (top)
            solve_level_solve_top(&cover->pattern, factor, z);
        else
            solve_level_solve(&level, g, factor, z);
        for (uint32_t i = 0; i < SOLVE_COARSE * cover->n; i++)
            y[SOLVE_COARSE * cover->node[i / SOLVE_COARSE] + i % SOLVE_COARSE] +=
                z[solve_coarse_at(&cover->pattern, i / SOLVE_COARSE) + i % SOLVE_COARSE];
        free(factor);
        free(z);
    }
}

static void add_groups(const double *x, double *y)
{
    add_solved(x, false, y);
}

static double dot(const double *x, const double *y)
{
    double sum = 0;
    for (uint32_t i = 0; i < ALL; i++)
        sum += x[i] * y[i];
    return sum;
}

static void multiply(const double *x, double *y)
{
    for (uint32_t i = 0; i < ALL; i++)
        y[i] = dot(dense[i], x);
}

UNIT_TEST(one_group_is_the_system_itself)
{
    static double x[ALL], y[ALL], back[ALL];
    srand(1);
    join();
    draw_matrix(NODES + 1);
    make(NODES);
    ck_assert_uint_eq(level.cover[0].n, NODES);
    for (uint32_t i = 0; i < ALL; i++)
        x[i] = i < SOLVE_COARSE ? 0 : draw(); /* node 0 is held */
    multiply(x, y);
    memset(back, 0, sizeof back);
    add_groups(y, back);
    for (uint32_t i = 0; i < ALL; i++)
        ck_assert_double_eq_tol(back[i], x[i], 1e-5); /* T is in float */
    solve_level_free(&level);
}

UNIT_TEST(levels_above_count_more)
{
    static double x[ALL], lowest[ALL], higher[ALL], one[ALL], top[ALL];
    srand(3);
    join();
    draw_matrix(NODES + 1);
    for (uint32_t i = 0; i < ALL; i++)
        x[i] = draw();
    for (int of_groups = 0; of_groups < 2; of_groups++) {
        double *y = of_groups ? higher : lowest;
        memset(y, 0, sizeof higher);
        make_level(GROUP, !of_groups);
        add_groups(x, y);
        solve_level_free(&level);
    }
    memset(one, 0, sizeof one);
    memset(top, 0, sizeof top);
    make(NODES);
    add_groups(x, one);
    add_solved(x, true, top);
    solve_level_free(&level);
    for (uint32_t i = 0; i < ALL; i++) {
        ck_assert_double_le(fabs(higher[i] - 3 * lowest[i]), 1e-12 * fabs(higher[i]));
        ck_assert_double_eq(top[i], 2 * one[i]);
    }
}

UNIT_LOOP(groups_are_symmetric_and_definite, 0, 3)
{
    static const uint32_t helds[] = {NODES + 1, 5, 3};
    static double x[ALL], y[ALL], bx[ALL], by[ALL];
    srand(2);
    join();
    draw_matrix(helds[_i]);
    make(GROUP);
    for (int k = 0; k < 10; k++) {
        for (uint32_t i = 0; i < ALL; i++) {
            x[i] = draw();
            y[i] = draw();
        }
        memset(bx, 0, sizeof bx);
        memset(by, 0, sizeof by);
        add_groups(x, bx);
        add_groups(y, by);
        ck_assert_double_eq_tol(dot(x, by), dot(y, bx), 1e-12 * sqrt(dot(x, bx) * dot(y, by)));
        ck_assert_double_gt(dot(x, bx), 0);
        for (uint32_t i = 0; i < ALL; i++)
            ck_assert(i / SOLVE_COARSE % helds[_i] || bx[i] == 0);
    }
    solve_level_free(&level);
}

UNIT_TEST(a_cover_has_one_layer_more)
{
    join();
    make(GROUP);
    for (uint32_t g = 0; g < level.n_groups; g++) {
        const struct solve_cover *cover = level.cover + g;
        bool has[NODES] = {false};
        for (uint32_t i = 0; i < cover->n; i++)
            has[cover->node[i]] = true;
        for (uint32_t p = 0; p < NODES; p++) {
            bool wanted = p / GROUP == g;
            for (uint32_t k = first[p]; k < first[p + 1]; k++)
                wanted = wanted || neighbour[k] / GROUP == g;
            ck_assert(has[p] == wanted);
        }
    }
    solve_level_free(&level);
}

/* Column j of Q: of group j / 9. */
static void column_of(uint32_t j, double *y)
{
    memset(y, 0, ALL * sizeof *y);
    for (uint32_t p = GROUP * (j / SOLVE_COARSE); p < GROUP * (j / SOLVE_COARSE + 1); p++) {
        y[SOLVE_COARSE * p + j % SOLVE_COARSE] = 1;
        solve_level_prolong(lift[p], y + SOLVE_COARSE * p);
    }
}

static void check_block(uint32_t k, uint32_t l, const double *block)
{
    static double a[ALL], b[ALL], product[ALL];
    for (uint32_t j = 0; j < SOLVE_COARSE; j++) {
        column_of(SOLVE_COARSE * l + j, b);
        multiply(b, product);
        for (uint32_t i = 0; i < SOLVE_COARSE; i++) {
            double sum[SOLVE_COARSE] = {0};
            column_of(SOLVE_COARSE * k + i, a);
            for (uint32_t p = GROUP * k; p < GROUP * (k + 1); p++)
                solve_level_restrict(lift[p], product + SOLVE_COARSE * p, sum);
            ck_assert_double_eq_tol(sum[i], dot(a, product), 1e-10);
            ck_assert_double_eq_tol(block[SOLVE_COARSE * i + j], sum[i], 1e-10);
        }
    }
}

UNIT_TEST(groups_have_the_matrix_of_their_motions)
{
    srand(3);
    join();
    draw_matrix(7);
    make(GROUP);
    for (uint32_t g = 0; g < level.n_groups; g++) {
        const size_t n = SOLVE_COUPLING * (size_t)solve_level_couplings(&level, g);
        double *all = calloc(n, sizeof *all), *at = all;
        ck_assert(all != NULL);
        for (uint32_t p = level.start[g]; p < level.start[g + 1]; p++)
            solve_level_couple(&level, p, coupling[p][0], (const double(*)[9])lift, all);
        check_block(g, g, at);
        at += SOLVE_COUPLING;
        for (uint32_t i = level.group_first[g]; i < level.group_first[g + 1]; i++) {
            if (level.group_neighbour[i] < g)
                continue;
            check_block(g, level.group_neighbour[i], at);
            at += SOLVE_COUPLING;
        }
        ck_assert_ptr_eq(at, all + n);
        free(all);
    }
    solve_level_free(&level);
}

/* The function of a frame at a point: 1, u or v. */
static double function_at(const struct solve_frame *frame, int k, const phys_vec *x)
{
    double sum = 0, square = 0;
    for (int c = 0; c < 3 && k; c++) {
        const double e = frame->extent[k - 1][c];
        sum += e * ((*x)[c] - frame->centre[c]);
        square += e * e;
    }
    return k ? sum / square : 1;
}

UNIT_TEST(motions_that_are_affine_are_lifted_exactly)
{
    enum { PARTS = 5, POINTS = 30 };
    phys_vec x[PARTS * POINTS];
    struct solve_frame part[PARTS];
    srand(4);
    for (int i = 0; i < PARTS * POINTS; i++) { /* in a plane that lies askew */
        const double u = 3 * draw() + 2 * (i / POINTS), v = draw();
        x[i] = (phys_vec){1 + 0.6 * u - 0.48 * v, 0.8 * u + 0.36 * v - 5, 0.8 * v + 2, 0};
    }
    for (int p = 0; p < PARTS; p++)
        part[p] = solve_frame_of(POINTS, x + POINTS * p);
    const struct solve_frame whole = solve_frame_of(PARTS * POINTS, x);
    const struct solve_frame group = solve_frame_of_group(PARTS, part);
    for (int c = 0; c < 3; c++)
        ck_assert_double_eq_tol(group.centre[c], whole.centre[c], 1e-12);
    for (int i = 0; i < PARTS * POINTS; i++) {
        double to[9];
        solve_lift(part + i / POINTS, &group, to);
        for (int k = 0; k < 3; k++) {
            double sum = 0;
            for (int a = 0; a < 3; a++)
                sum += to[3 * a + k] * function_at(part + i / POINTS, a, x + i);
            ck_assert_double_eq_tol(sum, function_at(&group, k, x + i), 1e-9);
            ck_assert_double_eq_tol(fabs(function_at(&whole, k, x + i)), fabs(sum), 1e-9);
        }
    }
    const struct solve_frame none = solve_frame_of(0, x), empty = solve_frame_of_group(1, &none);
    ck_assert(none.n == 0 && empty.n == 0 && empty.centre[0] == 0 && empty.extent[0][0] == 0);
}
