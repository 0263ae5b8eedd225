/* A control message is sent once and freed when MPI has sent it. Abort messages and last messages
 * are made at the start and sent at most once to each rank; there is always room for their
 * requests. */
#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/comm/internal.h"

#include <stdio.h>
#include <string.h>

/* ---- Start and stop ---- */

bool comm_control_start(struct comm *comm)
{
    struct comm_control *control = &comm->control;
    const size_t n_ranks = (size_t)comm->n_ranks;
    /* The messages that must go without further memory: abort, loss and last message to each. */
    comm->requests.reserved = 3 * n_ranks;
    control->abort = data_packet_new(sizeof(struct comm_abort), true);
    control->loss = data_packet_new(sizeof(struct comm_abort), true);
    control->last = data_packet_new(0, true);
    control->spare = data_packet_new(sizeof(struct comm_abort), true);
    control->standing = base_alloc_zero(n_ranks * sizeof *control->standing);
    return control->abort && control->loss && control->last && control->spare &&
           control->standing && comm_requests_room(comm, 1);
}

void comm_control_stop(struct comm_control *control)
{
    data_packet_free(control->abort);
    data_packet_free(control->loss);
    data_packet_free(control->last);
    data_packet_free(control->spare);
    base_free(control->standing);
}

/* ---- Sending ---- */

static void control_sent(struct comm *comm, struct comm_found *found, void *packet)
{
    (void)comm, (void)found;
    data_packet_free(packet);
}

static int control_isend(struct comm *comm, int to, struct data_packet *packet, bool own)
{
    int mpi = MPI_Isend(packet, (int)data_packet_lines(packet->bytes), comm->line, to, COMM_PACKETS,
                        comm->mpi, comm_request_next(comm));
    if (mpi == MPI_SUCCESS)
        comm_request_add(comm, control_sent, own ? NULL : packet);
    return mpi;
}

bool comm_control_send(struct comm *comm, int to, struct data_packet *packet)
{
    packet->key.slot = (uint32_t)comm->rank;
    if (!comm_requests_room(comm, 1))
        comm_break_memory(comm, "a control message");
    else if (comm_mpi_ok(comm, control_isend(comm, to, packet, false), "MPI_Isend"))
        return true;
    data_packet_free(packet);
    return false;
}

bool comm_control_tell(struct comm *comm, int to, enum comm_kind kind, const void *what,
                       size_t bytes)
{
    struct data_packet *packet = data_packet_new(bytes, true);
    if (!packet)
        return false;
    packet->kind = kind;
    memcpy(data_payload(packet), what, bytes);
    comm_control_send(comm, to, packet);
    return true;
}

/* ---- Abort ---- */

static bool code_is_loss(int code)
{
    return code == DUITE_E_LOST || code == DUITE_E_MPI;
}

void comm_break(struct comm *comm, int code, const char *message)
{
    if (code_is_loss(code))
        atomic_store(&comm->lost, true);
    if (atomic_flag_test_and_set(&comm->breaking))
        return;
    comm->reason.code = code;
    snprintf(comm->reason.message, sizeof comm->reason.message, "%s", message);
    atomic_store(&comm->broken, code);
    if (!comm->silent)
        comm->setup.owner->broke(comm->setup.context);
}

void comm_break_memory(struct comm *comm, const char *what)
{
    char message[100];
    snprintf(message, sizeof message, "out of memory for %s", what);
    comm_break(comm, DUITE_E_MEMORY, message);
}

int comm_mpi_class(int mpi)
{
    int class = mpi;
    return MPI_Error_class(mpi, &class) == MPI_SUCCESS ? class : mpi;
}

int comm_mpi(int mpi, const char *call)
{
    char reason[MPI_MAX_ERROR_STRING] = "unknown";
    int length = 0;
    if (mpi == MPI_SUCCESS)
        return DUITE_OK;
    MPI_Error_string(mpi, reason, &length);
    return base_error(DUITE_E_MPI, "%s: %s", call, reason);
}

/* Messages of channels alone may come into too little room. */
bool comm_mpi_ok(struct comm *comm, int mpi, const char *call)
{
    if (mpi == MPI_SUCCESS)
        return true;
    if (comm_mpi_class(mpi) == MPI_ERR_TRUNCATE)
        comm_break(comm, DUITE_E_DIFFERENT,
                   "a message of a recorded graph does not fit: the ranks recorded different "
                   "graphs");
    else
        comm_break(comm, comm_mpi(mpi, call), duite_message());
    return false;
}

bool comm_mpi_cut(struct comm *comm, int mpi, const char *call)
{
    return mpi == MPI_SUCCESS || comm_mpi_class(mpi) == MPI_ERR_TRUNCATE ||
           comm_mpi_ok(comm, mpi, call);
}

bool comm_is_broken(struct comm *comm)
{
    return comm && atomic_load(&comm->broken) != 0;
}

bool comm_is_lost(struct comm *comm)
{
    return comm && atomic_load(&comm->lost);
}

int comm_error(struct comm *comm)
{
    int code = comm ? atomic_load(&comm->broken) : 0;
    return code ? base_error(code, "%s", comm->reason.message) : DUITE_OK;
}

/* A send that fails here is not reported: MPI itself failed, and no rank can be reached. */
static void abort_send_all(struct comm *comm, struct data_packet *packet, enum comm_kind kind)
{
    packet->kind = kind;
    packet->key.slot = (uint32_t)comm->rank;
    memcpy(data_payload(packet), &comm->reason, sizeof comm->reason);
    for (int to = 0; to < comm->n_ranks; to++)
        if (to != comm->rank)
            control_isend(comm, to, packet, true);
}

/* Reports two things, each once: that communication broke; and that a rank is lost, if it broke for
 * another reason. */
static void abort_send(struct comm *comm)
{
    struct comm_control *control = &comm->control;
    if (!control->aborts && comm_is_broken(comm)) {
        control->aborts = true;
        comm->reason.entered = comm->entered;
        comm->reason.kind = (int32_t)comm->kind;
        abort_send_all(comm, control->abort, COMM_ABORT);
    }
    if (control->aborts && !control->loss_sent && comm_is_lost(comm)) {
        control->loss_sent = true;
        if (!code_is_loss(comm->reason.code))
            abort_send_all(comm, control->loss, COMM_LOSS);
    }
}

static void abort_hear(struct comm *comm, struct data_packet *packet)
{
    struct comm_abort *abort = data_payload(packet);
    char message[sizeof abort->message + 32];
    abort->message[sizeof abort->message - 1] = '\0';
    if (abort->code == DUITE_E_DIFFERENT) /* about all ranks: the same sentence on each */
        snprintf(message, sizeof message, "%s", abort->message);
    else
        snprintf(message, sizeof message, "rank %u: %s", packet->key.slot, abort->message);
    comm->control.heard++;
    if (abort->entered > comm->control.entered) {
        comm->control.entered = abort->entered;
        comm->control.kind = abort->kind;
    }
    comm_break(comm, abort->code, message);
}

/* ---- Requests for tasks ---- */

bool comm_request(struct comm *comm, struct worker *worker, int rank, unsigned idle, double seconds)
{
    bool sent = false;
    if (!comm_try_lock(comm))
        return false;
    /* The abort message is the last one. */
    struct data_packet *packet = comm_is_broken(comm) ? NULL : data_packet_new(0, true);
    if (packet) {
        packet->kind = COMM_REQUEST;
        packet->pieces = idle;
        packet->key.number = (uint64_t)(1e9 * seconds);
        comm->worker = worker;
        comm_note(comm, true, rank, sizeof *packet);
        sent = comm_control_send(comm, rank, packet);
    }
    comm_let_go(comm); /* the caller's next poll sends the posts made meanwhile */
    atomic_fetch_add_explicit(&comm->control.requested, sent, memory_order_relaxed);
    return sent;
}

static void request_hear(struct comm *comm, struct data_packet *packet)
{
    struct comm_control *control = &comm->control;
    control->standing[packet->key.slot] =
        (struct comm_requester){.rank = (int)packet->key.slot,
                                .idle = packet->pieces,
                                .until = base_seconds() + 1e-9 * (double)packet->key.number};
    atomic_store(&control->standing_any, 1);
}

bool comm_has_requests(struct comm *comm)
{
    return atomic_load(&comm->control.standing_any);
}

bool comm_take_request(struct comm *comm, struct comm_requester *requester)
{
    struct comm_control *control = &comm->control;
    double now = base_seconds();
    bool found = false;
    if (!comm_try_lock(comm))
        return false;
    for (int i = 0; i < comm->n_ranks && !found; i++) {
        control->turn = (control->turn + 1) % comm->n_ranks;
        struct comm_requester *standing = &control->standing[control->turn];
        found = standing->until > now;
        if (found)
            *requester = *standing;
        standing->until = 0;
    }
    if (!found)
        atomic_store(&control->standing_any, 0);
    comm_let_go(comm);
    return found;
}

void comm_return_request(struct comm *comm, const struct comm_requester *requester)
{
    struct comm_requester *standing = &comm->control.standing[requester->rank];
    if (!comm_try_lock(comm))
        return; /* that rank will request again */
    if (standing->until < requester->until)
        *standing = *requester;
    atomic_store(&comm->control.standing_any, 1);
    comm_let_go(comm);
}

/* ---- The end ---- */

/* True if that rank and this one send each other a last message, as they may send each other
 * control messages. Requests go between any two ranks, checks along the tree. */
static bool last_is_for(const struct comm *comm, int rank)
{
    return rank != comm->rank && (comm->may_request || comm_check_joins(comm->rank, rank));
}

void comm_control_end(struct comm *comm)
{
    struct comm_control *control = &comm->control;
    control->last->kind = COMM_LAST;
    control->last->key.slot = (uint32_t)comm->rank;
    comm_hold(comm);
    for (int to = 0; to < comm->n_ranks && !comm_is_broken(comm); to++)
        if (last_is_for(comm, to))
            comm_mpi_ok(comm, control_isend(comm, to, control->last, true), "MPI_Isend");
    comm_let_go(comm);
}

bool comm_control_over(struct comm *comm)
{
    const struct comm_control *control = &comm->control;
    int expected = 0;
    if (comm_is_broken(comm) ? comm_is_lost(comm) : !comm->open)
        return true;
    for (int from = 0; from < comm->n_ranks; from++)
        expected += last_is_for(comm, from);
    if (!comm_try_lock(comm))
        return false;
    const bool heard = comm_is_broken(comm) ? control->aborts && control->heard == comm->n_ranks - 1
                                            : control->last_heard == expected;
    const bool over = heard && !comm->requests.n;
    comm_let_go(comm);
    return over;
}

/* ---- All kinds ---- */

bool comm_control_hear(struct comm *comm, struct data_packet *packet)
{
    switch (packet->kind) {
    case COMM_ABORT:
        abort_hear(comm, packet);
        return true;
    case COMM_LOSS: /* it follows an abort message, whose reason stands */
        atomic_store(&comm->lost, true);
        return true;
    case COMM_CHECK:
        comm_check_see(comm, (int)packet->key.slot, data_payload(packet));
        return true;
    case COMM_DIFFERS:
    case COMM_INQUIRY:
    case COMM_ANSWER:
        comm_difference_hear(comm, packet);
        return true;
    case COMM_REQUEST:
        request_hear(comm, packet);
        return true;
    case COMM_LAST:
        comm->control.last_heard++;
        return true;
    default:
        return false;
    }
}

void comm_control_pass(struct comm *comm)
{
    if (!comm_is_broken(comm))
        comm_check_pass(comm);
    if (!comm_is_broken(comm))
        comm_difference_pass(comm);
    abort_send(comm);
}
