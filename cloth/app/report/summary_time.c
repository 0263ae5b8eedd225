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
static void say_kind(char *text, size_t size, const struct flow_report *report)
{
    size_t most = 0;
    double all = 0;
    for (size_t i = 0; i < KINDS; i++) {
        all += fmax(seconds_of(report, i), 0);
        if (!(seconds_of(report, most) >= seconds_of(report, i)) && !isnan(seconds_of(report, i)))
            most = i;
    }
    *text = '\0';
    if (all > 0)
        snprintf(text, size, ", %.0f %% of that in %s", 100 * seconds_of(report, most) / all,
                 KIND[most].name);
}

/* Names repeated steps or solves if they are a quarter of all or more. */
static void say_repeats(char *text, size_t size, const struct flow_report *report)
{
    const double given_up = (double)(report->steps_halved + report->steps_retaken);
    const double begun = (double)report->steps + given_up;
    const double contact = (double)report->contact_solves;
    const double again = given_up / begun, solved_again = contact / (begun + contact);
    *text = '\0';
    if (fmax(again, solved_again) < 0.25)
        return;
    if (again > solved_again)
        snprintf(text, size, "; %.0f %% of the steps were given up and made again", 100 * again);
    else
        snprintf(text, size, "; %.0f %% of the solves were made again for contact",
                 100 * solved_again);
}

/* Why there may have been too few tasks. */
static void say_tasks(char *text, size_t size, const struct summary *summary)
{
    if (summary->threads > summary->cores)
        snprintf(text, size, "%u workers on %u core%s", summary->threads, summary->cores,
                 summary->cores == 1 ? "" : "s");
    else
        snprintf(text, size, "%" PRIu64 " block%s for %" PRIu64 " worker%s",
                 summary->report->blocks, summary->report->blocks == 1 ? "" : "s", summary->workers,
                 summary->workers == 1 ? "" : "s");
}

static void say_fact(char *text, size_t size, enum limit limit, const struct summary *summary,
                     double percent)
{
    char more[100] = "";
    switch (limit) {
    case WORK:
        say_kind(more, sizeof more, summary->report);
        snprintf(text, size, "the workers were busy for %.0f %% of the time%s", percent, more);
        break;
    case PATH:
        snprintf(text, size, "tasks that wait for one another took %.0f %% of the time", percent);
        break;
    case MESSAGES:
        snprintf(text, size, "the workers had no task and awaited messages for %.0f %% of the time",
                 percent);
        break;
    case STARVED:
        say_tasks(more, sizeof more, summary);
        snprintf(text, size, "the workers had no task for %.0f %% of the time, with %s", percent,
                 more);
        break;
    default:
        snprintf(text, size,
                 "the workers were between tasks for %.0f %% of the time, with %" PRIu64 " tasks",
                 percent, summary->report->counters.tasks);
    }
}

void summary_limit_print(FILE *file, const struct summary *summary)
{
    double share[LIMITS];
    char fact[240], repeats[120];
    const enum limit limit = find_limit(summary, share);
    if (limit == LIMITS)
        return;
    say_fact(fact, sizeof fact, limit, summary, 100 * share[limit]);
    say_repeats(repeats, sizeof repeats, summary->report);
    fprintf(file, "Limited by %s%s: %s%s.\n", LIMIT[limit].article, LIMIT[limit].name, fact,
            repeats);
}

const char *summary_limit(const struct summary *summary)
{
    double share[LIMITS];
    const enum limit limit = find_limit(summary, share);
    return limit < LIMITS ? LIMIT[limit].name : NULL;
}
