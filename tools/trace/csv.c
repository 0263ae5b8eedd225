/* A head line, then a line an event; columns that an event lacks are empty. */
#include "tools/trace/export.h"

#include <inttypes.h>

struct csv_writer {
    const struct trace_run *run;
    FILE *file;
};

/* In quotes, for names are the program's. */
static void csv_put_name(FILE *file, const char *name)
{
    fputc('"', file);
    for (; *name; name++)
        fputs(*name == '"' ? "\"\"" : (const char[]){*name, 0}, file);
    fputc('"', file);
}

static void csv_put_event(void *context, const struct trace_seen *seen)
{
    const struct csv_writer *writer = context;
    const struct trace_event *event = seen->event;
    FILE *file = writer->file;
    bool task = event->kind == TRACE_TASK || event->kind == TRACE_OWN;
    bool peer = event->kind >= TRACE_STEAL && event->kind <= TRACE_DELEGATE;
    fprintf(file, "%" PRIu32 ",%" PRIu32 ",%s,", seen->rank, seen->worker,
            trace_kind_name(event->kind));
    csv_put_name(file, trace_event_name(writer->run, event));
    fprintf(file, ",%.9f,%.9f,%.9f,%" PRIu64 ",", seen->begin, seen->took,
            trace_lasts(writer->run, seen->rank, event->within), event->number);
    if (peer)
        fprintf(file, "%" PRIu32, event->kernel);
    fprintf(file, ",%d,%d,%d\n", task && event->flags & TRACE_NESTED,
            task && event->flags & TRACE_OFFLOADED ? 1 : 0,
            task && event->flags & TRACE_CHAINED ? 1 : 0);
}

static int csv_write(const struct trace_run *run, FILE *file)
{
    fputs("rank,worker,kind,name,begin,seconds,within,number,peer,nested,offloaded,chained\n",
          file);
    trace_each(run, csv_put_event, &(struct csv_writer){run, file});
    return 0;
}

const struct trace_export trace_export_csv = {
    .option = "csv",
    .help = "write a line an event",
    .write = csv_write,
};
