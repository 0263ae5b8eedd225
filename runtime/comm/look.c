/* Looks from outside, for the one who watches whether anything moves: nothing is sent, received or
 * changed. */
#include "runtime/comm/internal.h"

uint64_t comm_movement(struct comm *comm)
{
    return atomic_load_explicit(&comm->messages, memory_order_relaxed) +
           atomic_load_explicit(&comm->came, memory_order_relaxed);
}

void comm_look(struct comm *comm, const struct comm_looker *looker)
{
    comm_arrivals_look(&comm->arrivals, looker->awaited, looker->context);
    if (!comm_try_lock(comm))
        return;
    for (int i = 0; i < comm->sends.n; i++) {
        const struct graph_task *task = comm->sends.what[i];
        if (task->kind == GRAPH_SEND)
            looker->sending(looker->context, task->send);
    }
    comm_channels_look(comm, looker);
    comm_unlock(comm); /* what was posted meanwhile is sent by the next poll */
}
