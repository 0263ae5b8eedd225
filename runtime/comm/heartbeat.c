/* At most one heartbeat to the next rank is on its way: while that rank does not receive it, no
 * other is sent. The last heartbeat says that it is the last, and nothing follows it. */
#include "runtime/base/clock.h"
#include "runtime/comm/internal.h"

#include <math.h>
#include <sched.h>
#include <stdio.h>

enum { HEARTBEAT = 1, LAST_HEARTBEAT };

/* ---- Looks, under the lock of the comm ---- */

static int rank_before(const struct comm *comm)
{
    return (comm->rank + comm->n_ranks - 1) % comm->n_ranks;
}

static void heartbeat_lost(struct comm *comm)
{
    char message[200];
    snprintf(message, sizeof message,
             "rank %d on host %s is lost: nothing was heard of it for %g s", rank_before(comm),
             comm->heartbeat.host, comm->heartbeat.seconds);
    comm_break(comm, DUITE_E_LOST, message);
}

/* Posts the receive of the next heartbeat. */
static bool heartbeat_expect(struct comm *comm)
{
    struct comm_heartbeat *heartbeat = &comm->heartbeat;
    int mpi = MPI_Irecv(&heartbeat->in, 1, MPI_BYTE, rank_before(comm), COMM_HEARTBEATS, comm->mpi,
                        &heartbeat->heard);
    return comm_mpi_ok(comm, mpi, "MPI_Irecv of a heartbeat");
}

/* True if a heartbeat came since the last call, and always once the last one came. */
static bool heartbeat_hear(struct comm *comm)
{
    struct comm_heartbeat *heartbeat = &comm->heartbeat;
    bool any = heartbeat->last_heard;
    int there = 1;
    while (there && !heartbeat->last_heard) {
        int mpi = MPI_Test(&heartbeat->heard, &there, MPI_STATUS_IGNORE);
        if (!comm_mpi_ok(comm, mpi, "MPI_Test of a heartbeat"))
            return any;
        any = any || there;
        if (there && heartbeat->in == LAST_HEARTBEAT)
            heartbeat->last_heard = true;
        else if (there && !heartbeat_expect(comm))
            return any;
    }
    return any;
}

/* Sends a heartbeat, unless the one before is still on its way. */
static void heartbeat_send(struct comm *comm, char which)
{
    struct comm_heartbeat *heartbeat = &comm->heartbeat;
    int taken = 0, to = (comm->rank + 1) % comm->n_ranks;
    int mpi = MPI_Test(&heartbeat->sent, &taken, MPI_STATUS_IGNORE);
    if (!comm_mpi_ok(comm, mpi, "MPI_Test of a heartbeat") || !taken || heartbeat->last_sent)
        return;
    heartbeat->out = which;
    mpi = MPI_Isend(&heartbeat->out, 1, MPI_BYTE, to, COMM_HEARTBEATS, comm->mpi, &heartbeat->sent);
    if (comm_mpi_ok(comm, mpi, "MPI_Isend of a heartbeat"))
        heartbeat->last_sent = which == LAST_HEARTBEAT;
}

static void heartbeat_make_look(struct comm *comm)
{
    struct comm_heartbeat *heartbeat = &comm->heartbeat;
    if (comm_is_lost(comm))
        return;
    heartbeat_send(comm, HEARTBEAT);
    heartbeat->silent = heartbeat_hear(comm) ? 0 : heartbeat->silent + 1;
    if (heartbeat->silent >= COMM_SILENT_LOOKS)
        heartbeat_lost(comm);
}

void comm_heartbeat_pass(struct comm *comm)
{
    _Atomic int *state = &comm->heartbeat.state;
    if (atomic_load_explicit(state, memory_order_relaxed) != COMM_LOOK_DUE)
        return;
    heartbeat_make_look(comm);
    atomic_store_explicit(state, COMM_LOOK_MADE, memory_order_relaxed);
}

/* A look of the monitor. False: a worker polls, and the monitor comes again soon, for the lock or
 * to find that the look was made. */
static bool heartbeat_look(void *context)
{
    struct comm *comm = context;
    _Atomic int *state = &comm->heartbeat.state;
    const bool locked = comm_try_lock(comm);
    const int before = atomic_load_explicit(state, memory_order_relaxed);
    if (!locked && before == COMM_LOOK_DUE)
        return false;
    if (locked && before != COMM_LOOK_MADE)
        heartbeat_make_look(comm);
    const bool made = locked || before == COMM_LOOK_MADE;
    atomic_store_explicit(state, made ? COMM_LOOK_NOT_DUE : COMM_LOOK_DUE, memory_order_relaxed);
    if (locked)
        comm_let_go(comm); /* the next poll sends the posts made meanwhile */
    return made;
}

/* ---- The beginning ---- */

int comm_heartbeat_start(struct comm *comm, struct base_monitor *monitor)
{
    struct comm_heartbeat *heartbeat = &comm->heartbeat;
    heartbeat->sent = heartbeat->heard = MPI_REQUEST_NULL;
    heartbeat->monitor = monitor;
    heartbeat->look =
        (struct base_look){.look = heartbeat_look, .context = comm, .seconds = INFINITY};
    return base_monitor_add(monitor, &heartbeat->look);
}

void comm_ring(struct comm *comm, double seconds, const char *host)
{
    if (!comm)
        return;
    struct comm_heartbeat *heartbeat = &comm->heartbeat;
    snprintf(heartbeat->host, sizeof heartbeat->host, "%s", host);
    if (seconds <= 0) {
        base_monitor_remove(heartbeat->monitor, &heartbeat->look);
        return;
    }
    if (!heartbeat_expect(comm))
        return;
    heartbeat->seconds = seconds;
    base_monitor_set_period(heartbeat->monitor, &heartbeat->look, seconds / COMM_SILENT_LOOKS);
}

/* ---- The end ---- */

/* Sends the last heartbeat and awaits that of the rank before, which comes when the bodies of that
 * rank are over. A long gap between two looks is no silence: this process itself was stopped. */
static void heartbeat_take_leave(struct comm *comm)
{
    struct comm_heartbeat *heartbeat = &comm->heartbeat;
    double heard = base_seconds(), last = heard;
    while (!comm_is_lost(comm) && !(heartbeat->last_heard && heartbeat->last_sent &&
                                    heartbeat->sent == MPI_REQUEST_NULL)) {
        double now = base_seconds();
        heartbeat_send(comm, LAST_HEARTBEAT);
        if (heartbeat_hear(comm))
            heard = now;
        else if (now - last > heartbeat->seconds / COMM_SILENT_LOOKS)
            heard += now - last;
        else if (now - heard > heartbeat->seconds)
            heartbeat_lost(comm);
        last = now;
        sched_yield();
    }
}

void comm_heartbeat_stop(struct comm *comm)
{
    struct comm_heartbeat *heartbeat = &comm->heartbeat;
    if (heartbeat->monitor)
        base_monitor_remove(heartbeat->monitor, &heartbeat->look);
    if (heartbeat->seconds > 0)
        heartbeat_take_leave(comm);
}
