/* Matches messages sent with messages received. Events do not name their message, so the k-th from
 * one rank to another is taken to be the k-th that is received there. */
#include "tools/trace/read.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <stdlib.h>

struct end {
    uint64_t pair; /* from which rank to which */
    double at;
    uint64_t bytes;
    uint32_t worker;
};

struct ends {
    const struct trace_run *run;
    uint32_t rank, first; /* of the event before this one; its rank's first worker */
    struct end *sent, *received;
    size_t n_sent, n_received;
};

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
    const uint64_t bytes = seen->event->number;
    if (seen->event->kind == TRACE_SEND)
        ends->sent[ends->n_sent++] = (struct end){rank * n + peer, seen->begin, bytes, worker};
    if (seen->event->kind == TRACE_RECEIVE)
        ends->received[ends->n_received++] =
            (struct end){peer * n + rank, seen->begin, bytes, worker};
}

static int compare_ends(const void *a, const void *b)
{
    const struct end *x = a, *y = b;
    if (x->pair != y->pair)
        return x->pair < y->pair ? -1 : 1;
    return (x->at > y->at) - (x->at < y->at);
}

/* Both are sorted. A message received before any was sent comes from before the trace. */
static void ends_match(const struct ends *ends, struct trace_messages *messages)
{
    const uint32_t n = ends->run->n_ranks;
    size_t s = 0;
    for (size_t r = 0; r < ends->n_received && s < ends->n_sent; r++) {
        const struct end *received = &ends->received[r];
        while (s < ends->n_sent && ends->sent[s].pair < received->pair)
            s++;
        if (s == ends->n_sent || ends->sent[s].pair != received->pair ||
            ends->sent[s].at > received->at + ends->run->bound)
            continue;
        const struct end *sent = &ends->sent[s++];
        messages->message[messages->n++] =
            (struct trace_message){.sent = sent->at,
                                   .received = received->at,
                                   .bytes = sent->bytes,
                                   .from = sent->worker,
                                   .to = received->worker,
                                   .from_rank = (uint32_t)(sent->pair / n),
                                   .to_rank = (uint32_t)(sent->pair % n)};
    }
}

int trace_messages_find(const struct trace_run *run, struct trace_messages *messages)
{
    struct ends ends = {.run = run};
    trace_each(run, ends_count, &ends);
    const size_t n_sent = ends.n_sent, n_received = ends.n_received;
    const size_t n = n_sent < n_received ? n_sent : n_received;
    ends.sent = base_alloc((n_sent + 1) * sizeof *ends.sent);
    ends.received = base_alloc((n_received + 1) * sizeof *ends.received);
    *messages = (struct trace_messages){base_alloc((n + 1) * sizeof *messages->message), 0};
    const bool fine = ends.sent && ends.received && messages->message;
    if (fine) {
        ends.n_sent = ends.n_received = 0;
        trace_each(run, ends_take, &ends);
        qsort(ends.sent, n_sent, sizeof *ends.sent, compare_ends);
        qsort(ends.received, n_received, sizeof *ends.received, compare_ends);
        ends_match(&ends, messages);
    }
    base_free(ends.sent);
    base_free(ends.received);
    return fine ? DUITE_OK : base_no_memory("the messages of a trace");
}
