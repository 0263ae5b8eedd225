/* Each event is shared out once: to the columns that it covers, less the events within it. A piece
 * of a worker has its events in the order of their ends, so reading it backwards meets a task
 * before the events inside of it. */
#include "tools/chart/model.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <math.h>
#include <stdlib.h>

int chart_shares_make(struct chart_shares *shares, double from, double to, uint32_t n_rows,
                      uint32_t n_columns, uint32_t n_slots)
{
    const size_t n = (size_t)n_rows * n_columns * n_slots;
    *shares = (struct chart_shares){.from = from,
                                    .column = (to - from) / n_columns,
                                    .n_rows = n_rows,
                                    .n_columns = n_columns,
                                    .n_slots = n_slots,
                                    .seconds = base_alloc_zero(n * sizeof(double))};
    return shares->seconds ? DUITE_OK : base_no_memory("the columns of a chart");
}

void chart_shares_add(struct chart_shares *shares, uint32_t row, uint32_t slot, double begin,
                      double end, double weight)
{
    const double last = shares->n_columns - 1;
    const double from = (begin - shares->from) / shares->column;
    const double to = (end - shares->from) / shares->column;
    if (slot == CHART_NONE || !(to > from) || !(from < shares->n_columns) || !(to > 0))
        return;
    const uint32_t end_column = (uint32_t)fmin(to, last);
    for (uint32_t c = (uint32_t)fmax(from, 0); c <= end_column; c++) {
        const double covered = fmin(to, c + 1.0) - fmax(from, c);
        if (covered > 0)
            shares->seconds[((size_t)row * shares->n_columns + c) * shares->n_slots + slot] +=
                weight * covered * shares->column;
    }
}

/* A task around the event that is read next. */
struct around {
    double begin, end;
    uint32_t slot;
};

/* Those of a worker, the outermost first. */
struct nest {
    struct around *task;
    size_t n, capacity;
};

struct filling {
    struct chart_shares *shares;
    const struct trace_run *run;
    const uint32_t *row_of, *slot_of;
    struct nest *nest; /* by worker of all ranks */
};

static uint32_t slot_of_event(const struct filling *filling, const struct trace_event *event)
{
    const uint32_t *state = filling->slot_of + filling->run->n_kernels;
    switch (event->kind) {
    case TRACE_TASK:
        return filling->slot_of[event->kernel];
    case TRACE_OWN:
        return state[CHART_OWN];
    case TRACE_MESSAGES:
        return state[CHART_MESSAGES];
    case TRACE_FLUSH:
        return state[CHART_WRITING];
    case TRACE_IDLE:
        return state[CHART_IDLE];
    default:
        return CHART_NONE;
    }
}

/* True if trace_event.within counts the event. */
static bool event_is_within(const struct trace_event *event)
{
    return event->kind <= TRACE_IDLE || event->kind == TRACE_MESSAGES;
}

/* Takes the event's time away from the task around it. */
static void around_subtract(struct filling *filling, struct nest *nest, uint32_t row, double begin,
                            double end)
{
    while (nest->n && nest->task[nest->n - 1].begin > begin)
        nest->n--;
    if (!nest->n)
        return;
    const struct around *task = &nest->task[nest->n - 1];
    chart_shares_add(filling->shares, row, task->slot, begin, fmin(end, task->end), -1);
}

static bool event_add(struct filling *filling, uint32_t rank, uint32_t worker,
                      const struct trace_event *event)
{
    const double begin = trace_when(filling->run, rank, event->begin);
    const double end = trace_when(filling->run, rank, event->begin + event->took);
    const uint32_t row = filling->row_of[worker], slot = slot_of_event(filling, event);
    struct nest *nest = &filling->nest[worker];
    double awaiting = 0;
    if (event_is_within(event))
        around_subtract(filling, nest, row, begin, end);
    if (event->kind == TRACE_IDLE && event->took)
        awaiting = fmin((double)event->within / (double)event->took, 1);
    chart_shares_add(filling->shares, row, slot, begin, end, 1 - awaiting);
    if (awaiting > 0)
        chart_shares_add(filling->shares, row,
                         filling->slot_of[filling->run->n_kernels + CHART_AWAITING], begin, end,
                         awaiting);
    if (event->kind > TRACE_OWN || !event->within)
        return true;
    if (!BASE_GROW(nest->task, nest->capacity, nest->n + 1))
        return false;
    nest->task[nest->n++] = (struct around){begin, end, slot};
    return true;
}

int chart_shares_fill(struct chart_shares *shares, const struct trace_run *run,
                      const uint32_t *row_of, const uint32_t *slot_of)
{
    const uint32_t n_workers = trace_first_worker(run, run->n_ranks);
    struct filling filling = {shares, run, row_of, slot_of, NULL};
    filling.nest = base_alloc_zero((n_workers + 1) * sizeof *filling.nest);
    bool fine = filling.nest;
    for (uint32_t r = 0, first = 0; r < run->n_ranks && fine; r++) {
        const struct trace_rank *rank = &run->rank[r];
        for (size_t p = rank->n_pieces; p-- > 0 && fine;)
            for (size_t i = rank->piece[p].n; i-- > 0 && fine;)
                fine =
                    event_add(&filling, r, first + rank->piece[p].worker, &rank->piece[p].event[i]);
        first += rank->header->workers;
    }
    for (uint32_t w = 0; w < n_workers && filling.nest; w++)
        free(filling.nest[w].task);
    base_free(filling.nest);
    return fine ? DUITE_OK : base_no_memory("the columns of a chart");
}
