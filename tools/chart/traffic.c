/* Lines between the rows of a chart: the critical path from task to task, messages from rank to
 * rank. */
#include "tools/chart/model.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "tools/predict/predict.h"

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
    struct predict_bounds found;
    int code = predict_bounds(run, &found);
    *path = (struct chart_path){.known = !code, .seconds = found.path};
    if (code) {
        predict_bounds_free(&found);
        return code == DUITE_E_ARGUMENT ? DUITE_OK : code;
    }
    path->step = base_alloc((found.n + 1) * sizeof *path->step);
    if (path->step) {
        for (size_t i = 0; i < found.n; i++)
            path->step[i] = (struct chart_step){.begin = 0, .end = -1};
        trace_each(run, path_look, &(struct finding){run, found.number, found.n, path->step});
        for (size_t i = 0; i < found.n; i++)
            if (path->step[i].end >= path->step[i].begin)
                path->step[path->n++] = path->step[i];
    }
    predict_bounds_free(&found);
    return path->step ? DUITE_OK : base_no_memory("the critical path of a chart");
}

/* ---- Messages ---- */

struct sends {
    double from, to, column;
    uint32_t n_columns;
    struct chart_traffic *traffic;
};

static void sends_count(void *context, const struct trace_seen *seen)
{
    const struct sends *sends = context;
    if (seen->event->kind != TRACE_SEND || !(seen->begin >= sends->from && seen->begin < sends->to))
        return;
    const uint32_t column = (uint32_t)((seen->begin - sends->from) / sends->column);
    sends->traffic->n++;
    sends->traffic->count[column < sends->n_columns ? column : sends->n_columns - 1]++;
}

/* Keeps the messages that are on their way within the window. */
static int messages_take(const struct trace_run *run, double from, double to,
                         struct trace_messages *messages)
{
    int code = trace_messages_find(run, messages);
    const size_t n = messages->n;
    messages->n = 0;
    for (size_t i = 0; i < n; i++)
        if (messages->message[i].sent < to && messages->message[i].received > from)
            messages->message[messages->n++] = messages->message[i];
    return code;
}

int chart_traffic_find(const struct trace_run *run, double from, double to, uint32_t n_columns,
                       size_t max, struct chart_traffic *traffic)
{
    struct sends sends = {.from = from,
                          .to = to,
                          .column = (to - from) / n_columns,
                          .n_columns = n_columns,
                          .traffic = traffic};
    *traffic = (struct chart_traffic){.count = base_alloc_zero(n_columns * sizeof(uint32_t))};
    if (!traffic->count)
        return base_no_memory("the messages of a chart");
    trace_each(run, sends_count, &sends);
    return traffic->n <= max ? messages_take(run, from, to, &traffic->messages) : DUITE_OK;
}
