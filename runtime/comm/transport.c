/* Packets between ranks: a letter becomes a message, and a message that comes goes to whoever
 * expects it. Once communication is broken, posted letters are not sent but end as if they had
 * been.
 *
 * A large packet's header is a message of its own; the payload follows in pieces, by a tag that the
 * key gives. A second one to the same rank by the same tag waits until the first is through, so the
 * pieces of two messages never mix. */
#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/base/stack.h"
#include "runtime/comm/internal.h"

/* ---- Sending ---- */

/* Control messages go whole. */
static bool packet_is_large(const struct data_packet *packet)
{
    return packet->kind < COMM_ABORT && comm_is_large(packet->bytes);
}

static int pieces_tag(const struct data_packet *packet)
{
    return COMM_PIECES + (int)((packet->key.slot + packet->key.number) % COMM_PIECE_TAGS);
}

/* True if a large message must wait for another one. */
static bool message_stalls(struct comm *comm, struct comm_letter *letter)
{
    const struct data_packet *packet =
        comm_is_broken(comm) ? NULL : comm->setup.owner->packet(letter);
    if (!packet || !packet_is_large(packet))
        return false;
    for (int i = 0; i < comm->requests.n; i++) {
        if (comm->requests.of[i].over != comm_letter_sent)
            continue;
        struct comm_letter *other = comm->requests.of[i].what;
        const struct data_packet *sent = comm->setup.owner->packet(other);
        if (other->to == letter->to && packet_is_large(sent) &&
            pieces_tag(sent) == pieces_tag(packet))
            return true;
    }
    return false;
}

static int packet_isend(struct comm *comm, struct data_packet *packet, int to, MPI_Request *request)
{
    const bool large = packet_is_large(packet);
    const size_t lines = large ? 1 : data_packet_lines(packet->bytes);
    int mpi = MPI_Isend(packet, (int)lines, comm->line, to, COMM_PACKETS, comm->mpi, request);
    if (mpi != MPI_SUCCESS || !large)
        return mpi;
    mpi = MPI_Request_free(request);
    return mpi == MPI_SUCCESS ? comm_pieces_send(comm, data_payload(packet), packet->bytes, to,
                                                 pieces_tag(packet), request)
                              : mpi;
}

/* False: it was not sent, and never will be. */
static bool message_send(struct comm *comm, struct comm_letter *letter)
{
    if (comm_is_broken(comm))
        return false;
    struct data_packet *packet = comm->setup.owner->packet(letter);
    if (packet && packet->elsewhere && !packet_is_large(packet))
        packet = letter->packet = data_packet_copy(packet);
    if (!packet || !comm_requests_room(comm, 1)) {
        comm_break_memory(comm, "a message");
        return false;
    }
    size_t lines = data_packet_lines(packet->bytes);
    comm_note(comm, true, letter->to, lines * sizeof *packet);
    const int mpi = packet_isend(comm, packet, letter->to, comm_request_next(comm));
    if (!comm_mpi_ok(comm, mpi, "MPI_Isend"))
        return false;
    comm_request_add(comm, comm_letter_sent, letter);
    atomic_fetch_add_explicit(&comm->messages, 1, memory_order_relaxed);
    atomic_fetch_add_explicit(&comm->bytes, lines * sizeof *packet, memory_order_relaxed);
    return true;
}

void comm_letter_sent(struct comm *comm, struct comm_found *found, void *letter)
{
    (void)comm;
    comm_found_over(found, &((struct comm_letter *)letter)->post);
}

/* False: it must wait for another one. */
static bool letter_begin(struct comm *comm, struct comm_found *found, struct comm_letter *letter)
{
    if (message_stalls(comm, letter))
        return false;
    found->any = true;
    if (!message_send(comm, letter))
        comm_letter_sent(comm, found, letter);
    return true;
}

void comm_transport_begin(struct comm *comm, struct comm_found *found)
{
    struct comm_post *posts = BASE_STACK_TAKE(&comm->posts), *in_order = comm->stalled;
    struct comm_post **end = &in_order;
    BASE_LIST_REVERSE(posts);
    while (*end)
        end = &(*end)->next;
    *end = posts;
    end = &comm->stalled;
    while (in_order) {
        struct comm_post *post = in_order;
        in_order = post->next;
        if (post->is_channel ? comm_channel_begin(comm, found, (struct comm_channel *)post)
                             : letter_begin(comm, found, (struct comm_letter *)post))
            continue;
        *end = post;
        end = &post->next;
    }
    *end = NULL;
}

/* ---- Receiving ---- */

/* Receives a message without memory for it. A control message needs none: a rank about to leave
 * must not break for want of memory, since others may have left. Any other message is lost: MPI
 * forgets it, and its sender goes on. */
static void message_receive_scarce(struct comm *comm, MPI_Message *message, int lines, int from)
{
    struct data_packet *spare = comm->control.spare;
    if (lines > (int)data_packet_lines(sizeof(struct comm_abort))) {
        comm_break_memory(comm, "a message");
        comm_mpi_cut(comm, MPI_Mrecv(NULL, 0, comm->line, message, MPI_STATUS_IGNORE), "MPI_Mrecv");
        return;
    }
    if (!COMM_OK(comm, MPI_Mrecv, spare, lines, comm->line, message, MPI_STATUS_IGNORE) ||
        comm_control_hear(comm, spare))
        return;
    comm_break_memory(comm, "a message");
    if (packet_is_large(spare))
        comm_pieces_forget(comm, spare->bytes, from, pieces_tag(spare));
}

/* A packet is here, whole. */
static void packet_came(struct comm *comm, struct comm_found *found, void *what)
{
    struct data_packet *packet = what;
    data_packet_came(packet);
    if (comm_control_hear(comm, packet)) {
        data_packet_free(packet);
        return;
    }
    atomic_fetch_add_explicit(&comm->came, 1, memory_order_relaxed);
    packet->next = found->packets;
    found->packets = packet;
}

/* The header of a large packet came, in a packet of its own, which is freed. */
static void large_begin(struct comm *comm, struct data_packet *header, int from)
{
    struct data_packet *packet = data_packet_new(header->bytes, false);
    if (packet) {
        *packet = *header;
        data_packet_came(packet);
        comm_pieces_receive(comm, (struct comm_request){.over = packet_came,
                                                        .what = packet,
                                                        .into = data_payload(packet),
                                                        .left = packet->bytes,
                                                        .from = from,
                                                        .tag = pieces_tag(packet)});
    } else {
        comm_break_memory(comm, "a message");
        comm_pieces_forget(comm, header->bytes, from, pieces_tag(header));
    }
    header->lines = 1;
    data_packet_free(header);
}

/* A message of one line comes whole; it may be the header of a large packet. */
static void message_receive_line(struct comm *comm, struct comm_found *found, MPI_Message *message,
                                 struct data_packet *packet, int from)
{
    if (!COMM_OK(comm, MPI_Mrecv, packet, 1, comm->line, message, MPI_STATUS_IGNORE))
        data_packet_free(packet);
    else if (packet_is_large(packet))
        large_begin(comm, packet, from);
    else
        packet_came(comm, found, packet);
}

static bool message_receive(struct comm *comm, struct comm_found *found, size_t *received)
{
    int there = 0, lines = 0;
    MPI_Message message;
    MPI_Status status;
    if (!COMM_OK(comm, MPI_Improbe, MPI_ANY_SOURCE, COMM_PACKETS, comm->mpi, &there, &message,
                 &status) ||
        !there)
        return false;
    if (!COMM_OK(comm, MPI_Get_count, &status, comm->line, &lines) || lines < 1)
        return false;
    size_t bytes = ((size_t)lines - 1) * sizeof(struct data_packet);
    *received += bytes;
    struct data_packet *packet = data_packet_new(bytes, false);
    if (!packet || !comm_requests_room(comm, 1)) {
        data_packet_free(packet);
        message_receive_scarce(comm, &message, lines, status.MPI_SOURCE);
        return true;
    }
    comm_note(comm, false, status.MPI_SOURCE, (size_t)lines * sizeof *packet);
    if (lines == 1) {
        message_receive_line(comm, found, &message, packet, status.MPI_SOURCE);
        return true;
    }
    if (!COMM_OK(comm, MPI_Imrecv, packet, lines, comm->line, &message, comm_request_next(comm))) {
        data_packet_free(packet);
        return false;
    }
    comm_request_add(comm, packet_came, packet);
    return true;
}

void comm_transport_receive(struct comm *comm, struct comm_found *found)
{
    size_t received = 0;
    while (received < comm_piece_bytes && message_receive(comm, found, &received))
        found->any = true;
    found->more |= received >= comm_piece_bytes;
}

/* ---- Delivering, without the lock ---- */

static void message_deliver_to(struct comm *comm, struct worker *worker, struct comm_target target,
                               struct data_packet *packet)
{
    target.arrived(comm->setup.context, worker, target.what, packet);
}

/* A task of another rank, which has no key to expect it by. Once communication is broken no rank
 * waits for its result. */
static void message_deliver_task(struct comm *comm, struct worker *worker,
                                 struct data_packet *packet)
{
    const bool dropped = comm_is_broken(comm);
    if (!dropped && comm->setup.owner->came(comm->setup.context, worker, packet))
        return;
    data_packet_free(packet);
    if (!dropped)
        comm_break_memory(comm, "a task of another rank");
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
    case COMM_REFUSED:
        data_packet_free(packet);
        break;
    case COMM_LOST:
        data_packet_free(packet);
        comm_break_memory(comm, "a message that came early");
    }
}

void comm_transport_deliver(struct comm *comm, struct worker *worker, struct comm_found *found)
{
    const struct comm_owner *owner = comm->setup.owner;
    while (found->packets) {
        struct data_packet *packet = found->packets;
        found->packets = packet->next;
        if (packet->kind == DATA_OFFLOADED)
            message_deliver_task(comm, worker, packet);
        else
            message_deliver_value(comm, worker, packet);
    }
    while (found->over) {
        struct comm_post *post = found->over;
        struct comm_letter *letter = (struct comm_letter *)post;
        struct comm_channel *channel = (struct comm_channel *)post;
        found->over = post->next;
        if (!post->is_channel) {
            data_packet_free(letter->packet);
            owner->sent(comm->setup.context, worker, letter);
        } else if (comm_channel_copy(comm, channel)) {
            owner->through(comm->setup.context, worker, channel);
        }
    }
}

int comm_expect(struct comm *comm, struct worker *worker, struct data_key key,
                struct comm_target target, uint32_t packets)
{
    struct data_packet *early;
    if (!comm_arrivals_expect(&comm->arrivals, key, target, packets, &early))
        return DUITE_E_MEMORY;
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
    comm_let_go(comm);
    while (comm_arrivals_close(&comm->arrivals, &target))
        message_deliver_to(comm, worker, target, NULL);
}
