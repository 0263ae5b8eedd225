/* Seconds from the events: of each body (trace/sums.h), of a kernel's bodies in the mean or the
 * median, of the runtime's own tasks, between two tasks, and of messages. */
#include "tools/predict/graph.h"

#include "runtime/base/memory.h"
#include "runtime/task/task.h"
#include "tools/trace/sums.h"

#include <stdlib.h>

enum { OWN_KINDS = 64, MAX_GAPS = 1 << 16 };

struct times_mean {
    double seconds;
    uint64_t n;
};

struct predict_times {
    struct trace_bodies *bodies;
    struct times_mean *kernel, own[OWN_KINDS];
    float *median;                  /* by kernel, then by kind of the runtime's own tasks */
    double all_bodies, all_medians; /* of kernels */
    bool steady;
    uint32_t n_kernels;
    float *gap;
    size_t n_gaps;
    struct times_mean message, look; /* look.n: how many there may have been */
};

static void mean_add(struct times_mean *mean, double seconds)
{
    mean->seconds += seconds;
    mean->n++;
}

static double mean_value(const struct times_mean *mean)
{
    return mean->n ? mean->seconds / (double)mean->n : 0;
}

static void times_event(struct predict_times *times, const struct trace_event *event, double tick)
{
    double seconds = tick * (double)(event->took - event->within);
    if (event->kind == TRACE_OWN && event->kernel < OWN_KINDS)
        mean_add(&times->own[event->kernel], seconds);
    if (event->kind == TRACE_TASK && !(event->flags & TRACE_NESTED))
        mean_add(&times->kernel[event->kernel], seconds);
}

/* The runtime's time between two tasks of a worker, with no event between them. */
static void times_gap(struct predict_times *times, const struct trace_event *event, double tick)
{
    const struct trace_event *next = event + 1;
    uint64_t end = event->begin + event->took;
    if (event->kind > TRACE_OWN || next->kind > TRACE_OWN || next->within || next->begin < end ||
        times->n_gaps == MAX_GAPS)
        return;
    times->gap[times->n_gaps++] = (float)(tick * (double)(next->begin - end));
}

/* ---- Messages ---- */

/* Messages that were sent or taken while the event lasted: their marks lie before it. */
static uint64_t times_marks(const struct trace_event *first, const struct trace_event *event)
{
    uint64_t n = 0;
    for (const struct trace_event *e = event; e-- > first && e->begin >= event->begin;)
        n += e->kind == TRACE_SEND || e->kind == TRACE_RECEIVE;
    return n;
}

/* Takes one worker's messages. Work for messages while the worker was idle delays no task, and is
 * no event of its own. Looks shorter than such events are in the gaps. */
static void times_messages(struct predict_times *times, const struct trace_piece *piece,
                           double tick)
{
    const uint64_t apart = (uint64_t)(PREDICT_LOOKS / tick);
    uint64_t looked = 0;
    for (const struct trace_event *e = piece->event; e < piece->event + piece->n; e++) {
        if (e->kind <= TRACE_OWN && e->begin - looked >= apart) {
            looked = e->begin;
            times->look.n++;
        }
        if (e->kind != TRACE_MESSAGES)
            continue;
        const uint64_t n = times_marks(piece->event, e);
        (n ? &times->message : &times->look)->seconds += tick * (double)e->took;
        times->message.n += n;
    }
}

bool predict_times_messages(const struct predict_times *times, double *message, double *look)
{
    *message = mean_value(&times->message);
    *look = mean_value(&times->look);
    return times->message.n;
}

/* ---- Medians ---- */

static int times_compare_seconds(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

struct times_body {
    uint32_t kernel;
    float seconds;
};

static int times_compare_bodies(const void *a, const void *b)
{
    const struct times_body *x = a, *y = b;
    if (x->kernel != y->kernel)
        return x->kernel < y->kernel ? -1 : 1;
    return (x->seconds > y->seconds) - (x->seconds < y->seconds);
}

/* The body of an event, of the runtime's own tasks, too; false: it has none. */
static bool times_body_of(const struct predict_times *times, const struct trace_event *event,
                          double tick, struct times_body *body)
{
    double seconds = tick * (double)(event->took - event->within);
    const bool own = event->kind == TRACE_OWN && event->kernel < OWN_KINDS;
    if (!own && (event->kind != TRACE_TASK || event->flags & TRACE_NESTED))
        return false;
    if (!own)
        predict_times_find(times, event->number, &seconds);
    *body = (struct times_body){event->kernel + (own ? times->n_kernels : 0), (float)seconds};
    return true;
}

static size_t times_bodies(const struct predict_times *times, const struct trace_run *run,
                           struct times_body *body)
{
    size_t n = 0;
    for (uint32_t r = 0; r < run->n_ranks; r++)
        for (size_t p = 0; p < run->rank[r].n_pieces; p++)
            for (size_t i = 0; i < run->rank[r].piece[p].n; i++)
                n += times_body_of(times, &run->rank[r].piece[p].event[i],
                                   run->rank[r].header->tick, &body[n]);
    return n;
}

/* False without memory. */
static bool times_medians(struct predict_times *times, const struct trace_run *run)
{
    size_t n = 1;
    for (uint32_t r = 0; r < run->n_ranks; r++)
        n += run->rank[r].n_events;
    struct times_body *body = base_alloc(n * sizeof *body);
    times->median = base_alloc_zero((run->n_kernels + OWN_KINDS) * sizeof *times->median);
    if (body && times->median) {
        n = times_bodies(times, run, body);
        if (n)
            qsort(body, n, sizeof *body, times_compare_bodies);
    }
    for (size_t first = 0, end; body && times->median && first < n; first = end) {
        for (end = first; end < n && body[end].kernel == body[first].kernel;)
            end++;
        const float median = body[first + (end - first) / 2].seconds;
        times->median[body[first].kernel] = median;
        for (size_t i = first; i < end && body[i].kernel < times->n_kernels; i++) {
            times->all_bodies += (double)body[i].seconds;
            times->all_medians += (double)median;
        }
    }
    const bool fine = body && times->median;
    base_free(body);
    return fine;
}

/* ---- All of it ---- */

struct predict_times *predict_times_new(const struct trace_run *run, bool steady)
{
    struct predict_times *times = base_alloc_zero(sizeof *times);
    if (!times || !(times->bodies = trace_bodies_new(run)) ||
        !(times->kernel = base_alloc_zero((run->n_kernels + 1) * sizeof *times->kernel)) ||
        !(times->gap = base_alloc(MAX_GAPS * sizeof *times->gap))) {
        predict_times_free(times);
        return NULL;
    }
    times->n_kernels = run->n_kernels;
    times->steady = steady;
    for (uint32_t r = 0; r < run->n_ranks; r++)
        for (size_t p = 0; p < run->rank[r].n_pieces; p++) {
            const struct trace_piece *piece = &run->rank[r].piece[p];
            for (size_t i = 0; i < piece->n; i++) {
                times_event(times, &piece->event[i], run->rank[r].header->tick);
                if (i + 1 < piece->n)
                    times_gap(times, &piece->event[i], run->rank[r].header->tick);
            }
            times_messages(times, piece, run->rank[r].header->tick);
        }
    qsort(times->gap, times->n_gaps, sizeof *times->gap, times_compare_seconds);
    if (!times_medians(times, run)) {
        predict_times_free(times);
        return NULL;
    }
    return times;
}

void predict_times_free(struct predict_times *times)
{
    if (!times)
        return;
    trace_bodies_free(times->bodies);
    base_free(times->kernel);
    base_free(times->gap);
    base_free(times->median);
    base_free(times);
}

bool predict_times_find(const struct predict_times *times, uint64_t number, double *seconds)
{
    return trace_bodies_find(times->bodies, number, seconds);
}

double predict_times_kernel(const struct predict_times *times, uint32_t kernel)
{
    if (times->steady)
        return times->median[kernel];
    return mean_value(&times->kernel[kernel]);
}

double predict_times_own(const struct predict_times *times, uint32_t kind)
{
    if (kind >= OWN_KINDS)
        return 0;
    return times->steady ? (double)times->median[times->n_kernels + kind]
                         : mean_value(&times->own[kind]);
}

double predict_times_sums(const struct predict_times *times)
{
    static const uint32_t kinds[] = {TASK_COMBINE, TASK_PIECES, TASK_NODE_SUM, TASK_NODE_PARTIAL};
    double seconds = 0;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        seconds += predict_times_own(times, kinds[i]) * (double)times->own[kinds[i]].n;
    return seconds;
}

void predict_times_spread(const struct predict_times *times, double *bodies, double *medians)
{
    *bodies = times->all_bodies;
    *medians = times->all_medians;
}

double predict_times_gap(const struct predict_times *times)
{
    return times->n_gaps ? times->gap[times->n_gaps / 2] : 0;
}
