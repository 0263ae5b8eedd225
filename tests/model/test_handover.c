/* Messages to send (runtime/comm). Each thread that posts one polls afterwards, but only one polls
 * at a time. It sends what others post meanwhile, or the main thread does when it leaves a
 * collective call. No message may be left when all have polled. MPI sends at once here and receives
 * nothing. */
#include "tests/model/runtime.h"

#include "runtime/comm/comm.h"
#include "runtime/comm/internal.h"

enum { POSTS = 4 };

static struct {
    struct comm *comm;
    struct data_packet packet[POSTS];
    struct comm_letter letter[POSTS];
    int sent[POSTS], finished[POSTS];
    int turns;        /* of the wait for a collective call */
    _Atomic int over; /* the other thread has polled */
    int inside;       /* 1 + the thread that calls MPI, or 0 */
} its;

/* ---- What comm calls ---- */

static struct data_packet *packet_of(struct comm_letter *letter)
{
    return letter->packet;
}

static void finished(void *context, struct worker *worker, struct comm_letter *letter)
{
    (void)context, (void)worker;
    its.finished[letter - its.letter]++;
}

static const struct comm_owner sender = {.packet = packet_of, .sent = finished};

static int isend(const struct data_packet *packet, MPI_Request *request)
{
    int self = (int)explore_self();
    explore_check(!its.inside || its.inside == 1 + self);
    its.inside = 1 + self;
    its.sent[packet - its.packet]++;
    *request = MPI_REQUEST_NULL;
    return MPI_SUCCESS;
}

static int testsome(int n, int *done)
{
    its.inside = 0;
    *done = n;
    return MPI_SUCCESS;
}

static int done_at_once(int *done)
{
    *done = 1;
    return MPI_SUCCESS;
}

static int one_rank(int *value)
{
    *value = 0;
    return MPI_SUCCESS;
}

static int success(int n, ...)
{
    (void)n;
    return MPI_SUCCESS;
}

/* No recorded graph has channels here. */
int comm_channels_start(struct comm *comm)
{
    (void)comm;
    return 0;
}

bool comm_channels_stop(struct comm *comm)
{
    (void)comm;
    return true;
}

bool comm_channel_begin(struct comm *comm, struct comm_found *found, struct comm_channel *channel)
{
    (void)comm, (void)found, (void)channel;
    return true;
}

bool comm_channel_copy(struct comm *comm, struct comm_channel *channel)
{
    (void)comm, (void)channel;
    return true;
}

/* No heartbeat is due. */
void comm_heartbeat_pass(struct comm *comm)
{
    (void)comm;
}

void comm_channels_give_up(struct comm *comm)
{
    (void)comm;
}

void comm_channel_came(struct comm *comm, struct comm_found *found, void *channel)
{
    (void)comm, (void)found, (void)channel;
}

#define data_packet_free(packet)                               ((void)(packet))
#define MPI_Comm_rank(comm, rank)                              one_rank(rank)
#define MPI_Comm_size(comm, size)                              one_rank(size)
#define MPI_Isend(packet, n, type, to, tag, comm, request)     ((void)(n), isend(packet, request))
#define MPI_Request_free(request)                              success(0, request)
#define MPI_Testsome(n, request, done, index, status)          testsome(n, done)
#define MPI_Improbe(source, tag, comm, there, message, status) one_rank(there)
#define MPI_Iallgather(...)                                    success(0, __VA_ARGS__)
#define MPI_Iallreduce(...)                                    success(0, __VA_ARGS__)
#define MPI_Test(request, done, status)                        done_at_once(done)
#define MPI_Type_contiguous(n, type, new_type)                 ((void)(n), success(0, new_type))
#define MPI_Type_commit(type)                                  success(0, type)
#define MPI_Type_free(type)                                    success(0)
#define comm_heartbeat_start(comm, monitor)                    ((void)(monitor), success(0))
#define comm_heartbeat_stop(comm)                              success(0)

#include "runtime/comm/collective.c"
#include "runtime/comm/comm.c"
#include "runtime/comm/requests.c"
#include "runtime/comm/transport.c"

/* ---- The threads ---- */

static void start(void)
{
    memset(&its, 0, sizeof its);
    for (size_t i = 0; i < POSTS; i++)
        its.letter[i].packet = &its.packet[i];
    explore_check(!comm_start(&its.comm, MPI_COMM_NULL, &(struct comm_setup){.owner = &sender}));
    comm_open(its.comm, false);
}

static void post(int i)
{
    comm_send(its.comm, &its.letter[i]);
}

static void poll(void)
{
    comm_poll(its.comm, NULL);
}

static void post_and_poll(void)
{
    post((int)explore_self());
    poll();
}

static void post_two(void)
{
    post(2);
    post(3);
    poll();
}

/* Fair: the other thread ends at some time. */
static void between(void)
{
    poll();
    if (++its.turns == 2)
        explore_await(&its.over);
}

static void collective(void)
{
    comm_enter(its.comm, COMM_GATHERS, &(struct comm_word){0});
    while (!comm_is_entered(its.comm))
        between();
}

static void post_beside(void)
{
    post_and_poll();
    atomic_store(&its.over, 1);
}

static void end(void)
{
    int posted = 0;
    for (int i = 0; i < POSTS; i++) {
        posted += its.sent[i];
        explore_check(its.sent[i] <= 1 && its.finished[i] == its.sent[i]);
    }
    explore_check(!its.comm->posts);
    explore_check(posted > 0);
}

static const struct explore_case two = {
    .name = "two post", .start = start, .thread = {post_and_poll, post_and_poll}, .end = end};
static const struct explore_case more = {
    .name = "one posts, one two", .start = start, .thread = {post_and_poll, post_two}, .end = end};
static const struct explore_case beside = {.name = "one posts beside a collective call",
                                           .start = start,
                                           .thread = {collective, post_beside},
                                           .end = end};
static const struct explore_case mixed = {.name = "one posts, one two, one polls",
                                          .start = start,
                                          .thread = {post_and_poll, post_two, poll},
                                          .end = end};
static const struct explore_case three = {.name = "three post",
                                          .start = start,
                                          .thread = {post_and_poll, post_and_poll, post_and_poll},
                                          .end = end};

int main(int argc, char **argv)
{
    const struct explore_plant no_fence = {"comm_left_to_us", "fence", EXPLORE_DROP},
                               no_look = {"comm_has_posts", "&comm->posts", EXPLORE_DROP};
    explore_begin(argc, argv);
    explore_passes(&two);
    explore_passes(&more);
    explore_passes(&beside);
    if (explore_deep()) {
        explore_passes(&mixed);
        explore_passes(&three);
    }
    explore_finds(&two, no_fence);
    explore_finds(&two, no_look);
    explore_finds(&beside, no_fence);
    explore_finds(&beside, no_look);
    return explore_end();
}
