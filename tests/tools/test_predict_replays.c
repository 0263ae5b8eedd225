/* Predictions of recorded graphs, against schedules worked out by hand: what they send, and what
 * mappings, schedulers and balancers that know them make of them. */
#include "runtime/map/map.h"
#include "runtime/sched/sched.h"
#include "tests/runtime/passive.h"
#include "tests/support/unit.h"
#include "tests/tools/predicted.h"

#include <math.h>

/* Tasks on host 0 write the objects 1 and 2, two on host 1 read both, and each of them its own
 * object before: one packet a round, and none for what is read where it is written. */
UNIT_TEST(packets)
{
    static const struct trace_file_node nodes[] = {{FILE_W, 1 * MS, 0, 1, {0}},
                                                   {FILE_W, 1 * MS, 0, 1, {1}},
                                                   {FILE_RR_RW, 1 * MS, 0, 3, {0, 1, 2}},
                                                   {FILE_RR_RW, 1 * MS, 0, 3, {0, 1, 3}}};
    struct trace_file file = predicted_trace(4, 1000);
    trace_file_graph(&file, 4, 4, nodes);
    trace_file_replay(&file, 4, 4, nodes, 5);
    struct predict_cluster two = predicted_machine(2, 1);
    two.message = 0.1 * MS;
    struct predict_result r = predicted(&file, &two);
    ck_assert_uint_eq(r.messages, 5);
    ck_assert_uint_eq(r.bytes, 10 * 1000);
    /* Host 1: two writers, ten tasks, and five packets, the first of which comes while its core has
     * nothing else to do; looks for others cost 5e-7 s at most. */
    ck_assert_msg(r.makespan > 12.4 * MS && r.makespan < 12.41 * MS, "%.9g s", r.makespan);
}

/* The messages of so many rounds of a graph on four objects, the first two of which live on host
 * 0. */
static struct predict_result sent(uint64_t bytes, uint32_t n, const struct trace_file_node *nodes,
                                  uint32_t rounds)
{
    struct trace_file file = predicted_trace(4, bytes);
    trace_file_graph(&file, 4, n, nodes);
    trace_file_replay(&file, 4, n, nodes, rounds);
    const struct predict_cluster two = predicted_machine(2, 1);
    return predicted(&file, &two);
}

/* A replicated task runs where its result is read: here on the host that has what it reads. */
UNIT_TEST(replicated)
{
    static const struct trace_file_node nodes[] = {{FILE_SAME, 1 * MS, 0, 2, {0, 1}},
                                                   {FILE_R_W, 1 * MS, 0, 2, {1, 0}}};
    const struct predict_result r = sent(8, 2, nodes, 5);
    ck_assert_uint_eq(r.messages, 0);
    ck_assert(fabs(r.makespan - 10 * MS) < 1e-6);
}

/* A replicated task that two hosts read runs on a core of each: 1 + 1 + 1 ms a round on host 0,
 * and 2 ms on host 1. */
UNIT_TEST(replicated_on_both)
{
    static const struct trace_file_node nodes[] = {{FILE_W, 1 * MS, 0, 1, {0}},
                                                   {FILE_SAME, 1 * MS, 0, 2, {0, 1}},
                                                   {FILE_R_W, 1 * MS, 0, 2, {1, 2}},
                                                   {FILE_R_W, 1 * MS, 0, 2, {1, 0}}};
    const struct predict_result r = sent(8, 4, nodes, 5);
    ck_assert_uint_eq(r.bytes, 5 * 8);
    ck_assert_msg(fabs(r.work - 5 * 5 * MS) < 1e-6, "%.9g s of work", r.work);
    ck_assert_msg(fabs(r.makespan - 5 * 3 * MS) < 1e-5, "%.9g s", r.makespan);
}

/* An object that rounds only read goes to another host once, in whatever replay; and not at all if
 * it is there since before the trace, which nothing of it writes. One that each replay writes goes
 * in each. */
UNIT_TEST(reads_last)
{
    static const struct trace_file_node nodes[] = {{FILE_W, 1 * MS, 0, 1, {0}},
                                                   {FILE_RR_RW, 1 * MS, 0, 3, {0, 1, 2}}};
    for (int late = 0; late < 2; late++) {
        struct trace_file file = {.forks = late ? 100 : 0};
        for (uint32_t slot = 1; slot <= 4; slot++)
            trace_file_object(&file, slot, slot == 2 ? 1000 : 8);
        trace_file_begin(&file, 4);
        trace_file_graph(&file, 4, 2, nodes);
        for (int i = 0; i < 3; i++)
            trace_file_replay(&file, 4, 2, nodes, 2);
        const struct predict_cluster two = predicted_machine(2, 1);
        ck_assert_uint_eq(predicted(&file, &two).bytes, late ? 6 * 8 : 6 * 8 + 1000);
    }
}

/* A set runs wherever what it sets is read, and nothing moves. */
UNIT_TEST(sets)
{
    static const struct trace_file_node nodes[] = {{FILE_SET, 0, 0, 1, {0}},
                                                   {FILE_R_W, 1 * MS, 0, 2, {0, 1}},
                                                   {FILE_R_W, 1 * MS, 0, 2, {0, 2}}};
    ck_assert_uint_eq(sent(8, 3, nodes, 5).messages, 0);
}

/* A value goes once to each host that reads it, for a task there or for a replicated one; a sum is
 * made where it is read, of what hosts that contribute send. */
UNIT_TEST(exchanges)
{
    static const struct trace_file_node values[] = {{FILE_W, 1 * MS, 0, 1, {0}},
                                                    {FILE_R_W, 1 * MS, 0, 2, {0, 2}},
                                                    {FILE_SAME, 1 * MS, 0, 2, {0, 1}},
                                                    {FILE_R_W, 1 * MS, 0, 2, {1, 3}},
                                                    {FILE_R_W, 1 * MS, 0, 2, {1, 0}}};
    static const struct trace_file_node sums[] = {{FILE_SET, 0, 0, 1, {1}},
                                                  {FILE_R_CW, 1 * MS, 0, 2, {0, 1}},
                                                  {FILE_R_CW, 1 * MS, 0, 2, {0, 1}},
                                                  {FILE_R_W, 1 * MS, 0, 2, {1, 0}},
                                                  {FILE_R_W, 1 * MS, 0, 2, {1, 2}}};
    ck_assert_uint_eq(sent(8, 5, values, 5).bytes, 5 * 8);
    ck_assert_uint_eq(sent(8, 5, sums, 5).bytes, 5 * 8);
}

/* Two values of one object, the second of which overwrites the first: a phase counts messages that
 * come, not those that go, so both go in one packet a round. */
UNIT_TEST(phases)
{
    static const struct trace_file_node nodes[] = {{FILE_W, 1 * MS, 0, 1, {0}},
                                                   {FILE_R_W, 1 * MS, 0, 2, {0, 2}},
                                                   {FILE_W, 1 * MS, 0, 1, {0}},
                                                   {FILE_R_W, 1 * MS, 0, 2, {0, 3}}};
    const struct predict_result r = sent(1000, 4, nodes, 5);
    ck_assert_uint_eq(r.messages, 5);
    ck_assert_uint_eq(r.bytes, 10 * 1000);
}

/* Contributions of one round and of the next make one sum: five of one host go to the other in one
 * message, as two subtrees, of four and of one. */
UNIT_TEST(sums_over_rounds)
{
    static const struct trace_file_node nodes[] = {{FILE_R_CW, 1 * MS, 0, 2, {0, 3}}};
    for (uint64_t bytes = 8; bytes <= 8000; bytes *= 1000) {
        const struct predict_result r = sent(bytes, 1, nodes, 5);
        ck_assert_uint_eq(r.messages, 1);
        ck_assert_uint_eq(r.bytes, 2 * bytes);
    }
}

/* Such rounds are forked: two values from one host to another are two messages, not one packet. */
UNIT_TEST(forked_rounds)
{
    static const struct trace_file_node nodes[] = {{FILE_R_CW, 1 * MS, 0, 2, {0, 3}},
                                                   {FILE_W, 1 * MS, 0, 1, {0}},
                                                   {FILE_W, 1 * MS, 0, 1, {1}},
                                                   {FILE_RR_RW, 1 * MS, 0, 3, {0, 1, 2}}};
    ck_assert_uint_eq(sent(1000, 4, nodes, 5).messages, 2 * 5 + 1);
}

/* Costs of 3, 1, 1 and 1: block gives 4 and 2 ms a round, the mappings that see them 3 and 3, if
 * forks say them at once, else from the second replay on, since in the first all are thought alike.
 * The values of what moves go along. */
UNIT_TEST(mappings)
{
    static const struct {
        const duite_mapping *mapping;
        int told, expected; /* ms */
    } cases[] = {{&map_block, 1, 12},
                 {&map_list, 0, 10},
                 {&map_list, 1, 9},
                 {&map_taskgraph, 0, 10},
                 {&map_taskgraph, 1, 9}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct trace_file_node nodes[4];
        for (uint32_t i = 0; i < 4; i++) {
            const double seconds = i ? 1 * MS : 3 * MS;
            nodes[i] = (struct trace_file_node){
                FILE_RW, seconds, cases[k].told ? (float)seconds : 0, 1, {i}};
        }
        struct trace_file file = predicted_trace(4, 1000);
        for (uint32_t i = 0; i < 4; i++)
            trace_file_fork(&file, FILE_W, 0, 0, 1, SLOTS(i + 1));
        trace_file_graph(&file, 4, 4, nodes);
        for (int i = 0; i < 3; i++)
            trace_file_replay(&file, 4, 4, nodes, 1);
        struct predict_cluster two = predicted_machine(2, 1);
        two.mapping = cases[k].mapping;
        struct predict_result r = predicted(&file, &two);
        ck_assert_msg(fabs(r.makespan - cases[k].expected * MS) < 1e-6, "%s, told %d: %.9g s",
                      two.mapping->name, cases[k].told, r.makespan);
    }
}

/* 160 tasks, then a chain of ten that was forked last, 1 ms each, on 16 workers: first come, first
 * served, the chain begins when the others are nearly done; by the longest path it comes first: 170
 * / 16 tasks a worker. */
UNIT_TEST(paths)
{
    enum { SHORT = 160, CHAIN = 10 };
    static struct trace_file_node nodes[SHORT + CHAIN];
    for (uint32_t i = 0; i < SHORT + CHAIN; i++)
        nodes[i] = (struct trace_file_node){
            i < SHORT ? FILE_W : FILE_RW, 1 * MS, 0, 1, {i < SHORT ? i : SHORT}};
    for (int knows = 0; knows < 2; knows++) {
        struct trace_file file = predicted_trace(SHORT + 1, 8);
        trace_file_graph(&file, SHORT + 1, SHORT + CHAIN, nodes);
        trace_file_replay(&file, SHORT + 1, SHORT + CHAIN, nodes, 1);
        struct predict_cluster many = predicted_machine(1, 16);
        many.scheduler = knows ? &sched_priority : &sched_fifo;
        const double makespan = predicted(&file, &many).makespan;
        ck_assert_msg(knows ? fabs(makespan - 11 * MS) < 1e-6 : makespan > 18 * MS, "%.9g s",
                      makespan);
    }
}

/* A scheduler that keeps what it is told of who was at the data before. */
static uint32_t told[16];
static unsigned n_told;

static unsigned listen(void *state, const duite_ready *task)
{
    (void)state;
    told[n_told++ % 16] = task->affinity;
    return 1; /* the second worker runs all */
}

/* Two objects, forked once and replayed in two rounds: data are warm from the second one on. */
UNIT_TEST(warmth)
{
    static const duite_scheduler LISTENING = {.size = sizeof(duite_scheduler),
                                              .name = "listening",
                                              .summary = "for tests",
                                              .place = listen,
                                              .serve = passive_serve,
                                              .victim = passive_victim,
                                              .chain = passive_chain};
    static const struct trace_file_node nodes[] = {{FILE_RW, 1 * MS, 0, 1, {0}},
                                                   {FILE_RW, 1 * MS, 0, 1, {1}}};
    struct trace_file file = predicted_trace(2, 8);
    for (uint32_t i = 0; i < 2; i++)
        trace_file_fork(&file, FILE_W, 0, 0, 1, SLOTS(i + 1));
    trace_file_graph(&file, 2, 2, nodes);
    trace_file_replay(&file, 2, 2, nodes, 2);
    struct predict_cluster one = predicted_machine(1, 2);
    one.scheduler = &LISTENING;
    n_told = 0;
    predicted(&file, &one);
    ck_assert_uint_eq(n_told, 2 * 6); /* it is predicted twice */
    for (unsigned i = 0; i < n_told; i++)
        ck_assert_uint_eq(told[i], i % 6 < 4 ? 0 : 1 + 1);
}

/* Objects of 3 ms on host 0, of 1 ms on host 1: 6 ms a replay, 4 when some have moved. */
UNIT_TEST(migration)
{
    double makespan[2];
    for (int moves = 0; moves < 2; moves++) {
        struct trace_file_node nodes[8];
        for (uint32_t i = 0; i < 8; i++)
            nodes[i] = (struct trace_file_node){FILE_RW, (i < 4 ? 3 : 1) * MS, 0, 1, {i}};
        struct trace_file file = predicted_trace(8, 1000);
        trace_file_graph(&file, 8, 8, nodes);
        for (int i = 0; i < 10; i++)
            trace_file_replay(&file, 8, 8, nodes, 1);
        struct predict_cluster two = predicted_machine(2, 1);
        two.balance = duite_balancer_find(moves ? "migrate" : "none");
        struct predict_result r = predicted(&file, &two);
        makespan[moves] = r.makespan;
        ck_assert((r.migrated > 0) == moves);
        ck_assert(fabs(r.work - 160 * MS) < 1e-6); /* of floats */
    }
    ck_assert(fabs(makespan[0] - 120 * MS) < 1e-6);
    ck_assert_msg(makespan[1] < 100 * MS && makespan[1] >= 80 * MS, "%.9g s", makespan[1]);
}
