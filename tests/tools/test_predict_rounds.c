/* Mappings see the same tasks in virtual time as in a run: random graphs are recorded, replayed and
 * traced, and the predictor must hand to a mapping the rows that the runtime hands to it. */
#include "runtime/api/instance.h"
#include "runtime/sched/sched.h"
#include "tests/negative/misuse.h"
#include "tests/support/unit.h"
#include "tools/predict/predict.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { OBJECTS = 5, MOST_FORKS = 24, COUNT = 4 };

/* ---- Kernels: what they do does not matter ---- */

static int nothing(const duite_call *call)
{
    (void)call;
    return 0;
}

static const duite_kernel READ_WRITE = {
    .name = "read_write", .body = nothing, .access = {DUITE_R, DUITE_W}};
static const duite_kernel CHANGE = {.name = "change", .body = nothing, .access = {DUITE_RW}};
static const duite_kernel LEAF = {.name = "leaf", .body = nothing, .access = {DUITE_R, DUITE_CW}};
static const duite_kernel LEAVES = {
    .name = "leaves", .body = nothing, .access = {DUITE_CW, DUITE_CW}};
static const duite_kernel READS = {
    .name = "reads", .body = nothing, .access = {DUITE_RW}, .variadic = DUITE_R};
static const duite_kernel SAME = {
    .name = "same", .body = nothing, .access = {DUITE_R, DUITE_RW}, .replicated = 1};
static const duite_kernel *const KERNELS[] = {&READ_WRITE, &CHANGE, &LEAF, &LEAVES,
                                              &READS,      &SAME,   NULL};
static const size_t PARAMETERS[] = {2, 1, 2, 2, 4, 2};
enum { N_KERNELS = sizeof PARAMETERS / sizeof *PARAMETERS };

/* ---- A random graph ---- */

static struct {
    uint64_t random;
    duite_object name[OBJECTS];
    const struct plan_record *record;
} now;

static size_t draw(size_t n)
{
    return (size_t)(duite_random(&now.random) % n);
}

/* Different objects. */
static void draw_objects(size_t kernel, duite_object *objects)
{
    uint32_t used = 0;
    for (size_t i = 0; i < PARAMETERS[kernel]; i++) {
        size_t name;
        do
            name = draw(OBJECTS);
        while (used >> name & 1);
        used |= 1u << name;
        objects[i] = now.name[name];
    }
}

static int build(duite *rt, void *context)
{
    static const double values[COUNT] = {0};
    const size_t n = 1 + draw(MOST_FORKS);
    int code = DUITE_OK;
    (void)context;
    now.record = rt->building;
    for (size_t i = 0; i < n && !code; i++) {
        const size_t kernel = draw(N_KERNELS);
        const int here = 0;
        const bool named = !KERNELS[kernel]->replicated && !draw(6);
        duite_object objects[4];
        draw_objects(kernel, objects);
        if (draw(8))
            code = duite_fork_with(rt,
                                   &(duite_task_options){.at = named ? &here : NULL,
                                                         .cost = 0x1p-10 * (double)(1 + draw(7))},
                                   KERNELS[kernel], NULL, PARAMETERS[kernel], objects);
        else
            code = duite_set(rt, now.name[draw(OBJECTS)], values);
    }
    return code;
}

/* ---- What is compared ---- */

static struct plan_tasks expected;
static unsigned asked, rows;

static int map_by_turns(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    (void)seed;
    for (size_t i = 0; i < graph->n; i++)
        home[i] = (int)i % n_ranks;
    return DUITE_OK;
}

/* Blocks have other names than objects, but one each. */
static void same_blocks(const duite_task_graph *graph)
{
    uint32_t object_of[OBJECTS];
    memset(object_of, 0xff, sizeof object_of);
    for (size_t i = 0; i < graph->n; i++) {
        const uint32_t block = graph->block[i];
        const uint32_t owner = expected.owner[i];
        ck_assert_int_eq(block == DUITE_NO_BLOCK, owner == PLAN_NONE);
        if (block == DUITE_NO_BLOCK)
            continue;
        ck_assert_uint_lt(block, OBJECTS);
        ck_assert(object_of[block] == UINT32_MAX || object_of[block] == owner);
        for (uint32_t other = 0; other < OBJECTS; other++)
            ck_assert(other == block || object_of[other] != owner);
        object_of[block] = owner;
    }
}

static int map_compare(const duite_task_graph *graph, int *home)
{
    (void)home;
    asked++;
    ck_assert_uint_eq(graph->n, expected.n);
    ck_assert_int_eq(graph->n_ranks, 2);
    for (size_t i = 0; i < graph->n; i++) {
        ck_assert_uint_eq(graph->start[i + 1], expected.start[i + 1]);
        ck_assert_msg(!(fabs(graph->cost[i] - expected.cost[i]) > 0), "cost of task %zu", i);
        for (size_t k = graph->start[i]; k < graph->start[i + 1]; k++) {
            ck_assert_uint_eq(graph->from[k], expected.from[k]);
            ck_assert_msg(!(fabs(graph->bytes[k] - expected.bytes[k]) > 0), "bytes of row %zu", k);
            rows++;
        }
    }
    same_blocks(graph);
    return DUITE_OK;
}

static const duite_mapping COMPARE = {.size = sizeof(duite_mapping),
                                      .name = "compare",
                                      .summary = "by turns",
                                      .map = map_by_turns,
                                      .map_tasks = map_compare};

/* ---- A run, and its prediction ---- */

static void make_objects(duite *rt)
{
    for (int i = 0; i < OBJECTS; i++)
        ck_assert(!duite_new(rt, DUITE_F64, COUNT, &now.name[i]));
    for (int i = 0; i < OBJECTS; i++)
        ck_assert(!duite_fork(rt, &CHANGE, NULL, 1, &now.name[i]));
}

/* The rows that mappings see of a record. */
static void expect_tasks(const struct plan_record *record)
{
    struct plan_source source;
    struct plan_round round = {0};
    ck_assert(plan_record_source(record, NULL, &source) && plan_lower(&round, &source));
    ck_assert(plan_tasks_find(&expected, &round));
    plan_round_free(&round);
    plan_source_free(&source);
}

static duite *trace_one(const char *trace)
{
    duite_options options = duite_options_default();
    duite_graph graph;
    duite *rt;
    options.comm = MPI_COMM_SELF;
    options.kernels = KERNELS;
    options.threads = 1;
    options.trace = trace;
    ck_assert_msg(!duite_start(&rt, &options), "%s", duite_message());
    make_objects(rt);
    ck_assert_msg(!duite_graph_new(rt, build, NULL, &graph), "%s", duite_message());
    expect_tasks(now.record);
    ck_assert_int_eq(duite_replay(rt, graph, 2), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_int_eq(duite_trace_end(rt), DUITE_OK);
    return rt;
}

static void predict_one(const char *trace)
{
    const struct predict_cluster two = {.hosts = 2,
                                        .cores = 1,
                                        .bandwidth = 1e12,
                                        .capacity = INFINITY,
                                        .core_speed = 1,
                                        .scheduler = &sched_fifo,
                                        .mapping = &COMPARE,
                                        .seed = 1};
    struct predict_result result;
    struct trace_run *run;
    ck_assert_msg(!trace_read(&run, trace, false), "%s", duite_message());
    asked = 0;
    ck_assert_msg(!predict(run, &two, &result, NULL), "%s", duite_message());
    ck_assert_uint_eq(asked, 1);
    trace_run_free(run);
}

UNIT_TEST(mappings_see_the_same)
{
    char trace[64];
    misuse_mpi();
    snprintf(trace, sizeof trace, "test_predict_rounds.%d.trace", (int)getpid());
    for (uint64_t seed = 0; seed < (unit_quick() ? 20 : 100); seed++) {
        now.random = seed;
        duite *rt = trace_one(trace);
        predict_one(trace);
        plan_tasks_free(&expected);
        ck_assert_int_eq(duite_stop(&rt), DUITE_E_NOT_FREED); /* the graph and the objects */
        unlink(trace);
    }
    ck_assert_uint_gt(rows, 100);
}
