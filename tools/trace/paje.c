/* Paje (Schnorr, de Oliveira Stein & Chassin de Kergommeaux, 2013), which ViTE opens. Ranks hold
 * workers, whose states are pushed and popped; steals, sends and receives are events, messages are
 * links.
 *
 * Paje wants its lines in the order of time, so a span becomes two moments. At one time ends come
 * first, the inner ones before the outer; spans without a duration are left out. */
#include "tools/trace/export.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const char *const HEAD =
    "%EventDef PajeDefineContainerType 1\n%  Alias string\n%  Type string\n%  Name string\n"
    "%EndEventDef\n"
    "%EventDef PajeDefineStateType 2\n%  Alias string\n%  Type string\n%  Name string\n"
    "%EndEventDef\n"
    "%EventDef PajeDefineEventType 3\n%  Alias string\n%  Type string\n%  Name string\n"
    "%  Color color\n%EndEventDef\n"
    "%EventDef PajeDefineEntityValue 4\n%  Alias string\n%  Type string\n%  Name string\n"
    "%  Color color\n%EndEventDef\n"
    "%EventDef PajeCreateContainer 5\n%  Time date\n%  Alias string\n%  Type string\n"
    "%  Container string\n%  Name string\n%EndEventDef\n"
    "%EventDef PajeDestroyContainer 6\n%  Time date\n%  Type string\n%  Name string\n"
    "%EndEventDef\n"
    "%EventDef PajePushState 7\n%  Time date\n%  Type string\n%  Container string\n"
    "%  Value string\n%EndEventDef\n"
    "%EventDef PajePopState 8\n%  Time date\n%  Type string\n%  Container string\n%EndEventDef\n"
    "%EventDef PajeNewEvent 9\n%  Time date\n%  Type string\n%  Container string\n"
    "%  Value string\n%EndEventDef\n"
    "%EventDef PajeDefineLinkType 10\n%  Alias string\n%  Type string\n"
    "%  StartContainerType string\n%  EndContainerType string\n%  Name string\n%EndEventDef\n"
    "%EventDef PajeStartLink 11\n%  Time date\n%  Type string\n%  Container string\n"
    "%  StartContainer string\n%  Value string\n%  Key string\n%EndEventDef\n"
    "%EventDef PajeEndLink 12\n%  Time date\n%  Type string\n%  Container string\n"
    "%  EndContainer string\n%  Value string\n%  Key string\n%EndEventDef\n"
    "1 R 0 Rank\n1 W R Worker\n2 S W State\n10 M 0 W W Message\n";

/* The beginning or the end of a span, something without a duration, or an end of a message. */
struct moment {
    double time, begin, end; /* of its span */
    const struct trace_span *span;
    enum { END, BEGIN, MARK, SENT, RECEIVED } what;
    uint32_t worker;
    size_t key; /* of a message */
};

static int paje_moment_compare(const void *a, const void *b)
{
    const struct moment *x = a, *y = b;
    if (x->time < y->time || x->time > y->time)
        return x->time < y->time ? -1 : 1;
    if (x->what != y->what)
        return (int)x->what - (int)y->what;
    if (x->what == END) /* the one that began last ends first */
        return (x->begin < y->begin) - (x->begin > y->begin);
    return (x->end < y->end) - (x->end > y->end);
}

static void paje_put_name(FILE *file, const char *name)
{
    fputc('"', file);
    for (; *name; name++)
        fputc(*name == '"' || *name == '\n' ? '\'' : *name, file);
    fputc('"', file);
}

/* Each name once; its color goes round. */
static void paje_put_values(FILE *file, const struct trace_span *span, size_t n)
{
    static const char *const colors[] = {"0.12 0.47 0.71", "0.99 0.50 0.05", "0.17 0.63 0.17",
                                         "0.84 0.15 0.16", "0.58 0.40 0.74", "0.55 0.34 0.29",
                                         "0.89 0.47 0.76", "0.74 0.74 0.13", "0.09 0.75 0.81"};
    const char *known[1 << 9]; /* names differ by their places; more than these share a color */
    size_t n_known = 0, n_colors = sizeof colors / sizeof colors[0];
    for (size_t i = 0; i < n && n_known < sizeof known / sizeof known[0]; i++) {
        size_t k = 0;
        while (k < n_known && known[k] != span[i].name)
            k++;
        if (k < n_known)
            continue;
        known[n_known++] = span[i].name;
        fputs("4 ", file);
        paje_put_name(file, span[i].name);
        fputs(" S ", file);
        paje_put_name(file, span[i].name);
        fprintf(file, " \"%s\"\n",
                strcmp(span[i].name, "idle") ? colors[n_known % n_colors] : "0.90 0.90 0.90");
    }
}

static void paje_put_containers(FILE *file, const uint32_t *host_of, uint32_t n_workers)
{
    uint32_t inner = 0;
    for (uint32_t w = 0; w < n_workers; w++) {
        bool first = !w || host_of[w] != host_of[w - 1];
        inner = first ? 0 : inner + 1;
        if (first)
            fprintf(file, "5 0 R%" PRIu32 " R 0 \"rank %" PRIu32 "\"\n", host_of[w], host_of[w]);
        fprintf(file, "5 0 W%" PRIu32 " W R%" PRIu32 " \"rank %" PRIu32 " worker %" PRIu32 "\"\n",
                w, host_of[w], host_of[w], inner);
    }
}

static void paje_put_ends(FILE *file, const uint32_t *host_of, uint32_t n_workers, double limit)
{
    for (uint32_t w = 0; w < n_workers; w++)
        fprintf(file, "6 %.9f W W%" PRIu32 "\n", limit, w);
    for (uint32_t w = 0; w < n_workers; w++)
        if (!w || host_of[w] != host_of[w - 1])
            fprintf(file, "6 %.9f R R%" PRIu32 "\n", limit, host_of[w]);
}

static void paje_put_moment(FILE *file, const struct moment *moment)
{
    const bool begins = moment->what == BEGIN;
    switch (moment->what) {
    case END:
        fprintf(file, "8 %.9f S W%" PRIu32 "\n", moment->time, moment->worker);
        return;
    case SENT:
    case RECEIVED:
        fprintf(file, "%d %.9f M 0 W%" PRIu32 " message %zu\n", moment->what == SENT ? 11 : 12,
                moment->time, moment->worker, moment->key);
        return;
    default:
        fprintf(file, "%d %.9f %s W%" PRIu32 " ", begins ? 7 : 9, moment->time, begins ? "S" : "E",
                moment->worker);
        paje_put_name(file, moment->span->name);
        fputc('\n', file);
    }
}

/* Adds at most two moments; returns how many. */
static size_t paje_take_span(struct moment *moment, const struct trace_span *s)
{
    const uint32_t worker = s->worker;
    if (s->end < s->begin) {
        moment[0] = (struct moment){s->begin, s->begin, s->begin, s, MARK, worker, 0};
        return 1;
    }
    if (!(s->end > s->begin))
        return 0;
    moment[0] = (struct moment){s->begin, s->begin, s->end, s, BEGIN, worker, 0};
    moment[1] = (struct moment){s->end, s->begin, s->end, s, END, worker, 0};
    return 2;
}

/* Adds two moments. By the clocks of two ranks the message may be received first. */
static size_t paje_take_message(struct moment *moment, const struct trace_message *message,
                                size_t key)
{
    const double sent = message->sent,
                 received = message->received > sent ? message->received : sent;
    moment[0] = (struct moment){sent, sent, sent, NULL, SENT, message->from, key};
    moment[1] = (struct moment){received, received, received, NULL, RECEIVED, message->to, key};
    return 2;
}

int trace_write_paje_spans(FILE *file, struct trace_span *span, size_t n,
                           const struct trace_messages *messages, const uint32_t *host_of,
                           uint32_t n_workers, double limit)
{
    const size_t n_messages = messages ? messages->n : 0;
    struct moment *moment = base_alloc((2 * (n + n_messages) + 1) * sizeof *moment);
    size_t m = 0;
    if (!moment)
        return base_no_memory("the moments of a trace");
    for (size_t i = 0; i < n; i++)
        m += paje_take_span(moment + m, &span[i]);
    for (size_t i = 0; i < n_messages; i++)
        m += paje_take_message(moment + m, &messages->message[i], i + 1);
    for (size_t i = 0; i < m; i++)
        limit = moment[i].end > limit ? moment[i].end : limit;
    qsort(moment, m, sizeof *moment, paje_moment_compare);
    fputs(HEAD, file);
    fputs("3 E W Event \"0.3 0.3 0.3\"\n", file);
    paje_put_values(file, span, n);
    paje_put_containers(file, host_of, n_workers);
    for (size_t i = 0; i < m; i++)
        paje_put_moment(file, &moment[i]);
    paje_put_ends(file, host_of, n_workers, limit);
    base_free(moment);
    return DUITE_OK;
}

struct spans {
    const struct trace_run *run;
    struct trace_span *span;
    size_t n;
};

static void paje_add_span(void *context, const struct trace_seen *seen)
{
    struct spans *spans = context;
    spans->span[spans->n++] =
        (struct trace_span){.begin = seen->begin,
                            .end = trace_event_lasts(seen->event) ? seen->end : seen->begin - 1,
                            .name = trace_event_name(spans->run, seen->event),
                            .worker = trace_first_worker(spans->run, seen->rank) + seen->worker};
}

static int paje_write(const struct trace_run *run, FILE *file)
{
    uint32_t n_workers = trace_first_worker(run, run->n_ranks);
    size_t n = 0;
    for (uint32_t r = 0; r < run->n_ranks; r++)
        n += run->rank[r].n_events;
    struct spans spans = {run, base_alloc((n + 1) * sizeof *spans.span), 0};
    uint32_t *host_of = base_alloc((n_workers + 1) * sizeof *host_of);
    struct trace_messages messages;
    int code = trace_messages_find(run, &messages);
    if (!spans.span || !host_of)
        code = base_no_memory("the spans of a trace");
    for (uint32_t r = 0, w = 0; r < run->n_ranks && !code; r++)
        for (uint32_t i = 0; i < run->rank[r].header->workers; i++)
            host_of[w++] = r;
    if (!code) {
        trace_each(run, paje_add_span, &spans);
        code = trace_write_paje_spans(file, spans.span, n, &messages, host_of, n_workers, 0);
    }
    base_free(messages.message);
    base_free(spans.span);
    base_free(host_of);
    return code;
}

const struct trace_export trace_export_paje = {
    .option = "paje",
    .help = "write a Paje trace, which ViTE opens",
    .write = paje_write,
};
