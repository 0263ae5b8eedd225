/* One runtime a process, started when a run first wants it and again when a run wants another. */
#include "bench/tasks/tasks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct bench_case *const CASES[] = {
    &tasks_stencil, &tasks_chain,  &tasks_independent,  &tasks_fib_case,
    &tasks_skynet,  &tasks_queens, &tasks_matmul,       &tasks_tree,
    &tasks_tiles,   &tasks_growth, &tasks_bytes,        &tasks_wake,
    &tasks_event,   &tasks_adopt,  &tasks_instructions, NULL};
enum { N_CASES = sizeof CASES / sizeof *CASES - 1 };

/* For two cores and the full sizes. */
static const struct measure_target TARGETS[] = {
    {"stencil_replay_ns_per_task_vs_libomp", 0.06, false},
    {"stencil_dynamic_ns_per_task_vs_libomp", 0.15, false},
    {"stencil_dynamic_ns_per_task_vs_starpu", 0.04, false},
    {"stencil_once_ns_per_task_vs_libomp", 0.3, false},
    {"chain_replay_ns_per_task_vs_libomp", 0.03, false},
    {"chain_dynamic_ns_per_task_vs_libomp", 0.12, false},
    {"independent_dynamic_ns_per_task_vs_libomp", 0.7, false},
    {"fib_core_ns_vs_libomp", 1, false},
    {"fib_core_ns_vs_tbb", 1, false},
    {"fib_core_ns_vs_taskflow", 1, false},
    {"skynet_core_ns_vs_tbb", 1, false},
    {"skynet_core_ns_vs_taskflow", 1, false},
    {"fib_speedup_t2", 1.8, true},
    {"tree_vs_libomp", 1.3, false},
    {"tiles_vs_libomp", 1, false},
    {"adopt_vs_copy", 0.1, false},
    {"independent_growth", 1.5, false},
    {"bytes_per_pending_task", 192, false},
    {"event_ns", 500, false},
    {"instructions_per_task_stencil", 1000, false},
    {"instructions_per_task_chain", 750, false},
    {"instructions_per_task_independent", 700, false},
    {"instructions_per_task_fib", 1200, false},
    {"instructions_per_task_replay", 300, false},
    {0}};
enum { TARGET_THREADS = 2 };

static const duite_kernel *const KERNELS[] = {&tasks_gate,
                                              &tasks_gate_write,
                                              &tasks_stencil_combine,
                                              &tasks_stencil_empty,
                                              &tasks_stencil_padded,
                                              &tasks_chain_next,
                                              &tasks_independent_mark,
                                              &tasks_fib,
                                              &tasks_fib_flow,
                                              &tasks_fib_put,
                                              &tasks_fib_add,
                                              &tasks_forks_kernels[TASKS_SKYNET],
                                              &tasks_forks_kernels[TASKS_QUEENS],
                                              &tasks_forks_kernels[TASKS_MATMUL],
                                              &tasks_tree_node,
                                              &tasks_wake_up,
                                              &tasks_adopt_change,
                                              &tasks_event_hold,
                                              &tasks_tiles_kernels[TILES_POTRF],
                                              &tasks_tiles_kernels[TILES_TRSM_L],
                                              &tasks_tiles_kernels[TILES_SYRK],
                                              &tasks_tiles_kernels[TILES_GEMM_T],
                                              &tasks_tiles_kernels[TILES_GETRF],
                                              &tasks_tiles_kernels[TILES_TRSM_U],
                                              &tasks_tiles_kernels[TILES_TRSM_1],
                                              &tasks_tiles_kernels[TILES_GEMM],
                                              NULL};

int tasks_code(int code)
{
    return code ? serve_fail("%s", duite_message()) : 0;
}

int tasks_ready(struct tasks_session *session, struct serve_request *request)
{
    char scheduler[sizeof session->scheduler];
    unsigned threads = (unsigned)serve_number(request, "threads");
    serve_word(request, "scheduler", scheduler, sizeof scheduler);
    if (session->rt && session->threads == threads && !strcmp(session->scheduler, scheduler))
        return 0;
    if (session->rt && duite_stop(&session->rt))
        return tasks_code(1);
    session->threads = threads;
    memcpy(session->scheduler, scheduler, sizeof scheduler);
    duite_options options = duite_options_default();
    options.kernels = KERNELS;
    options.context = session;
    options.threads = threads;
    options.scheduler = duite_scheduler_find(scheduler);
    options.window = 0; /* off: some cases fork a million tasks before one can end */
    return tasks_code(duite_start(&session->rt, &options));
}

int tasks_objects(struct tasks_session *session, duite_type type, size_t count, size_t n,
                  duite_object *object)
{
    for (size_t i = 0; i < n; i++)
        if (duite_new(session->rt, type, count, &object[i])) {
            tasks_free_objects(session, i, object);
            return tasks_code(1);
        }
    return 0;
}

void tasks_free_objects(struct tasks_session *session, size_t n, const duite_object *object)
{
    for (size_t i = 0; i < n; i++)
        duite_free(session->rt, object[i]);
    duite_wait(session->rt); /* nothing is on its way to another rank when this one leaves duite */
}

/* ---- Rounds ---- */

int tasks_record(struct tasks_rounds *rounds)
{
    rounds->graph = DUITE_NO_GRAPH;
    if (!rounds->replayed)
        return 0;
    int code = duite_graph_new(rounds->rt, rounds->fork, rounds->context, &rounds->graph);
    if (!code)
        code = duite_replay(rounds->rt, rounds->graph, 1);
    if (!code)
        code = duite_wait(rounds->rt);
    return tasks_code(code);
}

int tasks_run(struct tasks_rounds *rounds, double *seconds)
{
    int code = duite_wait(rounds->rt);
    double start = serve_seconds();
    if (!code && rounds->replayed)
        code = duite_replay(rounds->rt, rounds->graph, rounds->rounds);
    for (uint64_t i = 0; i < rounds->rounds && !code && !rounds->replayed; i++)
        code = rounds->fork(rounds->rt, rounds->context);
    if (!code)
        code = duite_wait(rounds->rt);
    *seconds = serve_seconds() - start;
    return tasks_code(code);
}

void tasks_forget(struct tasks_rounds *rounds)
{
    if (rounds->replayed)
        duite_graph_free(rounds->rt, rounds->graph);
}

/* ---- Gates ---- */

static int gate(const duite_call *call)
{
    struct tasks_session *session = call->context;
    atomic_fetch_add(&session->waiting, 1);
    while (!atomic_load_explicit(&session->gate, memory_order_acquire))
        ;
    return 0;
}

const duite_kernel tasks_gate_write = {.name = "gate_write", .body = gate, .access = {DUITE_W}};
const duite_kernel tasks_gate = {.name = "gate", .body = gate};

/* ---- Plans ---- */

struct subject_shape tasks_ours(unsigned threads)
{
    return (struct subject_shape){.kind = "duite", .threads = threads};
}

struct subject_shape tasks_twin(void)
{
    return (struct subject_shape){.kind = "sequential", .threads = 1};
}

static struct measure_series *add(struct measure *measure, const struct tasks_contest *contest,
                                  struct subject_shape shape, const char *run, const char *more)
{
    struct measure_series *series = measure_series(measure, shape, "%s %s threads=%u%s", run,
                                                   contest->size, shape.threads, more);
    series->work = contest->tasks;
    return series;
}

static const char *figure_of(const struct tasks_contest *contest)
{
    return contest->core ? "core_ns" : "ns_per_task";
}

/* The figure of a subject on so many cores. */
static void plan_figure(struct measure *measure, const struct tasks_contest *contest,
                        const struct measure_series *of, unsigned cores, const char *name)
{
    measure_value(measure, of, 1e9 * (contest->core ? cores : 1) / contest->tasks, "ns", "%s_%s",
                  name, figure_of(contest));
}

static const char *run_of(const struct tasks_contest *contest)
{
    return contest->run ? contest->run : contest->name;
}

/* A rival in each of its settings. */
static struct measure_series *plan_rival(struct measure *measure,
                                         const struct bench_options *options,
                                         const struct tasks_contest *contest, const char *kind)
{
    struct measure_series *first = NULL, *last = NULL;
    for (; kind; kind = subject_other(kind)) {
        struct subject_shape shape = {kind, 0, options->threads};
        struct measure_series *series = add(measure, contest, shape, run_of(contest), "");
        if (last)
            last->other = series;
        else
            first = series;
        last = series;
    }
    return first;
}

/* WHAT, or WHAT_VARIANT. */
static const char *join(char *key, size_t size, const char *what, const char *variant)
{
    snprintf(key, size, "%s%s%s", what, *variant ? "_" : "", variant);
    return key;
}

/* Ours against each rival, of which `rival` are the series. */
static void plan_ours(struct measure *measure, const struct bench_options *options,
                      const struct tasks_contest *contest, const char *variant,
                      struct measure_series *const *rival)
{
    char scheduler[80], name[60], run[60];
    snprintf(scheduler, sizeof scheduler, " scheduler=%s", options->scheduler);
    join(name, sizeof name, contest->name, variant);
    join(run, sizeof run, run_of(contest), variant);
    struct measure_series *ours =
        add(measure, contest, tasks_ours(options->threads), run, scheduler);
    if (contest->twice)
        ours->other = add(measure, contest, tasks_ours(options->threads), run, scheduler);
    plan_figure(measure, contest, ours, options->threads, name);
    for (size_t i = 0; contest->rivals[i]; i++)
        measure_ratio(measure, ours, rival[i], "%s%s%s_vs_%s", name, contest->brief ? "" : "_",
                      contest->brief ? "" : figure_of(contest), contest->rivals[i]);
}

void tasks_plan_contest(struct measure *measure, const struct bench_options *options,
                        const struct tasks_contest *contest)
{
    enum { MOST = 8 };
    char run[60];
    struct measure_series *rival[MOST];
    for (size_t i = 0; contest->rivals[i] && i < MOST; i++)
        rival[i] = plan_rival(measure, options, contest, contest->rivals[i]);
    for (size_t i = 0; contest->variants[i]; i++)
        plan_ours(measure, options, contest, contest->variants[i], rival);
    join(run, sizeof run, run_of(contest), "sequential");
    const struct measure_series *twin = add(measure, contest, tasks_twin(), run, "");
    plan_figure(measure, contest, twin, 1, join(run, sizeof run, contest->name, "sequential"));
    for (size_t i = 0; contest->rivals[i]; i++)
        plan_figure(measure, contest, rival[i], options->threads,
                    join(run, sizeof run, contest->name, contest->rivals[i]));
}

/* ---- Serving ---- */

static int serve_tasks(const struct bench *bench)
{
    static struct tasks_session session;
    const struct serve_run *runs[N_CASES + 1] = {0};
    const char *settings = strcmp(serve_kind(), "duite")
                               ? "one thread, loops that call the same bodies through pointers"
                               : "duite_options_default() but for threads and scheduler: it "
                                 "binds a worker to each core";
    for (size_t i = 0; i < N_CASES; i++)
        runs[i] = bench->cases[i]->runs;
    int status = serve(settings, runs, &session);
    if (session.rt && duite_stop(&session.rt)) {
        fprintf(stderr, "duite-bench: %s\n", duite_message());
        status = 1;
    }
    return status;
}

const struct bench bench_tasks = {
    "tasks",        "what a task costs: stencil, chain, independent, ...",
    CASES,          TARGETS,
    TARGET_THREADS, serve_tasks,
    NULL,           NULL};
