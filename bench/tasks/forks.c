/* Tasks that fork tasks and wait for them, in the sizes of others who measure that (bench/forks.h):
 * the last child is a plain call. Skynet and queens return their results in objects; matrices are
 * no objects but memory that all tasks know, and a task waits for its children. Figures are the
 * time of a core for a call. */
#include "bench/forks.h"
#include "bench/tasks/tasks.h"

#include <stdio.h>
#include <stdlib.h>

const char *const tasks_forking_rivals[] = {"libgomp", "libomp", "tbb", "taskflow", NULL};

static void plan_one(struct measure *measure, const struct bench_options *options, const char *name,
                     unsigned n, uint64_t calls)
{
    static const char *const variants[] = {"", NULL};
    char size[40];
    snprintf(size, sizeof size, "n=%u", n);
    tasks_plan_contest(measure, options,
                       &(struct tasks_contest){.name = name,
                                               .size = size,
                                               .tasks = (double)calls,
                                               .core = true,
                                               .variants = variants,
                                               .rivals = tasks_forking_rivals});
}

static void plan_skynet(struct measure *measure, const struct bench_options *options)
{
    const unsigned n = options->quick ? 100 : 100000;
    plan_one(measure, options, "skynet", n, forks_skynet_calls(n));
}

static void plan_queens(struct measure *measure, const struct bench_options *options)
{
    const struct forks_board board = {.n = options->quick ? 5 : 10};
    plan_one(measure, options, "queens", board.n, forks_queens_calls(&board));
}

static void plan_matmul(struct measure *measure, const struct bench_options *options)
{
    const unsigned n = options->quick ? 2 * FORKS_TILE : 16 * FORKS_TILE;
    plan_one(measure, options, "matmul", n, forks_multiply_calls(n));
}

/* ---- Tasks ---- */

/* Adds what n children leave. */
static int add_up(duite *rt, size_t n, const duite_object *part, uint64_t *sum)
{
    uint64_t one = 0;
    int code = 0;
    for (size_t i = 0; i < n && !code; i++) {
        code = duite_get(rt, part[i], &one);
        *sum += one;
    }
    return code;
}

struct numbers {
    uint64_t first, n;
};

static int add_numbers(duite *rt, uint64_t first, uint64_t n, uint64_t *sum)
{
    const uint64_t tenth = n / FORKS_TEN;
    duite_object part[FORKS_TEN - 1];
    *sum = first;
    if (!tenth)
        return 0;
    for (uint64_t i = 0; i < FORKS_TEN - 1; i++) {
        duite_new(rt, DUITE_U64, 1, &part[i]);
        DUITE_FORK(rt, &tasks_forks_kernels[TASKS_SKYNET],
                   DUITE_ARGS(struct numbers, first + i * tenth, tenth), part[i]);
    }
    const int code = add_numbers(rt, first + (FORKS_TEN - 1) * tenth, tenth, sum);
    return code ? code : add_up(rt, FORKS_TEN - 1, part, sum);
}

static int skynet(const duite_call *call)
{
    const struct numbers *numbers = call->args;
    return add_numbers(call->rt, numbers->first, numbers->n, duite_out(call, 0, uint64_t));
}

static int add_boards(duite *rt, const struct forks_board *board, uint64_t *sum)
{
    struct forks_board next[FORKS_QUEENS];
    duite_object part[FORKS_QUEENS];
    *sum = board->row == board->n;
    const unsigned n = *sum ? 0 : forks_next(board, next);
    for (unsigned i = 0; i + 1 < n; i++) {
        duite_new(rt, DUITE_U64, 1, &part[i]);
        DUITE_FORK(rt, &tasks_forks_kernels[TASKS_QUEENS], &next[i], part[i]);
    }
    const int code = n ? add_boards(rt, &next[n - 1], sum) : 0;
    return code || !n ? code : add_up(rt, n - 1, part, sum);
}

static int queens(const duite_call *call)
{
    return add_boards(call->rt, call->args, duite_out(call, 0, uint64_t));
}

static int matmul(const duite_call *call)
{
    const struct tasks_session *session = call->context;
    const struct forks_square *square = call->args;
    if (square->n <= FORKS_TILE) {
        forks_tile(session->matrices, *square);
        return 0;
    }
    int code = 0;
    for (unsigned k = 0; k < FORKS_QUARTERS && !code; k++) {
        const struct forks_square quarter = forks_quarter(*square, k);
        duite_fork(call->rt, &tasks_forks_kernels[TASKS_MATMUL], &quarter, 0, NULL);
        if (k + 1 == FORKS_QUARTERS / 2 || k + 1 == FORKS_QUARTERS)
            code = duite_wait(call->rt);
    }
    return code;
}

const duite_kernel tasks_forks_kernels[TASKS_FORKS] = {
    {.name = "skynet", .body = skynet, .access = {DUITE_W}, .args_size = sizeof(struct numbers)},
    {.name = "queens",
     .body = queens,
     .access = {DUITE_W},
     .args_size = sizeof(struct forks_board)},
    {.name = "matmul", .body = matmul, .args_size = sizeof(struct forks_square)}};

/* ---- Runs ---- */

/* The answer of a task, twice; the seconds of the second. */
static int time_twice(struct tasks_session *session, struct serve_request *request,
                      const duite_kernel *kernel, const void *args, uint64_t right, double *value)
{
    duite_object object;
    int code = tasks_ready(session, request);
    if (!code)
        code = tasks_objects(session, DUITE_U64, 1, 1, &object);
    if (code)
        return code;
    for (int i = 0; i < 2 && !code; i++) {
        uint64_t got = 0;
        const double start = serve_seconds();
        code = duite_fork(session->rt, kernel, args, 1, &object);
        if (!code)
            code = duite_wait(session->rt);
        *value = serve_seconds() - start;
        code = tasks_code(code ? code : duite_get(session->rt, object, &got));
        if (!code && got != right)
            code = serve_fail("wrong answer");
    }
    tasks_free_objects(session, 1, &object);
    return code;
}

static int run_skynet(void *context, struct serve_request *request, double *value)
{
    const struct numbers all = {0, serve_number(request, "n")};
    return time_twice(context, request, &tasks_forks_kernels[TASKS_SKYNET], &all,
                      forks_skynet(0, all.n), value);
}

static int run_queens(void *context, struct serve_request *request, double *value)
{
    const struct forks_board board = {.n = (uint8_t)serve_number(request, "n")};
    return time_twice(context, request, &tasks_forks_kernels[TASKS_QUEENS], &board,
                      forks_queens(&board), value);
}

static int run_matmul(void *context, struct serve_request *request, double *value)
{
    struct tasks_session *session = context;
    const size_t n = serve_number(request, "n");
    struct forks_square square;
    int code = tasks_ready(session, request);
    session->matrices = code ? NULL : forks_matrices(n, &square);
    if (!code && !session->matrices)
        code = serve_no_memory();
    for (int i = 0; i < 2 && !code; i++) {
        const double start = serve_seconds();
        code = duite_fork(session->rt, &tasks_forks_kernels[TASKS_MATMUL], &square, 0, NULL);
        code = tasks_code(code ? code : duite_wait(session->rt));
        *value = serve_seconds() - start;
        if (!code && forks_matrices_wrong(session->matrices, n))
            code = serve_fail("wrong answer");
    }
    free(session->matrices);
    return code;
}

/* ---- Without tasks ---- */

static int sequential_skynet(void *context, struct serve_request *request, double *value)
{
    static uint64_t (*volatile body)(uint64_t, uint64_t) = forks_skynet;
    const uint64_t n = serve_number(request, "n");
    (void)context;
    const double start = serve_seconds();
    const uint64_t sum = body(0, n);
    *value = serve_seconds() - start;
    return sum == n * (n - 1) / 2 ? 0 : serve_fail("wrong answer");
}

static int sequential_queens(void *context, struct serve_request *request, double *value)
{
    const struct forks_board board = {.n = (uint8_t)serve_number(request, "n")};
    (void)context;
    const double start = serve_seconds();
    const uint64_t sum = forks_queens(&board);
    *value = serve_seconds() - start;
    return sum ? 0 : serve_fail("wrong answer");
}

static int sequential_matmul(void *context, struct serve_request *request, double *value)
{
    struct forks_square square;
    const size_t n = serve_number(request, "n");
    int32_t *matrices = forks_matrices(n, &square);
    (void)context;
    if (!matrices)
        return serve_no_memory();
    const double start = serve_seconds();
    forks_multiply(matrices, square);
    *value = serve_seconds() - start;
    const int wrong = forks_matrices_wrong(matrices, n);
    free(matrices);
    return wrong ? serve_fail("wrong answer") : 0;
}

static const struct serve_run SKYNET[] = {
    {"skynet", run_skynet}, {"skynet_sequential", sequential_skynet}, {0}};
static const struct serve_run QUEENS[] = {
    {"queens", run_queens}, {"queens_sequential", sequential_queens}, {0}};
static const struct serve_run MATMUL[] = {
    {"matmul", run_matmul}, {"matmul_sequential", sequential_matmul}, {0}};

const struct bench_case tasks_skynet = {"skynet", "tasks that fork ten and wait: a sum over a tree",
                                        plan_skynet, SKYNET, 0};
const struct bench_case tasks_queens = {
    "queens", "tasks that fork and wait for some: queens on a board", plan_queens, QUEENS, 0};
const struct bench_case tasks_matmul = {
    "matmul", "tasks that fork and wait for four: a product of matrices", plan_matmul, MATMUL, 0};
