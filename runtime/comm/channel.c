/* A channel's turn counts its messages since the opening, over all replays; the turn's parity
 * selects the buffer. A large message is written and read without the lock and comes in pieces; its
 * receive is posted when the channel is ready, not a round early. A sender does not learn that its
 * message was read: in most graphs it cannot get far without an answer. To bound how many rounds a
 * rank can be ahead, every sixteenth message of a channel, and every large one, is sent
 * synchronously: MPI tells when it was received. */
#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/base/stack.h"
#include "runtime/comm/internal.h"

#include <sched.h>

enum { CHECKED_TURN = 16 };

struct channel_side {
    struct comm_channel *channel;
    char *buffer[2];
    MPI_Request request[2];
    uint64_t turn;
    size_t written; /* bytes of a large message that is to be sent; or 0 */
    bool copies;    /* a large message is to be written or read next, without the lock */
};

struct comm_group {
    struct comm_group *next;
    struct comm *comm;
    int first_tag;
    size_t n;
    struct channel_side side[];
};

/* ---- Start and stop ---- */

int comm_channels_start(struct comm *comm)
{
    int *max = NULL, known = 0;
    const int code = COMM_MPI(MPI_Comm_get_attr, comm->mpi, MPI_TAG_UB, &max, &known);
    comm->channels.tags.next = COMM_CHANNELS;
    comm->channels.tags.last = known ? *max : 32767; /* guaranteed by MPI */
    return code;
}

/* Without the lock: freeing large buffers takes long. */
static void groups_free(struct comm_group *group)
{
    while (group) {
        struct comm_group *next = group->next;
        for (size_t i = 0; i < group->n; i++) {
            base_free(group->side[i].buffer[0]);
            base_free(group->side[i].buffer[1]);
        }
        base_free(group);
        group = next;
    }
}

/* True if MPI is done with the group's memory. A message that no longer matters may have been too
 * long. */
static bool group_is_quiet(struct comm_group *group)
{
    for (size_t i = 0; i < 2 * group->n; i++) {
        MPI_Request *request = &group->side[i / 2].request[i % 2];
        int done;
        comm_mpi_cut(group->comm, MPI_Test(request, &done, MPI_STATUS_IGNORE), "MPI_Test");
        if (*request != MPI_REQUEST_NULL)
            return false;
    }
    return true;
}

/* Takes out the closed groups whose memory MPI is done with; the caller frees them. */
static struct comm_group *channels_sweep(struct comm *comm)
{
    struct comm_group **link = &comm->channels.closed, *quiet = NULL;
    while (*link) {
        struct comm_group *group = *link;
        if (group_is_quiet(group)) {
            *link = group->next;
            group->next = quiet;
            quiet = group;
        } else {
            link = &group->next;
        }
    }
    return quiet;
}

/* Lets go of the lock, and frees what MPI is done with. */
static void channels_let_go(struct comm *comm)
{
    struct comm_group *quiet = comm_is_lost(comm) ? NULL : channels_sweep(comm);
    comm_let_go(comm);
    groups_free(quiet);
}

bool comm_channels_stop(struct comm *comm)
{
    groups_free(channels_sweep(comm));
    while (comm->channels.closed && !comm_is_broken(comm)) { /* the others have received it all */
        sched_yield();
        groups_free(channels_sweep(comm));
    }
    base_free(comm->channels.tags.range);
    return !comm->channels.closed;
}

/* ---- Opening and closing: all ranks in the same order ---- */

static bool side_is_large(const struct channel_side *side)
{
    return comm_is_large(side->channel->bytes);
}

static bool channel_post_receive(struct comm *comm, struct channel_side *side, size_t turn)
{
    const struct comm_channel *channel = side->channel;
    return COMM_OK(comm, MPI_Irecv, side->buffer[turn % 2], (int)channel->bytes, MPI_BYTE,
                   channel->peer, channel->tag, comm->mpi, &side->request[turn % 2]);
}

static struct comm_group *group_new(struct comm *comm, struct comm_channel_set *set)
{
    struct comm_group *group = base_alloc_zero(sizeof *group + set->n * sizeof group->side[0]);
    if (!group)
        return NULL;
    group->comm = comm;
    group->n = set->n;
    bool fine = true;
    for (size_t i = 0; i < set->n; i++) {
        struct channel_side *side = &group->side[i];
        side->channel = &set->channel[i];
        for (int k = 0; k < 2; k++) {
            side->request[k] = MPI_REQUEST_NULL;
            side->buffer[k] = base_alloc(side->channel->bytes);
            fine &= side->buffer[k] != NULL;
        }
        set->channel[i].own = side;
    }
    if (fine)
        return group;
    groups_free(group);
    return NULL;
}

/* A plan is freed: no message comes for the receives that were posted for another round. */
static void group_close(struct comm_channel_set *set)
{
    struct comm_group *group = set->own, **link;
    struct comm *comm = group->comm;
    comm_hold(comm);
    for (link = &comm->channels.open; *link != group; link = &(*link)->next)
        ;
    *link = group->next;
    for (size_t i = 0; i < group->n && !comm_is_lost(comm); i++) {
        comm->requests.reserved -= !group->side[i].channel->sends;
        for (int k = 0; k < 2 && !group->side[i].channel->sends; k++)
            if (group->side[i].request[k] != MPI_REQUEST_NULL)
                COMM_OK(comm, MPI_Cancel, &group->side[i].request[k]);
    }
    group->next = comm->channels.closed;
    comm->channels.closed = group;
    channels_let_go(comm);
}

static void group_drop(struct comm_channel_set *set)
{
    const struct comm_group *group = set->own;
    comm_tags_drop(&group->comm->channels.tags, group->first_tag);
}

/* Under the lock. */
static int group_open(struct comm *comm, struct comm_group *group, struct comm_channel_set *set)
{
    int code = comm_tags_take(&comm->channels.tags, set->phases + 1, &group->first_tag);
    if (code)
        return code;
    group->next = comm->channels.open;
    comm->channels.open = group;
    set->own = group;
    set->close = group_close;
    set->drop = group_drop;
    for (size_t i = 0; i < set->n; i++) {
        set->channel[i].tag += group->first_tag;
        if (set->channel[i].sends)
            continue;
        comm->requests.reserved++;
        if (side_is_large(&group->side[i]))
            continue;
        if (!channel_post_receive(comm, &group->side[i], 0) ||
            !channel_post_receive(comm, &group->side[i], 1))
            return DUITE_E_MPI;
    }
    return comm_requests_room(comm, 0) ? DUITE_OK : base_no_memory("messages to come");
}

int comm_channels_open(struct comm *comm, struct comm_channel_set *set)
{
    struct comm_group *group = group_new(comm, set);
    if (!group)
        return base_no_memory("the messages of a recorded graph");
    comm_hold(comm);
    int code = group_open(comm, group, set);
    channels_let_go(comm);
    if (!set->close)
        groups_free(group);
    return code;
}

/* True while a plan that the program dropped has open channels, or messages still being sent. Under
 * the lock. */
static bool channels_linger(struct comm *comm)
{
    size_t open = 0;
    for (const struct comm_group *group = comm->channels.open; group; group = group->next)
        open++;
    return comm->channels.closed || open > comm_tags_held(&comm->channels.tags);
}

int comm_channels_settle(struct comm *comm)
{
    bool lingers = true;
    while (lingers && !comm_is_broken(comm)) {
        comm_hold(comm);
        lingers = channels_linger(comm);
        channels_let_go(comm);
        sched_yield();
    }
    return comm_error(comm);
}

/* ---- Messages ---- */

/* Sends the message; a large one is already written. Returns its bytes. */
static size_t channel_isend(struct comm *comm, struct channel_side *side)
{
    struct comm_channel *channel = side->channel;
    MPI_Request *request = &side->request[side->turn % 2];
    void *buffer = side->buffer[side->turn % 2];
    const bool checked = side->turn++ % CHECKED_TURN == CHECKED_TURN - 1;
    const bool large = side->written;
    const size_t bytes = large ? side->written : comm->setup.owner->pack(side->channel, buffer);
    int mpi;
    side->written = 0;
    comm_note(comm, true, channel->peer, bytes);
    if (large)
        mpi = comm_pieces_send(comm, buffer, channel->bytes, channel->peer, channel->tag, request);
    else
        mpi = (checked ? MPI_Issend : MPI_Isend)(buffer, (int)bytes, MPI_BYTE, channel->peer,
                                                 channel->tag, comm->mpi, request);
    return comm_mpi_ok(comm, mpi, "MPI_Isend") ? bytes : 0;
}

/* No message is sent or comes, since communication is broken. */
static void channel_lose(struct comm *comm, struct comm_found *found, struct comm_channel *channel)
{
    const struct channel_side *side = channel->own;
    if (!side->written)
        comm->setup.owner->lose(channel);
    comm_found_over(found, &channel->post);
}

/* False: the buffer is still sent. */
static bool channel_send(struct comm *comm, struct comm_found *found, struct comm_channel *channel)
{
    struct channel_side *side = channel->own;
    MPI_Request *request = &side->request[side->turn % 2];
    int free = 1;
    if (*request != MPI_REQUEST_NULL && !comm_is_broken(comm))
        COMM_OK(comm, MPI_Test, request, &free, MPI_STATUS_IGNORE);
    if (comm_is_broken(comm)) {
        channel_lose(comm, found, channel);
        return true;
    }
    if (!free)
        return false;
    side->copies = side_is_large(side) && !side->written;
    const size_t bytes = side->copies ? 0 : channel_isend(comm, side);
    if (bytes) {
        atomic_fetch_add_explicit(&comm->messages, 1, memory_order_relaxed);
        atomic_fetch_add_explicit(&comm->bytes, bytes, memory_order_relaxed);
    }
    comm_found_over(found, &channel->post);
    return true;
}

/* A receive that was posted becomes a request; that of a large message is posted now. */
static void channel_await(struct comm *comm, struct comm_found *found, struct comm_channel *channel)
{
    struct channel_side *side = channel->own;
    MPI_Request *posted = &side->request[side->turn % 2];
    if (comm_is_broken(comm) ||
        (side_is_large(side) &&
         !comm_pieces_receive(comm, (struct comm_request){.over = comm_channel_came,
                                                          .what = channel,
                                                          .into = side->buffer[side->turn % 2],
                                                          .left = channel->bytes,
                                                          .from = channel->peer,
                                                          .tag = channel->tag}))) {
        channel_lose(comm, found, channel);
        return;
    }
    comm->channels.awaited++;
    if (side_is_large(side))
        return;
    *comm_request_next(comm) = *posted;
    comm_request_add(comm, comm_channel_came, channel);
    *posted = MPI_REQUEST_NULL;
}

bool comm_channel_begin(struct comm *comm, struct comm_found *found, struct comm_channel *channel)
{
    if (channel->sends)
        return channel_send(comm, found, channel);
    channel_await(comm, found, channel);
    return true;
}

void comm_channel_came(struct comm *comm, struct comm_found *found, void *what)
{
    struct comm_channel *channel = what;
    struct channel_side *side = channel->own;
    comm->channels.awaited--;
    atomic_fetch_add_explicit(&comm->came, 1, memory_order_relaxed);
    comm_note(comm, false, channel->peer, channel->bytes);
    side->copies = side_is_large(side);
    if (!side->copies) {
        comm->setup.owner->unpack(channel, side->buffer[side->turn % 2]);
        channel_post_receive(comm, side, side->turn++);
    }
    comm_found_over(found, &channel->post);
}

bool comm_channel_copy(struct comm *comm, struct comm_channel *channel)
{
    struct channel_side *side = channel->own;
    void *buffer = side->buffer[side->turn % 2];
    if (!side->copies)
        return true;
    side->copies = false;
    if (channel->sends) {
        side->written = comm->setup.owner->pack(channel, buffer);
        comm_post(comm, &channel->post);
        return false;
    }
    comm->setup.owner->unpack(channel, buffer);
    side->turn++;
    return true;
}

void comm_channels_give_up(struct comm *comm)
{
    comm_arrivals_also(&comm->arrivals, -comm->channels.awaited);
    comm->channels.awaited = 0;
    for (int i = comm->requests.n - 1; i >= 0; i--) {
        if (comm->requests.of[i].over != comm_channel_came)
            continue;
        MPI_Request posted = comm->requests.request[i];
        struct comm_channel *channel = comm_request_take(comm, i).what;
        struct channel_side *side = channel->own;
        side->request[side->turn % 2] = posted;
        comm_post(comm, &channel->post);
    }
}
