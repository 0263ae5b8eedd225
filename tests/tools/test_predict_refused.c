/* Refused by the predictor: traces that are damaged or not whole, which cost no memory either, and
 * clusters that do not fit. */
#include "runtime/map/map.h"
#include "tests/support/unit.h"
#include "tests/tools/predicted.h"
#include "tools/predict/predict.h"

#include <stddef.h>
#include <string.h>
#include <sys/resource.h>

static void refused(struct trace_file *file, const struct predict_cluster *cluster, const char *why)
{
    struct predict_result result;
    struct trace_run *run = predicted_run(file);
    ck_assert_int_eq(predict(run, cluster, &result, NULL), DUITE_E_ARGUMENT);
    unit_says(duite_message(), why);
    trace_run_free(run);
}

UNIT_TEST(refusals)
{
    const struct predict_cluster one = predicted_machine(1, 1);
    struct predict_cluster other = predicted_machine(2, 1);
    struct trace_file file = predicted_trace(1, 8);
    trace_file_fork(&file, FILE_RW, 1 * MS, 0, 1, SLOTS(1));
    file.lost = 3;
    refused(&file, &one, "is not whole (3 events or words are missing)");
    file = predicted_trace(1, 8);
    refused(&file, &one, "no tasks");
    file = predicted_trace(1, 8);
    trace_file_fork(&file, FILE_RW, 1 * MS, 0, 1, SLOTS(7));
    refused(&file, &one, "damaged");
    file = predicted_trace(1, 8);
    trace_file_word(&file, 200);
    refused(&file, &one, "damaged");
    file = predicted_trace(1, 8);
    trace_file_fork(&file, FILE_RW, 1 * MS, 0, 1, SLOTS(1));
    other.mapping = NULL;
    refused(&file, &other, "name a mapping");
    file = predicted_trace(1, 8);
    trace_file_fork(&file, FILE_RW, 1 * MS, 0, 1, SLOTS(1));
    other = predicted_machine(0, 1);
    refused(&file, &other, "are invalid");
    file = predicted_trace(1, 8);
    trace_file_fork(&file, FILE_RW, 1 * MS, 0, 1, SLOTS(1));
    other = predicted_machine(2, 1);
    other.balance = duite_balancer_find("delegate");
    refused(&file, &other, "are not predicted");
    file = predicted_trace(1, 8);
    trace_file_fork(&file, FILE_RW, 1 * MS, 0, 1, SLOTS(1));
    other = one;
    other.balance = duite_balancer_find("migrate");
    refused(&file, &other, "name a mapping");
}

/* A number in a small file asks for no memory that the file has nothing for. */
static void costs_little(struct trace_file *file)
{
    enum { MOST_KIB = 50 << 10 };
    const struct predict_cluster one = predicted_machine(1, 1);
    struct rusage before, after;
    ck_assert_int_eq(getrusage(RUSAGE_SELF, &before), 0);
    refused(file, &one, "damaged");
    ck_assert_int_eq(getrusage(RUSAGE_SELF, &after), 0);
    ck_assert_msg(after.ru_maxrss - before.ru_maxrss < MOST_KIB, "%ld KiB more",
                  after.ru_maxrss - before.ru_maxrss);
}

UNIT_TEST(a_far_slot_costs_little)
{
    struct trace_file file = predicted_trace(1, 8);
    trace_file_object(&file, (1u << 28) - 1, 8);
    costs_little(&file);
}

/* Rounds without tasks: all that says how many there were is a number. */
UNIT_TEST(many_rounds_cost_little)
{
    struct trace_file file = predicted_trace(1, 8);
    trace_file_graph(&file, 1, 0, NULL);
    trace_file_replay(&file, 1, 0, NULL, 2000000);
    costs_little(&file);
}

UNIT_TEST(a_far_graph_costs_little)
{
    struct trace_file file = predicted_trace(1, 8);
    trace_file_word(&file, TRACE_GRAPH);
    trace_file_word(&file, (1u << 20) - 1);
    trace_file_word(&file, 0);
    costs_little(&file);
}

UNIT_TEST(more_objects_than_words_cost_little)
{
    static const enum trace_call call[] = {TRACE_FORK, TRACE_HINT, TRACE_HOMES, TRACE_GRAPH,
                                           TRACE_REPLAY};
    for (size_t i = 0; i < sizeof call / sizeof *call; i++) {
        struct trace_file file = predicted_trace(1, 8);
        trace_file_word(&file, 0xffffff00u | call[i]);
        for (int k = 0; k < 20; k++)
            trace_file_word(&file, 0);
        costs_little(&file);
    }
}
