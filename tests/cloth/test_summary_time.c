/* The limit of a run, by reports that are made here: the largest share of its time decides. */
#include "cloth/app/report/summary.h"

#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>

/* 100 steps in 10 s of two workers on two cores. Each case gives 20 s to busy, idle and the rest.
 */
static struct flow_report report;
static struct simulate_options options;
static struct phases phases;
static struct summary summary;

static void start(void)
{
    report = (struct flow_report){.steps = 100,
                                  .blocks = 24,
                                  .wall_seconds = 10,
                                  .seconds_matrix = 4,
                                  .seconds_cg = 12,
                                  .seconds_collide = NAN,
                                  .seconds_output = 1,
                                  .counters = {.tasks = 5000}};
    report.seconds_force = report.seconds_acceleration = report.seconds_velocity =
        report.seconds_position = report.seconds_correction = NAN;
    options = (struct simulate_options){.runtime = {.trace_end = UINT64_MAX}};
    phases = (struct phases){.n = 1};
    summary = (struct summary){.options = &options,
                               .report = &report,
                               .phases = &phases,
                               .ranks = 1,
                               .threads = 2,
                               .cores = 2,
                               .workers = 2,
                               .critical_path = NAN};
}

static void takes(double busy, double idle, double exposed)
{
    report.counters.busy = busy;
    report.counters.idle = idle;
    report.counters.exposed = exposed;
}

static void check_says(const char *want)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    ck_assert_ptr_nonnull(file);
    summary_limit_print(file, &summary);
    ck_assert_int_eq(fclose(file), 0);
    ck_assert_str_eq(text, want);
    free(text);
}

UNIT_FIXTURE(start, NULL)

UNIT_TEST(work)
{
    takes(18.6, 1, 0);
    check_says(
        "Limited by work: the workers were busy for 93 % of the time, 71 % of that in CG.\n");
    report.seconds_collide = 20;
    check_says(
        "Limited by work: the workers were busy for 93 % of the time, 54 % of that in contact.\n");
    report.seconds_output = 63;
    check_says(
        "Limited by work: the workers were busy for 93 % of the time, 64 % of that in output.\n");
}

UNIT_TEST(messages)
{
    takes(8, 11, 9);
    check_says("Limited by messages: the workers had no task and awaited messages for 45 % of the "
               "time.\n");
}

/* Messages that are awaited while workers have tasks are no limit. */
UNIT_TEST(hidden_messages)
{
    takes(8, 3, 50);
    report.counters.awaited = 60;
    check_says(
        "Limited by the runtime and main program: the workers were between tasks for 45 % of "
        "the time, with 5000 tasks.\n");
}

UNIT_TEST(starved)
{
    takes(8, 11, 1);
    check_says("Limited by too few ready tasks: the workers had no task for 50 % of the time, with "
               "24 blocks for 2 workers.\n");
    summary.threads = 8;
    check_says("Limited by too few ready tasks: the workers had no task for 50 % of the time, with "
               "8 workers on 2 cores.\n");
}

/* The critical path counts where the whole run was traced. */
UNIT_TEST(path)
{
    const char *busy =
        "Limited by work: the workers were busy for 60 % of the time, 71 % of that in CG.\n";
    takes(12, 7, 0);
    summary.critical_path = 8;
    check_says(busy);
    options.runtime.trace = "a.trace";
    check_says(
        "Limited by the critical path: tasks that wait for one another took 80 % of the time.\n");
    options.runtime.trace_first = 3;
    check_says(busy);
    options.runtime.trace_first = 0;
    options.runtime.trace_end = 90;
    check_says(busy);
    options.runtime.trace_end = UINT64_MAX;
    phases.n = 2;
    check_says(busy);
    phases.n = 1;
    summary.critical_path = NAN;
    check_says(busy);
}

UNIT_TEST(repeats)
{
    takes(18.6, 1, 0);
    report.contact_solves = 33;
    check_says(
        "Limited by work: the workers were busy for 93 % of the time, 71 % of that in CG.\n");
    report.contact_solves = 100;
    check_says("Limited by work: the workers were busy for 93 % of the time, 71 % of that in CG; "
               "50 % of the solves were made again for contact.\n");
    report.steps_halved = 150;
    report.steps_retaken = 50;
    check_says("Limited by work: the workers were busy for 93 % of the time, 71 % of that in CG; "
               "67 % of the steps were given up and made again.\n");
}

UNIT_TEST(nothing_to_say)
{
    report.steps = 0;
    check_says("");
    report.steps = 1;
    report.wall_seconds = 0;
    check_says("");
}
