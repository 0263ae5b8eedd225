/* A task of the main program has the seconds of its own body and of all its descendants: to other
 * tasks its subtree is one task. A replicated task has the mean over the ranks that ran it. */
#include "runtime/trace/bodies.h"

#include "runtime/base/memory.h"

struct body {
    uint64_t number; /* 0: free */
    double seconds; /* float would lose what is added to many */
    uint32_t n;     /* bodies, nested ones left out */
};

/* An open table. Task numbers lie close together and are asked for in their order: so do their
 * places. */
struct trace_bodies {
    struct body *body;
    size_t mask;
};

static struct body *body_at(const struct trace_bodies *bodies, uint64_t number)
{
    size_t at = (size_t)number & bodies->mask;
    while (bodies->body[at].number && bodies->body[at].number != number)
        at = (at + 1) & bodies->mask;
    return &bodies->body[at];
}

static void body_add(struct trace_bodies *bodies, const struct trace_event *event, double tick)
{
    if (event->kind != TRACE_TASK)
        return;
    struct body *body = body_at(bodies, event->number);
    body->number = event->number;
    body->seconds += tick * (double)(event->took - event->within);
    body->n += !(event->flags & TRACE_NESTED);
}

struct trace_bodies *trace_bodies_new(const struct trace_run *run)
{
    size_t n = 16, room = 1;
    for (uint32_t r = 0; r < run->n_ranks; r++)
        n += run->rank[r].n_events;
    while (room < 2 * n)
        room *= 2;
    struct trace_bodies *bodies = base_alloc_zero(sizeof *bodies);
    if (!bodies || !(bodies->body = base_alloc_zero(room * sizeof *bodies->body))) {
        base_free(bodies);
        return NULL;
    }
    bodies->mask = room - 1;
    for (uint32_t r = 0; r < run->n_ranks; r++)
        for (size_t p = 0; p < run->rank[r].n_pieces; p++)
            for (size_t i = 0; i < run->rank[r].piece[p].n; i++)
                body_add(bodies, &run->rank[r].piece[p].event[i], run->rank[r].header->tick);
    return bodies;
}

void trace_bodies_free(struct trace_bodies *bodies)
{
    if (bodies)
        base_free(bodies->body);
    base_free(bodies);
}

bool trace_bodies_find(const struct trace_bodies *bodies, uint64_t number, double *seconds)
{
    const struct body *body = body_at(bodies, number);
    *seconds = body->n > 1 ? body->seconds / body->n : body->seconds;
    return body->number != 0;
}
