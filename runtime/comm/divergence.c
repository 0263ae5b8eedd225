/* An entry of the log is written before `made` counts it and stays until all ranks agreed on it. A
 * rank that has not heard of the last agreement yet may see entries of the log after it: there is
 * room for the entries of two logs. */
#include "runtime/base/clock.h"
#include "runtime/base/memory.h"
#include "runtime/comm/internal.h"

#include <stdio.h>
#include <string.h>

#define PATIENCE_SECONDS 0.2

enum { SEEN_CALLS = 2 * COMM_LOGGED_CALLS };

bool comm_calls_start(struct comm_calls *calls)
{
    calls->log = base_alloc_zero(COMM_LOGGED_CALLS * sizeof *calls->log);
    calls->seen = base_alloc_zero(SEEN_CALLS * sizeof *calls->seen);
    return calls->log && calls->seen;
}

/* ---- The log ---- */

static struct comm_called *call_logged(struct comm_calls *calls, uint64_t number)
{
    return &calls->log[number % COMM_LOGGED_CALLS];
}

const struct comm_called *comm_calls_logged(struct comm_calls *calls, uint64_t number)
{
    const struct comm_called *call = call_logged(calls, number);
    const uint64_t made = atomic_load(&calls->made);
    return number && number <= made && call->number == number ? call : NULL;
}

bool comm_call(struct comm *comm, const char *name, uint64_t fingerprint)
{
    struct comm_calls *calls = &comm->calls;
    uint64_t number = atomic_load(&calls->made) + 1;
    struct comm_called *call = call_logged(calls, number);
    *call = (struct comm_called){.number = number,
                                 .fingerprint = fingerprint,
                                 .homes = comm->setup.table->homes,
                                 .rank = comm->rank};
    snprintf(call->name, sizeof call->name, "%s", name);
    atomic_store(&calls->made, number);
    return number - atomic_load(&calls->agreed) == COMM_LOGGED_CALLS;
}

void comm_waits(struct comm *comm, bool waits)
{
    if (!comm)
        return;
    struct comm_calls *calls = &comm->calls;
    uint64_t number = waits ? atomic_load(&calls->made) : 0;
    atomic_store(&calls->waits, number);
}

/* ---- The tree ---- */

static int tree_parent(int rank)
{
    return rank & (rank - 1);
}

bool comm_check_joins(int a, int b)
{
    return a != b && (a < b ? tree_parent(b) == a : tree_parent(a) == b);
}

/* Sends the entry to all neighbours but one. Without memory the run goes on: a wait finds the
 * difference, only later. */
static void check_pass_on(struct comm *comm, int from, const struct comm_called *call)
{
    int rank = comm->rank;
    if (rank && tree_parent(rank) != from)
        comm_control_tell(comm, tree_parent(rank), COMM_CHECK, call, sizeof *call);
    for (int bit = 1; rank + bit < comm->n_ranks && !(rank & bit); bit <<= 1)
        if (rank + bit != from)
            comm_control_tell(comm, rank + bit, COMM_CHECK, call, sizeof *call);
}

/* ---- Comparing ---- */

/* Two ranks' calls of one number. */
static void call_compare(struct comm *comm, const struct comm_called *a,
                         const struct comm_called *b)
{
    char message[300];
    if (a->fingerprint == b->fingerprint && a->homes == b->homes)
        return;
    snprintf(message, sizeof message,
             "ranks %d and %d forked different tasks, made different objects or other calls, or "
             "have different homes: the blocking call of number %llu is %s on rank %d and %s on "
             "rank %d",
             a->rank, b->rank, (unsigned long long)a->number, a->name, a->rank, b->name, b->rank);
    comm_difference_found(comm, a->number, message);
}

void comm_check_see(struct comm *comm, int from, const struct comm_called *call)
{
    struct comm_calls *calls = &comm->calls;
    struct comm_called *seen = &calls->seen[call->number % SEEN_CALLS];
    if (comm_is_broken(comm) || call->number <= atomic_load(&calls->agreed))
        return;
    if (seen->number == call->number) {
        call_compare(comm, seen, call);
        return;
    }
    *seen = *call;
    if (call->number > calls->last_seen)
        calls->last_seen = call->number;
    if (call->number <= calls->compared)
        call_compare(comm, call_logged(calls, call->number), call);
    check_pass_on(comm, from, call);
}

/* Calls that this rank made since the last time. */
static void check_new_calls(struct comm *comm)
{
    struct comm_calls *calls = &comm->calls;
    uint64_t made = atomic_load(&calls->made);
    uint64_t agreed = atomic_load(&calls->agreed);
    uint64_t last = calls->last_seen < made ? calls->last_seen : made;
    for (uint64_t n = 1 + (agreed > calls->compared ? agreed : calls->compared); n <= last; n++)
        if (calls->seen[n % SEEN_CALLS].number == n)
            call_compare(comm, call_logged(calls, n), &calls->seen[n % SEEN_CALLS]);
    calls->compared = made;
}

void comm_check_pass(struct comm *comm)
{
    struct comm_calls *calls = &comm->calls;
    uint64_t number = atomic_load(&calls->waits);
    check_new_calls(comm);
    if (!number || calls->seen[number % SEEN_CALLS].number == number)
        return;
    double now = base_seconds();
    if (number != calls->waited) {
        calls->waited = number;
        calls->since = now;
    } else if (now - calls->since > PATIENCE_SECONDS) {
        comm_check_see(comm, comm->rank, call_logged(calls, number));
    }
}
