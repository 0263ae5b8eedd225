/* The cost to a rank of tasks that it records, and for those of other ranks that it only hears
 * of. */
#include "bench/ranks/ranks.h"

#include <stdlib.h>

enum { POINTS = 500 }; /* of a ring, half of them on each of two ranks */

static void plan(struct measure *measure, const struct bench_options *options)
{
    const unsigned ranks = options->threads, tasks = options->quick ? 4 * POINTS : 100000;
    const struct measure_series *record =
        measure_series(measure, ranks_ours(ranks, 1), "record tasks=%u threads=1 scheduler=%s",
                       tasks, options->scheduler);
    const struct measure_series *prune =
        measure_series(measure, ranks_ours(ranks, 1), "prune tasks=%u threads=1 scheduler=%s",
                       tasks, options->scheduler);
    measure_value(measure, record, 1e6 * ranks / tasks, "us", "record_us_per_task");
    measure_value(measure, prune, 1e9 / tasks, "ns", "prune_ns_per_task");
}

struct ring {
    duite_object object[2][POINTS];
    size_t steps;
};

/* Both fields of a ring: point i on rank i x ranks / POINTS, or all on one. */
static int make_ring(struct tasks_session *session, struct ring *ring, bool spread)
{
    int code = tasks_objects(session, DUITE_I64, 1, POINTS, ring->object[0]);
    if (!code)
        code = tasks_objects(session, DUITE_I64, 1, POINTS, ring->object[1]);
    for (size_t i = 0; i < POINTS && !code; i++) {
        code = tasks_code(duite_colocate(session->rt, ring->object[1][i], ring->object[0][i]));
        if (!code && i)
            code = tasks_code(
                spread ? duite_hint(session->rt, ring->object[0][i], 1, 1, &ring->object[0][i - 1],
                                    NULL)
                       : duite_colocate(session->rt, ring->object[0][i], ring->object[0][0]));
    }
    return code;
}

static void free_ring(struct tasks_session *session, const struct ring *ring)
{
    for (int field = 0; field < 2; field++)
        tasks_free_objects(session, POINTS, ring->object[field]);
}

static int fork_ring(duite *rt, void *context)
{
    const struct ring *ring = context;
    int code = 0;
    for (size_t s = 0; s < ring->steps; s++) {
        const duite_object *old = ring->object[s % 2], *new = ring->object[1 - s % 2];
        for (size_t i = 0; i < POINTS; i++)
            code |= DUITE_FORK(rt, &tasks_stencil_combine, NULL, old[i ? i - 1 : POINTS - 1],
                               old[i], old[(i + 1) % POINTS], new[i]);
    }
    return code;
}

/* The points start as the sequential ring's do, and end as they do. */
static int set_ring(duite *rt, const struct ring *ring)
{
    int code = 0;
    for (size_t i = 0; i < POINTS; i++) {
        const uint64_t start = problem_start(i);
        code |= duite_set(rt, ring->object[0][i], &start);
    }
    return tasks_code(code);
}

static int check_ring(duite *rt, const struct ring *ring, size_t steps)
{
    struct problem_cell *cell = calloc(POINTS, sizeof *cell);
    int code = cell ? 0 : serve_no_memory();
    for (size_t i = 0; i < POINTS && !code; i++)
        code = tasks_code(duite_get(rt, ring->object[steps % 2][i], &cell[i].value));
    if (!code && problem_stencil_wrong(cell, POINTS, steps))
        code = serve_fail("wrong answer");
    free(cell);
    return code;
}

/* A round, with its wait. */
static int replay(duite *rt, duite_graph graph, double *seconds)
{
    const double start = serve_seconds();
    int code = duite_replay(rt, graph, 1);
    if (!code)
        code = duite_wait(rt);
    *seconds = serve_seconds() - start;
    return tasks_code(code);
}

/* Recording, and what the first replay takes more than the second. */
static int time_record(duite *rt, struct ring *ring, double *value)
{
    duite_graph graph;
    double first = 0, second = 0;
    int code = tasks_code(duite_wait(rt));
    const double start = serve_seconds();
    if (!code)
        code = tasks_code(duite_graph_new(rt, fork_ring, ring, &graph));
    const double recorded = serve_seconds() - start;
    if (code)
        return code;
    code = replay(rt, graph, &first);
    if (!code)
        code = replay(rt, graph, &second);
    duite_graph_free(rt, graph);
    if (!code)
        code = check_ring(rt, ring, 2 * ring->steps);
    *value = recorded + (first > second ? first - second : 0);
    return code;
}

static int record(void *context, struct serve_request *request, double *value)
{
    struct tasks_session *session = context;
    struct ring ring = {.steps = serve_number(request, "tasks") / POINTS};
    int code = tasks_ready(session, request);
    if (!code)
        code = make_ring(session, &ring, true);
    if (!code)
        code = set_ring(session->rt, &ring);
    if (!code)
        code = time_record(session->rt, &ring, value);
    free_ring(session, &ring);
    return code;
}

/* Forks of tasks that are all another rank's: seen from a rank that has none of them. */
static int prune(void *context, struct serve_request *request, double *value)
{
    struct tasks_session *session = context;
    struct ring ring = {.steps = serve_number(request, "tasks") / POINTS};
    int code = tasks_ready(session, request);
    if (!code)
        code = make_ring(session, &ring, false);
    if (!code)
        code = set_ring(session->rt, &ring);
    if (!code)
        code = tasks_code(duite_wait(session->rt));
    const double start = serve_seconds();
    if (!code)
        code = tasks_code(fork_ring(session->rt, &ring));
    const bool owner = duite_home(session->rt, ring.object[0][0]) == duite_rank(session->rt);
    *value = owner ? 0 : serve_seconds() - start;
    if (!code)
        code = check_ring(session->rt, &ring, ring.steps);
    free_ring(session, &ring);
    return code;
}

static const struct serve_run RUNS[] = {{"record", record}, {"prune", prune}, {0}};

const struct bench_case ranks_forks = {
    "forks", "recording a graph over ranks, and forks that touch nothing of a rank", plan, RUNS, 0};
