#ifndef DUITE_COMM_INTERNAL_H
#define DUITE_COMM_INTERNAL_H

#include "runtime/comm/arrivals.h"
#include "runtime/comm/channel.h"
#include "runtime/comm/comm.h"
#include "runtime/comm/control.h"
#include "runtime/comm/divergence.h"
#include "runtime/comm/heartbeat.h"
#include "runtime/comm/requests.h"

/* Shared by the files of this folder only. */

/* Tags: of packets, of heartbeats, and from the last one on of channels. */
enum { COMM_PACKETS, COMM_HEARTBEATS, COMM_CHANNELS };

/* What a small reduction takes the largest of; complements make it the smallest as well. */
struct comm_reduced {
    uint64_t fingerprint, not_fingerprint, homes, not_homes;
    uint64_t failed; /* minus comm_word.failed: the first failed task of all ranks, or 0 */
};
enum { COMM_REDUCED = sizeof(struct comm_reduced) / sizeof(uint64_t) };

/* The kinds of collective calls. */
enum comm_collective { COMM_AGREES, COMM_GATHERS, COMM_SUMS };

struct comm {
    MPI_Comm mpi;
    MPI_Datatype line; /* 64 bytes: see data_packet_lines */
    struct task_graph *graph;
    int rank, n_ranks;
    atomic_flag lock;
    _Atomic(struct task *) posts;
    struct comm_requests sends, receives; /* touched by the holder of `lock` only */
    struct comm_arrivals arrivals;
    struct comm_channels channels;
    _Atomic int broken;
    atomic_flag breaking;     /* taken by the one who breaks */
    struct comm_abort reason; /* of `broken`, written before it is set */
    struct comm_control control;
    struct comm_heartbeat heartbeat;
    struct comm_calls calls;
    comm_told *tell;                               /* NULL: nobody */
    struct worker *worker;                         /* under the lock: who passes */
    bool open, may_request;                        /* comm_open was called; with requests */
    double latency, per_byte;                      /* seconds: of the slowest link measured */
    uint64_t entered;                              /* collective calls */
    enum comm_collective kind;                     /* of the last of them */
    struct comm_reduced own, max;                  /* of the last agreement */
    double addend[COMM_SUMMED], sums[COMM_SUMMED]; /* of the last sum */
    MPI_Request request;                    /* of the last one; MPI_REQUEST_NULL once it is over */
    struct comm_word *words;                /* one a rank, and this rank's own */
    _Atomic uint64_t messages, bytes, came; /* the last one: received */
};

/* Joins the collective calls that other ranks entered before communication broke. All ranks are at
 * their end. */
void comm_catch_up(struct comm *comm);

/* True for MPI_SUCCESS; else communication is broken. */
bool comm_mpi_ok(struct comm *comm, int mpi, const char *what);

/* A message is sent, or came, or nobody is told. Under the lock. */
static inline void comm_note(const struct comm *comm, bool sends, int peer, size_t bytes)
{
    if (comm->tell)
        comm->tell(comm->worker, sends, peer, bytes);
}

static inline bool comm_is_broken(struct comm *comm)
{
    return atomic_load_explicit(&comm->broken, memory_order_acquire) != 0;
}

/* MPI itself failed, or a rank is lost: what is on its way may stay there. */
static inline bool comm_is_lost(struct comm *comm)
{
    int code = atomic_load_explicit(&comm->broken, memory_order_acquire);
    return code == DUITE_E_MPI || code == DUITE_E_LOST;
}

static inline bool comm_try_lock(struct comm *comm)
{
    return !atomic_flag_test_and_set_explicit(&comm->lock, memory_order_acquire);
}

static inline void comm_unlock(struct comm *comm)
{
    atomic_flag_clear_explicit(&comm->lock, memory_order_release);
}

/* To be asked after comm_unlock: what was posted meanwhile by those who did not get the lock must
 * not wait for the next poll. Against comm_send: it tries the lock after this look, or its post is
 * seen here. */
static inline bool comm_left_to_us(struct comm *comm)
{
    atomic_thread_fence(memory_order_seq_cst);
    return comm_posted(comm);
}

#endif
