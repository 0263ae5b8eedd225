/* Events in the Trace Event Format: times in microseconds, a process a rank, a thread a worker. */
#include "runtime/trace/export.h"

#include <inttypes.h>

void trace_each(const struct trace_run *run, void (*visit)(void *, const struct trace_seen *),
                void *context)
{
    for (uint32_t r = 0; r < run->n_ranks; r++)
        for (size_t p = 0; p < run->rank[r].n_pieces; p++) {
            const struct trace_piece *piece = &run->rank[r].piece[p];
            for (size_t i = 0; i < piece->n; i++)
                visit(context, &(struct trace_seen){&piece->event[i], r, piece->worker,
                                                    trace_when(run, r, piece->event[i].begin),
                                                    trace_lasts(run, r, piece->event[i].took)});
        }
}

void trace_put_json(FILE *file, const char *text)
{
    fputc('"', file);
    for (; *text; text++) {
        unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\')
            fprintf(file, "\\%c", c);
        else if (c < 0x20)
            fprintf(file, "\\u%04x", c);
        else
            fputc(c, file);
    }
    fputc('"', file);
}

struct writer {
    const struct trace_run *run;
    FILE *file;
};

static void put_args(FILE *file, const struct trace_event *event)
{
    switch (event->kind) {
    case TRACE_TASK:
    case TRACE_OWN:
        fprintf(file, "\"number\":%" PRIu64 ",\"nested\":%d", event->number,
                event->flags & TRACE_NESTED);
        break;
    case TRACE_SEND:
    case TRACE_RECEIVE:
        fprintf(file, "\"rank\":%" PRIu32 ",\"bytes\":%" PRIu64, event->kernel, event->number);
        break;
    case TRACE_STEAL:
        fprintf(file, "\"from\":%" PRIu32, event->kernel);
        break;
    case TRACE_DELEGATE:
        fprintf(file, "\"rank\":%" PRIu32 ",\"number\":%" PRIu64, event->kernel, event->number);
        break;
    default:
        fprintf(file, "\"number\":%" PRIu64, event->number);
    }
}

static bool lasts(const struct trace_event *event)
{
    return event->kind <= TRACE_IDLE || event->kind == TRACE_MIGRATE || event->kind == TRACE_FLUSH;
}

static void put(void *context, const struct trace_seen *seen)
{
    const struct writer *writer = context;
    FILE *file = writer->file;
    fputs(",\n{\"name\":", file);
    trace_put_json(file, trace_event_name(writer->run, seen->event));
    fprintf(file, ",\"cat\":\"%s\",\"pid\":%" PRIu32 ",\"tid\":%" PRIu32 ",\"ts\":%.3f",
            trace_kind_name(seen->event->kind), seen->rank, seen->worker, 1e6 * seen->begin);
    if (lasts(seen->event))
        fprintf(file, ",\"ph\":\"X\",\"dur\":%.3f", 1e6 * seen->took);
    else
        fputs(",\"ph\":\"i\",\"s\":\"t\"", file);
    fputs(",\"args\":{", file);
    put_args(file, seen->event);
    fputs("}}", file);
}

int trace_write_chrome(const struct trace_run *run, FILE *file)
{
    const char *comma = "";
    fputs("{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n", file);
    for (uint32_t r = 0; r < run->n_ranks; r++)
        for (uint32_t w = 0; w < run->rank[r].header->workers; w++) {
            fprintf(file,
                    "%s{\"name\":\"process_name\",\"ph\":\"M\",\"pid\":%" PRIu32 ",\"tid\":%" PRIu32
                    ",\"args\":{\"name\":\"rank %" PRIu32 "\"}},\n",
                    comma, r, w, r);
            fprintf(file,
                    "{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":%" PRIu32 ",\"tid\":%" PRIu32
                    ",\"args\":{\"name\":\"worker %" PRIu32 "\"}}",
                    r, w, w);
            comma = ",\n";
        }
    trace_each(run, put, &(struct writer){run, file});
    fputs("\n]}\n", file);
    return 0;
}
