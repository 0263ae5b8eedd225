/* What is to be sent waits in a lock-free stack, linked by the tasks themselves, until somebody
 * polls. Once communication is broken nothing is sent any more: what was posted ends as if it had
 * been. */
#include "runtime/comm/comm.h"

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/base/stack.h"
#include "runtime/comm/internal.h"
#include "runtime/offload/offload.h"

#include <sched.h>
#include <stdlib.h>

/* What one poll found, delivered after the lock is let go. */
struct found {
    struct data_packet *packets;
    struct task *sent;
    struct task *nodes; /* of channels, that are through */
    bool any;
};

/* ---- Start and stop ---- */

static int prepare(struct comm *comm, struct base_monitor *monitor)
{
    if (MPI_Comm_rank(comm->mpi, &comm->rank) || MPI_Comm_size(comm->mpi, &comm->n_ranks))
        return base_error(DUITE_E_MPI, "MPI_Comm_size failed");
    comm->words = base_alloc((size_t)(comm->n_ranks + 1) * sizeof *comm->words);
    if (!comm_control_start(&comm->control, comm->n_ranks) || !comm_calls_start(&comm->calls) ||
        !comm->words)
        return base_no_memory("communication");
    if (MPI_Type_contiguous(sizeof(struct data_packet), MPI_BYTE, &comm->line) ||
        MPI_Type_commit(&comm->line))
        return base_error(DUITE_E_MPI, "MPI_Type_contiguous failed");
    if (!comm_channels_start(comm))
        return base_error(DUITE_E_MPI, "MPI_Comm_get_attr failed");
    return comm_heartbeat_start(comm, monitor);
}

int comm_start(struct comm **out, MPI_Comm mpi, struct task_graph *graph,
               struct base_monitor *monitor)
{
    struct comm *comm = *out = base_alloc_zero(sizeof *comm);
    if (!comm)
        return base_no_memory("communication");
    comm->graph = graph;
    comm->mpi = mpi;
    comm->line = MPI_DATATYPE_NULL;
    comm->request = MPI_REQUEST_NULL;
    atomic_flag_test_and_set(&comm->lock); /* until comm_open */
    atomic_init(&comm->posts, NULL);
    comm_arrivals_start(&comm->arrivals);
    return prepare(comm, monitor);
}

void comm_ring(struct comm *comm, double seconds, const char *host)
{
    if (comm)
        comm_heartbeat_open(comm, seconds, host);
}

void comm_tell(struct comm *comm, comm_told *tell)
{
    comm->tell = tell;
}

void comm_open(struct comm *comm, bool requests)
{
    if (!comm)
        return;
    comm->open = true;
    comm->may_request = requests;
    comm_unlock(comm);
}

/* Nothing is on its way, neither of a whole run nor of one that broke. */
static bool is_over(struct comm *comm)
{
    if (comm_is_broken(comm))
        return comm_is_lost(comm) || comm_is_quiet(comm);
    return !comm->open || (!comm->sends.n && comm_control_over(comm));
}

bool comm_stop(struct comm *comm)
{
    if (!comm)
        return true;
    if (comm->open)
        comm_control_end(comm);
    while (!is_over(comm)) {
        comm_poll(comm, NULL);
        sched_yield();
    }
    comm_heartbeat_stop(comm);
    if (comm_is_lost(comm)) /* MPI may still read and write here: all of it stays */
        return false;
    comm_catch_up(comm);
    if (!comm_channels_stop(comm))
        return false;
    if (comm->line != MPI_DATATYPE_NULL)
        MPI_Type_free(&comm->line);
    comm_requests_free(&comm->sends);
    comm_requests_free(&comm->receives);
    comm_control_stop(&comm->control);
    comm_calls_stop(&comm->calls);
    comm_arrivals_stop(&comm->arrivals);
    base_free(comm->words);
    base_free(comm);
    return true;
}

/* ---- Sending ---- */

void comm_send(struct comm *comm, struct task *task)
{
    BASE_STACK_PUSH(&comm->posts, task, memory_order_release);
    /* Against comm_left_to_us: the next try for the lock succeeds, or its holder sees this. */
    atomic_thread_fence(memory_order_seq_cst);
}

bool comm_posted(struct comm *comm)
{
    return !BASE_STACK_IS_EMPTY(&comm->posts) || !BASE_STACK_IS_EMPTY(&comm->channels.ready);
}

/* False: it was not sent, and never will be. */
static bool start_send(struct comm *comm, struct task *task)
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
    int mpi = MPI_Isend(packet, (int)lines, comm->line, task->send->to, 0, comm->mpi, request);
    if (!comm_mpi_ok(comm, mpi, "MPI_Isend"))
        return false;
    comm_requests_started(&comm->sends, task);
    atomic_fetch_add_explicit(&comm->messages, 1, memory_order_relaxed);
    atomic_fetch_add_explicit(&comm->bytes, lines * sizeof *packet, memory_order_relaxed);
    comm_note(comm, true, task->send->to, lines * sizeof *packet);
    return true;
}

static void push_sent(struct found *found, struct task *task)
{
    task->next = found->sent;
    found->sent = task;
}

static void start_sends(struct comm *comm, struct found *found)
{
    struct task *in_order = BASE_STACK_TAKE(&comm->posts);
    BASE_LIST_REVERSE(in_order);
    while (in_order) {
        struct task *task = in_order;
        in_order = task->next;
        found->any = true;
        if (!start_send(comm, task))
            push_sent(found, task);
    }
    int done;
    comm_mpi_ok(comm, comm_requests_test(&comm->sends, &done), "MPI_Testsome");
    for (int i = 0; i < done; i++)
        push_sent(found, comm->sends.what[comm->sends.n + i]);
}

/* ---- Receiving ---- */

/* A message that there is no memory for. A control message needs none: a rank that is about to
 * leave must not break for want of memory, since others may have left. Any other is lost: MPI
 * forgets it, and its sender goes on. */
static void receive_without_memory(struct comm *comm, MPI_Message *message, int lines)
{
    struct data_packet *spare = comm->control.spare;
    if (lines > (int)data_packet_lines(sizeof(struct comm_abort))) {
        comm_broke_memory(comm, "a message");
        MPI_Mrecv(NULL, 0, comm->line, message, MPI_STATUS_IGNORE); /* truncated, as it is meant */
        return;
    }
    int mpi = MPI_Mrecv(spare, lines, comm->line, message, MPI_STATUS_IGNORE);
    if (comm_mpi_ok(comm, mpi, "MPI_Mrecv") && !comm_control_hear(comm, spare))
        comm_broke_memory(comm, "a message");
}

static bool start_receive(struct comm *comm)
{
    int there = 0, lines = 0;
    MPI_Message message;
    MPI_Status status;
    int mpi = MPI_Improbe(MPI_ANY_SOURCE, 0, comm->mpi, &there, &message, &status);
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
        receive_without_memory(comm, &message, lines);
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

static void receive(struct comm *comm, struct found *found)
{
    int done;
    while (start_receive(comm))
        found->any = true;
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

static void deliver_to(struct comm *comm, struct worker *worker, struct comm_target target,
                       struct data_packet *packet)
{
    if (target.version)
        task_arrived(comm->graph, worker, target.version, packet);
    else
        task_pieces_arrived(comm->graph, worker, target.sum, packet);
}

/* A task of another rank; once communication is broken nobody waits for it. */
static void deliver_offloaded(struct comm *comm, struct worker *worker, struct data_packet *packet)
{
    if (!comm_is_broken(comm) && offload_arrived(comm->graph, worker, packet))
        return;
    data_packet_free(packet);
    comm_broke_memory(comm, "a task of another rank");
}

static void deliver_value(struct comm *comm, struct worker *worker, struct data_packet *packet)
{
    struct comm_target target = {0};
    switch (comm_arrivals_take(&comm->arrivals, packet, &target)) {
    case COMM_WANTED:
        deliver_to(comm, worker, target, packet);
        break;
    case COMM_KEPT:
        break;
    case COMM_LOST:
        data_packet_free(packet);
        comm_broke_memory(comm, "a message that came early");
    }
}

static void deliver(struct comm *comm, struct worker *worker, struct found *found)
{
    while (found->packets) {
        struct data_packet *packet = found->packets;
        found->packets = packet->next;
        if (packet->kind == DATA_OFFLOADED)
            deliver_offloaded(comm, worker, packet);
        else if (packet->kind == DATA_RESULT)
            offload_result_arrived(comm->graph, worker, packet);
        else
            deliver_value(comm, worker, packet);
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
        deliver_to(comm, worker, target, packet);
    }
    return DUITE_OK;
}

void comm_hold(struct comm *comm)
{
    while (!comm_try_lock(comm))
        sched_yield();
}

void comm_let_go(struct comm *comm)
{
    comm_unlock(comm); /* what was posted meanwhile is sent by the next poll */
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

uint64_t comm_stuck(struct comm *comm)
{
    uint64_t stuck = 0;
    if (comm_is_lost(comm) && comm_try_lock(comm)) {
        stuck = (uint64_t)comm->sends.n;
        comm_unlock(comm);
    }
    return stuck;
}

/* ---- Progress ---- */

/* Nodes that are finished make others ready: those are taken by the pass that finished them. */
static _Thread_local bool passing;

/* While a recorded graph waits for its messages others are looked for less often. */
enum { SELDOM = 8 };

static void look_around(struct comm *comm, struct found *found)
{
    if (comm->channels.awaited.n && ++comm->channels.looks % SELDOM)
        return;
    receive(comm, found);
    comm_control_pass(comm);
}

static bool pass(struct comm *comm, struct worker *worker, bool looks)
{
    bool any = false, outer = passing;
    passing = true;
    do {
        struct found found = {0};
        if (!comm_try_lock(comm))
            break;
        comm->worker = worker;
        if (comm->sends.n || !BASE_STACK_IS_EMPTY(&comm->posts))
            start_sends(comm, &found);
        found.nodes = comm_channels_pass(comm, NULL);
        if (looks)
            look_around(comm, &found);
        comm_unlock(comm);
        any = any || found.any || found.packets || found.sent || found.nodes;
        deliver(comm, worker, &found);
    } while (comm_left_to_us(comm));
    passing = outer;
    return any;
}

bool comm_poll(struct comm *comm, struct worker *worker)
{
    return pass(comm, worker, true);
}

bool comm_awaits(struct comm *comm)
{
    return atomic_load_explicit(&comm->channels.awaits, memory_order_relaxed);
}

void comm_channel_ready(struct comm *comm, struct worker *worker, struct task *node)
{
    comm_channel_post(comm, node);
    if (!passing)
        pass(comm, worker, false);
}

void comm_part(struct comm *comm, struct worker *worker)
{
    const double moment = 0.1;
    for (double since = base_seconds(); base_seconds() - since < moment; sched_yield())
        comm_poll(comm, worker);
}

uint64_t comm_awaited_ticks(const struct comm *comm)
{
    return comm_gauge_ticks(&comm->arrivals.gauge);
}

void comm_count(struct comm *comm, uint64_t *messages, uint64_t *bytes)
{
    uint64_t requested = atomic_load_explicit(&comm->control.requested, memory_order_relaxed);
    *messages = atomic_load_explicit(&comm->messages, memory_order_relaxed) + requested;
    *bytes = atomic_load_explicit(&comm->bytes, memory_order_relaxed) +
             requested * sizeof(struct data_packet);
}
