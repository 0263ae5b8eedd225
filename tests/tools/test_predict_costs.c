/* The predictor's charges for the runtime itself, against closed forms: messages where they are
 * handled, sums where they are made, forks of tasks that other hosts run, and packed values. */
#include "runtime/map/map.h"
#include "runtime/task/task.h"
#include "tests/support/unit.h"
#include "tests/tools/predicted.h"
#include "tools/predict/predict.h"

#include <math.h>

/* Up to the looks for messages, of 5e-7 s each. */
static void nearly(double value, double expected)
{
    ck_assert_msg(value > expected - 1e-9 && value < expected + 1e-5, "%.9g, not %.9g", value,
                  expected);
}

/* Two messages come at once, after 1 ms: the host takes one after the other, 0.2 ms each, and its
 * task of 1 ms begins when it comes to the second one. Hosts 1 and 2 send one each. */
UNIT_TEST(messages_wait_for_one_another)
{
    struct trace_file file = predicted_trace(3, 8);
    trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(2));
    trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(3));
    trace_file_fork(&file, FILE_RR_W, 1 * MS, 0, 3, SLOTS(2, 3, 1));
    struct predict_cluster three = predicted_machine(3, 1);
    three.message = 0.2 * MS;
    nearly(predicted(&file, &three).makespan, 2.2 * MS);
}

/* The costs of the example above, with messages as its trace has them: a worker was busy with them
 * for `handled` s, of which two were sent or taken, and for `looked` s without one. It ran three
 * tasks, 1 ms apart, and so looked twice. A message that an idle worker sends costs nobody time. */
static struct predict_result with_messages(double handled, double looked,
                                           const struct predict_cluster *cluster)
{
    const uint64_t ms = 1000000, took = (uint64_t)(1e9 * handled + 0.5);
    const struct trace_event events[] = {
        {.kind = TRACE_OWN, .begin = 1 * ms},
        {.kind = TRACE_SEND, .begin = 2 * ms + took / 2, .number = 8},
        {.kind = TRACE_RECEIVE, .begin = 2 * ms + took, .number = 8},
        {.kind = TRACE_MESSAGES, .begin = 2 * ms, .took = took},
        {.kind = TRACE_OWN, .begin = 3 * ms},
        {.kind = TRACE_SEND, .begin = 4 * ms, .number = 8},
        {.kind = TRACE_IDLE, .begin = 4 * ms, .took = ms},
        {.kind = TRACE_MESSAGES, .begin = 5 * ms, .took = (uint64_t)(1e9 * looked + 0.5)}};
    struct trace_file file = predicted_trace(3, 8);
    trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(2));
    trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(3));
    trace_file_fork(&file, FILE_RR_W, 1 * MS, 0, 3, SLOTS(2, 3, 1));
    for (size_t i = 0; handled > 0 && i < sizeof events / sizeof *events; i++)
        trace_file_event(&file, &events[i]);
    return predicted(&file, cluster);
}

static void same(double value, double expected)
{
    ck_assert_msg(fabs(value - expected) < 1e-12, "%.9g, not %.9g", value, expected);
}

UNIT_TEST(messages_cost_what_they_did)
{
    struct predict_cluster three = predicted_machine(3, 1);
    three.message = three.look = -1;
    const struct predict_result seen = with_messages(0.4 * MS, 0.002 * MS, &three);
    same(seen.message, 0.2 * MS);
    same(seen.look, 0.001 * MS);
    nearly(seen.makespan, 2.2 * MS);
    const struct predict_result unseen = with_messages(0, 0, &three);
    same(unseen.message, 5e-7);
    same(unseen.look, 5e-7);
    three.core_speed = 2;
    const struct predict_result faster = with_messages(0.4 * MS, 0.002 * MS, &three);
    same(faster.message, 0.1 * MS);
    same(faster.look, 0.0005 * MS);
    three.core_speed = 1;
    three.message = 0.3 * MS;
    three.look = 0.004 * MS;
    const struct predict_result said = with_messages(0.4 * MS, 0.002 * MS, &three);
    same(said.message, three.message);
    same(said.look, three.look);
    nearly(said.makespan, 2.3 * MS);
    const struct predict_cluster one = predicted_machine(1, 1);
    same(with_messages(0.4 * MS, 0.002 * MS, &one).look, 0);
}

/* Host 1 sends to two hosts after 1 ms: the second message leaves 0.2 ms later. Its only core sends
 * both before its next task, of 2 ms; a second core has nothing else to do, and delays nothing. */
UNIT_TEST(idle_cores_handle_messages)
{
    for (uint32_t cores = 1; cores <= 2; cores++) {
        struct trace_file file = predicted_trace(8, 8);
        trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(3));
        trace_file_fork(&file, FILE_R_W, 1 * MS, 0, 2, SLOTS(3, 5));
        trace_file_fork(&file, FILE_R_W, 1 * MS, 0, 2, SLOTS(3, 7));
        trace_file_fork(&file, FILE_RW, 2 * MS, 0, 1, SLOTS(4));
        struct predict_cluster four = predicted_machine(4, cores);
        four.message = 0.2 * MS;
        nearly(predicted(&file, &four).makespan, cores == 1 ? 3.4 * MS : 2.2 * MS);
    }
}

/* Four contributions took 4 ms to combine on the one rank of the trace. On two hosts each combines
 * two of them; then the one with the object takes the other's piece, too: 2 + (2 + 1) ms. */
UNIT_TEST(hosts_combine_their_own_contributions)
{
    for (uint32_t hosts = 1; hosts <= 2; hosts++) {
        struct trace_file file = predicted_trace(6, 8);
        for (uint32_t i = 0; i < 4; i++)
            trace_file_fork(&file, FILE_R_CW, 0, 0, 2, SLOTS(i < 2 ? 1 + i : 2 + i, 3));
        trace_file_fork(&file, FILE_RW, 1 * MS, 0, 1, SLOTS(3));
        trace_file_own(&file, TASK_COMBINE, 4 * MS);
        const struct predict_cluster cluster = predicted_machine(hosts, 1);
        nearly(predicted(&file, &cluster).makespan, hosts == 1 ? 5 * MS : 6 * MS);
    }
}

/* The same in three rounds of a replay, whose sum each host makes that reads it: 2 ms for its own
 * contributions and 1 ms for the other's piece, at once on both. One of the traced sums took 40 ms:
 * medians know nothing of it, and the mean of 16 ms makes each round 9 ms longer. */
UNIT_TEST(each_host_adds_what_it_has)
{
    static const struct trace_file_node nodes[] = {
        {FILE_SET, 0, 0, 1, {2}},        {FILE_R_CW, 0, 0, 2, {0, 2}},
        {FILE_R_CW, 0, 0, 2, {1, 2}},    {FILE_R_CW, 0, 0, 2, {3, 2}},
        {FILE_R_CW, 0, 0, 2, {4, 2}},    {FILE_R_W, 1 * MS, 0, 2, {2, 0}},
        {FILE_R_W, 1 * MS, 0, 2, {2, 3}}};
    for (int steady = 0; steady < 2; steady++) {
        struct trace_file file = predicted_trace(6, 8);
        trace_file_graph(&file, 6, 7, nodes);
        trace_file_replay(&file, 6, 7, nodes, 3);
        for (int i = 0; i < 3; i++)
            trace_file_own(&file, TASK_NODE_SUM, i == 1 ? 40 * MS : 4 * MS);
        struct predict_cluster two = predicted_machine(2, 1);
        two.steady = steady;
        nearly(predicted(&file, &two).makespan, steady ? 3 * 4 * MS : 3 * 13 * MS);
    }
}

/* Twenty forks in 10 ms. On two hosts each forks ten of its own, 0.5 ms each, and passes over the
 * ten others for two fifths of that. */
UNIT_TEST(forks_of_others_are_cheap)
{
    for (uint32_t hosts = 1; hosts <= 2; hosts++) {
        struct trace_file file = predicted_trace(20, 8);
        for (uint32_t i = 1; i <= 20; i++)
            trace_file_fork(&file, FILE_W, 0, 0, 1, SLOTS(i));
        trace_file_forked(&file, 10 * MS);
        const struct predict_cluster cluster = predicted_machine(hosts, 1);
        nearly(predicted(&file, &cluster).makespan, hosts == 1 ? 10 * MS : 7 * MS);
    }
}

/* Object 1 of host 0 exchanges 200 bytes with object 3 and 100 with object 4, both on host 1: half
 * of that goes there, however large it is, if what hosts send is packed. */
UNIT_TEST(packed_values)
{
    static const struct trace_file_node nodes[] = {{FILE_W, 1 * MS, 0, 1, {0}},
                                                   {FILE_R_W, 1 * MS, 0, 2, {0, 2}},
                                                   {FILE_R_W, 1 * MS, 0, 2, {0, 3}}};
    for (int packed = 0; packed < 2; packed++) {
        struct trace_file file = {0};
        for (uint32_t slot = 1; slot <= 4; slot++)
            trace_file_object(&file, slot, 1000);
        trace_file_hint(&file, 1, 3, 200);
        trace_file_hint(&file, 4, 1, 100);
        trace_file_begin(&file, 4);
        trace_file_graph(&file, 4, 3, nodes);
        trace_file_replay(&file, 4, 3, nodes, 5);
        struct predict_cluster two = predicted_machine(2, 1);
        two.packed = packed;
        const struct predict_result r = predicted(&file, &two);
        ck_assert_uint_eq(r.messages, 5);
        ck_assert_uint_eq(r.bytes, packed ? 5 * 150 : 5 * 1000);
    }
}

/* Eight hosts with two objects each: a graph of 16 tasks, two on each host. */
static struct predict_result eight_hosts(struct trace_file_node *nodes, uint32_t n)
{
    struct trace_file file = predicted_trace(16, 8);
    trace_file_graph(&file, 16, n, nodes);
    trace_file_replay(&file, 16, n, nodes, 1);
    struct predict_cluster eight = predicted_machine(8, 1);
    eight.latency = 1 * MS;
    return predicted(&file, &eight);
}

/* A sum of eight contributions, one a host, that each host reads: three messages a host, one after
 * the other. In the rounds lists of 1, 2 and 4 leaves go; those that begin at an even place, or one
 * divisible by four, are combined: 8 + (4 + 4 * 2) + (2 + 2 * 2 + 4 * 3) values. */
UNIT_TEST(sums_from_host_to_host)
{
    struct trace_file_node nodes[17] = {{FILE_SET, 0, 0, 1, {0}}};
    for (uint32_t i = 0; i < 8; i++) {
        nodes[1 + i] = (struct trace_file_node){FILE_R_CW, 1 * MS, 0, 2, {2 * i + 1, 0}};
        nodes[9 + i] = (struct trace_file_node){FILE_R_W, 1 * MS, 0, 2, {0, 2 * i + 1}};
    }
    const struct predict_result r = eight_hosts(nodes, 17);
    ck_assert_uint_eq(r.messages, 8 * 3);
    ck_assert_uint_eq(r.bytes, 8 * (8 + 12 + 18));
    nearly(r.makespan, (1 + 3 + 1) * MS);
}

/* A value of one host that all read: seven messages, three one after the other to the last host. */
UNIT_TEST(values_from_host_to_host)
{
    struct trace_file_node nodes[9] = {{FILE_W, 1 * MS, 0, 1, {0}}};
    for (uint32_t i = 0; i < 8; i++)
        nodes[1 + i] = (struct trace_file_node){FILE_R_W, 1 * MS, 0, 2, {0, 2 * i + 1}};
    const struct predict_result r = eight_hosts(nodes, 9);
    ck_assert_uint_eq(r.messages, 7);
    ck_assert_uint_eq(r.bytes, 7 * 8);
    nearly(r.makespan, (1 + 3 + 1) * MS);
}

/* Bodies of larger blocks take longer; what is between tasks does not. */
UNIT_TEST(larger_bodies)
{
    struct trace_file file = predicted_trace(1, 8);
    for (int i = 0; i < 4; i++)
        trace_file_fork(&file, FILE_RW, 2 * MS, 0, 1, SLOTS(1));
    struct predict_cluster one = predicted_machine(1, 1);
    one.bodies = 3;
    one.overhead = 0.5 * MS;
    nearly(predicted(&file, &one).makespan, 3 * 8 * MS + 3 * 0.5 * MS);
}
