/* The cases with OpenMP tasks: built once with gcc for libgomp and once with clang for libomp. One
 * thread makes all tasks, and takes part when it waits for them. */
#include "bench/rivals/openmp.h"
#include "bench/problem.h"
#include "bench/serve.h"
#include "bench/tiles.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

static problem_point *const volatile COMBINE = problem_combine, *const volatile NOTHING =
                                                                    problem_nothing;
static problem_link *const volatile NEXT = problem_next;
static problem_mark_body *const volatile MARK = problem_mark;

/* ---- Stencil ---- */

static void make_stencil(struct problem_cell *const field[2], size_t points, size_t steps,
                         problem_point *body)
{
    for (size_t s = 0; s < steps; s++) {
        struct problem_cell *old = field[s % 2], *new = field[1 - s % 2];
        for (size_t i = 0; i < points; i++) {
            uint64_t *left = &old[i ? i - 1 : points - 1].value, *middle = &old[i].value;
            uint64_t *right = &old[i + 1 < points ? i + 1 : 0].value, *out = &new[i].value;
#pragma omp task depend(in                                                                         \
                        : *left, *middle, *right) depend(out                                       \
                                                         : *out)                                   \
    firstprivate(left, middle, right, out, body)
            body(left, middle, right, out);
        }
    }
#pragma omp taskwait
}

static double time_stencil(struct problem_cell *const field[2], size_t points, size_t steps,
                           int threads, problem_point *body)
{
    double seconds = 0;
#pragma omp parallel num_threads(threads)
#pragma omp master
    {
        double start = serve_seconds();
        make_stencil(field, points, steps, body);
        seconds = serve_seconds() - start;
    }
    return seconds;
}

static int stencil(void *context, struct serve_request *request, double *value)
{
    size_t points = serve_number(request, "points"), steps = serve_number(request, "steps");
    int threads = (int)serve_number(request, "threads");
    struct problem_cell *field[2];
    (void)context;
    if (problem_fields(field, points))
        return serve_no_memory();
    time_stencil(field, points, steps, threads, COMBINE);
    int wrong = problem_stencil_wrong(field[steps % 2], points, steps);
    *value = time_stencil(field, points, steps, threads, NOTHING);
    free(field[0]);
    return wrong ? serve_fail("wrong answer") : 0;
}

/* ---- Chain ---- */

static double time_chain(uint64_t *x, uint64_t n, int threads)
{
    problem_link *body = NEXT;
    double seconds = 0;
#pragma omp parallel num_threads(threads)
#pragma omp master
    {
        double start = serve_seconds();
        for (uint64_t i = 0; i < n; i++) {
#pragma omp task depend(inout : *x) firstprivate(x, i, body)
            body(x, i);
        }
#pragma omp taskwait
        seconds = serve_seconds() - start;
    }
    return seconds;
}

static int chain(void *context, struct serve_request *request, double *value)
{
    uint64_t n = serve_number(request, "tasks"), x = 0;
    int threads = (int)serve_number(request, "threads");
    (void)context;
    time_chain(&x, n, threads);
    x = 0;
    *value = time_chain(&x, n, threads);
    return x == problem_chain(n, &NEXT) ? 0 : serve_fail("wrong answer");
}

/* ---- Independent tasks ---- */

static double time_independent(uint64_t *mark, uint64_t n, int threads)
{
    problem_mark_body *body = MARK;
    double seconds = 0;
#pragma omp parallel num_threads(threads)
#pragma omp master
    {
        double start = serve_seconds();
        for (uint64_t i = 0; i < n; i++) {
#pragma omp task firstprivate(mark, i, body)
            body(mark, i);
        }
#pragma omp taskwait
        seconds = serve_seconds() - start;
    }
    return seconds;
}

static int independent(void *context, struct serve_request *request, double *value)
{
    uint64_t n = serve_number(request, "tasks");
    int threads = (int)serve_number(request, "threads");
    uint64_t *mark = calloc(n, sizeof *mark);
    (void)context;
    if (!mark)
        return serve_no_memory();
    time_independent(mark, n, threads);
    int wrong = problem_marks_wrong(mark, n);
    *value = time_independent(mark, n, threads);
    wrong |= problem_marks_wrong(mark, n);
    free(mark);
    return wrong ? serve_fail("wrong answer") : 0;
}

/* ---- Fibonacci ---- */

static void fib(unsigned n, int64_t *result)
{
    int64_t first, second;
    if (n < 2) {
        *result = n;
        return;
    }
#pragma omp task shared(first)
    fib(n - 1, &first);
    fib(n - 2, &second);
#pragma omp taskwait
    *result = first + second;
}

static double time_fib(unsigned n, int threads, int64_t *result)
{
    double seconds = 0;
#pragma omp parallel num_threads(threads)
#pragma omp master
    {
        double start = serve_seconds();
        fib(n, result);
        seconds = serve_seconds() - start;
    }
    return seconds;
}

static int fibonacci(void *context, struct serve_request *request, double *value)
{
    unsigned n = (unsigned)serve_number(request, "n");
    int threads = (int)serve_number(request, "threads");
    int64_t warm = -1, result = -1;
    (void)context;
    time_fib(n, threads, &warm);
    *value = time_fib(n, threads, &result);
    int64_t right = problem_fib(n);
    return warm == right && result == right ? 0 : serve_fail("wrong answer");
}

/* ---- The unbalanced tree ---- */

static uint64_t tree_nodes; /* by thread */
#pragma omp threadprivate(tree_nodes)

static void tree_node(struct problem_node node, uint32_t levels)
{
    const uint32_t n = problem_tree_children(&node, levels);
    tree_nodes++;
    for (uint32_t i = 0; i < n; i++) {
        const struct problem_node child = problem_tree_child(&node, i);
#pragma omp task firstprivate(child, levels)
        tree_node(child, levels);
    }
}

static double time_tree(uint32_t levels, int threads, uint64_t *nodes)
{
    double seconds = 0;
    uint64_t sum = 0;
#pragma omp parallel num_threads(threads) reduction(+ : sum)
    {
        tree_nodes = 0;
#pragma omp barrier
#pragma omp master
        {
            double start = serve_seconds();
#pragma omp taskgroup
            tree_node(problem_tree_root(), levels);
            seconds = serve_seconds() - start;
        }
#pragma omp barrier
        sum += tree_nodes;
    }
    *nodes = sum;
    return seconds;
}

static int tree(void *context, struct serve_request *request, double *value)
{
    const uint32_t levels = (uint32_t)serve_number(request, "levels");
    const struct problem_node root = problem_tree_root();
    int threads = (int)serve_number(request, "threads");
    uint64_t warm = 0, nodes = 0;
    (void)context;
    time_tree(levels, threads, &warm);
    *value = time_tree(levels, threads, &nodes);
    uint64_t right = problem_tree_nodes(&root, levels);
    return warm == right && nodes == right ? 0 : serve_fail("wrong answer");
}

/* ---- Factorisations by tiles ---- */

struct tiled {
    double *a;
    size_t size;
};

static void make_tiles_task(const struct tiles_task *task, void *context)
{
    const struct tiled *tiled = context;
    const size_t size = tiled->size, length = size * size;
    tiles_body *body = tiles_routine[task->routine];
    double *x = tiled->a + task->x * length, *y = tiled->a + task->y * length;
    double *z = tiled->a + task->z * length;
    switch (tiles_reads[task->routine]) {
    case 0:
#pragma omp task depend(inout : *z) firstprivate(z, size, body)
        body(NULL, NULL, z, size);
        break;
    case 1:
#pragma omp task depend(in : *x) depend(inout : *z) firstprivate(x, z, size, body)
        body(x, NULL, z, size);
        break;
    default:
#pragma omp task depend(in : *x, *y) depend(inout : *z) firstprivate(x, y, z, size, body)
        body(x, y, z, size);
    }
}

static double time_tiles(struct tiles tiles, double *a, int threads)
{
    double seconds = 0;
#pragma omp parallel num_threads(threads)
#pragma omp master
    {
        double start = serve_seconds();
        tiles_visit(tiles, make_tiles_task, &(struct tiled){a, tiles.size});
#pragma omp taskwait
        seconds = serve_seconds() - start;
    }
    return seconds;
}

static int time_all(struct tiles tiles, double *a, int threads, double *value)
{
    double *start = tiles_make(tiles);
    if (!start)
        return serve_no_memory();
    int wrong = 0;
    for (int i = 0; i < TILES_TIMES; i++) {
        memcpy(a, start, tiles_bytes(tiles));
        *value = tiles_least(*value, i, time_tiles(tiles, a, threads));
        wrong |= tiles_all_wrong(tiles, a);
    }
    free(start);
    return wrong ? serve_fail("wrong answer") : 0;
}

static int factorise(struct serve_request *request, enum tiles_kind kind, double *value)
{
    const struct tiles tiles = {kind, serve_number(request, "tiles"),
                                serve_number(request, "rows")};
    double *a = tiles_make(tiles);
    int code =
        a ? time_all(tiles, a, (int)serve_number(request, "threads"), value) : serve_no_memory();
    free(a);
    return code;
}

static int cholesky(void *context, struct serve_request *request, double *value)
{
    (void)context;
    return factorise(request, TILES_CHOLESKY, value);
}

static int lu(void *context, struct serve_request *request, double *value)
{
    (void)context;
    return factorise(request, TILES_LU, value);
}

int main(void)
{
    static const struct serve_run runs[] = {{"stencil", stencil},
                                            {"chain", chain},
                                            {"independent", independent},
                                            {"fib", fibonacci},
                                            {"tree", tree},
                                            {"cholesky", cholesky},
                                            {"lu", lu},
                                            {0}};
    const struct serve_run *const all[] = {runs, openmp_forks, NULL};
    return serve(RIVAL_SETTINGS, all, NULL);
}
