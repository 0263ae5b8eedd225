/* What the events say about seconds. A task that forked others is given their time, too: to all
 * other ranks its subtree is one task. A replicated one has the mean over its ranks. */
#include "runtime/predict/graph.h"

#include "runtime/base/memory.h"

#include <stdlib.h>

enum { OWN_KINDS = 64, MOST_GAPS = 1 << 16 };

struct time {
    uint64_t number; /* 0: free */
    float seconds;
    uint32_t n; /* bodies, nested ones left out */
};

struct mean {
    double seconds;
    uint64_t n;
};

struct predict_times {
    struct time *time;
    size_t mask;
    struct mean *kernel, own[OWN_KINDS];
    float *median; /* by kernel; NULL: not asked for */
    float *gap;
    size_t n_gaps;
};

/* Numbers lie close together and are asked for in their order: so do their places. */
static struct time *place(const struct predict_times *times, uint64_t number)
{
    size_t at = (size_t)number & times->mask;
    while (times->time[at].number && times->time[at].number != number)
        at = (at + 1) & times->mask;
    return &times->time[at];
}

static void add(struct mean *mean, double seconds)
{
    mean->seconds += seconds;
    mean->n++;
}

static double get(const struct mean *mean)
{
    return mean->n ? mean->seconds / (double)mean->n : 0;
}

static void take(struct predict_times *times, const struct trace_event *event, double tick)
{
    double seconds = tick * (double)(event->took - event->within);
    if (event->kind == TRACE_OWN && event->kernel < OWN_KINDS)
        add(&times->own[event->kernel], seconds);
    if (event->kind != TRACE_TASK)
        return;
    struct time *time = place(times, event->number);
    time->number = event->number;
    time->seconds += (float)seconds;
    time->n += !(event->flags & TRACE_NESTED);
    if (!(event->flags & TRACE_NESTED))
        add(&times->kernel[event->kernel], seconds);
}

/* Between two tasks of a worker, with nothing else there: what the runtime takes. */
static void take_gap(struct predict_times *times, const struct trace_event *event, double tick)
{
    const struct trace_event *next = event + 1;
    uint64_t end = event->begin + event->took;
    if (event->kind > TRACE_OWN || next->kind > TRACE_OWN || next->within || next->begin < end ||
        times->n_gaps == MOST_GAPS)
        return;
    times->gap[times->n_gaps++] = (float)(tick * (double)(next->begin - end));
}

static int compare(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* ---- Medians ---- */

struct body {
    uint32_t kernel;
    float seconds;
};

static int compare_bodies(const void *a, const void *b)
{
    const struct body *x = a, *y = b;
    if (x->kernel != y->kernel)
        return x->kernel < y->kernel ? -1 : 1;
    return (x->seconds > y->seconds) - (x->seconds < y->seconds);
}

static size_t take_bodies(const struct predict_times *times, const struct trace_run *run,
                          struct body *body)
{
    size_t n = 0;
    double seconds;
    for (uint32_t r = 0; r < run->n_ranks; r++)
        for (size_t p = 0; p < run->rank[r].n_pieces; p++)
            for (size_t i = 0; i < run->rank[r].piece[p].n; i++) {
                const struct trace_event *event = &run->rank[r].piece[p].event[i];
                if (event->kind != TRACE_TASK || event->flags & TRACE_NESTED)
                    continue;
                predict_times_find(times, event->number, &seconds);
                body[n++] = (struct body){event->kernel, (float)seconds};
            }
    return n;
}

bool predict_times_steady(struct predict_times *times, const struct trace_run *run)
{
    size_t n = 1;
    for (uint32_t r = 0; r < run->n_ranks; r++)
        n += run->rank[r].n_events;
    struct body *body = base_alloc(n * sizeof *body);
    times->median = base_alloc_zero((run->n_kernels + 1) * sizeof *times->median);
    if (body && times->median) {
        n = take_bodies(times, run, body);
        if (n)
            qsort(body, n, sizeof *body, compare_bodies);
    }
    for (size_t first = 0, end; body && times->median && first < n; first = end) {
        for (end = first; end < n && body[end].kernel == body[first].kernel;)
            end++;
        times->median[body[first].kernel] = body[first + (end - first) / 2].seconds;
    }
    const bool fine = body && times->median;
    base_free(body);
    return fine;
}

/* ---- All of it ---- */

struct predict_times *predict_times_new(const struct trace_run *run)
{
    struct predict_times *times = base_alloc_zero(sizeof *times);
    size_t n = 16;
    for (uint32_t r = 0; r < run->n_ranks; r++)
        n += run->rank[r].n_events;
    for (times ? times->mask = 1 : 0; times && times->mask < 2 * n; times->mask *= 2)
        continue;
    if (!times || !(times->time = base_alloc_zero(times->mask * sizeof *times->time)) ||
        !(times->kernel = base_alloc_zero((run->n_kernels + 1) * sizeof *times->kernel)) ||
        !(times->gap = base_alloc(MOST_GAPS * sizeof *times->gap))) {
        predict_times_free(times);
        return NULL;
    }
    times->mask--;
    for (uint32_t r = 0; r < run->n_ranks; r++)
        for (size_t p = 0; p < run->rank[r].n_pieces; p++) {
            const struct trace_piece *piece = &run->rank[r].piece[p];
            for (size_t i = 0; i < piece->n; i++) {
                take(times, &piece->event[i], run->rank[r].header->tick);
                if (i + 1 < piece->n)
                    take_gap(times, &piece->event[i], run->rank[r].header->tick);
            }
        }
    qsort(times->gap, times->n_gaps, sizeof *times->gap, compare);
    return times;
}

void predict_times_free(struct predict_times *times)
{
    if (!times)
        return;
    base_free(times->time);
    base_free(times->kernel);
    base_free(times->gap);
    base_free(times->median);
    base_free(times);
}

bool predict_times_find(const struct predict_times *times, uint64_t number, double *seconds)
{
    const struct time *time = place(times, number);
    *seconds = time->n > 1 ? time->seconds / (float)time->n : time->seconds;
    return time->number != 0;
}

double predict_times_kernel(const struct predict_times *times, uint32_t kernel)
{
    if (times->median)
        return times->median[kernel];
    return get(&times->kernel[kernel]);
}

double predict_times_own(const struct predict_times *times, uint32_t kind)
{
    return kind < OWN_KINDS ? get(&times->own[kind]) : 0;
}

double predict_times_gap(const struct predict_times *times)
{
    return times->n_gaps ? times->gap[times->n_gaps / 2] : 0;
}
