/* The report of a run (options.report): rank 0 opens the file before work starts, and writes it at
 * the stop. Its keys are those that duite-cloth's report has for the same things. */
#include "runtime/api/instance.h"

#include "runtime/base/clock.h"
#include "runtime/base/error.h"

#include <errno.h>
#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int report_failed(const char *path)
{
    return base_error(DUITE_E_SYSTEM, "the report %s cannot be written: %s", path, strerror(errno));
}

int api_report_open(duite *rt, const duite_options *options)
{
    struct api_report *report = &rt->report;
    if (!options->report || rt->graph.rank)
        return DUITE_OK;
    report->scheduler = options->scheduler;
    report->path = strdup(options->report);
    if (!report->path)
        return base_no_memory("the report");
    report->file = fopen(report->path, "we");
    return report->file ? DUITE_OK : report_failed(report->path);
}

/* A policy's name may be any text. */
static void report_put_name(FILE *file, const char *key, const char *name)
{
    fprintf(file, ",\n  \"%s\": \"", key);
    for (; *name; name++) {
        const unsigned char letter = (unsigned char)*name;
        if (letter == '"' || letter == '\\')
            fputc('\\', file);
        fputc(letter < ' ' ? ' ' : letter, file);
    }
    fputc('"', file);
}

static void report_put_settings(const duite *rt, FILE *file, int code)
{
    const int version = duite_version();
    fprintf(file, "{\n  \"version\": \"%d.%d.%d\",\n  \"code\": %d,\n  \"ranks\": %d",
            version / 10000, version / 100 % 100, version % 100, code, rt->graph.n_ranks);
    fprintf(file, ",\n  \"threads\": %u,\n  \"workers\": %u,\n  \"seed\": %" PRIu64,
            rt->share.workers, rt->report.workers, rt->seed);
    report_put_name(file, "scheduler", rt->report.scheduler->name);
    report_put_name(file, "mapping", rt->mapping.own->name);
    report_put_name(file, "balance", rt->balance->name);
}

static void report_put_counters(FILE *file, const duite_counters *counters, double all)
{
    static const struct {
        const char *key;
        size_t at;
    } counts[] = {{"tasks", offsetof(duite_counters, tasks)},
                  {"tasks_placed", offsetof(duite_counters, placed)},
                  {"tasks_stolen", offsetof(duite_counters, stolen)},
                  {"tasks_stolen_far", offsetof(duite_counters, stolen_far)},
                  {"tasks_chained", offsetof(duite_counters, chained)},
                  {"tasks_recognised", offsetof(duite_counters, recognised)},
                  {"rounds_recognised", offsetof(duite_counters, recognised_rounds)},
                  {"graphs_recorded", offsetof(duite_counters, graphs_recorded)},
                  {"messages", offsetof(duite_counters, messages)},
                  {"bytes_moved", offsetof(duite_counters, bytes)},
                  {"delegated_tasks", offsetof(duite_counters, delegated)},
                  {"migrated_objects", offsetof(duite_counters, migrated)}};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        uint64_t count;
        memcpy(&count, (const char *)counters + counts[i].at, sizeof count);
        fprintf(file, ",\n  \"%s\": %" PRIu64, counts[i].key, count);
    }
    fprintf(file, ",\n  \"busy_seconds\": %.9g,\n  \"idle_seconds\": %.9g", counters->busy,
            counters->idle);
    fprintf(file, ",\n  \"awaited_seconds\": %.9g,\n  \"exposed_seconds\": %.9g", counters->awaited,
            counters->exposed);
    fprintf(file, ",\n  \"busy_fraction\": %.6g,\n  \"idle_fraction\": %.6g", counters->busy / all,
            counters->idle / all);
}

int api_report_write(duite *rt, int code)
{
    struct api_report *report = &rt->report;
    const double seconds = base_seconds() - report->began;
    duite_counters counters;
    if (!report->wanted)
        return DUITE_OK;
    const bool counted = !api_is_broken(rt) && !api_count(rt, &counters);
    FILE *file = report->file;
    report->file = NULL;
    if (!file)
        return DUITE_OK;
    report_put_settings(rt, file, code);
    fprintf(file, ",\n  \"wall_seconds\": %.9g", seconds);
    if (counted)
        report_put_counters(file, &counters, seconds * report->workers);
    fputs("\n}\n", file);
    const bool whole = !ferror(file);
    return fclose(file) || !whole ? report_failed(report->path) : DUITE_OK;
}

void api_report_close(duite *rt)
{
    if (rt->report.file)
        fclose(rt->report.file);
    free(rt->report.path);
}
