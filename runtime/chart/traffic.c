/* What joins the rows of a chart: the critical path from task to task, messages from rank to
 * rank. */
#include "runtime/chart/model.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/trace/sums.h"

#include <stdlib.h>

/* ---- The critical path ---- */

struct finding {
    const struct trace_run *run;
    const uint64_t *number;
    size_t n;
    struct chart_step *step; /* by place of the number; end < begin: not seen yet */
};

static int compare_numbers(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

static void path_look(void *context, const struct trace_seen *seen)
{
    const struct finding *finding = context;
    const struct trace_event *event = seen->event;
    if (event->kind != TRACE_TASK || event->flags & TRACE_NESTED)
        return;
    const uint64_t *found = bsearch(&event->number, finding->number, finding->n,
                                    sizeof *finding->number, compare_numbers);
    if (!found)
        return;
    struct chart_step *step = &finding->step[found - finding->number];
    if (seen->end - seen->begin > step->end - step->begin)
        *step = (struct chart_step){seen->begin, seen->end,
                                    trace_first_worker(finding->run, seen->rank) + seen->worker,
                                    event->kernel};
}

int chart_path_find(const struct trace_run *run, struct chart_path *path)
{
    struct trace_path found;
    int code = trace_path_find(run, &found);
    *path = (struct chart_path){.known = !code, .seconds = found.seconds};
    if (code)
        return code == DUITE_E_ARGUMENT ? DUITE_OK : code;
    path->step = base_alloc((found.n + 1) * sizeof *path->step);
    if (path->step) {
        for (size_t i = 0; i < found.n; i++)
            path->step[i] = (struct chart_step){.begin = 0, .end = -1};
        trace_each(run, path_look, &(struct finding){run, found.number, found.n, path->step});
        for (size_t i = 0; i < found.n; i++)
            if (path->step[i].end >= path->step[i].begin)
                path->step[path->n++] = path->step[i];
    }
    base_free(found.number);
    return path->step ? DUITE_OK : base_no_memory("the critical path of a chart");
}

/* ---- Messages ---- */

struct end {
    uint64_t pair; /* from which rank to which */
    double at;
    uint32_t worker;
};

struct ends {
    const struct trace_run *run;
    double from, to, column;
    uint32_t n_columns;
    uint32_t rank, first; /* of the event before this one; its rank's first worker */
    struct chart_traffic *traffic;
    struct end *sent, *received; /* NULL: they are only counted */
    size_t n_sent, n_received;
};

static void sends_count(void *context, const struct trace_seen *seen)
{
    const struct ends *ends = context;
    if (seen->event->kind != TRACE_SEND || !(seen->begin >= ends->from && seen->begin < ends->to))
        return;
    const uint32_t column = (uint32_t)((seen->begin - ends->from) / ends->column);
    ends->traffic->n++;
    ends->traffic->count[column < ends->n_columns ? column : ends->n_columns - 1]++;
}

static void ends_count(void *context, const struct trace_seen *seen)
{
    struct ends *ends = context;
    ends->n_sent += seen->event->kind == TRACE_SEND;
    ends->n_received += seen->event->kind == TRACE_RECEIVE;
}

static void ends_take(void *context, const struct trace_seen *seen)
{
    struct ends *ends = context;
    const uint64_t rank = seen->rank, peer = seen->event->kernel, n = ends->run->n_ranks;
    if (seen->rank != ends->rank)
        ends->first = trace_first_worker(ends->run, seen->rank);
    ends->rank = seen->rank;
    const uint32_t worker = ends->first + seen->worker;
    if (seen->event->kind == TRACE_SEND)
        ends->sent[ends->n_sent++] = (struct end){rank * n + peer, seen->begin, worker};
    if (seen->event->kind == TRACE_RECEIVE)
        ends->received[ends->n_received++] = (struct end){peer * n + rank, seen->begin, worker};
}

static int compare_ends(const void *a, const void *b)
{
    const struct end *x = a, *y = b;
    if (x->pair != y->pair)
        return x->pair < y->pair ? -1 : 1;
    return (x->at > y->at) - (x->at < y->at);
}

/* Both are sorted. What is received before anything was sent came from before the trace began. */
static void ends_match(struct ends *ends)
{
    const double bound = ends->run->bound;
    size_t s = 0;
    for (size_t r = 0; r < ends->n_received && s < ends->n_sent; r++) {
        const struct end *received = &ends->received[r];
        while (s < ends->n_sent && ends->sent[s].pair < received->pair)
            s++;
        if (s == ends->n_sent || ends->sent[s].pair != received->pair ||
            ends->sent[s].at > received->at + bound)
            continue;
        const struct end *sent = &ends->sent[s++];
        if (sent->at < ends->to && received->at > ends->from)
            ends->traffic->message[ends->traffic->n_messages++] =
                (struct chart_message){sent->at, received->at, sent->worker, received->worker};
    }
}

static int messages_find(struct ends *ends)
{
    trace_each(ends->run, ends_count, ends);
    const size_t n_sent = ends->n_sent, n_received = ends->n_received;
    const size_t n = n_sent < n_received ? n_sent : n_received;
    ends->sent = base_alloc((n_sent + 1) * sizeof *ends->sent);
    ends->received = base_alloc((n_received + 1) * sizeof *ends->received);
    ends->traffic->message = base_alloc((n + 1) * sizeof *ends->traffic->message);
    const bool fine = ends->sent && ends->received && ends->traffic->message;
    if (fine) {
        ends->n_sent = ends->n_received = 0;
        ends->rank = ends->first = 0;
        trace_each(ends->run, ends_take, ends);
        qsort(ends->sent, n_sent, sizeof *ends->sent, compare_ends);
        qsort(ends->received, n_received, sizeof *ends->received, compare_ends);
        ends_match(ends);
    }
    base_free(ends->sent);
    base_free(ends->received);
    return fine ? DUITE_OK : base_no_memory("the messages of a chart");
}

int chart_traffic_find(const struct trace_run *run, double from, double to, uint32_t n_columns,
                       size_t max, struct chart_traffic *traffic)
{
    struct ends ends = {.run = run,
                        .from = from,
                        .to = to,
                        .column = (to - from) / n_columns,
                        .n_columns = n_columns,
                        .traffic = traffic};
    *traffic = (struct chart_traffic){.count = base_alloc_zero(n_columns * sizeof(uint32_t))};
    if (!traffic->count)
        return base_no_memory("the messages of a chart");
    trace_each(run, sends_count, &ends);
    return traffic->n <= max ? messages_find(&ends) : DUITE_OK;
}
