/* A run as spans, and in the order of time as moments: forms whose states are pushed and popped, or
 * entered and left, want it so. A span becomes two moments. At one time ends come first, the inner
 * ones before the outer; spans without a duration are left out. */
#include "tools/trace/export.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <stdlib.h>

/* ---- Spans ---- */

struct spans_reader {
    const struct trace_run *run;
    struct trace_spans *spans;
};

static void spans_add(void *context, const struct trace_seen *seen)
{
    const struct spans_reader *reader = context;
    struct trace_spans *spans = reader->spans;
    spans->span[spans->n++] =
        (struct trace_span){.begin = seen->begin,
                            .end = trace_event_lasts(seen->event) ? seen->end : seen->begin - 1,
                            .name = trace_event_name(reader->run, seen->event),
                            .worker = trace_first_worker(reader->run, seen->rank) + seen->worker,
                            .event = seen->event};
}

int trace_spans_find(const struct trace_run *run, struct trace_spans *spans)
{
    size_t n = 0;
    *spans = (struct trace_spans){.n_workers = trace_first_worker(run, run->n_ranks)};
    for (uint32_t r = 0; r < run->n_ranks; r++)
        n += run->rank[r].n_events;
    spans->span = base_alloc((n + 1) * sizeof *spans->span);
    spans->host_of = base_alloc((spans->n_workers + 1) * sizeof *spans->host_of);
    if (!spans->span || !spans->host_of)
        return base_no_memory("the spans of a trace");
    for (uint32_t r = 0, w = 0; r < run->n_ranks; r++)
        for (uint32_t i = 0; i < run->rank[r].header->workers; i++)
            spans->host_of[w++] = r;
    trace_each(run, spans_add, &(struct spans_reader){run, spans});
    return DUITE_OK;
}

void trace_spans_free(struct trace_spans *spans)
{
    base_free(spans->span);
    base_free(spans->host_of);
}

/* ---- Moments ---- */

int trace_moment_compare(const void *a, const void *b)
{
    const struct trace_moment *x = a, *y = b;
    if (x->time < y->time || x->time > y->time)
        return x->time < y->time ? -1 : 1;
    if (x->what != y->what)
        return (int)x->what - (int)y->what;
    if (x->what == MOMENT_END) /* the one that began last ends first */
        return (x->begin < y->begin) - (x->begin > y->begin);
    return (x->end < y->end) - (x->end > y->end);
}

/* Adds at most two moments; returns how many. */
static size_t moments_of_span(struct trace_moment *moment, const struct trace_span *s)
{
    const uint32_t worker = s->worker;
    if (s->end < s->begin) {
        moment[0] =
            (struct trace_moment){s->begin, s->begin, s->begin, s, NULL, MOMENT_MARK, worker, 0};
        return 1;
    }
    if (!(s->end > s->begin))
        return 0;
    moment[0] = (struct trace_moment){s->begin, s->begin, s->end, s, NULL, MOMENT_BEGIN, worker, 0};
    moment[1] = (struct trace_moment){s->end, s->begin, s->end, s, NULL, MOMENT_END, worker, 0};
    return 2;
}

/* Adds two moments. By the clocks of two ranks the message may be received first. */
static size_t moments_of_message(struct trace_moment *moment, const struct trace_message *m,
                                 size_t key)
{
    const double sent = m->sent, received = m->received > sent ? m->received : sent;
    moment[0] = (struct trace_moment){sent, sent, sent, NULL, m, MOMENT_SENT, m->from, key};
    moment[1] =
        (struct trace_moment){received, received, received, NULL, m, MOMENT_RECEIVED, m->to, key};
    return 2;
}

int trace_moments_find(const struct trace_spans *spans, const struct trace_messages *messages,
                       struct trace_moment **moment, size_t *n)
{
    const size_t n_messages = messages ? messages->n : 0;
    *n = 0;
    *moment = base_alloc((2 * (spans->n + n_messages) + 1) * sizeof **moment);
    if (!*moment)
        return base_no_memory("the moments of a trace");
    for (size_t i = 0; i < spans->n; i++)
        *n += moments_of_span(*moment + *n, &spans->span[i]);
    for (size_t i = 0; i < n_messages; i++)
        *n += moments_of_message(*moment + *n, &messages->message[i], i + 1);
    qsort(*moment, *n, sizeof **moment, trace_moment_compare);
    return DUITE_OK;
}
