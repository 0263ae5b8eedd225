/* The program that valgrind counts for `duite-bench tasks --only instructions`: CASE TASKS runs so
 * many tasks of a case on one thread and checks the answer. A program of its own with the shared
 * library, as programs of users have it. */
#include "bench/problem.h"
#include "bench/tasks/fib.h"

#include <duite.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 64 };

struct counted {
    duite *rt;
    uint64_t tasks, *mark;
    duite_object object[2 * POINTS]; /* two fields of the stencil; chain and fib use the first */
};

/* ---- Kernels ---- */

static int combine(const duite_call *call)
{
    problem_combine(duite_in(call, 0, uint64_t), duite_in(call, 1, uint64_t),
                    duite_in(call, 2, uint64_t), duite_out(call, 3, uint64_t));
    return 0;
}

static int next(const duite_call *call)
{
    problem_next(duite_out(call, 0, uint64_t), *(const uint64_t *)call->args);
    return 0;
}

static int mark(const duite_call *call)
{
    struct counted *counted = call->context;
    problem_mark(counted->mark, *(const uint64_t *)call->args);
    return 0;
}

static int fib(const duite_call *call);

static const duite_kernel
    COMBINE = {.name = "combine", .body = combine, .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_W}},
    NEXT = {.name = "next", .body = next, .access = {DUITE_RW}, .args_size = sizeof(uint64_t)},
    MARK = {.name = "mark", .body = mark, .args_size = sizeof(uint64_t)},
    FIB = {.name = "fib", .body = fib, .access = {DUITE_W}, .args_size = sizeof(unsigned)};
static const duite_kernel *const KERNELS[] = {&COMBINE, &NEXT, &MARK, &FIB, NULL};

static int fib(const duite_call *call)
{
    return fib_wait(call, &FIB);
}

/* ---- Cases: each returns whether its answer is right ---- */

/* Two steps: there and back. */
static int fork_round(duite *rt, void *context)
{
    const struct counted *counted = context;
    int code = 0;
    for (size_t s = 0; s < 2; s++) {
        const duite_object *old = counted->object + s * POINTS,
                           *new = counted->object + (1 - s) * POINTS;
        for (size_t i = 0; i < POINTS; i++)
            code |= DUITE_FORK(rt, &COMBINE, NULL, old[i ? i - 1 : POINTS - 1], old[i],
                               old[i + 1 < POINTS ? i + 1 : 0], new[i]);
    }
    return code;
}

static bool stencil_is_right(struct counted *counted, uint64_t rounds)
{
    struct problem_cell *got[2];
    int code = problem_fields(got, POINTS);
    for (size_t i = 0; i < POINTS && !code; i++)
        code = duite_get(counted->rt, counted->object[i], &got[0][i].value);
    const bool right = !code && !problem_stencil_wrong(got[0], POINTS, 2 * rounds);
    if (!code)
        free(got[0]);
    return right;
}

static void stencil_set(struct counted *counted)
{
    for (size_t i = 0; i < POINTS; i++)
        duite_set(counted->rt, counted->object[i], &(uint64_t){problem_start(i)});
}

static bool stencil(struct counted *counted)
{
    const uint64_t rounds = counted->tasks / (2 * POINTS);
    int code = 0;
    stencil_set(counted);
    for (uint64_t i = 0; i < rounds && !code; i++)
        code = fork_round(counted->rt, counted);
    return !code && stencil_is_right(counted, rounds);
}

static bool replay(struct counted *counted)
{
    const uint64_t rounds = counted->tasks / (2 * POINTS);
    duite_graph graph = DUITE_NO_GRAPH;
    stencil_set(counted);
    int code = duite_graph_new(counted->rt, fork_round, counted, &graph);
    if (!code)
        code = duite_replay(counted->rt, graph, rounds);
    const bool right = !code && stencil_is_right(counted, rounds);
    duite_graph_free(counted->rt, graph);
    return right;
}

static bool chain(struct counted *counted)
{
    static problem_link *const volatile body = problem_next;
    uint64_t got = 0;
    int code = 0;
    for (uint64_t i = 0; i < counted->tasks && !code; i++)
        code = DUITE_FORK(counted->rt, &NEXT, DUITE_ARGS(uint64_t, i % PROBLEM_PERIOD),
                          counted->object[0]);
    return !code && !duite_get(counted->rt, counted->object[0], &got) &&
           got == problem_chain(counted->tasks, &body);
}

static bool independent(struct counted *counted)
{
    int code = 0;
    for (uint64_t i = 0; i < counted->tasks && !code; i++)
        code = duite_fork(counted->rt, &MARK, &i, 0, NULL);
    return !code && !duite_wait(counted->rt) && !problem_marks_wrong(counted->mark, counted->tasks);
}

/* tasks: n, which makes problem_fib_calls(n) tasks. */
static bool fibonacci(struct counted *counted)
{
    int64_t got = -1;
    const unsigned n = (unsigned)counted->tasks;
    return !DUITE_FORK(counted->rt, &FIB, &n, counted->object[0]) &&
           !duite_get(counted->rt, counted->object[0], &got) && got == problem_fib(n);
}

/* ---- The program ---- */

static const struct {
    const char *name;
    bool (*run)(struct counted *counted);
} CASES[] = {{"stencil", stencil},
             {"chain", chain},
             {"independent", independent},
             {"fib", fibonacci},
             {"replay", replay}};

static bool run(struct counted *counted, const char *name)
{
    bool right = false;
    for (size_t i = 0; i < 2 * POINTS; i++)
        duite_new(counted->rt, DUITE_I64, 1, &counted->object[i]);
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++)
        right |= !strcmp(CASES[i].name, name) && CASES[i].run(counted);
    for (size_t i = 0; i < 2 * POINTS; i++)
        duite_free(counted->rt, counted->object[i]);
    return right;
}

int main(int argc, char **argv)
{
    struct counted counted = {.tasks = argc == 3 ? strtoull(argv[2], NULL, 10) : 0};
    duite_options options = duite_options_default();
    options.kernels = KERNELS;
    options.context = &counted;
    options.threads = 1;
    options.window = 0;
    if (argc != 3 || !counted.tasks) {
        fprintf(stderr, "usage: counted CASE TASKS\n");
        return 2;
    }
    counted.mark = calloc(counted.tasks, sizeof *counted.mark);
    if (!counted.mark || duite_start(&counted.rt, &options)) {
        fprintf(stderr, "counted: %s\n", counted.mark ? duite_message() : "out of memory");
        free(counted.mark);
        return 1;
    }
    const bool right = run(&counted, argv[1]);
    const int code = duite_stop(&counted.rt);
    if (!right || code)
        fprintf(stderr, "counted: %s\n", right ? duite_message() : "wrong answer");
    free(counted.mark);
    return !right || code;
}
