/* A folder of tables with the names and columns that phase 1 of StarVZ reads (packed by gzip):
 * spans of workers, moments, messages, and a table of the workers. Times are milliseconds. Behind
 * StarVZ's columns of spans stand those of duite. */
#include "tools/trace/export.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { NO_SPAN = -1 };
#define MS 1e3 /* of a second */

struct csv_tables {
    const struct trace_run *run;
    struct trace_spans spans;
    struct trace_messages messages;
    uint32_t *depth; /* by span: how many lie around it */
};

/* ---- Depths ---- */

/* From the last end to the first one a span lies in the innermost one there that has begun before
 * it ends. False without memory. */
static bool csv_depths(struct csv_tables *t)
{
    const struct trace_spans *spans = &t->spans;
    ptrdiff_t *innermost = base_alloc((spans->n_workers + 1) * sizeof *innermost);
    ptrdiff_t *around = base_alloc((spans->n + 1) * sizeof *around);
    t->depth = base_alloc_zero((spans->n + 1) * sizeof *t->depth);
    const bool fine = innermost && around && t->depth;
    for (uint32_t w = 0; w < spans->n_workers && fine; w++)
        innermost[w] = NO_SPAN;
    for (ptrdiff_t i = (ptrdiff_t)spans->n - 1; i >= 0 && fine; i--) {
        const struct trace_span *span = &spans->span[i];
        if (span->end < span->begin)
            continue;
        ptrdiff_t outer = innermost[span->worker];
        while (outer != NO_SPAN && spans->span[outer].begin >= span->end)
            outer = around[outer];
        around[i] = outer;
        t->depth[i] = outer == NO_SPAN ? 0 : t->depth[outer] + 1;
        innermost[span->worker] = i;
    }
    base_free(innermost);
    base_free(around);
    return fine;
}

/* ---- Rows ---- */

/* In quotes, for names are the program's. */
static void csv_put_name(FILE *file, const char *name)
{
    fputc('"', file);
    for (; *name; name++)
        fputs(*name == '"' ? "\"\"" : (const char[]){*name, 0}, file);
    fputc('"', file);
}

/* A worker in StarVZ's names: its rank, and its place there. */
static void csv_put_worker(FILE *file, const struct csv_tables *t, uint32_t worker)
{
    const uint32_t rank = t->spans.host_of[worker];
    fprintf(file, "%" PRIu32 "_CPU%" PRIu32, rank, worker - trace_first_worker(t->run, rank));
}

/* Tasks have the names of their kernels; all else is a state of StarPU's. */
static const char *csv_state(const struct trace_span *span)
{
    switch (span->event->kind) {
    case TRACE_TASK:
        return span->name;
    case TRACE_IDLE:
        return "Idle";
    case TRACE_MESSAGES:
        return "Progressing";
    default:
        return "Overhead";
    }
}

static void csv_put_state(const struct csv_tables *t, size_t i, FILE *file)
{
    const struct trace_span *span = &t->spans.span[i];
    const struct trace_event *event = span->event;
    const bool task = event->kind == TRACE_TASK;
    const bool counts = task || event->kind == TRACE_OWN;
    const uint32_t rank = t->spans.host_of[span->worker];
    fputs("State,", file);
    csv_put_worker(file, t, span->worker);
    fprintf(file, ",Worker State,%.6f,%.6f,%.6f,%" PRIu32 ",", MS * span->begin, MS * span->end,
            MS * trace_lasts(t->run, rank, event->took), t->depth[i]);
    csv_put_name(file, csv_state(span));
    fputs(",,,,,", file);
    if (task)
        fprintf(file, "%" PRIu32 "_%" PRIu64 ",%" PRIu64, rank, event->number, event->number);
    else
        fputc(',', file);
    fprintf(file, ",,,,,,,%s,", trace_kind_name(event->kind));
    csv_put_name(file, span->name);
    fprintf(file, ",%.6f,%" PRIu64 ",%d,%d,%d\n", MS * trace_lasts(t->run, rank, event->within),
            event->number, counts && event->flags & TRACE_NESTED,
            counts && event->flags & TRACE_OFFLOADED ? 1 : 0,
            counts && event->flags & TRACE_CHAINED ? 1 : 0);
}

static void csv_put_states(const struct csv_tables *t, FILE *file)
{
    fputs("Nature,ResourceId,Type,Start,End,Duration,Depth,Value,Size,Params,Footprint,Tag,JobId,"
          "SubmitOrder,GFlop,X,Y,Iteration,Subiteration,NumaNodes,Kind,Name,Within,Number,Nested,"
          "Offloaded,Chained\n",
          file);
    for (size_t i = 0; i < t->spans.n; i++)
        if (t->spans.span[i].end >= t->spans.span[i].begin)
            csv_put_state(t, i, file);
}

/* Info: the other rank, or the other worker of a steal. */
static void csv_put_events(const struct csv_tables *t, FILE *file)
{
    fputs("Nature,Container,Type,Start,Value,Handle,Info,Size,Tid,Src\n", file);
    for (size_t i = 0; i < t->spans.n; i++) {
        const struct trace_span *span = &t->spans.span[i];
        const struct trace_event *event = span->event;
        const bool message = event->kind == TRACE_SEND || event->kind == TRACE_RECEIVE;
        if (span->end >= span->begin)
            continue;
        fputs("Event,", file);
        csv_put_worker(file, t, span->worker);
        fprintf(file, ",%s,%.6f,%" PRIu64 ",,", span->name, MS * span->begin, event->number);
        if (event->kind != TRACE_STEP)
            fprintf(file, "%" PRIu32, event->kernel);
        fputc(',', file);
        if (message)
            fprintf(file, "%" PRIu64, event->number);
        fputs(",,\n", file);
    }
}

static void csv_put_links(const struct csv_tables *t, FILE *file)
{
    fputs("Nature,Container,Type,Start,End,Duration,Size,Origin,Dest,Key,Tag,MPIType,Priority,"
          "Handle\n",
          file);
    for (size_t i = 0; i < t->messages.n; i++) {
        const struct trace_message *m = &t->messages.message[i];
        fprintf(file, "Link,root,MPI communication,%.6f,%.6f,%.6f,%" PRIu64 ",", MS * m->sent,
                MS * m->received, MS * (m->received - m->sent), m->bytes);
        csv_put_worker(file, t, m->from);
        fputc(',', file);
        csv_put_worker(file, t, m->to);
        fprintf(file, ",mpicom_%zu,,,,\n", i);
    }
}

/* Ranks in the run, workers in ranks. */
static void csv_put_entities(const struct csv_tables *t, FILE *file)
{
    fputs("Parent,Name,Type,Nature\n0,0,0,Container\n0,root,MPI Program,Container\n", file);
    for (uint32_t w = 0; w < t->spans.n_workers; w++) {
        const uint32_t rank = t->spans.host_of[w];
        if (!w || t->spans.host_of[w - 1] != rank)
            fprintf(file, "root,%" PRIu32 "_program,Program,Container\n", rank);
        fprintf(file, "%" PRIu32 "_program,", rank);
        csv_put_worker(file, t, w);
        fputs(",Worker,Container\n", file);
        csv_put_worker(file, t, w);
        fputs(",Worker State,Worker State,State\n", file);
    }
}

/* ---- Files ---- */

static const struct {
    const char *name;
    void (*put)(const struct csv_tables *t, FILE *file);
} FILES[] = {{"paje.worker_state.csv", csv_put_states},
             {"paje.events.csv", csv_put_events},
             {"paje.link.csv", csv_put_links},
             {"entities.csv", csv_put_entities}};

static int csv_failed(const char *path)
{
    return base_error(DUITE_E_SYSTEM, "%s cannot be written: %s", path, strerror(errno));
}

static int csv_write_file(const struct csv_tables *t, const char *folder, size_t i)
{
    char *path;
    if (asprintf(&path, "%s/%s", folder, FILES[i].name) < 0)
        return base_no_memory("a table");
    FILE *file = fopen(path, "w");
    int code = file ? DUITE_OK : csv_failed(path);
    if (file) {
        FILES[i].put(t, file);
        const bool fine = !fflush(file) && !ferror(file);
        if ((fclose(file) || !fine) && !code)
            code = csv_failed(path);
    }
    free(path);
    return code;
}

static int csv_write(const struct trace_run *run, const char *folder)
{
    struct csv_tables t = {.run = run};
    int code = trace_spans_find(run, &t.spans);
    if (!code)
        code = trace_messages_find(run, &t.messages);
    if (!code && !csv_depths(&t))
        code = base_no_memory("the tables of a trace");
    if (!code && mkdir(folder, 0777) && errno != EEXIST)
        code = csv_failed(folder);
    for (size_t i = 0; i < sizeof FILES / sizeof FILES[0] && !code; i++)
        code = csv_write_file(&t, folder, i);
    base_free(t.depth);
    base_free(t.messages.message);
    trace_spans_free(&t.spans);
    return code;
}

const struct trace_export trace_export_csv = {
    .option = "csv",
    .help = "write tables of spans, events and messages with the names of StarVZ",
    .write_folder = csv_write,
};
