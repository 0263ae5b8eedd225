#ifndef DUITE_COMM_COMM_H
#define DUITE_COMM_COMM_H

#include "runtime/base/monitor.h"
#include "runtime/comm/history.h"
#include "runtime/comm/message.h"
#include "runtime/data/object.h"

#include <mpi.h>

/* All of the communication but message.h: its start and end, collective calls, idle ranks. A poll
 * does all it can and never waits. Only the holder of `lock` calls MPI; packets are delivered after
 * the lock is let go. */

/* The layers above, as they handle messages; `context` is theirs. Any thread. All but `packet` and
 * `broke` are called without the lock. */
struct comm_owner {
    /* The packet of a letter that is about to be sent, under its key. NULL without memory. */
    struct data_packet *(*packet)(struct comm_letter *letter);
    /* A letter is sent, or never will be. */
    void (*sent)(void *context, struct worker *worker, struct comm_letter *letter);
    /* A task of another rank came. False without memory: then the packet stays the caller's. */
    bool (*came)(void *context, struct worker *worker, struct data_packet *packet);
    /* Communication broke: whoever waits for messages is to look. */
    void (*broke)(void *context);
    /* A channel writes its message and returns the bytes; reads its message; or none will come.
     * Then it is `through`. */
    size_t (*pack)(struct comm_channel *channel, void *message);
    void (*unpack)(struct comm_channel *channel, const void *message);
    void (*lose)(struct comm_channel *channel);
    void (*through)(void *context, struct worker *worker, struct comm_channel *channel);
};

/* A trace. `message` is called for each message that is sent or received, with its bytes; `begins`
 * and, if that returned true, `ends` around the work on messages, in which tasks may run that a
 * message made ready. */
struct comm_report {
    void (*message)(struct worker *worker, bool sends, int peer, size_t bytes);
    bool (*begins)(struct worker *worker);
    void (*ends)(struct worker *worker);
};

/* The program, as a comm knows it. The ranks compare history and homes; a sentence about a
 * difference names kernels. */
struct comm_setup {
    const struct comm_owner *owner;
    void *context;
    struct comm_history *history;
    const struct data_table *table;
    const duite_kernel *const *kernels;
    uint32_t n_kernels;
    struct base_monitor *monitor;     /* gives heartbeats */
    const struct comm_report *report; /* NULL: there is no trace */
};

/* Calls MPI: COMM_MPI(MPI_Comm_rank, comm, &rank). DUITE_OK; or DUITE_E_MPI, with the call and
 * MPI's reason as the message. */
#define COMM_MPI(call, ...) comm_mpi(call(__VA_ARGS__), #call)
int comm_mpi(int mpi, const char *call);

/* Starts on mpi, which stays the caller's and is for these messages only. Local. Errors:
 * DUITE_E_MPI, memory; comm_stop is due even then. */
int comm_start(struct comm **comm, MPI_Comm mpi, const struct comm_setup *setup);

/* Before comm_open, on all ranks alike. A rank that sends no heartbeat for so many seconds is lost
 * (0: never). `host`: of the rank before this one in the ring. NULL is fine. */
void comm_ring(struct comm *comm, double seconds, const char *host);

/* Messages are sent and received from now on. `requests`, the same on all ranks: ranks may request
 * tasks of others. Until then the lock keeps workers out of MPI, so that the main thread may call
 * it while it starts. All ranks call this or none. NULL is fine. */
void comm_open(struct comm *comm, bool requests);

/* The kernels from now on. Under the lock (comm_hold). */
void comm_set_kernels(struct comm *comm, const duite_kernel *const *kernels, uint32_t n);

/* Frees everything; no other thread and no task is left. Collective: all ranks have agreed
 * (COMM_AGREES) that nothing is on its way; or communication is broken, and this waits until that
 * is so. False if MPI may still use its communicator, which then must not be freed. */
bool comm_stop(struct comm *comm);

/* After COMM_NEEDS_TAGS: settling waits until the channels that the program dropped on this rank
 * are closed; met: all ranks have settled. Main thread. */
int comm_channels_settle(struct comm *comm);
void comm_channels_met(struct comm *comm);

/* True while messages of channels are awaited. Any thread. */
bool comm_awaits(struct comm *comm);

/* Sends, receives, delivers and finishes what can be. Returns whether anything happened. Any
 * thread. */
bool comm_poll(struct comm *comm, struct worker *worker);

/* Calls back with everything awaited (see comm_arrivals_look) and, if the lock can be had, with
 * everything being sent. Returns whether it could be had. Waiters for awaited values stay as they
 * are during the call. Any thread. */
struct comm_looker {
    void *context;
    void (*awaited)(void *context, const struct data_key *key, const struct comm_target *target,
                    uint32_t packets);
    void (*sending)(void *context, const struct comm_letter *letter);
    /* A channel whose message has not come or, if it sends, waits for its buffer. */
    void (*channel)(void *context, const struct comm_channel *channel);
};
bool comm_look(struct comm *comm, const struct comm_looker *looker);

/* A number that changes with each message that comes or goes. */
uint64_t comm_movement(struct comm *comm);

/* Results of tasks on other ranks that named no task of this rank: an error of their sender. */
uint64_t comm_refused(struct comm *comm);

/* ---- The machine, at start ---- */

/* The ranks of one host that share their cores with this one. */
struct comm_host {
    MPI_Comm sharers; /* these ranks, until their workers are counted */
    unsigned ranks;   /* this one among them */
    unsigned before;  /* workers of the ranks below this one */
    unsigned total;   /* workers of all of them */
};

/* hash: of the cores this rank may use. Collective over mpi. Errors: DUITE_E_MPI, on all ranks;
 * comm_host_count is not due then. */
int comm_host_find(struct comm_host *host, MPI_Comm mpi, uint64_t hash);
/* threads: workers of this rank. Collective over the ranks of the host. Errors: DUITE_E_MPI. */
int comm_host_count(struct comm_host *host, unsigned threads);

/* Measures the cost of a message between ranks. Before comm_open; collective, blocks. A failure is
 * told by the next call. */
void comm_measure(struct comm *comm);

/* Seconds for a message and its answer, of so many bytes together. */
double comm_transfer(const struct comm *comm, size_t bytes);

/* ---- Idle ranks ---- */

/* Requests tasks of a rank, for so many idle workers. The request stands there for so many seconds,
 * or until a task is granted or the next one comes. No rank waits for a grant, and requests do not
 * count as movement of the program. False: not now. */
bool comm_request(struct comm *comm, struct worker *worker, int rank, unsigned idle,
                  double seconds);

/* A request that stands here. */
struct comm_requester {
    int rank;
    unsigned idle;
    double until; /* 0: none */
};

/* True if there may be a request; takes one (false: none now); puts back one that got no grant. */
bool comm_has_requests(struct comm *comm);
bool comm_take_request(struct comm *comm, struct comm_requester *requester);
void comm_return_request(struct comm *comm, const struct comm_requester *requester);

/* ---- Calls that block, made by all ranks alike ---- */

/* This rank enters a blocking call; the fingerprint is that of its forks so far. True if the log is
 * full: all ranks must agree now. Main thread. */
bool comm_call(struct comm *comm, const char *name, uint64_t fingerprint);

/* This rank waits for data in the call, or no longer waits; NULL is fine. If a difference between
 * ranks is found while it waits, communication breaks. Main thread. */
void comm_waits(struct comm *comm, bool waits);

enum { COMM_WORD_NUMBERS = sizeof(struct data_failure) / sizeof(double) };

/* A rank's contribution to a collective call. */
struct comm_word {
    uint64_t fingerprint; /* to be the same on all */
    uint64_t failed;      /* number + 1 of this rank's first failed task in fork order, or 0 */
    union {
        struct data_failure failure;
        double number[COMM_WORD_NUMBERS];
    };
};

/* The kinds of collective calls. */
enum comm_collective {
    /* Compares own->fingerprint (the forks) and the homes of all ranks; words[0].failed becomes 1
     * if a task failed on any rank, else 0. One small reduction. If ranks differ communication
     * breaks, with DUITE_E_DIFFERENT and a message that names the first difference. */
    COMM_AGREES,
    /* Gathers the words of all ranks, which agreed on this call before. */
    COMM_GATHERS
};

/* A collective call: enters it, then asks again and again, and works meanwhile. comm_is_entered:
 * true once the call is over, or communication broke. The words are the comm's, and good until the
 * next call. Main thread. */
void comm_enter(struct comm *comm, enum comm_collective kind, const struct comm_word *own);
bool comm_is_entered(void *comm);
const struct comm_word *comm_words(const struct comm *comm);

/* ---- When it breaks ----
 *
 * A rank that lost a message, or cannot go on for another reason, breaks. From then on it sends
 * only an abort message with the reason to all others, which break in turn. Blocking calls return
 * the code; the main thread gives up everything still expected; only stop is left. */

/* True once communication is broken; NULL is fine. comm_error: its code, with the message set; else
 * 0. */
bool comm_is_broken(struct comm *comm);
int comm_error(struct comm *comm);

/* True if MPI failed or a rank is lost, even if it broke for another reason: messages may stay on
 * their way for ever, and MPI must not be relied on, nor finalised. */
bool comm_is_lost(struct comm *comm);

/* After comm_is_lost: polls for a moment, so that the abort messages go out. Main thread. */
void comm_part(struct comm *comm, struct worker *worker);

/* Between hold and let_go the caller alone calls MPI: nothing is sent or received. NULL is fine.
 * Main thread. */
void comm_hold(struct comm *comm);
void comm_let_go(struct comm *comm);

/* The workers end: they are no longer woken if communication breaks. Main thread. */
void comm_workers_end(struct comm *comm);

/* After it broke: takes everything expected for lost. Main thread. */
void comm_give_up(struct comm *comm, struct worker *worker);

/* Ticks so far in which this rank awaited messages. Any thread. */
uint64_t comm_awaited_ticks(const struct comm *comm);

/* Messages and bytes sent by this rank so far. */
void comm_count(struct comm *comm, uint64_t *messages, uint64_t *bytes);

#endif
