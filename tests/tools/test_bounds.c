/* The bounds of a run against chains worked out by hand. */
#include "tests/support/unit.h"
#include "tests/tools/predicted.h"

#include <math.h>
#include <stdio.h>

static struct trace_file begun(uint32_t n)
{
    return predicted_trace(n, 8);
}

static int bounds_of(struct trace_file *file, double *path, double *bound)
{
    struct predict_bounds bounds;
    struct trace_run *run = predicted_run(file);
    const int code = predict_bounds(run, &bounds);
    for (size_t i = 1; i < bounds.n; i++)
        ck_assert_uint_gt(bounds.number[i], bounds.number[i - 1]);
    *path = bounds.path;
    *bound = bounds.lower;
    predict_bounds_free(&bounds);
    trace_run_free(run);
    return code;
}

static void bounds_are(struct trace_file *file, double path, double bound)
{
    double found = 0, lower = 0;
    ck_assert_msg(!bounds_of(file, &found, &lower), "%s", duite_message());
    ck_assert_msg(fabs(found - path) < 1e-9, "path %.12g, not %.12g", found, path);
    ck_assert_msg(fabs(lower - bound) < 1e-9, "bound %.12g, not %.12g", lower, bound);
}

/* 1 + 2 + 3 ms in a row; a task beside them makes the work of the one worker more. */
UNIT_TEST(values_make_chains)
{
    struct trace_file file = begun(2);
    for (int i = 1; i <= 3; i++)
        trace_file_fork(&file, FILE_RW, i * MS, 0, 1, SLOTS(1));
    trace_file_fork(&file, FILE_W, 5 * MS, 0, 1, SLOTS(2));
    bounds_are(&file, 6 * MS, 11 * MS);
}

/* 1 + 4: who writes without reading waits for nobody if there is memory enough. */
UNIT_TEST(writers_begin_chains)
{
    struct trace_file file = begun(2);
    trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(1));
    trace_file_fork(&file, FILE_R_W, 4 * MS, 0, 2, SLOTS(1, 2));
    trace_file_fork(&file, FILE_W, 2 * MS, 0, 1, SLOTS(1));
    bounds_are(&file, 5 * MS, 7 * MS);
}

/* 1 + 3 + 1: contributions wait for no other, and a reader for all of them. */
UNIT_TEST(contributions_end_together)
{
    struct trace_file file = begun(2);
    trace_file_fork(&file, FILE_W, 1 * MS, 0, 1, SLOTS(1));
    for (int i = 1; i <= 3; i++)
        trace_file_fork(&file, FILE_R_CW, i * MS, 0, 2, SLOTS(1, 2));
    trace_file_fork(&file, FILE_RW, 1 * MS, 0, 1, SLOTS(2));
    bounds_are(&file, 5 * MS, 8 * MS);
}

/* Three rounds of 1 + 2 in a row, then 1 more on what the last one left. */
static const struct trace_file_node NODES[] = {{FILE_RW, 1 * MS, 0, 1, {0}},
                                               {FILE_R_W, 2 * MS, 0, 2, {0, 1}}};
UNIT_TEST(rounds_follow_rounds)
{
    struct trace_file file = begun(2);
    trace_file_graph(&file, 2, 2, NODES);
    trace_file_replay(&file, 2, 2, NODES, 3);
    trace_file_fork(&file, FILE_RW, 1 * MS, 0, 1, SLOTS(2));
    bounds_are(&file, 6 * MS, 10 * MS);
}

/* The same with a flag that the second task writes: the next round begins when it is read. */
UNIT_TEST(flags_hold_rounds)
{
    struct trace_file file = begun(2);
    trace_file_graph(&file, 2, 2, NODES);
    const size_t at = file.n_words;
    trace_file_replay(&file, 2, 2, NODES, 3);
    file.word[at + 2] = 2;
    trace_file_fork(&file, FILE_RW, 1 * MS, 0, 1, SLOTS(2));
    bounds_are(&file, 10 * MS, 10 * MS);
}

/* The second task waits for the flag, too, although one of its own round reads what it overwrites:
 * 2 (the first round's flag) + 1 (the second round's second task) + 3. */
UNIT_TEST(readers_do_not_hide_flags)
{
    static const struct trace_file_node nodes[] = {{FILE_R_W, 2 * MS, 0, 2, {0, 1}},
                                                   {FILE_W, 1 * MS, 0, 1, {0}}};
    struct trace_file file = begun(2);
    trace_file_graph(&file, 2, 2, nodes);
    const size_t at = file.n_words;
    trace_file_replay(&file, 2, 2, nodes, 2);
    file.word[at + 2] = 2;
    trace_file_fork(&file, FILE_RW, 3 * MS, 0, 1, SLOTS(1));
    bounds_are(&file, 6 * MS, 9 * MS);
}

/* Rounds of a replay count nothing from the one that was poisoned on. */
UNIT_TEST(poisoned_rounds_take_no_time)
{
    struct trace_file file = begun(2);
    trace_file_graph(&file, 2, 2, NODES);
    const size_t at = file.n_words;
    trace_file_replay(&file, 2, 2, NODES, 1);
    file.word[at + 3] = 1000000000;
    file.forks += 999999999ull * 2; /* as many as did not run */
    trace_file_fork(&file, FILE_RW, 1 * MS, 0, 1, SLOTS(2));
    bounds_are(&file, 4 * MS, 4 * MS);
}

/* Each word, replaced, gives bounds or a refusal. */
UNIT_TEST(damage_is_refused)
{
    static const uint32_t planted[] = {0, 1, 0xff, 0xffffff00u | TRACE_GRAPH, UINT32_MAX};
    struct trace_file file;
    double path, bound;
    size_t n = 1;
    for (size_t at = 0; at < n; at++)
        for (size_t k = 0; k < sizeof planted / sizeof *planted; k++) {
            file = begun(2);
            trace_file_graph(&file, 2, 2, NODES);
            trace_file_replay(&file, 2, 2, NODES, 3);
            trace_file_fork(&file, FILE_R_CW, 1 * MS, 0, 2, SLOTS(1, 2));
            n = file.n_words;
            file.word[at] = planted[k];
            const int code = bounds_of(&file, &path, &bound);
            ck_assert(!code || code == DUITE_E_ARGUMENT);
        }
    file = begun(1);
    file.lost = 1;
    ck_assert_int_eq(bounds_of(&file, &path, &bound), DUITE_E_ARGUMENT);
    file = begun(1);
    ck_assert_int_eq(bounds_of(&file, &path, &bound), DUITE_E_ARGUMENT);
}
