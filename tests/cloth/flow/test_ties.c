/* Ties of up to four weighted corners in up to four blocks: what blocks make of them, through their
 * tables, against the dense matrix that the list of ties is. */
#include "cloth/flow/state/bodies.h"
#include "cloth/flow/state/kernels.h"
#include "cloth/solve/coarse.h"
#include "cloth/solve/local.h"
#include "tests/cloth/flow/models.h"
#include "tests/cloth/flow/random_ties.h"

UNIT_TEST(room_that_does_not_do)
{
    uint32_t others[BLOCKS][2];
    make_all(1);
    for (int lacks = 0; lacks < 5; lacks++) {
        struct flow_ties_of of = table_of(1, BLOCKS, others);
        of.room.ties -= lacks == 1;
        of.room.rows -= lacks == 2;
        of.room.others = lacks == 3 ? of.n_others - 1 : BLOCKS;
        of.n_others -= lacks == 4;
        void *memory = aligned_alloc(64, flow_ties_bytes(of.n_rows, &of.room));
        ck_assert_ptr_nonnull(memory);
        ck_assert(flow_ties_make(&of, memory) == !lacks);
        ck_assert(lacks == 0 || (!flow_ties_open(memory).n && !flow_ties_others(memory)));
        free(memory);
    }
    free_all();
}

/* Blocks may be among the others of each other though they share no tie. */
UNIT_TEST(others_that_show_nothing)
{
    uint32_t others[BLOCKS][2];
    make_all(2);
    const struct flow_ties_of of = table_of(1, BLOCKS - 1, others);
    void *memory = aligned_alloc(64, flow_ties_bytes(of.n_rows, &of.room));
    ck_assert_ptr_nonnull(memory);
    ck_assert(flow_ties_make(&of, memory));
    const struct flow_ties t = flow_ties_open(memory);
    const uint32_t last = flow_ties_others(memory) - 1;
    ck_assert_uint_eq(t.other[last], BLOCKS - 1);
    ck_assert_uint_eq(t.start[last], t.start[last + 1]);
    free(memory);
    free_all();
}

/* ---- What a block makes of them ---- */

/* A block without entries, as a solve sees it. */
struct seen {
    struct flow_ties ties;
    struct solve_block block;
    struct solve_ties solved;
    struct solve_cut cut;
    double free[ROWS];
    uint32_t row[ROWS + 1];
    phys_vec value[4 * (3 + TIES)], ghosts[BLOCKS * ROWS];
};

static void see(uint32_t b, enum solve_format format, struct seen *s)
{
    memset(s, 0, sizeof *s);
    s->ties = flow_ties_open(table[b]);
    for (uint32_t row = 0; row < n_rows[b]; row++)
        s->free[row] = 1;
    s->block = (struct solve_block){
        .n = n_rows[b], .diagonal = diagonal[b], .free = s->free, .row = s->row, .format = format};
    for (uint32_t i = 0; i < s->ties.n; i++)
        s->value[i] = values[s->ties.of[i]];
    for (uint32_t g = 0; g < s->ties.n_ghosts; g++)
        s->ghosts[g] = p[s->ties.other[s->ties.ghost_other[g]]][s->ties.ghost_row[g]];
    ck_assert_uint_le(s->ties.room.ties + flow_acting_rows(s->ties.room.ties), 4 * (3 + TIES));
    flow_ties_gather(&s->ties, s->value);
    s->solved = flow_ties_solved(&s->ties, s->value, s->ghosts);
    s->cut = (struct solve_cut){0, NULL, s->ties.n_halo, s->ties.halo, &s->solved};
}

static double dense_times(uint32_t b, uint32_t row, int c)
{
    double y = 0;
    for (uint32_t o = 0; o < BLOCKS; o++)
        for (uint32_t r = 0; r < n_rows[o]; r++)
            for (int d = 0; d < 3; d++)
                y += dense[place(b, row, c)][place(o, r, d)] * p[o][r][d];
    return y;
}

UNIT_LOOP(product, 0, 6)
{
    static const phys_vec none[2 * ROWS]; /* turns, too */
    repeats = _i > 2;
    make_all((unsigned)_i + 1);
    for (uint32_t b = 0; b < BLOCKS; b++) {
        phys_vec dv[ROWS], r[ROWS] = {{0}}, was[ROWS], q[ROWS] = {{0}};
        double dots[SOLVE_DOTS];
        struct seen s;
        see(b, (enum solve_format)(_i % 3), &s);
        memcpy(dv, p[b], sizeof dv);
        const struct solve_rows rows = solve_rows_plain(dv, r, was, q);
        memset(was, 0, sizeof was);
        solve_residual(&s.block, &s.cut, none, none, NULL, &rows, dots);
        for (uint32_t row = 0; row < n_rows[b]; row++)
            for (int c = 0; c < 3; c++)
                ck_assert_double_eq_tol(q[row][c], dense_times(b, row, c), 1e-10);
    }
    free_all();
}

/* So many corners come first that are rows; the others are ghosts, or have no weight. */
static void check_kind(const struct seen *s, uint32_t i, uint32_t kind)
{
    const uint32_t own = kind ? kind : 1;
    ck_assert_double_ne(s->solved.weight[i][0], 0);
    for (uint32_t k = 0; k < SOLVE_TIE_CORNERS; k++) {
        const bool here = s->solved.corner[i][k] < s->ties.n_rows;
        if (kind == SOLVE_TIE_ALONE && k > 0)
            ck_assert_double_eq(s->solved.weight[i][k], 0);
        else
            ck_assert(here == (k < own));
        ck_assert_uint_lt(s->solved.corner[i][k], s->ties.n_rows + s->ties.n_ghosts);
    }
}

UNIT_LOOP(solved_ties_by_kind, 0, 6)
{
    uint32_t of_kind[SOLVE_TIE_KINDS] = {0};
    repeats = _i > 2;
    make_all((unsigned)_i + 1);
    for (uint32_t b = 0; b < BLOCKS; b++) {
        struct seen s;
        see(b, SOLVE_SPRINGS, &s);
        ck_assert_uint_eq(s.solved.start[0], 0);
        ck_assert_uint_eq(s.solved.start[SOLVE_TIE_KINDS], s.solved.n);
        for (uint32_t kind = 0; kind < SOLVE_TIE_KINDS; kind++)
            for (uint32_t i = s.solved.start[kind]; i < s.solved.start[kind + 1]; i++) {
                check_kind(&s, i, kind);
                of_kind[kind]++;
            }
    }
    for (uint32_t kind = 0; kind < SOLVE_TIE_INNER; kind++)
        ck_assert_uint_gt(of_kind[kind], 0);
    free_all();
}

UNIT_LOOP(local_preconditioners_have_the_diagonal, 0, 4)
{
    static const phys_vec none[2 * ROWS];
    static _Alignas(32) double factor[8 * ROWS];
    make_all((unsigned)_i + 1);
    for (uint32_t b = 0; b < BLOCKS; b++) {
        phys_vec s[ROWS];
        struct seen seen;
        see(b, SOLVE_SPRINGS, &seen);
        const enum solve_local kind = _i % 2 ? SOLVE_IC0 : SOLVE_JACOBI;
        ck_assert_int_eq(solve_local_factor(&seen.block, &seen.cut, none, kind, factor), 0);
        solve_local_apply(&seen.block, kind, factor, p[b], s);
        for (uint32_t row = 0; row < n_rows[b]; row++)
            for (int c = 0; c < 3; c++) {
                double y = 0;
                for (int d = 0; d < 3; d++)
                    y += dense[place(b, row, c)][place(b, row, d)] * s[row][d];
                ck_assert_double_eq_tol(y, p[b][row][c], 1e-9);
            }
    }
    free_all();
}

/* P' N P of rows with weights, some without axes. */
UNIT_TEST(coarse_block)
{
    enum { N = 4 };
    srand(5);
    for (int trial = 0; trial < 100; trial++) {
        double block[SOLVE_COUPLING] = {0};
        struct solve_lifted a = {{0}}, b = {{0}};
        const phys_vec value = {draw(), draw(), draw(), 1 + draw()};
        phys_vec basis[N];
        double weight[N];
        for (int i = 0; i < N; i++) {
            basis[i] = (phys_vec){1, draw(), draw(), (double)below(8)};
            weight[i] = draw();
            solve_lift_corner(weight[i], basis + i, i < 2 ? &a : &b);
        }
        solve_couple_lifted(&value, &a, &b, block);
        for (int at = 0; at < SOLVE_COUPLING; at++) {
            const int k = at / 9 / 3, c = at / 9 % 3, l = at % 9 / 3, d = at % 3;
            double sum = 0;
            for (int i = 0; i < 2; i++)
                for (int j = 2; j < N; j++)
                    sum += weight[i] * basis[i][k] * !((int)basis[i][3] >> c & 1) * weight[j] *
                           basis[j][l] * !((int)basis[j][3] >> d & 1);
            sum *= value[c] * value[d] + (c == d ? value[3] : 0);
            ck_assert_double_eq_tol(block[at], sum, 1e-13);
        }
    }
}
