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
    float median;
};

struct predict_times {
    struct trace_bodies *bodies;
    struct times_mean *mean;        /* by kernel, then by kind of the runtime's own tasks */
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

/* The mean that an event counts in; NULL: it is no task, or one within another. */
static struct times_mean *times_mean_of(const struct predict_times *times,
                                        const struct trace_event *event)
{
    if (event->kind == TRACE_OWN && event->kernel < OWN_KINDS)
        return &times->mean[times->n_kernels + event->kernel];
    if (event->kind == TRACE_TASK && !(event->flags & TRACE_NESTED))
        return &times->mean[event->kernel];
    return NULL;
}

static void times_event(const struct predict_times *times, const struct trace_event *event,
                        double tick)
{
    struct times_mean *mean = times_mean_of(times, event);
    if (mean)
        mean_add(mean, tick * (double)(event->took - event->within));
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

/* The value that stands at k when n values are sorted; reorders them (Hoare's selection). */
static float times_select(float *value, size_t n, size_t k)
{
    ptrdiff_t low = 0, high = (ptrdiff_t)n - 1;
    while (low < high) {
        const float pivot = value[k];
        ptrdiff_t i = low, j = high;
        while (i <= j) {
            while (value[i] < pivot)
                i++;
            while (pivot < value[j])
                j--;
            if (i > j)
                break;
            const float other = value[i];
            value[i++] = value[j];
            value[j--] = other;
        }
        low = j < (ptrdiff_t)k ? i : low;
        high = (ptrdiff_t)k < i ? j : high;
    }
    return value[k];
}

/* Adds the bodies of a run to the lists of their kernels. end: of each list as it grows. */
static void times_list_bodies(const struct predict_times *times, const struct trace_run *run,
                              float **end)
{
    for (uint32_t r = 0; r < run->n_ranks; r++)
        for (size_t p = 0; p < run->rank[r].n_pieces; p++)
            for (size_t i = 0; i < run->rank[r].piece[p].n; i++) {
                const struct trace_event *event = &run->rank[r].piece[p].event[i];
                const struct times_mean *mean = times_mean_of(times, event);
                double seconds = run->rank[r].header->tick * (double)(event->took - event->within);
                if (mean && event->kind == TRACE_TASK)
                    trace_bodies_find(times->bodies, event->number, &seconds);
                if (mean)
                    *end[mean - times->mean]++ = (float)seconds;
            }
}

/* False without memory. */
static bool times_medians(struct predict_times *times, const struct trace_run *run)
{
    const size_t n_means = times->n_kernels + OWN_KINDS;
    size_t n = 0;
    for (size_t k = 0; k < n_means; k++)
        n += times->mean[k].n;
    float *body = base_alloc((n + 1) * sizeof *body), **end = base_alloc(n_means * sizeof *end);
    const bool fine = body && end;
    if (fine) {
        end[0] = body;
        for (size_t k = 1; k < n_means; k++)
            end[k] = end[k - 1] + times->mean[k - 1].n;
        times_list_bodies(times, run, end);
    }
    for (size_t k = 0; fine && k < n_means; k++) {
        struct times_mean *mean = &times->mean[k];
        if (!mean->n)
            continue;
        float *first = end[k] - mean->n;
        mean->median = times_select(first, mean->n, mean->n / 2);
        for (size_t i = 0; i < mean->n && k < times->n_kernels; i++)
            times->all_bodies += (double)first[i];
        if (k < times->n_kernels)
            times->all_medians += (double)mean->n * (double)mean->median;
    }
    base_free(body);
    base_free(end);
    return fine;
}

/* ---- All of it ---- */

struct predict_times *predict_times_new(const struct trace_run *run, bool steady)
{
    struct predict_times *times = base_alloc_zero(sizeof *times);
    if (!times || !(times->bodies = trace_bodies_new(run)) ||
        !(times->mean = base_alloc_zero((run->n_kernels + OWN_KINDS) * sizeof *times->mean)) ||
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
    base_free(times->mean);
    base_free(times->gap);
    base_free(times);
}

bool predict_times_find(const struct predict_times *times, uint64_t number, double *seconds)
{
    return trace_bodies_find(times->bodies, number, seconds);
}

static double times_value(const struct predict_times *times, size_t k)
{
    return times->steady ? (double)times->mean[k].median : mean_value(&times->mean[k]);
}

double predict_times_kernel(const struct predict_times *times, uint32_t kernel)
{
    return times_value(times, kernel);
}

double predict_times_own(const struct predict_times *times, uint32_t kind)
{
    return kind < OWN_KINDS ? times_value(times, times->n_kernels + kind) : 0;
}

double predict_times_sums(const struct predict_times *times)
{
    static const uint32_t kinds[] = {TASK_COMBINE, TASK_PIECES, TASK_NODE_SUM, TASK_NODE_PARTIAL};
    double seconds = 0;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        seconds +=
            predict_times_own(times, kinds[i]) * (double)times->mean[times->n_kernels + kinds[i]].n;
    return seconds;
}

void predict_times_spread(const struct predict_times *times, double *bodies, double *medians)
{
    *bodies = times->all_bodies;
    *medians = times->all_medians;
}

double predict_times_gap(const struct predict_times *times)
{
    return times->n_gaps ? times_select(times->gap, times->n_gaps, times->n_gaps / 2) : 0;
}
