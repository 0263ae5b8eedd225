/* Packets between ranks: a SEND becomes a message, and a message that comes goes to the version,
 * sum or task that expects it. Once communication is broken nothing is sent any more: posted tasks
 * end as if they had been sent. */
#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/base/stack.h"
#include "runtime/comm/internal.h"
#include "runtime/offload/offload.h"

/* ---- Sending ---- */

/* False: it was not sent, and never will be. */
static bool message_send(struct comm *comm, struct task *task)
{
    if (comm_is_broken(comm))
        return false;
    struct data_packet *packet = task_send_packet(task);
    MPI_Request *request = packet ? comm_requests_place(&comm->sends) : NULL;
    if (!request) {
        comm_broke_memory(comm, "a message");
        return false;
    }
    size_t lines = data_packet_lines(packet->bytes);
    int mpi =
        MPI_Isend(packet, (int)lines, comm->line, task->send->to, COMM_PACKETS, comm->mpi, request);
    if (!comm_mpi_ok(comm, mpi, "MPI_Isend"))
        return false;
    comm_requests_started(&comm->sends, task);
    atomic_fetch_add_explicit(&comm->messages, 1, memory_order_relaxed);
    atomic_fetch_add_explicit(&comm->bytes, lines * sizeof *packet, memory_order_relaxed);
    comm_note(comm, true, task->send->to, lines * sizeof *packet);
    return true;
}

static void message_push_sent(struct comm_found *found, struct task *task)
{
    task->next = found->sent;
    found->sent = task;
}

void comm_transport_send(struct comm *comm, struct comm_found *found)
{
    struct task *in_order = BASE_STACK_TAKE(&comm->posts);
    BASE_LIST_REVERSE(in_order);
    while (in_order) {
        struct task *task = in_order;
        in_order = task->next;
        found->any = true;
        if (!message_send(comm, task))
            message_push_sent(found, task);
    }
    int done;
    comm_mpi_ok(comm, comm_requests_test(&comm->sends, &done), "MPI_Testsome");
    for (int i = 0; i < done; i++)
        message_push_sent(found, comm->sends.what[comm->sends.n + i]);
}

/* ---- Receiving ---- */

/* A message that there is no memory for. A control message needs none: a rank that is about to
 * leave must not break for want of memory, since others may have left. Any other is lost: MPI
 * forgets it, and its sender goes on. */
static void message_receive_scarce(struct comm *comm, MPI_Message *message, int lines)
{
    struct data_packet *spare = comm->control.spare;
    if (lines > (int)data_packet_lines(sizeof(struct comm_abort))) {
        comm_broke_memory(comm, "a message");
        MPI_Mrecv(NULL, 0, comm->line, message, MPI_STATUS_IGNORE); /* truncated on purpose */
        return;
    }
    int mpi = MPI_Mrecv(spare, lines, comm->line, message, MPI_STATUS_IGNORE);
    if (comm_mpi_ok(comm, mpi, "MPI_Mrecv") && !comm_control_hear(comm, spare))
        comm_broke_memory(comm, "a message");
}

static bool message_receive(struct comm *comm)
{
    int there = 0, lines = 0;
    MPI_Message message;
    MPI_Status status;
    int mpi = MPI_Improbe(MPI_ANY_SOURCE, COMM_PACKETS, comm->mpi, &there, &message, &status);
    if (!comm_mpi_ok(comm, mpi, "MPI_Improbe") || !there)
        return false;
    mpi = MPI_Get_count(&status, comm->line, &lines);
    if (!comm_mpi_ok(comm, mpi, "MPI_Get_count") || lines < 1)
        return false;
    size_t bytes = ((size_t)lines - 1) * sizeof(struct data_packet);
    struct data_packet *packet = data_packet_new(bytes, false);
    MPI_Request *request = packet ? comm_requests_place(&comm->receives) : NULL;
    if (!request) {
        data_packet_free(packet);
        message_receive_scarce(comm, &message, lines);
        return true;
    }
    mpi = MPI_Imrecv(packet, lines, comm->line, &message, request);
    if (!comm_mpi_ok(comm, mpi, "MPI_Imrecv")) {
        data_packet_free(packet);
        return false;
    }
    comm_requests_started(&comm->receives, packet);
    comm_note(comm, false, status.MPI_SOURCE, (size_t)lines * sizeof *packet);
    return true;
}

void comm_transport_receive(struct comm *comm, struct comm_found *found)
{
    int done;
    while (message_receive(comm))
        found->any = true;
    if (!comm->receives.n)
        return;
    comm_mpi_ok(comm, comm_requests_test(&comm->receives, &done), "MPI_Testsome");
    for (int i = 0; i < done; i++) {
        struct data_packet *packet = comm->receives.what[comm->receives.n + i];
        data_packet_came(packet);
        if (comm_control_hear(comm, packet)) {
            data_packet_free(packet);
            continue;
        }
        atomic_fetch_add_explicit(&comm->came, 1, memory_order_relaxed);
        packet->next = found->packets;
        found->packets = packet;
    }
}

/* ---- Delivering, without the lock ---- */

static void message_deliver_to(struct comm *comm, struct worker *worker, struct comm_target target,
                               struct data_packet *packet)
{
    if (target.version)
        task_arrived(comm->graph, worker, target.version, packet);
    else
        task_pieces_arrived(comm->graph, worker, target.sum, packet);
}

/* A task of another rank came. Once communication is broken no rank waits for it. */
static void message_deliver_offloaded(struct comm *comm, struct worker *worker,
                                      struct data_packet *packet)
{
    if (!comm_is_broken(comm) && offload_arrived(comm->graph, worker, packet))
        return;
    data_packet_free(packet);
    comm_broke_memory(comm, "a task of another rank");
}

static void message_deliver_value(struct comm *comm, struct worker *worker,
                                  struct data_packet *packet)
{
    struct comm_target target = {0};
    switch (comm_arrivals_take(&comm->arrivals, packet, &target)) {
    case COMM_WANTED:
        message_deliver_to(comm, worker, target, packet);
        break;
    case COMM_KEPT:
        break;
    case COMM_LOST:
        data_packet_free(packet);
        comm_broke_memory(comm, "a message that came early");
    }
}

void comm_transport_deliver(struct comm *comm, struct worker *worker, struct comm_found *found)
{
    while (found->packets) {
        struct data_packet *packet = found->packets;
        found->packets = packet->next;
        if (packet->kind == DATA_OFFLOADED)
            message_deliver_offloaded(comm, worker, packet);
        else if (packet->kind == DATA_RESULT)
            offload_result_arrived(comm->graph, worker, packet);
        else
            message_deliver_value(comm, worker, packet);
    }
    while (found->nodes) {
        struct task *node = found->nodes;
        found->nodes = node->next;
        work_finish(comm->graph, worker, node);
    }
    while (found->sent) {
        struct task *task = found->sent;
        found->sent = task->next;
        data_packet_free(task->send->packet);
        work_finish(comm->graph, worker, task);
    }
}

int comm_expect(struct comm *comm, struct worker *worker, struct data_key key,
                struct comm_target target, uint32_t packets)
{
    struct data_packet *early;
    if (!comm_arrivals_expect(&comm->arrivals, key, target, packets, &early))
        return base_no_memory("messages to come");
    while (early) {
        struct data_packet *packet = early;
        early = packet->next;
        message_deliver_to(comm, worker, target, packet);
    }
    return DUITE_OK;
}

void comm_give_up(struct comm *comm, struct worker *worker)
{
    struct comm_target target;
    comm_hold(comm);
    comm_channels_give_up(comm);
    comm_unlock(comm);
    while (comm_arrivals_close(&comm->arrivals, &target)) {
        if (target.version)
            task_lost(comm->graph, worker, target.version);
        else
            task_pieces_lost(comm->graph, worker, target.sum);
    }
    offload_lost(comm->graph, worker);
}
