/* The cases that fork and wait with oneTBB, or with Taskflow (RIVAL_TASKFLOW), as the public
 * comparison of runtimes writes them: the last child is a plain call. */
#define _Alignas(n) alignas(n)
extern "C" {
#include "bench/forks.h"
#include "bench/problem.h"
#include "bench/serve.h"
}

#include <memory>

#ifdef RIVAL_TASKFLOW
#include <taskflow/taskflow.hpp>

static std::unique_ptr<tf::Executor> executor;

class group {
    tf::TaskGroup tasks = executor->task_group();

  public:
    template <class F> void fork(F body)
    {
        tasks.silent_async(body);
    }
    void wait()
    {
        tasks.corun();
    }
};

template <class F> static void run_in(std::size_t threads, F body)
{
    if (!executor || executor->num_workers() != threads)
        executor = std::make_unique<tf::Executor>(threads);
    executor->async(body).get();
}

template <class F, class G> static void both(F one, G other)
{
    group children;
    children.fork(one);
    other();
    children.wait();
}
#else
#include <tbb/tbb.h>

class group {
    tbb::task_group tasks;

  public:
    template <class F> void fork(F body)
    {
        tasks.run(body);
    }
    void wait()
    {
        tasks.wait();
    }
};

template <class F> static void run_in(std::size_t threads, F body)
{
    static std::unique_ptr<tbb::task_arena> arena;
    if (!arena || arena->max_concurrency() != static_cast<int>(threads))
        arena = std::make_unique<tbb::task_arena>(static_cast<int>(threads));
    arena->execute(body);
}

template <class F, class G> static void both(F one, G other)
{
    tbb::parallel_invoke(one, other);
}
#endif

/* Twice, the first time to get warm; the seconds of the second. */
template <class F> static double time_twice(serve_request *request, F body)
{
    const std::size_t threads = serve_number(request, "threads");
    run_in(threads, body);
    const double start = serve_seconds();
    run_in(threads, body);
    return serve_seconds() - start;
}

static int judge(bool right)
{
    return right ? 0 : serve_fail("wrong answer");
}

/* ---- The cases ---- */

static int64_t fib(unsigned n)
{
    int64_t first, second;
    if (n < 2)
        return n;
    both([&] { first = fib(n - 1); }, [&] { second = fib(n - 2); });
    return first + second;
}

static int run_fib(void *, serve_request *request, double *value)
{
    const unsigned n = static_cast<unsigned>(serve_number(request, "n"));
    int64_t result = -1;
    *value = time_twice(request, [&] { result = fib(n); });
    return judge(result == problem_fib(n));
}

static uint64_t skynet(uint64_t first, uint64_t n)
{
    uint64_t part[FORKS_TEN], sum = 0;
    if (n == 1)
        return first;
    const uint64_t tenth = n / FORKS_TEN;
    group children;
    for (uint64_t i = 0; i + 1 < FORKS_TEN; i++)
        children.fork([=, &part] { part[i] = skynet(first + i * tenth, tenth); });
    part[FORKS_TEN - 1] = skynet(first + (FORKS_TEN - 1) * tenth, tenth);
    children.wait();
    for (uint64_t one : part)
        sum += one;
    return sum;
}

static int run_skynet(void *, serve_request *request, double *value)
{
    const uint64_t n = serve_number(request, "n");
    uint64_t result = 0;
    *value = time_twice(request, [&] { result = skynet(0, n); });
    return judge(result == forks_skynet(0, n));
}

static uint64_t queens(const forks_board &board)
{
    forks_board next[FORKS_QUEENS];
    uint64_t part[FORKS_QUEENS] = {0}, sum = 0;
    if (board.row == board.n)
        return 1;
    const unsigned n = forks_next(&board, next);
    group children;
    for (unsigned i = 0; i + 1 < n; i++)
        children.fork([i, &next, &part] { part[i] = queens(next[i]); });
    if (n)
        part[n - 1] = queens(next[n - 1]);
    children.wait();
    for (unsigned i = 0; i < n; i++)
        sum += part[i];
    return sum;
}

static int run_queens(void *, serve_request *request, double *value)
{
    forks_board board = {};
    board.n = static_cast<uint8_t>(serve_number(request, "n"));
    uint64_t result = 0;
    *value = time_twice(request, [&] { result = queens(board); });
    return judge(result == forks_queens(&board));
}

static void multiply(int32_t *matrices, forks_square square)
{
    if (square.n <= FORKS_TILE) {
        forks_tile(matrices, square);
        return;
    }
    for (unsigned half = 0; half < FORKS_QUARTERS; half += FORKS_QUARTERS / 2) {
        group children;
        for (unsigned k = half; k < half + 3; k++)
            children.fork([=] { multiply(matrices, forks_quarter(square, k)); });
        multiply(matrices, forks_quarter(square, half + 3));
        children.wait();
    }
}

static int run_matmul(void *, serve_request *request, double *value)
{
    forks_square square;
    const std::size_t n = serve_number(request, "n"), threads = serve_number(request, "threads");
    int32_t *matrices = forks_matrices(n, &square);
    bool right = true;
    if (!matrices)
        return serve_no_memory();
    for (int i = 0; i < 2; i++) {
        const double start = serve_seconds();
        run_in(threads, [=] { multiply(matrices, square); });
        *value = serve_seconds() - start;
        right = !forks_matrices_wrong(matrices, n) && right;
    }
    free(matrices);
    return judge(right);
}

int main()
{
    static const serve_run runs[] = {{"fib", run_fib},
                                     {"skynet", run_skynet},
                                     {"queens", run_queens},
                                     {"matmul", run_matmul},
                                     {nullptr, nullptr}};
    const serve_run *const all[] = {runs, nullptr};
    const int status = serve(RIVAL_SETTINGS, all, nullptr);
#ifdef RIVAL_TASKFLOW
    executor.reset();
#endif
    return status;
}
