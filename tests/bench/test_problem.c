/* The answers of the bench's problems: a wrong one is seen, whatever is wrong with it. */
#include "bench/forks.h"
#include "bench/problem.h"
#include "bench/tiles.h"

#include "tests/support/unit.h"

#include <stdlib.h>

enum { POINTS = 6, STEPS = 4 };

static void swept(struct problem_cell *field[2], problem_point *body)
{
    problem_point *const volatile pointer = body;
    ck_assert_int_eq(problem_fields(field, POINTS), 0);
    problem_sweep(field, POINTS, STEPS, &pointer);
}

UNIT_TEST(test_stencil)
{
    struct problem_cell *field[2];
    swept(field, problem_combine);
    ck_assert_int_eq(problem_stencil_wrong(field[STEPS % 2], POINTS, STEPS), 0);
    ck_assert_int_ne(problem_stencil_wrong(field[STEPS % 2], POINTS, STEPS + 2), 0);
    for (size_t i = 0; i < POINTS; i++) {
        field[STEPS % 2][i].value ^= 1;
        ck_assert_int_ne(problem_stencil_wrong(field[STEPS % 2], POINTS, STEPS), 0);
        field[STEPS % 2][i].value ^= 1;
    }
    free(field[0]);
}

static void mirrored(const uint64_t *left, const uint64_t *middle, const uint64_t *right,
                     uint64_t *out)
{
    problem_combine(right, middle, left, out);
}

UNIT_TEST(test_stencil_sides)
{
    struct problem_cell *field[2];
    swept(field, mirrored);
    ck_assert_int_ne(problem_stencil_wrong(field[STEPS % 2], POINTS, STEPS), 0);
    free(field[0]);
}

static void backwards(uint64_t *value, uint64_t i)
{
    problem_next(value, 9 - i);
}

UNIT_TEST(test_chain)
{
    problem_link *const volatile right = problem_next, *const volatile wrong = backwards;
    ck_assert(problem_chain(10, &right) != problem_chain(10, &wrong));
    ck_assert(problem_chain(10, &right) != problem_chain(11, &right));
}

UNIT_TEST(test_marks)
{
    uint64_t mark[5] = {0};
    for (uint64_t i = 0; i < 5; i++)
        problem_mark(mark, i);
    ck_assert_int_eq(problem_marks_wrong(mark, 5), 0);
    ck_assert_int_ne(problem_marks_wrong(mark, 5), 0); /* cleared: none is made now */
    for (uint64_t i = 0; i < 5; i++)
        problem_mark(mark, i);
    problem_mark(mark, 3);
    ck_assert_int_ne(problem_marks_wrong(mark, 5), 0);
}

UNIT_TEST(test_line)
{
    struct problem_message now = {3, 1}, before = {2, 1}, out = {0};
    ck_assert_int_eq(problem_line_point(&now, &now, NULL, &out), 0);
    ck_assert_uint_eq(out.step, 4);
    ck_assert_int_ne(problem_line_point(&before, &now, NULL, &out), 0);
    ck_assert_int_ne(problem_line_point(NULL, &before, &now, &out), 0);
    ck_assert_int_ne(problem_line_point(NULL, &now, &before, &out), 0);
}

UNIT_TEST(test_fib)
{
    static const int64_t numbers[] = {0, 1, 1, 2, 3, 5, 8, 13};
    static const uint64_t calls[] = {1, 1, 3, 5, 9, 15, 25, 41};
    for (unsigned n = 0; n < 8; n++) {
        ck_assert_int_eq(problem_fib(n), numbers[n]);
        ck_assert_uint_eq(problem_fib_calls(n), calls[n]);
    }
}

UNIT_TEST(test_skynet)
{
    ck_assert_uint_eq(forks_skynet(7, 1), 7);
    ck_assert_uint_eq(forks_skynet(0, 1000), 499500);
    ck_assert_uint_eq(forks_skynet_calls(1000), 1111);
}

/* Published numbers of solutions; on four rows 17 boards have no queen that takes another. */
UNIT_TEST(test_queens)
{
    static const uint64_t solutions[] = {1, 0, 0, 2, 10, 4, 40, 92};
    for (uint8_t n = 1; n <= 8; n++)
        ck_assert_uint_eq(forks_queens(&(struct forks_board){.n = n}), solutions[n - 1]);
    ck_assert_uint_eq(forks_queens_calls(&(struct forks_board){.n = 4}), 17);
}

UNIT_TEST(test_matrices)
{
    struct forks_square square;
    const size_t n = 4 * FORKS_TILE;
    int32_t *matrices = forks_matrices(n, &square);
    ck_assert_ptr_nonnull(matrices);
    forks_multiply(matrices, square);
    matrices[square.c + 5]++;
    ck_assert_int_ne(forks_matrices_wrong(matrices, n), 0);
    forks_multiply(matrices, square);
    ck_assert_int_eq(forks_matrices_wrong(matrices, n), 0); /* c was cleared */
    for (unsigned k = 0; k < 7; k++)
        forks_multiply(matrices, forks_quarter(square, k));
    ck_assert_int_ne(forks_matrices_wrong(matrices, n), 0);
    ck_assert_uint_eq(forks_multiply_calls(n), 1 + 8 + 64);
    free(matrices);
}

/* The published size of T1, with all 10 levels. */
UNIT_TEST(test_tree)
{
    const struct problem_node root = problem_tree_root();
    ck_assert_uint_eq(problem_tree_nodes(&root, 0), 1);
    ck_assert_uint_eq(problem_tree_nodes(&root, 10), 4130071);
}

/* The factors come out, and a tile with another number is told, where the factors have one. */
UNIT_LOOP(test_tiles, 0, 2)
{
    const struct tiles tiles = {_i ? TILES_LU : TILES_CHOLESKY, 3, 8};
    const size_t last = 3 * 3 - 1, numbers = 8 * 8;
    double *a = tiles_make(tiles);
    ck_assert_ptr_nonnull(a);
    ck_assert_int_ne(tiles_all_wrong(tiles, a), 0);
    tiles_factor(tiles, a);
    ck_assert_int_eq(tiles_all_wrong(tiles, a), 0);
    for (size_t k = 0; k < numbers; k++) {
        const int counts = tiles.kind == TILES_LU || k % 8 >= k / 8;
        a[last * numbers + k] += 1;
        ck_assert_int_eq(tiles_all_wrong(tiles, a), counts);
        a[last * numbers + k] -= 1;
    }
    free(a);
}

struct skip {
    double *a;
    size_t left, visited;
};

/* Every task but one. */
static void visit_others(const struct tiles_task *task, void *context)
{
    struct skip *skip = context;
    if (skip->visited++ != skip->left)
        tiles_routine[task->routine](skip->a + task->x * 64, skip->a + task->y * 64,
                                     skip->a + task->z * 64, 8);
}

UNIT_LOOP(test_tiles_without_a_task, 0, 2)
{
    const struct tiles tiles = {_i ? TILES_LU : TILES_CHOLESKY, 4, 8};
    struct skip skip = {.visited = 1};
    for (skip.left = 0; skip.left < skip.visited; skip.left++) {
        skip.visited = 0;
        skip.a = tiles_make(tiles);
        ck_assert_ptr_nonnull(skip.a);
        tiles_visit(tiles, visit_others, &skip);
        ck_assert_int_ne(tiles_all_wrong(tiles, skip.a), 0);
        free(skip.a);
    }
    ck_assert_uint_eq(skip.visited, (size_t)tiles_tasks(tiles));
}
