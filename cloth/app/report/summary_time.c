/* All of it follows from the counters of the run; nothing is measured. The names of limits are
 * those of duite-trace (tools/trace/sums.c), so that a run and its trace speak of the same
 * things. */
#include "cloth/app/report/summary.h"

#include <inttypes.h>
#include <math.h>

enum limit { WORK, PATH, MESSAGES, STARVED, RUNTIME, LIMITS };

static const struct {
    const char *name, *article;
} LIMIT[LIMITS] = {[WORK] = {"work", ""},
                   [PATH] = {"critical path", "the "},
                   [MESSAGES] = {"messages", ""},
                   [STARVED] = {"too few ready tasks", ""},
                   [RUNTIME] = {"runtime and main program", "the "}};

/* Kinds of tasks, each with its seconds in the report; NaN: there were none. */
enum { KINDS = 9 };
#define AT(member) offsetof(struct flow_report, member)
static const struct {
    const char *row, *name; /* in the table; in a sentence */
    size_t seconds;
} KIND[KINDS] = {{"force", "forces", AT(seconds_force)},
                 {"acceleration", "accelerations", AT(seconds_acceleration)},
                 {"matrix", "the matrix", AT(seconds_matrix)},
                 {"CG", "CG", AT(seconds_cg)},
                 {"velocity", "velocities", AT(seconds_velocity)},
                 {"position", "positions", AT(seconds_position)},
                 {"collide", "contact", AT(seconds_collide)},
                 {"correction", "velocity correction", AT(seconds_correction)},
                 {"output", "output", AT(seconds_output)}};

static double seconds_of(const struct flow_report *report, size_t kind)
{
    return *(const double *)((const char *)report + KIND[kind].seconds);
}

void summary_time_print(FILE *file, const struct flow_report *report)
{
    fprintf(file, "  seconds in tasks, over all workers\n");
    for (size_t i = 0; i < KINDS; i++)
        if (!isnan(seconds_of(report, i)))
            fprintf(file, "    %-14s %12.4f\n", KIND[i].row, seconds_of(report, i));
}

/* Shares of the workers' time, of which work, messages, starved and runtime add up to 1. The
 * critical path is a share of the time of the run, 0 where it is not known. */
static void find_shares(const struct summary *summary, double share[LIMITS])
{
    const struct flow_report *report = summary->report;
    const duite_counters *counters = &report->counters;
    const double wall = report->wall_seconds * (double)summary->workers;
    const double all = fmax(wall, counters->busy + counters->idle); /* no share is above 1 */
    const double exposed = fmin(counters->exposed, counters->idle);
    share[WORK] = counters->busy / all;
    share[MESSAGES] = exposed / all;
    share[STARVED] = (counters->idle - exposed) / all;
    share[RUNTIME] = 1 - share[WORK] - share[MESSAGES] - share[STARVED];
    const duite_options *runtime = &summary->options->runtime;
    const bool whole = runtime->trace && !runtime->trace_first &&
                       runtime->trace_end == UINT64_MAX && summary->phases->n == 1;
    share[PATH] =
        whole && summary->critical_path > 0 ? summary->critical_path / report->wall_seconds : 0;
}

static enum limit find_limit(const struct summary *summary, double share[LIMITS])
{
    enum limit largest = WORK;
    if (!summary->report->steps || !(summary->report->wall_seconds > 0))
        return LIMITS;
    find_shares(summary, share);
    for (int i = 0; i < LIMITS; i++)
        if (share[i] > share[largest])
            largest = (enum limit)i;
    return largest;
}

/* The kind of task with most seconds, and its part of the seconds of all. */
static void print_kind(FILE *file, const struct flow_report *report)
{
    size_t most = 0;
    double all = 0;
    for (size_t i = 0; i < KINDS; i++) {
        all += fmax(seconds_of(report, i), 0);
        if (!(seconds_of(report, most) >= seconds_of(report, i)) && !isnan(seconds_of(report, i)))
            most = i;
    }
    if (all > 0)
        fprintf(file, ", %.0f %% of that in %s", 100 * seconds_of(report, most) / all,
                KIND[most].name);
}

/* Names repeated steps or solves if they are a quarter of all or more. */
static void print_repeats(FILE *file, const struct flow_report *report)
{
    const double given_up = (double)(report->steps_halved + report->steps_retaken);
    const double begun = (double)report->steps + given_up;
    const double contact = (double)report->contact_solves;
    const double again = given_up / begun, solved_again = contact / (begun + contact);
    if (fmax(again, solved_again) < 0.25)
        return;
    if (again > solved_again)
        fprintf(file, "; %.0f %% of the steps were given up and made again", 100 * again);
    else
        fprintf(file, "; %.0f %% of the solves were made again for contact", 100 * solved_again);
}

/* Why there may have been too few tasks. */
static void print_tasks(FILE *file, const struct summary *summary)
{
    const uint64_t blocks = summary->report->blocks;
    if (summary->threads > summary->cores)
        fprintf(file, ", with %u workers on %u core%s", summary->threads, summary->cores,
                summary->cores == 1 ? "" : "s");
    else
        fprintf(file, ", with %" PRIu64 " block%s for %" PRIu64 " worker%s", blocks,
                blocks == 1 ? "" : "s", summary->workers, summary->workers == 1 ? "" : "s");
}

static void print_fact(FILE *file, enum limit limit, const struct summary *summary, double percent)
{
    switch (limit) {
    case WORK:
        fprintf(file, "the workers were busy for %.0f %% of the time", percent);
        print_kind(file, summary->report);
        return;
    case PATH:
        fprintf(file, "tasks that wait for one another took %.0f %% of the time", percent);
        return;
    case MESSAGES:
        fprintf(file, "the workers had no task and awaited messages for %.0f %% of the time",
                percent);
        return;
    case STARVED:
        fprintf(file, "the workers had no task for %.0f %% of the time", percent);
        print_tasks(file, summary);
        return;
    default:
        fprintf(file,
                "the workers were between tasks for %.0f %% of the time, with %" PRIu64 " tasks",
                percent, summary->report->counters.tasks);
    }
}

void summary_limit_print(FILE *file, const struct summary *summary)
{
    double share[LIMITS];
    const enum limit limit = find_limit(summary, share);
    if (limit == LIMITS)
        return;
    fprintf(file, "Limited by %s%s: ", LIMIT[limit].article, LIMIT[limit].name);
    print_fact(file, limit, summary, 100 * share[limit]);
    print_repeats(file, summary->report);
    fputs(".\n", file);
}

const char *summary_limit(const struct summary *summary)
{
    double share[LIMITS];
    const enum limit limit = find_limit(summary, share);
    return limit < LIMITS ? LIMIT[limit].name : NULL;
}
