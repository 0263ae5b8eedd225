/* The cases of bench/forks.h with OpenMP tasks: the last child is a plain call. */
#include "bench/forks.h"
#include "bench/rivals/openmp.h"

#include <stdlib.h>

static uint64_t skynet(uint64_t first, uint64_t n)
{
    uint64_t part[FORKS_TEN], sum = 0;
    if (n == 1)
        return first;
    const uint64_t tenth = n / FORKS_TEN;
    for (uint64_t i = 0; i + 1 < FORKS_TEN; i++) {
#pragma omp task shared(part) firstprivate(i)
        part[i] = skynet(first + i * tenth, tenth);
    }
    part[FORKS_TEN - 1] = skynet(first + (FORKS_TEN - 1) * tenth, tenth);
#pragma omp taskwait
    for (int i = 0; i < FORKS_TEN; i++)
        sum += part[i];
    return sum;
}

static uint64_t queens(const struct forks_board *board)
{
    struct forks_board next[FORKS_QUEENS];
    uint64_t part[FORKS_QUEENS], sum = 0;
    if (board->row == board->n)
        return 1;
    const unsigned n = forks_next(board, next);
    for (unsigned i = 0; i + 1 < n; i++) {
#pragma omp task shared(part, next) firstprivate(i)
        part[i] = queens(&next[i]);
    }
    if (n)
        part[n - 1] = queens(&next[n - 1]);
#pragma omp taskwait
    for (unsigned i = 0; i < n; i++)
        sum += part[i];
    return sum;
}

static void multiply(int32_t *matrices, struct forks_square square)
{
    if (square.n <= FORKS_TILE) {
        forks_tile(matrices, square);
        return;
    }
    for (unsigned half = 0; half < FORKS_QUARTERS; half += FORKS_QUARTERS / 2) {
        for (unsigned k = half; k < half + 3; k++) {
#pragma omp task firstprivate(k)
            multiply(matrices, forks_quarter(square, k));
        }
        multiply(matrices, forks_quarter(square, half + 3));
#pragma omp taskwait
    }
}

/* ---- Runs ---- */

struct problem {
    uint64_t n, answer;
    int32_t *matrices;
    struct forks_square square;
};

static void solve_skynet(struct problem *problem)
{
    problem->answer = skynet(0, problem->n);
}

static void solve_queens(struct problem *problem)
{
    problem->answer = queens(&(struct forks_board){.n = (uint8_t)problem->n});
}

static void solve_matmul(struct problem *problem)
{
    multiply(problem->matrices, problem->square);
}

static double time_one(struct problem *problem, void (*solve)(struct problem *problem), int threads)
{
    double seconds = 0;
#pragma omp parallel num_threads(threads)
#pragma omp master
    {
        const double start = serve_seconds();
        solve(problem);
        seconds = serve_seconds() - start;
    }
    return seconds;
}

/* Twice, the first time to get warm; the seconds of the second. */
static int time_twice(struct serve_request *request, struct problem *problem,
                      void (*solve)(struct problem *problem), uint64_t right, double *value)
{
    const int threads = (int)serve_number(request, "threads");
    int wrong = 0;
    for (int i = 0; i < 2; i++) {
        problem->answer = 0;
        *value = time_one(problem, solve, threads);
        if (problem->matrices)
            problem->answer = !forks_matrices_wrong(problem->matrices, problem->n);
        wrong |= problem->answer != right;
    }
    return wrong ? serve_fail("wrong answer") : 0;
}

static int run_skynet(void *context, struct serve_request *request, double *value)
{
    struct problem problem = {.n = serve_number(request, "n")};
    (void)context;
    return time_twice(request, &problem, solve_skynet, forks_skynet(0, problem.n), value);
}

static int run_queens(void *context, struct serve_request *request, double *value)
{
    struct problem problem = {.n = serve_number(request, "n")};
    const struct forks_board board = {.n = (uint8_t)problem.n};
    (void)context;
    return time_twice(request, &problem, solve_queens, forks_queens(&board), value);
}

static int run_matmul(void *context, struct serve_request *request, double *value)
{
    struct problem problem = {.n = serve_number(request, "n")};
    (void)context;
    problem.matrices = forks_matrices(problem.n, &problem.square);
    if (!problem.matrices)
        return serve_no_memory();
    const int code = time_twice(request, &problem, solve_matmul, 1, value);
    free(problem.matrices);
    return code;
}

const struct serve_run openmp_forks[] = {
    {"skynet", run_skynet}, {"queens", run_queens}, {"matmul", run_matmul}, {0}};
