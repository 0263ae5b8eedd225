#ifndef DUITE_COMM_INTERNAL_H
#define DUITE_COMM_INTERNAL_H

#include "runtime/base/monitor.h"
#include "runtime/base/stack.h"
#include "runtime/comm/comm.h"
#include "runtime/comm/control.h"

#include <pthread.h>

/* For the files of this folder only: the parts of a comm (control.h has the control messages), then
 * the comm itself. "Under the lock" means: the caller holds comm->lock. */

/* Tags of packets, of heartbeats and of pieces of packets; channels have COMM_CHANNELS and all
 * above. */
enum { COMM_PIECE_TAGS = 16 };
enum { COMM_PACKETS, COMM_HEARTBEATS, COMM_PIECES, COMM_CHANNELS = COMM_PIECES + COMM_PIECE_TAGS };

/* The findings of one poll, delivered after the lock is let go. */
struct comm_found {
    struct data_packet *packets;
    struct comm_post *over; /* letters that are sent, channels that are through or to be copied */
    bool any;
    bool more; /* so much came that the lock is let go before the rest is received */
};

/* ---- Requests (requests.c); all of it under the lock ---- */

/* A request is over: a letter is sent, a packet came, and so on. It may add others. */
typedef void comm_over(struct comm *comm, struct comm_found *found, void *what);

struct comm_request {
    comm_over *over;
    void *what;
    bool failed;
    char *into; /* of a large message: where the rest of it is received, and from whom */
    size_t left;
    int from, tag;
};

struct comm_requests {
    MPI_Request *request;
    struct comm_request *of;
    int *index; /* this and the next for MPI_Testsome */
    MPI_Status *status;
    int n;
    size_t capacity[4];
    size_t reserved; /* more of them that must find room: of control messages and channels */
};

/* Room for n more beside those reserved. False without memory. */
bool comm_requests_room(struct comm *comm, size_t n);

/* A request is added in two steps, if there is room: MPI writes it to the next place; then it
 * counts. */
MPI_Request *comm_request_next(struct comm *comm);
void comm_request_add(struct comm *comm, comm_over *over, void *what);

/* Takes the request at place i out of the table; the last one gets its place. */
struct comm_request comm_request_take(struct comm *comm, int i);

/* Tests all, and ends those that are over. */
void comm_requests_pass(struct comm *comm, struct comm_found *found);

/* A message of more bytes than this is sent in pieces of so many. MPI may copy a whole message in
 * one call, seconds long if it is large, and the lock is held meanwhile; it is let go between two
 * pieces. A piece takes some 10 ms. Tests make pieces smaller, alike on all ranks. */
enum { COMM_PIECE_BYTES = 1 << 24 };
extern size_t comm_piece_bytes;

static inline bool comm_is_large(size_t bytes)
{
    return bytes > comm_piece_bytes;
}

/* Sends all pieces; the request is over when the receiver has all but the last, which it is
 * receiving. Returns MPI's code. */
int comm_pieces_send(struct comm *comm, const void *from, size_t bytes, int to, int tag,
                     MPI_Request *request);

/* Adds the request of all pieces, if there is room. False: MPI failed, which is told. */
bool comm_pieces_receive(struct comm *comm, struct comm_request of);

/* Receives all pieces, which are on their way, and forgets them. */
void comm_pieces_forget(struct comm *comm, size_t bytes, int from, int tag);

/* ---- Transport: packets between ranks (transport.c) ---- */

/* Under the lock: begins what was posted; receives messages. */
void comm_transport_begin(struct comm *comm, struct comm_found *found);
void comm_transport_receive(struct comm *comm, struct comm_found *found);

/* A letter's request is over. */
comm_over comm_letter_sent;

/* Without the lock: delivers the findings. */
void comm_transport_deliver(struct comm *comm, struct worker *worker, struct comm_found *found);

/* ---- Arrivals (arrivals.c) ---- */

/* The time in which messages were awaited. `clock` is one word, so it can be read without a lock.
 * While none is awaited it holds the ticks so far, with bit 0 clear. Otherwise it holds these minus
 * the moment at which waiting began, with bit 0 set. Written under the lock of its owner. */
struct comm_gauge {
    uint64_t awaited; /* messages */
    _Atomic uint64_t clock;
};

/* Matches packets that arrive with their targets, whichever comes first. Safe from any thread. */
struct comm_arrivals {
    pthread_mutex_t lock;
    bool closed;
    _Atomic uint64_t refused; /* results that nobody expected */
    struct comm_gauge gauge;  /* of the packets that are expected and not there, but for results */
    struct comm_arrival
        *table; /* uthash by key: expected and not all there, or there and not expected yet */
};

void comm_arrivals_start(struct comm_arrivals *arrivals);
void comm_arrivals_stop(struct comm_arrivals *arrivals); /* frees packets never wanted */

/* Notes a target for so many packets; *early gets those that came already, linked by next. False
 * without memory, and once it is closed. */
bool comm_arrivals_expect(struct comm_arrivals *arrivals, struct data_key key,
                          struct comm_target target, uint32_t packets, struct data_packet **early);

enum comm_take {
    COMM_WANTED,  /* *target is set: deliver it */
    COMM_KEPT,    /* until it is expected */
    COMM_LOST,    /* it is wanted nowhere, or there is no memory: the caller frees it */
    COMM_REFUSED, /* a result, which is expected before it can come: likewise */
};

/* A packet came. */
enum comm_take comm_arrivals_take(struct comm_arrivals *arrivals, struct data_packet *packet,
                                  struct comm_target *target);

/* Adds messages that are awaited elsewhere to the gauge; negative: takes them off. */
void comm_arrivals_also(struct comm_arrivals *arrivals, int messages);

/* Calls back with everything awaited and its number of packets. No awaited packet is handed out
 * during the call. */
void comm_arrivals_look(struct comm_arrivals *arrivals,
                        void (*awaited)(void *context, const struct data_key *key,
                                        const struct comm_target *target, uint32_t packets),
                        void *context);

/* After the first call no packet is expected, and those that come are lost. Each call takes one
 * waiting target, once for every packet that it wants; false: there are no more. */
bool comm_arrivals_close(struct comm_arrivals *arrivals, struct comm_target *target);

/* ---- Tags of channels (tags.c) ---- */

struct comm_tag_range {
    int first, n;
    bool dropped; /* by the program, since the ranks met */
};

/* Main thread. */
struct comm_tags {
    struct comm_tag_range *range; /* of the plans that the program holds, and of those above `next`
                                     that it dropped; in no order */
    size_t n, capacity;
    int next, last; /* last: the largest that MPI has */
};

/* n tags for a plan, the same on all ranks. COMM_NEEDS_TAGS: there are none before the ranks meet.
 * Errors: memory. */
int comm_tags_take(struct comm_tags *tags, int n, int *first);

/* The program drops the plan whose tags begin here. */
void comm_tags_drop(struct comm_tags *tags, int first);

/* Plans that the program holds. */
size_t comm_tags_held(const struct comm_tags *tags);

/* ---- Channels (channel.c) ---- */

/* A channel has two buffers and, if it receives, a receive posted for each of them, so that a
 * message finds its place when it comes a round early. Its tag is its alone. */

struct comm_group; /* the channels of one set */

struct comm_channels {
    int awaited;                      /* under the lock: requests of channels */
    struct comm_group *open, *closed; /* under the lock; closed: some messages are still sent */
    unsigned looks;
    struct comm_tags tags;
    _Atomic bool awaits; /* there are some */
};

/* Starts the channels: asks MPI for its largest tag. Before the lock is used. Errors: MPI's. */
int comm_channels_start(struct comm *comm);
/* Under the lock, at the end: false if MPI may still read or write memory, which then stays. */
bool comm_channels_stop(struct comm *comm);

/* Under the lock: sends a channel's message, or awaits it. False: its buffer is still sent. */
bool comm_channel_begin(struct comm *comm, struct comm_found *found, struct comm_channel *channel);

/* The receive of a channel's message is over. */
comm_over comm_channel_came;

/* Without the lock, for a channel that is over. One whose message is large writes it, and is posted
 * again; or reads the one that came. True: it is through. */
bool comm_channel_copy(struct comm *comm, struct comm_channel *channel);

/* Under the lock: communication is broken, and nothing is awaited any more. */
void comm_channels_give_up(struct comm *comm);

/* ---- Heartbeats (heartbeat.c) ---- */

/* Ranks stand in a ring: each sends the next one a heartbeat sixteen times in `seconds`, and
 * listens to the one before it. If that one is not heard at sixteen looks in a row it is lost: then
 * communication breaks, and abort messages tell all others. So a rank sends and hears one message a
 * look, however many ranks there are. If the ring is cut in two, both parts find out: on each side
 * a rank listens to one of the other side.
 *
 * The monitor sends heartbeats, not the poll of the workers: all workers may be inside long bodies,
 * and such a rank is not lost. The monitor calls MPI under the lock, like the workers. The lock is
 * hardly ever free while they move large messages, so its holder makes the look that is due.
 * Silence is counted in looks, not in seconds, so that the time in which this process itself was
 * stopped, or got no core, does not count. */
enum { COMM_SILENT_LOOKS = 16, COMM_HOST_NAME = 64 };

/* State of a look that the monitor cannot make itself: it declares the look due, the holder of the
 * lock makes it, and the monitor takes notice. */
enum comm_look_state { COMM_LOOK_NOT_DUE, COMM_LOOK_DUE, COMM_LOOK_MADE };

struct comm_heartbeat {
    struct base_monitor *monitor;
    struct base_look look;
    _Atomic int state;         /* enum comm_look_state */
    double seconds;            /* until a silent rank is lost; 0: no rank listens */
    char host[COMM_HOST_NAME]; /* of the rank before this one */
    /* Under the lock of the comm: */
    bool last_sent, last_heard;
    unsigned silent; /* looks in a row */
    char out, in;    /* a heartbeat, or the last one */
    MPI_Request sent, heard;
};

/* Registers with the monitor, which does nothing before comm_ring. comm_heartbeat_stop is
 * due all the same. Errors: DUITE_E_SYSTEM, memory. */
int comm_heartbeat_start(struct comm *comm, struct base_monitor *monitor);

/* Under the lock of the comm: makes the look if one is due. */
void comm_heartbeat_pass(struct comm *comm);

/* Ends the monitor's looks; no other thread but the monitor is left. All ranks are at their end.
 * Unless communication is lost, takes leave of both neighbours, so that no heartbeat is on its way
 * afterwards. */
void comm_heartbeat_stop(struct comm *comm);

/* ---- Collective calls (collective.c) ---- */

/* Numbers of a small reduction, which finds the largest; complements give the smallest as well.
 * MPICH 4.0 compares them as if they had a sign. */
struct comm_reduced {
    uint64_t fingerprint, not_fingerprint, homes, not_homes;
    uint64_t failed; /* 1 if a task failed on any rank, else 0 */
};
enum { COMM_REDUCED = sizeof(struct comm_reduced) / sizeof(uint64_t) };

/* ---- The comm ---- */

struct comm {
    MPI_Comm mpi;
    MPI_Datatype line; /* 64 bytes: see data_packet_lines */
    MPI_Datatype word; /* struct comm_word */
    struct comm_setup setup;
    int rank, n_ranks;
    atomic_flag lock;
    _Atomic(struct comm_post *) posts;
    struct comm_requests requests; /* touched by the holder of `lock` only, like: */
    struct comm_post *stalled;     /* wait for others, in the order of their posts */
    struct comm_arrivals arrivals;
    struct comm_channels channels;
    _Atomic int broken;
    _Atomic bool lost;    /* MPI failed or a rank is lost, even if it broke for another reason */
    atomic_flag breaking; /* taken by the one who breaks */
    struct comm_abort reason; /* of `broken`, written before it is set */
    struct comm_control control;
    struct comm_heartbeat heartbeat;
    struct comm_calls calls;
    struct comm_difference difference;
    struct worker *worker;     /* under the lock: the one that passes */
    bool open, may_request;    /* comm_open was called; with requests */
    bool silent;               /* the owner is not told that it broke */
    double latency, per_byte;  /* seconds: of the slowest link measured */
    uint64_t entered;          /* collective calls */
    enum comm_collective kind; /* of the last of them */
    enum comm_collective next; /* the one to enter, if `enters`, once the lock can be had */
    bool enters;
    struct comm_reduced own, max;           /* of the last agreement */
    MPI_Request request;                    /* of the last one; MPI_REQUEST_NULL once it is over */
    struct comm_word *words;                /* one a rank, and this rank's own */
    _Atomic uint64_t messages, bytes, came; /* sent, and of these the bytes; received */
};

/* Posts; the caller makes sure that a worker polls afterwards. Any thread. */
void comm_post(struct comm *comm, struct comm_post *post);

static inline void comm_found_over(struct comm_found *found, struct comm_post *post)
{
    post->next = found->over;
    found->over = post;
}

/* Joins the collective calls that other ranks entered before communication broke. All ranks are at
 * their end. */
void comm_catch_up(struct comm *comm);

/* True for MPI_SUCCESS; else communication is broken. cut: true even if a message was longer than
 * what it was received into. */
#define COMM_OK(comm, call, ...) comm_mpi_ok(comm, call(__VA_ARGS__), #call)
bool comm_mpi_ok(struct comm *comm, int mpi, const char *call);
bool comm_mpi_cut(struct comm *comm, int mpi, const char *call);
/* The class of MPI's code: MPI_ERR_TRUNCATE and so on. */
int comm_mpi_class(int mpi);

/* Reports a message, if there is a report: before it is sent, so that it never comes before it was
 * sent, and after it came. Under the lock. */
static inline void comm_note(const struct comm *comm, bool sends, int peer, size_t bytes)
{
    if (comm->setup.report)
        comm->setup.report->message(comm->worker, sends, peer, bytes);
}

static inline bool comm_try_lock(struct comm *comm)
{
    return !atomic_flag_test_and_set_explicit(&comm->lock, memory_order_acquire);
}

/* Ask after comm_let_go: letters posted meanwhile, by threads that did not get the lock, must not
 * wait for the next poll. Pairs with comm_send: it tries the lock after this look, or this look
 * sees its post. */
static inline bool comm_left_to_us(struct comm *comm)
{
    atomic_thread_fence(memory_order_seq_cst);
    return comm_has_posts(comm);
}

/* True if comm_control_pass has work. Most polls have none, so this looks at four numbers instead
 * of making five calls. Under the lock. */
static inline bool comm_control_is_due(struct comm *comm)
{
    const struct comm_calls *calls = &comm->calls;
    return comm_is_broken(comm) || comm->difference.until > 0 ||
           atomic_load_explicit(&calls->waits, memory_order_relaxed) ||
           atomic_load_explicit(&calls->made, memory_order_relaxed) != calls->compared;
}

#endif
