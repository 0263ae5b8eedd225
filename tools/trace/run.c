/* Queries of a run that was read: times on one clock, names, its events one after the other. They
 * cannot fail, since trace_read has checked all of it. */
#include "tools/trace/read.h"

#include "runtime/task/task.h"

/* How far the clock is ahead of rank 0's: in a straight line between the measurements. */
static double run_clock_ahead(const struct trace_rank *rank, double at)
{
    const struct trace_clock *c = rank->clock;
    if (rank->n_clocks < 2 || !(c[1].at > c[0].at))
        return c[0].ahead;
    return c[0].ahead + (c[1].ahead - c[0].ahead) * (at - c[0].at) / (c[1].at - c[0].at);
}

double trace_lasts(const struct trace_run *run, uint32_t rank, uint64_t ticks)
{
    return run->rank[rank].header->tick * (double)ticks;
}

double trace_when(const struct trace_run *run, uint32_t rank, uint64_t ticks)
{
    const struct trace_header *header = run->rank[rank].header;
    double at = header->tick * (double)(int64_t)(ticks - header->epoch);
    return at - run_clock_ahead(&run->rank[rank], at) - run->zero;
}

bool trace_event_lasts(const struct trace_event *event)
{
    return event->kind <= TRACE_IDLE || event->kind == TRACE_MIGRATE ||
           event->kind == TRACE_FLUSH || event->kind == TRACE_MESSAGES;
}

const char *trace_kind_name(unsigned kind)
{
    static const char *const names[] = {"",        "task", "runtime", "idle",
                                        "steal",   "send", "receive", "delegate",
                                        "migrate", "step", "flush",   "messages"};
    return kind < TRACE_KINDS ? names[kind] : "";
}

const char *trace_event_name(const struct trace_run *run, const struct trace_event *event)
{
    if (event->kind == TRACE_TASK)
        return run->kernel_name[event->kernel];
    if (event->kind == TRACE_OWN)
        return task_own_name(event->kernel);
    return trace_kind_name(event->kind);
}

uint32_t trace_first_worker(const struct trace_run *run, uint32_t rank)
{
    uint32_t before = 0;
    for (uint32_t r = 0; r < rank; r++)
        before += run->rank[r].header->workers;
    return before;
}

void trace_each(const struct trace_run *run, void (*visit)(void *, const struct trace_seen *),
                void *context)
{
    for (uint32_t r = 0; r < run->n_ranks; r++)
        for (size_t p = 0; p < run->rank[r].n_pieces; p++) {
            const struct trace_piece *piece = &run->rank[r].piece[p];
            for (size_t i = 0; i < piece->n; i++) {
                const struct trace_event *event = &piece->event[i];
                visit(context, &(struct trace_seen){event, r, piece->worker,
                                                    trace_when(run, r, event->begin),
                                                    trace_when(run, r, event->begin + event->took),
                                                    trace_lasts(run, r, event->took)});
            }
        }
}
