/* Platforms: predictions against schedules worked out by hand, and files that are refused. The
 * mapping is block: objects 1, 2, ... are spread over the hosts in order, as many on each. */
#include "runtime/map/map.h"
#include "runtime/sched/sched.h"
#include "tests/support/unit.h"
#include "tests/tools/predicted.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { MB = 1000000 };

static struct predict_platform platform;

static void is(double value, double expected)
{
    ck_assert_msg(fabs(value - expected) < 1e-9, "%.12g, not %.12g", value, expected);
}

static int read_text(const char *text)
{
    char path[64];
    snprintf(path, sizeof path, "test_platform.%d", (int)getpid());
    FILE *file = fopen(path, "w");
    ck_assert_ptr_nonnull(file);
    ck_assert_int_ge(fputs(text, file), 0);
    ck_assert_int_eq(fclose(file), 0);
    const int code = predict_platform_read(&platform, path, 3);
    unlink(path);
    return code;
}

/* Predicted on the platform of a text. */
static struct predict_result on(const char *text, struct trace_file *file)
{
    ck_assert_msg(!read_text(text), "%s", duite_message());
    struct predict_cluster cluster = predicted_machine(platform.n_hosts, 1);
    cluster.platform = &platform;
    const struct predict_result result = predicted(file, &cluster);
    predict_platform_free(&platform);
    return result;
}

/* Four hosts stand two on each of two switches. Both on the left send to one each on the right: 1
 * MB and `more` MB, whose readers take so many seconds. */
static struct trace_file two_flows(uint32_t more, double one_takes, double more_takes)
{
    struct trace_file file = {0};
    for (uint32_t slot = 1; slot <= 4; slot++)
        trace_file_object(&file, slot, slot == 2 ? more * MB : MB);
    trace_file_begin(&file, 4);
    trace_file_fork(&file, FILE_W, 0, 0, 1, SLOTS(1));
    trace_file_fork(&file, FILE_W, 0, 0, 1, SLOTS(2));
    trace_file_fork(&file, FILE_R_W, one_takes, 0, 2, SLOTS(1, 3));
    trace_file_fork(&file, FILE_R_W, more_takes, 0, 2, SLOTS(2, 4));
    return file;
}

static const char *const TWO_SWITCHES = "switch top\n"
                                        "switch left to top bandwidth 1e9\n"
                                        "switch right to top # as fast as may be\n"
                                        "hosts 2 to left cores 1\n"
                                        "hosts 2 to right cores 1\n";

/* Over a link of 1 GB/s 1 MB takes 1 ms, and two at once take 2 ms. */
UNIT_TEST(two_flows_share_a_link)
{
    struct trace_file file = two_flows(1, 0, 0);
    is(on(TWO_SWITCHES, &file).makespan, 2 * MS);
}

/* 1 MB and 3 MB at half the speed until the first is through at 2 ms; then 2 MB more at the whole.
 */
UNIT_TEST(a_flow_that_ends_leaves_its_share)
{
    struct trace_file file = two_flows(3, 5 * MS, 0);
    is(on(TWO_SWITCHES, &file).makespan, 7 * MS);
    file = two_flows(3, 0, 5 * MS);
    is(on(TWO_SWITCHES, &file).makespan, 9 * MS);
}

/* The same over cards that are slower than the share of the link. */
UNIT_TEST(the_slowest_link_counts)
{
    struct trace_file file = two_flows(1, 0, 0);
    is(on("switch top capacity 1e9\nhosts 4 to top bandwidth 1e8\n", &file).makespan, 10 * MS);
    file = two_flows(1, 0, 0);
    is(on("switch top capacity 1e9\nhosts 4 to top\n", &file).makespan, 2 * MS);
}

/* 0.1 + 0.2 + 0.3 + 0.4 ms on the way from one host to the other, at 0.5 GB/s the slowest. */
UNIT_TEST(a_chain_over_switches)
{
    struct trace_file file = predicted_trace(2, MB);
    trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(1));
    trace_file_fork(&file, FILE_R_W, 1 * MS, 0, 2, SLOTS(1, 2));
    const struct predict_result r = on("switch top\n"
                                       "switch left to top latency 2e-4 bandwidth 1e9\n"
                                       "switch right to top latency 3e-4 bandwidth 5e8\n"
                                       "hosts 1 to left latency 1e-4 bandwidth 1e10\n"
                                       "hosts 1 to right latency 4e-4 bandwidth 1e10\n",
                                       &file);
    is(r.makespan, 1 * MS + 2 * MS + 1 * MS + 1 * MS);
    is(r.chain[PREDICT_LATENCY], 1 * MS);
    is(r.chain[PREDICT_BANDWIDTH], 2 * MS);
}

/* Two tasks of 1 ms on each host: one at a time at half the speed, both at once at the whole. */
UNIT_TEST(hosts_of_two_kinds)
{
    struct trace_file file = predicted_trace(4, 8);
    for (uint32_t slot = 1; slot <= 4; slot++)
        trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(slot));
    const struct predict_result r = on("switch top\n"
                                       "hosts 1 to top cores 1 speed 0.5\n"
                                       "hosts 1 to top cores 2\n",
                                       &file);
    is(r.makespan, 4 * MS);
    is(r.work, 6 * MS);
}

/* A crowd of 40 flows over one link of 1 GB/s: 40 MB in 40 ms. */
UNIT_TEST(a_crowd_shares_a_link)
{
    struct trace_file file = predicted_trace(80, MB);
    for (uint32_t slot = 1; slot <= 40; slot++)
        trace_file_fork(&file, FILE_W, 0, 0, 1, SLOTS(slot));
    for (uint32_t slot = 1; slot <= 40; slot++)
        trace_file_fork(&file, FILE_R_W, 0, 0, 2, SLOTS(slot, slot + 40));
    const struct predict_result r = on("switch top\n"
                                       "switch left to top bandwidth 1e9\n"
                                       "hosts 40 to left\n"
                                       "hosts 40 to top\n",
                                       &file);
    ck_assert_msg(fabs(r.makespan - 40 * MS) < 40 * MS / 16, "%g", r.makespan);
}

/* Hosts that are alike on one switch, by their numbers and by a file: the same to the last bit. */
UNIT_TEST(hosts_that_are_alike)
{
    struct predict_result result[2];
    for (int by_file = 0; by_file < 2; by_file++) {
        struct trace_file file = predicted_trace(20, 10000);
        for (uint32_t i = 0; i < 300; i++)
            trace_file_fork(&file, FILE_RR_W, (i % 7) * 0.1 * MS, 0, 3,
                            SLOTS(i % 20 + 1, (i + 3) % 20 + 1, (i + 7) % 20 + 1));
        struct predict_cluster cluster = predicted_machine(5, 2);
        cluster.latency = 1e-5;
        cluster.bandwidth = 1e9;
        cluster.capacity = 2e9;
        cluster.core_speed = 0.75;
        ck_assert_int_eq(read_text("switch top capacity 2e9\n"
                                   "hosts 5 to top cores 2 speed 0.75 latency 5e-6 bandwidth 1e9"),
                         0);
        cluster.platform = by_file ? &platform : NULL;
        result[by_file] = predicted(&file, &cluster);
        predict_platform_free(&platform);
    }
    ck_assert_mem_eq(&result[0], &result[1], offsetof(struct predict_result, limit));
}

UNIT_TEST(files_that_are_refused)
{
    static const struct {
        const char *text, *says;
    } files[] = {
        {"", ": no hosts"},
        {"hosts 2\n", ":1: 2: to what switch do these hosts go? (to NAME)"},
        {"\nhosts 2 to there\n", ":2: there: no line before names this switch"},
        {"switch a\nswitch b\n", ":2: b: only the first switch is the top: to NAME is expected"},
        {"switch a\nswitch a to a\n", ":2: a: two switches have this name"},
        {"switch\n", ":1: switch: its name is missing"},
        {"node 1\n", ":1: node: a line begins with switch or hosts"},
        {"switch a\nhosts 0 to a\n", ":2: 0: a number of hosts is expected"},
        {"switch a\nhosts 2 to\n", ":2: to: its value is missing"},
        {"switch a\nhosts 2 to a cores x\n", ":2: x: a number of cores from 1 on is expected"},
        {"switch a\nhosts 2 to a speed 0\n", ":2: 0: a number > 0 is expected"},
        {"switch a\nhosts 2 to a latency -1\n", ":2: -1: a number >= 0 is expected"},
        {"switch a cores 2\n", ":1: cores: a switch has to, latency, bandwidth and capacity"},
        {"switch a\nhosts 2 to a capacity 2\n",
         ":2: capacity: hosts have to, cores, speed, latency and bandwidth"},
        {"switch a\nhosts 16000000 to a cores 2\n",
         ":2: 16000000: more than 16777216 cores in all"},
        {"switch a\nswitch b to a\nswitch c to b\nswitch d to c\nswitch e to d\nswitch f to e\n"
         "switch g to f\n",
         ":7: g: more than 6 switches one above the other"}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        ck_assert_int_eq(read_text(files[i].text), DUITE_E_ARGUMENT);
        unit_says(duite_message(), files[i].says);
        predict_platform_free(&platform);
    }
    ck_assert_int_eq(predict_platform_read(&platform, "nowhere/platform", 1), DUITE_E_SYSTEM);
}
