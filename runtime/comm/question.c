/* An entry of the log is written before `made` counts it and stays until all ranks agreed on it;
 * whoever is asked about a call that was agreed on need not look. */
#include "runtime/comm/question.h"

#include "runtime/base/clock.h"
#include "runtime/base/memory.h"
#include "runtime/comm/internal.h"

#include <stdio.h>
#include <string.h>

#define PATIENCE_SECONDS 0.2

bool comm_calls_start(struct comm_calls *calls, int n_ranks)
{
    calls->log = base_alloc_zero(COMM_LOGGED_CALLS * sizeof *calls->log);
    calls->pending = base_alloc_zero((size_t)n_ranks * sizeof *calls->pending);
    calls->packet = data_packet_new(sizeof(struct comm_called), true);
    calls->request = base_alloc((size_t)n_ranks * sizeof(MPI_Request));
    for (int i = 0; i < n_ranks && calls->request; i++)
        calls->request[i] = MPI_REQUEST_NULL;
    return calls->log && calls->pending && calls->packet && calls->request;
}

void comm_calls_stop(struct comm_calls *calls)
{
    base_free(calls->log);
    base_free(calls->pending);
    data_packet_free(calls->packet);
    base_free(calls->request);
}

static struct comm_called *logged(struct comm_calls *calls, uint64_t number)
{
    return &calls->log[number % COMM_LOGGED_CALLS];
}

bool comm_call(struct comm *comm, const char *name, uint64_t fingerprint)
{
    struct comm_calls *calls = &comm->calls;
    uint64_t number = atomic_load_explicit(&calls->made, memory_order_relaxed) + 1;
    struct comm_called *call = logged(calls, number);
    call->number = number;
    call->fingerprint = fingerprint;
    call->homes = comm->graph->table.homes;
    snprintf(call->name, sizeof call->name, "%s", name);
    atomic_store_explicit(&calls->made, number, memory_order_release);
    return number - atomic_load_explicit(&calls->agreed, memory_order_relaxed) == COMM_LOGGED_CALLS;
}

void comm_calls_agreed(struct comm *comm)
{
    atomic_store_explicit(&comm->calls.agreed,
                          atomic_load_explicit(&comm->calls.made, memory_order_relaxed),
                          memory_order_relaxed);
}

void comm_waits(struct comm *comm, bool waits)
{
    struct comm_calls *calls = &comm->calls;
    uint64_t number = waits ? atomic_load_explicit(&calls->made, memory_order_relaxed) : 0;
    atomic_store_explicit(&calls->waits, number, memory_order_release);
}

void comm_homes_differ(struct comm *comm, int a, int b)
{
    char sentence[300];
    snprintf(
        sentence, sizeof sentence,
        "the mapping gave objects other homes on rank %d than on rank %d: its function `map` "
        "must write the same homes on every rank, and may not look at the rank, the time or the "
        "machine",
        a, b);
    comm_broke(comm, DUITE_E_DIFFERENT, sentence);
}

/* Breaks if this rank's call of that number was another one. False: it did not come to it yet. */
static bool answer(struct comm *comm, int asker, const struct comm_called *theirs)
{
    struct comm_calls *calls = &comm->calls;
    char sentence[300];
    if (theirs->number > atomic_load_explicit(&calls->made, memory_order_acquire))
        return false;
    if (theirs->number <= atomic_load_explicit(&calls->agreed, memory_order_relaxed))
        return true;
    const struct comm_called *ours = logged(calls, theirs->number);
    if (ours->fingerprint == theirs->fingerprint && !strcmp(ours->name, theirs->name)) {
        if (ours->homes != theirs->homes)
            comm_homes_differ(comm, comm->rank, asker);
        return true;
    }
    snprintf(sentence, sizeof sentence,
             "ranks %d and %d forked different tasks, made different objects, or made different "
             "calls: the blocking call of number %llu is %s on rank %d and %s on rank %d",
             comm->rank, asker, (unsigned long long)theirs->number, ours->name, comm->rank,
             theirs->name, asker);
    comm_broke(comm, DUITE_E_DIFFERENT, sentence);
    return true;
}

void comm_question_hear(struct comm *comm, struct data_packet *packet)
{
    struct comm_called *theirs = data_payload(packet);
    int asker = (int)packet->key.slot;
    comm->calls.heard++;
    if (!answer(comm, asker, theirs))
        comm->calls.pending[asker] = *theirs; /* it waits in one call at a time */
}

bool comm_questions_sent(struct comm *comm)
{
    int sent = 1;
    if (comm->calls.questions)
        MPI_Testall(comm->n_ranks, comm->calls.request, &sent, MPI_STATUSES_IGNORE);
    return sent;
}

bool comm_questions_over(struct comm *comm)
{
    return comm->calls.heard == comm->calls.to_hear && comm_questions_sent(comm);
}

static void ask(struct comm *comm, const struct comm_called *call)
{
    struct comm_calls *calls = &comm->calls;
    struct data_packet *packet = calls->packet;
    packet->kind = DATA_QUESTION;
    packet->key.slot = (uint32_t)comm->rank;
    memcpy(data_payload(packet), call, sizeof *call);
    calls->questions++;
    for (int to = 0; to < comm->n_ranks; to++)
        if (to != comm->rank)
            comm_mpi_ok(comm,
                        MPI_Isend(packet, (int)data_packet_lines(packet->bytes), comm->line, to, 0,
                                  comm->mpi, &calls->request[to]),
                        "MPI_Isend");
}

/* Asks once about the call that the main thread waits in, when it does so for long. */
static void ask_when_due(struct comm *comm)
{
    struct comm_calls *calls = &comm->calls;
    uint64_t number = atomic_load_explicit(&calls->waits, memory_order_acquire);
    if (!number || number == calls->asked)
        return;
    double now = base_seconds();
    if (number != calls->seen) {
        calls->seen = number;
        calls->since = now;
    } else if (now - calls->since > PATIENCE_SECONDS && comm_questions_sent(comm)) {
        calls->asked = number;
        ask(comm, logged(calls, number));
    }
}

void comm_question_ask(struct comm *comm)
{
    struct comm_calls *calls = &comm->calls;
    if (comm_is_broken(comm))
        return;
    for (int rank = 0; calls->heard && rank < comm->n_ranks; rank++)
        if (calls->pending[rank].number && answer(comm, rank, &calls->pending[rank]))
            calls->pending[rank].number = 0;
    ask_when_due(comm);
}
