/* Looks from outside, for the one who watches whether anything moves: nothing is sent, received or
 * changed. */
#include "runtime/comm/internal.h"

#include <time.h>

uint64_t comm_movement(struct comm *comm)
{
    return atomic_load_explicit(&comm->messages, memory_order_relaxed) +
           atomic_load_explicit(&comm->came, memory_order_relaxed);
}

/* Whoever polls has the lock for microseconds, or as long as its thread has no core. One that
 * stands still inside MPI keeps it: then nobody can look. */
static bool lock_soon(struct comm *comm)
{
    enum { TRIES = 100 };
    const struct timespec pause = {.tv_nsec = 1000000};
    for (int i = 0; i < TRIES; i++) {
        if (comm_try_lock(comm))
            return true;
        nanosleep(&pause, NULL);
    }
    return false;
}

bool comm_look(struct comm *comm, const struct comm_looker *looker)
{
    comm_arrivals_look(&comm->arrivals, looker->awaited, looker->context);
    if (!lock_soon(comm))
        return false;
    for (int i = 0; i < comm->sends.n; i++) {
        const struct task *task = comm->sends.what[i];
        if (task->type == TASK_SEND || task->type == TASK_PIECES)
            looker->sending(looker->context, task->send);
    }
    comm_channels_look(comm, looker);
    comm_unlock(comm); /* what was posted meanwhile is sent by the next poll */
    return true;
}
