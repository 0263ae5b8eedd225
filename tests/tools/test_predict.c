/* Predictions against schedules worked out by hand. The mapping is block: of two objects the first
 * lives on host 0, the second on host 1. */
#include "runtime/map/map.h"
#include "runtime/sched/sched.h"
#include "tests/support/unit.h"
#include "tests/tools/predicted.h"
#include "tools/predict/predict.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void is(double value, double expected)
{
    ck_assert_msg(fabs(value - expected) < 1e-9, "%.12g, not %.12g", value, expected);
}

/* Three tasks in a row: 1 + 2 + 3 ms, however many cores. */
UNIT_TEST(chain)
{
    struct trace_file file = predicted_trace(1, 8);
    for (int i = 1; i <= 3; i++)
        trace_file_fork(&file, FILE_RW, i * MS, 0, 1, SLOTS(1));
    const struct predict_cluster four = predicted_machine(1, 4);
    struct predict_result r = predicted(&file, &four);
    is(r.makespan, 6 * MS);
    is(r.critical_path, 6 * MS);
    is(r.idle, 0.75);
    ck_assert_int_eq(r.limit, PREDICT_PATH);
    ck_assert_uint_eq(r.tasks, 3);
    ck_assert_uint_eq(r.messages, 0);
}

/* The same three, and one beside them: the bodies on the chain are listed by kernels. */
UNIT_TEST(bodies_of_the_chain)
{
    struct trace_file file = predicted_trace(2, 8);
    trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(2));
    for (int i = 1; i <= 3; i++)
        trace_file_fork(&file, FILE_RW, i * MS, 0, 1, SLOTS(1));
    struct trace_run *run = predicted_run(&file);
    double *kernels = malloc((run->n_kernels + 1) * sizeof *kernels);
    ck_assert(kernels != NULL);
    for (uint32_t k = 0; k < run->n_kernels; k++)
        kernels[k] = 7;
    const struct predict_cluster two = predicted_machine(1, 2);
    const struct predict_more more = {.chain = kernels};
    struct predict_result result;
    ck_assert_int_eq(predict(run, &two, &result, &more), DUITE_OK);
    for (uint32_t k = 0; k < run->n_kernels; k++)
        is(kernels[k], k == FILE_RW ? 6 * MS : 0);
    free(kernels);
    trace_run_free(run);
}

/* Tasks of 3, 3, 2, 2, 2 ms on two cores, first come, first served: 3 + 2 + 2 and 3 + 2. */
UNIT_TEST(independent)
{
    struct trace_file file = predicted_trace(5, 8);
    const double took[] = {3, 3, 2, 2, 2};
    for (uint32_t i = 0; i < 5; i++)
        trace_file_fork(&file, FILE_W, took[i] * MS, 0, 1, SLOTS(i + 1));
    const struct predict_cluster two = predicted_machine(1, 2);
    struct predict_result r = predicted(&file, &two);
    is(r.makespan, 7 * MS);
    is(r.work, 12 * MS);
    is(r.critical_path, 3 * MS);
    ck_assert_int_eq(r.limit, PREDICT_WORK);
}

/* A writer waits for all readers of what it overwrites, and two readers run at once: 1 + 4 + 1. */
UNIT_TEST(readers)
{
    struct trace_file file = predicted_trace(3, 8);
    trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(1));
    trace_file_fork(&file, FILE_R_W, 2 * MS, 0, 2, SLOTS(1, 2));
    trace_file_fork(&file, FILE_R_W, 4 * MS, 0, 2, SLOTS(1, 3));
    trace_file_fork(&file, FILE_RW, 1 * MS, 0, 1, SLOTS(1));
    const struct predict_cluster two = predicted_machine(1, 2);
    is(predicted(&file, &two).makespan, 6 * MS);
}

/* The largest delay limits: the long task, which waited for a core, has 8 of 2 + 8 ms. The longest
 * chain of tasks is 8 ms, too, but held nothing up. */
UNIT_TEST(the_largest_share_limits)
{
    struct trace_file file = predicted_trace(3, 8);
    trace_file_fork(&file, FILE_W, 2 * MS, 0, 1, SLOTS(1));
    trace_file_fork(&file, FILE_W, 2 * MS, 0, 1, SLOTS(2));
    trace_file_fork(&file, FILE_W, 8 * MS, 0, 1, SLOTS(3));
    struct predict_cluster two = predicted_machine(1, 2);
    two.scheduler = &sched_fifo;
    struct predict_result r = predicted(&file, &two);
    is(r.makespan, 10 * MS);
    is(r.critical_path, 8 * MS);
    is(r.chain[PREDICT_WORK], 8 * MS);
    is(r.chain[PREDICT_PATH], 2 * MS);
    ck_assert_int_eq(r.limit, PREDICT_WORK);
}

/* The long one first if it is told to be urgent: 6, not 2 + 2 + 6 on the second core's end. */
UNIT_TEST(priorities)
{
    for (int urgent = 0; urgent < 2; urgent++) {
        struct trace_file file = predicted_trace(4, 8);
        for (uint32_t i = 0; i < 3; i++)
            trace_file_fork(&file, FILE_W, 2 * MS, 0, 1, SLOTS(i + 1));
        trace_file_fork(&file, FILE_W, 6 * MS, urgent, 1, SLOTS(4));
        struct predict_cluster two = predicted_machine(1, 2);
        two.scheduler = urgent ? &sched_priority : &sched_fifo;
        /* The main thread forks in no time, then worker 0 serves, and worker 1 was served before:
         * it has the first task either way. */
        is(predicted(&file, &two).makespan, urgent ? 6 * MS : 8 * MS);
    }
}

/* 1 ms on host 0, 1,000,000 bytes in 2 ms and 0.5 ms on their way, 1 ms on host 1. */
UNIT_TEST(message)
{
    struct trace_file file = predicted_trace(2, 1000000);
    trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(1));
    trace_file_fork(&file, FILE_R_W, 1 * MS, 0, 2, SLOTS(1, 2));
    struct predict_cluster two = predicted_machine(2, 1);
    two.latency = 0.5 * MS;
    two.bandwidth = 5e8;
    struct predict_result r = predicted(&file, &two);
    is(r.makespan, 4.5 * MS);
    is(r.critical_path, 2 * MS);
    is(r.chain[PREDICT_LATENCY], 0.5 * MS);
    is(r.chain[PREDICT_BANDWIDTH], 2 * MS);
    is(r.chain[PREDICT_PATH], 2 * MS);
    ck_assert_uint_eq(r.messages, 1);
    ck_assert_uint_eq(r.bytes, 1000000);
}

/* One message for all who read it there; cards carry one at a time: objects 1 and 2 of host 0 go to
 * host 1 in 2 ms each, one after the other. */
UNIT_TEST(cards)
{
    struct trace_file file = predicted_trace(4, 1000000);
    trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(1));
    trace_file_fork(&file, FILE_W, 0, 0, 1, SLOTS(2));
    trace_file_fork(&file, FILE_RR_W, 1 * MS, 0, 3, SLOTS(1, 2, 3));
    trace_file_fork(&file, FILE_RR_W, 1 * MS, 0, 3, SLOTS(1, 2, 4));
    struct predict_cluster two = predicted_machine(2, 2);
    two.bandwidth = 5e8;
    struct predict_result r = predicted(&file, &two);
    ck_assert_uint_eq(r.messages, 2);
    /* Both tasks on host 0 begin at 0: 2 goes until 2, then 1 until 4; then both readers. */
    is(r.makespan, 5 * MS);
    ck_assert_int_eq(r.limit, PREDICT_BANDWIDTH);
}

/* One card sends to two hosts: 2 ms, then 2 ms more. */
UNIT_TEST(sender)
{
    struct trace_file file = predicted_trace(3, 1000000);
    trace_file_fork(&file, FILE_W, 0, 0, 1, SLOTS(1));
    trace_file_fork(&file, FILE_R_W, 0, 0, 2, SLOTS(1, 2));
    trace_file_fork(&file, FILE_R_W, 0, 0, 2, SLOTS(1, 3));
    struct predict_cluster three = predicted_machine(3, 1);
    three.bandwidth = 5e8;
    is(predicted(&file, &three).makespan, 4 * MS);
}

/* The switch carries all: 4 hosts in a ring send at once, 1 ms in cards, 4 ms in a slow switch. */
UNIT_TEST(fabric)
{
    for (int slow = 0; slow < 2; slow++) {
        struct trace_file file = predicted_trace(8, 1000000);
        for (uint32_t i = 0; i < 4; i++)
            trace_file_fork(&file, FILE_W, 0, 0, 1, SLOTS(2 * i + 1));
        for (uint32_t i = 0; i < 4; i++)
            trace_file_fork(&file, FILE_R_W, 0, 0, 2, SLOTS(2 * i + 1, (2 * i + 3) % 8 + 1));
        struct predict_cluster four = predicted_machine(4, 1);
        four.bandwidth = 1e9;
        four.capacity = slow ? 1e9 : INFINITY;
        is(predicted(&file, &four).makespan, slow ? 4 * MS : 1 * MS);
    }
}

/* Contributions run at once; who reads the sum waits for them all. */
UNIT_TEST(sums)
{
    struct trace_file file = predicted_trace(5, 8);
    for (uint32_t i = 0; i < 3; i++)
        trace_file_fork(&file, FILE_R_CW, (i + 1) * MS, 0, 2, SLOTS(i + 1, 4));
    trace_file_fork(&file, FILE_R_W, 1 * MS, 0, 2, SLOTS(4, 5));
    const struct predict_cluster three = predicted_machine(1, 3);
    is(predicted(&file, &three).makespan, 4 * MS);
}

/* Tasks forked after a wait come after all before it; after a get, after that object. */
UNIT_TEST(waits)
{
    for (int get = 0; get < 2; get++) {
        struct trace_file file = predicted_trace(3, 8);
        trace_file_fork(&file, FILE_W, 5 * MS, 0, 1, SLOTS(1));
        trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(2));
        if (get)
            trace_file_get(&file, 2);
        else
            trace_file_wait(&file);
        trace_file_fork(&file, FILE_W, 3 * MS, 0, 1, SLOTS(3));
        const struct predict_cluster two = predicted_machine(1, 3);
        is(predicted(&file, &two).makespan, get ? 5 * MS : 8 * MS);
    }
}

/* A get that was begun has the value of then: a task that overwrites the object meanwhile, on the
 * other core, is not waited for. One that was begun before the trace waits for nothing, and the
 * last task comes before the second one. */
UNIT_TEST(gets_that_were_begun)
{
    static const double makespan[] = {9 * MS, 6 * MS, 6.5 * MS};
    for (int begun = 0; begun < 3; begun++) {
        struct trace_file file = predicted_trace(3, 8);
        trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(1));
        if (begun == 1)
            trace_file_get_begin(&file, 7, 1);
        trace_file_fork(&file, FILE_RW, 5 * MS, 0, 1, SLOTS(1));
        trace_file_fork(&file, FILE_W, 1.5 * MS, 0, 1, SLOTS(2)); /* beside the first one */
        if (begun)
            trace_file_get_end(&file, 7);
        else
            trace_file_get(&file, 1);
        trace_file_fork(&file, FILE_W, 3 * MS, 0, 1, SLOTS(3));
        trace_file_wait(&file);
        const struct predict_cluster two = predicted_machine(1, 2);
        is(predicted(&file, &two).makespan, makespan[begun]);
    }
}

/* A core of twice the speed, and half a millisecond between tasks. */
UNIT_TEST(speed_and_overhead)
{
    struct trace_file file = predicted_trace(1, 8);
    for (int i = 0; i < 4; i++)
        trace_file_fork(&file, FILE_RW, 2 * MS, 0, 1, SLOTS(1));
    struct predict_cluster one = predicted_machine(1, 1);
    one.core_speed = 2;
    one.overhead = 0.5 * MS;
    struct predict_result r = predicted(&file, &one);
    is(r.makespan, 4 * MS + 3 * 0.5 * MS);
    is(r.chain[PREDICT_OVERHEAD], 1.5 * MS);
}

/* Five bodies of 1 ms, one of which was held up if that is said, and one of another kernel. */
static struct trace_file bodies_one_late(double late)
{
    struct trace_file file = predicted_trace(2, 8);
    for (int i = 0; i < 5; i++)
        trace_file_fork(&file, FILE_RW, i == 3 ? late : 1 * MS, 0, 1, SLOTS(1));
    trace_file_fork(&file, FILE_R_W, 2 * MS, 0, 2, SLOTS(1, 2));
    return file;
}

/* The median of 1, 1, 1, 9 and 1 ms; another kernel has its own. */
UNIT_TEST(steady)
{
    for (int is_steady = 0; is_steady < 2; is_steady++) {
        struct trace_file file = bodies_one_late(9 * MS);
        struct predict_cluster one = predicted_machine(1, 1);
        one.steady = is_steady;
        const struct predict_result r = predicted(&file, &one);
        is(r.makespan, is_steady ? 7 * MS : 15 * MS);
        is(r.bodies, 15 * MS);
        is(r.medians, 7 * MS);
    }
}

/* A trace in which bodies took far longer than their kernels' medians is believed with a warning
 * alone, which names --steady; bodies a little apart, and --steady itself, need none. */
UNIT_TEST(warns_of_a_disturbed_trace)
{
    static const struct {
        double late;
        const char *option;
        bool warns;
    } runs[] = {{9 * MS, "", true}, {2 * MS, "", false}, {9 * MS, "--steady", false}};
    for (size_t i = 0; i < sizeof runs / sizeof *runs; i++) {
        struct trace_file file = bodies_one_late(runs[i].late);
        char command[128], said[4096], trace[64];
        snprintf(trace, sizeof trace, "test_predict.%d.late.trace", (int)getpid());
        snprintf(command, sizeof command, "./duite-predict %s %s 2>&1", trace, runs[i].option);
        ck_assert(trace_file_write(&file, trace));
        FILE *output = popen(command, "r");
        ck_assert_ptr_nonnull(output);
        said[fread(said, 1, sizeof said - 1, output)] = 0;
        ck_assert_int_eq(pclose(output), 0);
        unlink(trace);
        const char *warning = strstr(said, "duite-predict: warning: ");
        ck_assert_msg(!warning == !runs[i].warns, "%g s late: %s", runs[i].late, said);
        ck_assert_msg(!warning || (strstr(warning, "--steady") && strstr(warning, "0.015 s") &&
                                   strstr(warning, "0.007 s")),
                      "%s", said);
    }
}

/* Replicated: once, everywhere; what it reads goes to all. */
UNIT_TEST(replicated)
{
    struct trace_file file = predicted_trace(3, 1000);
    trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(1));
    trace_file_fork(&file, FILE_SAME, 1 * MS, 0, 2, SLOTS(1, 2));
    trace_file_fork(&file, FILE_R_W, 1 * MS, 0, 2, SLOTS(2, 3));
    struct predict_cluster three = predicted_machine(3, 1);
    three.latency = 1 * MS;
    struct predict_result r = predicted(&file, &three);
    ck_assert_uint_eq(r.messages, 2);
    ck_assert(r.makespan > 4 * MS && r.makespan < 4.001 * MS);
}

/* Every scheduler ends with every task. */
UNIT_TEST(schedulers)
{
    for (size_t k = 0; duite_scheduler_names()[k]; k++) {
        struct trace_file file = predicted_trace(20, 8);
        for (uint32_t i = 0; i < 200; i++)
            trace_file_fork(&file, FILE_RR_W, (i % 7) * 0.1 * MS, (int32_t)i % 3, 3,
                            SLOTS(i % 20 + 1, (i + 3) % 20 + 1, (i + 7) % 20 + 1));
        struct predict_cluster some = predicted_machine(2, 3);
        some.scheduler = duite_scheduler_find(duite_scheduler_names()[k]);
        struct predict_result r = predicted(&file, &some);
        ck_assert_msg(r.makespan >= r.critical_path - 1e-9 && r.makespan >= r.work / 6 - 1e-9,
                      "%s: sooner than can be", some.scheduler->name);
        ck_assert_msg(r.makespan <= r.work + 1e-9, "%s: later than one after the other",
                      some.scheduler->name);
    }
}

/* Rounds of which no task ran, since all were poisoned, take no time; the replay's rounds are words
 * 3 and 4 of its entry, before the number of the last fork and the one object. */
UNIT_TEST(poisoned_rounds_take_no_time)
{
    const struct trace_file_node node = {FILE_RW, 1 * MS, 0, 1, {0}};
    const struct predict_cluster one = predicted_machine(1, 1);
    struct trace_file file = predicted_trace(1, 8);
    trace_file_graph(&file, 1, 1, &node);
    trace_file_replay(&file, 1, 1, &node, 2);
    ck_assert_uint_eq(file.word[file.n_words - 5], 2);
    file.word[file.n_words - 5] = 2000000000;
    struct predict_result r = predicted(&file, &one);
    is(r.makespan, 2 * MS);
    ck_assert_uint_eq(r.tasks, 2);
}

/* One task in three ran in each of a thousand rounds: no reason to call the trace damaged. */
UNIT_TEST(poisoned_tasks_are_no_damage)
{
    static const struct trace_file_node nodes[] = {
        {FILE_RW, 1 * MS, 0, 1, {0}}, {FILE_RW, 1 * MS, 0, 1, {1}}, {FILE_RW, 1 * MS, 0, 1, {2}}};
    const struct predict_cluster one = predicted_machine(1, 1);
    struct trace_file file = predicted_trace(3, 8);
    trace_file_graph(&file, 3, 3, nodes);
    trace_file_replay(&file, 3, 3, nodes, 1000);
    for (size_t i = 0; i < file.n_events; i++)
        if (i % 3)
            file.event[i].number = 1; /* some nested task of the first one */
    ck_assert_uint_eq(predicted(&file, &one).tasks, 3000);
}
