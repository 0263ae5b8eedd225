/* The JSON of Chrome's trace viewer (the Trace Event Format), which Perfetto opens: times in
 * microseconds, a process a rank, a thread a worker. Perfetto has three rules. No process or thread
 * is 0 (its idle thread, which swallows others). No time is below 0 (such events are dropped). A
 * span that lies in or after another one in the trace does so in whole nanoseconds, too (spans that
 * overlap are dropped). Other viewers add begin and duration in doubles: spans that touch must not
 * overlap by a rounding error, as all behind it would then lie in each other. */
#include "tools/trace/export.h"

#include "runtime/base/memory.h"

#include <inttypes.h>
#include <math.h>

/* A string, in quotes. */
static void chrome_put_string(FILE *file, const char *text)
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

struct chrome_writer {
    const struct trace_run *run;
    FILE *file;
};

static void chrome_put_args(FILE *file, const struct trace_event *event)
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

static void chrome_put_time(FILE *file, const char *key, int64_t t)
{
    fprintf(file, ",\"%s\":%" PRId64 ".%03" PRId64, key, t / 1000, t % 1000);
}

/* 0.4 ns less: of no effect in whole nanoseconds, and far more than a rounding error. */
static void chrome_put_duration(FILE *file, int64_t t)
{
    const int64_t tenths = t > 0 ? 10 * t - 4 : 0;
    fprintf(file, ",\"dur\":%" PRId64 ".%04" PRId64, tenths / 10000, tenths % 10000);
}

static int64_t chrome_nanoseconds(double seconds)
{
    return seconds > 0 ? llrint(1e9 * seconds) : 0;
}

/* thread: the worker, numbered through all ranks. */
static void chrome_put_ids(FILE *file, uint32_t rank, uint32_t thread)
{
    fprintf(file, "\"pid\":%" PRIu32 ",\"tid\":%" PRIu32, rank + 1, thread + 1);
}

static void chrome_put_event(void *context, const struct trace_seen *seen)
{
    const struct chrome_writer *writer = context;
    FILE *file = writer->file;
    const int64_t begin = chrome_nanoseconds(seen->begin), end = chrome_nanoseconds(seen->end);
    fputs(",\n{\"name\":", file);
    chrome_put_string(file, trace_event_name(writer->run, seen->event));
    fprintf(file, ",\"cat\":\"%s\",", trace_kind_name(seen->event->kind));
    chrome_put_ids(file, seen->rank, trace_first_worker(writer->run, seen->rank) + seen->worker);
    chrome_put_time(file, "ts", begin);
    if (trace_event_lasts(seen->event)) {
        fputs(",\"ph\":\"X\"", file);
        chrome_put_duration(file, end - begin);
    } else {
        fputs(",\"ph\":\"i\",\"s\":\"t\"", file);
    }
    fputs(",\"args\":{", file);
    chrome_put_args(file, seen->event);
    fputs("}}", file);
}

/* The name of a process or thread, and its place among them. */
static void chrome_put_name(FILE *file, const struct trace_run *run, uint32_t rank, uint32_t worker,
                            bool process)
{
    const char *what = process ? "process" : "thread";
    fprintf(file, "%s{\"name\":\"%s_name\",\"ph\":\"M\",", rank || worker || !process ? ",\n" : "",
            what);
    chrome_put_ids(file, rank, trace_first_worker(run, rank) + worker);
    fprintf(file, ",\"args\":{\"name\":\"%s %" PRIu32 "\"}},\n", process ? "rank" : "worker",
            process ? rank : worker);
    fprintf(file, "{\"name\":\"%s_sort_index\",\"ph\":\"M\",", what);
    chrome_put_ids(file, rank, trace_first_worker(run, rank) + worker);
    fprintf(file, ",\"args\":{\"sort_index\":%" PRIu32 "}}", process ? rank : worker);
}

/* An end of an arrow between ranks. */
static void chrome_put_end(FILE *file, char phase, size_t id, uint32_t rank, uint32_t thread,
                           int64_t t)
{
    fprintf(file, ",\n{\"name\":\"message\",\"cat\":\"message\",\"id\":%zu,", id);
    chrome_put_ids(file, rank, thread);
    chrome_put_time(file, "ts", t);
    fprintf(file, ",\"ph\":\"%c\",\"bp\":\"e\"}", phase);
}

/* Perfetto joins an arrow's end to the event that began last before it on the thread, here the send
 * or the receive: so arrows come behind all events. It drops an arrow that ends before it begins,
 * as clocks of two ranks may have it. */
static void chrome_put_arrow(FILE *file, const struct trace_message *message, size_t id)
{
    const int64_t sent = chrome_nanoseconds(message->sent),
                  received = chrome_nanoseconds(message->received);
    chrome_put_end(file, 's', id, message->from_rank, message->from, sent);
    chrome_put_end(file, 'f', id, message->to_rank, message->to,
                   received > sent ? received : sent + 1);
}

static int chrome_write(const struct trace_run *run, FILE *file)
{
    struct trace_messages messages;
    int code = trace_messages_find(run, &messages);
    fputs("{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n", file);
    for (uint32_t r = 0; r < run->n_ranks; r++) {
        chrome_put_name(file, run, r, 0, true);
        for (uint32_t w = 0; w < run->rank[r].header->workers; w++)
            chrome_put_name(file, run, r, w, false);
    }
    trace_each(run, chrome_put_event, &(struct chrome_writer){run, file});
    for (size_t i = 0; i < messages.n; i++)
        chrome_put_arrow(file, &messages.message[i], i + 1);
    fputs("\n]}\n", file);
    base_free(messages.message);
    return code;
}

const struct trace_export trace_export_chrome = {
    .option = "chrome",
    .help = "write Chrome's JSON, which Perfetto opens",
    .write = chrome_write,
};
