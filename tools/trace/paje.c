/* Paje (Schnorr, de Oliveira Stein & Chassin de Kergommeaux, 2013), which ViTE opens. Ranks hold
 * workers, whose states are pushed and popped; steals, sends and receives are events, messages are
 * links. */
#include "tools/trace/export.h"

#include "runtime/base/memory.h"

#include <inttypes.h>
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

static void paje_put_moment(FILE *file, const struct trace_moment *moment)
{
    const bool begins = moment->what == MOMENT_BEGIN;
    switch (moment->what) {
    case MOMENT_END:
        fprintf(file, "8 %.9f S W%" PRIu32 "\n", moment->time, moment->worker);
        return;
    case MOMENT_SENT:
    case MOMENT_RECEIVED:
        fprintf(file, "%d %.9f M 0 W%" PRIu32 " message %zu\n",
                moment->what == MOMENT_SENT ? 11 : 12, moment->time, moment->worker, moment->key);
        return;
    default:
        fprintf(file, "%d %.9f %s W%" PRIu32 " ", begins ? 7 : 9, moment->time, begins ? "S" : "E",
                moment->worker);
        paje_put_name(file, moment->span->name);
        fputc('\n', file);
    }
}

int trace_write_paje_spans(FILE *file, const struct trace_spans *spans,
                           const struct trace_messages *messages, double limit)
{
    struct trace_moment *moment;
    size_t n;
    const int code = trace_moments_find(spans, messages, &moment, &n);
    if (code)
        return code;
    for (size_t i = 0; i < n; i++)
        limit = moment[i].end > limit ? moment[i].end : limit;
    fputs(HEAD, file);
    fputs("3 E W Event \"0.3 0.3 0.3\"\n", file);
    paje_put_values(file, spans->span, spans->n);
    paje_put_containers(file, spans->host_of, spans->n_workers);
    for (size_t i = 0; i < n; i++)
        paje_put_moment(file, &moment[i]);
    paje_put_ends(file, spans->host_of, spans->n_workers, limit);
    base_free(moment);
    return DUITE_OK;
}

static int paje_write(const struct trace_run *run, FILE *file)
{
    struct trace_spans spans;
    struct trace_messages messages = {0};
    int code = trace_spans_find(run, &spans);
    if (!code)
        code = trace_messages_find(run, &messages);
    if (!code)
        code = trace_write_paje_spans(file, &spans, &messages, 0);
    base_free(messages.message);
    trace_spans_free(&spans);
    return code;
}

const struct trace_export trace_export_paje = {
    .option = "paje",
    .help = "write a Paje trace, which ViTE opens",
    .write = paje_write,
};
