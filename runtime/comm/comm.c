/* Start, stop and progress. Letters and channels wait in a lock-free stack, linked by themselves,
 * until a thread polls. The holder of the lock calls MPI; a poll delivers its findings after it has
 * let go of the lock. */
#include "runtime/comm/comm.h"

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/base/stack.h"
#include "runtime/comm/internal.h"

#include <sched.h>
#include <time.h>

/* ---- Start and stop ---- */

/* A type of so many bytes. */
static int bytes_type(size_t bytes, MPI_Datatype *type)
{
    const int code = COMM_MPI(MPI_Type_contiguous, (int)bytes, MPI_BYTE, type);
    return code ? code : COMM_MPI(MPI_Type_commit, type);
}

static int comm_prepare(struct comm *comm)
{
    if (COMM_MPI(MPI_Comm_rank, comm->mpi, &comm->rank) ||
        COMM_MPI(MPI_Comm_size, comm->mpi, &comm->n_ranks))
        return DUITE_E_MPI;
    comm->words = base_alloc((size_t)(comm->n_ranks + 1) * sizeof *comm->words);
    if (!comm_control_start(comm) || !comm_calls_start(&comm->calls) || !comm->words)
        return base_no_memory("communication");
    if (bytes_type(sizeof(struct data_packet), &comm->line) ||
        bytes_type(sizeof(struct comm_word), &comm->word) || comm_channels_start(comm))
        return DUITE_E_MPI;
    return comm_heartbeat_start(comm, comm->setup.monitor);
}

int comm_start(struct comm **out, MPI_Comm mpi, const struct comm_setup *setup)
{
    struct comm *comm = *out = base_alloc_zero(sizeof *comm);
    if (!comm)
        return base_no_memory("communication");
    comm->setup = *setup;
    comm->mpi = mpi;
    comm->line = comm->word = MPI_DATATYPE_NULL;
    comm->request = MPI_REQUEST_NULL;
    atomic_flag_test_and_set(&comm->lock); /* until comm_open */
    atomic_init(&comm->posts, NULL);
    comm_arrivals_start(&comm->arrivals);
    return comm_prepare(comm);
}

void comm_set_kernels(struct comm *comm, const duite_kernel *const *kernels, uint32_t n)
{
    comm->setup.kernels = kernels;
    comm->setup.n_kernels = n;
}

void comm_open(struct comm *comm, bool requests)
{
    if (!comm)
        return;
    comm->open = true;
    comm->may_request = requests;
    comm_let_go(comm);
}

bool comm_stop(struct comm *comm)
{
    if (!comm)
        return true;
    if (comm->open)
        comm_control_end(comm);
    while (!comm_control_over(comm)) {
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
    if (comm->word != MPI_DATATYPE_NULL)
        MPI_Type_free(&comm->word);
    base_free(comm->requests.request);
    base_free(comm->requests.of);
    base_free(comm->requests.index);
    base_free(comm->requests.status);
    comm_control_stop(&comm->control);
    base_free(comm->calls.log);
    base_free(comm->calls.seen);
    base_free(comm->difference.inquiry);
    comm_arrivals_stop(&comm->arrivals);
    base_free(comm->words);
    base_free(comm);
    return true;
}

/* ---- Posts and the lock ---- */

void comm_post(struct comm *comm, struct comm_post *post)
{
    BASE_STACK_PUSH(&comm->posts, post, memory_order_release);
    /* Pairs with comm_left_to_us: either the next try for the lock succeeds, or its holder sees
     * this post. */
    atomic_thread_fence(memory_order_seq_cst);
}

void comm_send(struct comm *comm, struct comm_letter *letter)
{
    letter->post.is_channel = false;
    comm_post(comm, &letter->post);
}

bool comm_has_posts(struct comm *comm)
{
    return !BASE_STACK_IS_EMPTY(&comm->posts);
}

void comm_hold(struct comm *comm)
{
    while (comm && !comm_try_lock(comm))
        sched_yield();
}

void comm_let_go(struct comm *comm)
{
    if (comm)
        atomic_flag_clear_explicit(&comm->lock, memory_order_release);
}

void comm_workers_end(struct comm *comm)
{
    if (comm->open)
        comm_hold(comm); /* the monitor wakes a worker under it */
    comm->silent = true;
    if (comm->open)
        comm_let_go(comm);
}

/* ---- Progress ---- */

/* A channel that is through makes others ready; the pass that found it takes those. */
static _Thread_local bool passing __attribute__((tls_model("initial-exec")));

/* Other messages are looked for less often while a recorded graph waits for its own. */
enum { SELDOM = 8 };

/* One round under the lock. Control messages come last: an abort message goes out in the round that
 * broke communication, since the main thread may not poll again. */
static inline void comm_pass_locked(struct comm *comm, struct comm_found *found, bool looks)
{
    const int before = comm->channels.awaited;
    if (comm->stalled || !BASE_STACK_IS_EMPTY(&comm->posts))
        comm_transport_begin(comm, found);
    if (looks && !(comm->channels.awaited && ++comm->channels.looks % SELDOM))
        comm_transport_receive(comm, found);
    if (comm->requests.n)
        comm_requests_pass(comm, found);
    if (comm->channels.awaited != before) {
        comm_arrivals_also(&comm->arrivals, comm->channels.awaited - before);
        atomic_store_explicit(&comm->channels.awaits, comm->channels.awaited > 0,
                              memory_order_relaxed);
    }
    if (looks && comm_control_is_due(comm))
        comm_control_pass(comm);
    comm_heartbeat_pass(comm);
}

static inline bool comm_pass(struct comm *comm, struct worker *worker, bool looks)
{
    const bool outer = passing, noted = comm->setup.report && comm->setup.report->begins(worker);
    bool any = false, more;
    passing = true;
    do {
        struct comm_found found = {0};
        if (!comm_try_lock(comm))
            break;
        comm->worker = worker;
        comm_pass_locked(comm, &found, looks);
        comm_let_go(comm);
        any |= found.any;
        more = found.more;
        if (found.packets || found.over) {
            any = true;
            comm_transport_deliver(comm, worker, &found);
        }
    } while (more || comm_left_to_us(comm));
    passing = outer;
    if (noted)
        comm->setup.report->ends(worker);
    return any;
}

bool comm_poll(struct comm *comm, struct worker *worker)
{
    return comm_pass(comm, worker, true);
}

bool comm_awaits(struct comm *comm)
{
    return atomic_load_explicit(&comm->channels.awaits, memory_order_relaxed);
}

void comm_channel_ready(struct comm *comm, struct worker *worker, struct comm_channel *channel)
{
    channel->post.is_channel = true;
    comm_post(comm, &channel->post);
    if (!passing)
        comm_pass(comm, worker, false);
}

void comm_part(struct comm *comm, struct worker *worker)
{
    const double moment = 0.1;
    for (double since = base_seconds(); base_seconds() - since < moment; sched_yield())
        comm_poll(comm, worker);
}

void comm_count(struct comm *comm, uint64_t *messages, uint64_t *bytes)
{
    uint64_t requested = atomic_load(&comm->control.requested);
    *messages = atomic_load(&comm->messages) + requested;
    *bytes = atomic_load(&comm->bytes) + requested * sizeof(struct data_packet);
}

/* ---- Looks from outside: nothing is sent, received or changed ---- */

uint64_t comm_movement(struct comm *comm)
{
    return atomic_load(&comm->messages) + atomic_load(&comm->came);
}

uint64_t comm_refused(struct comm *comm)
{
    return atomic_load(&comm->arrivals.refused);
}

/* A poll holds the lock for microseconds, or as long as its thread has no core. A thread that
 * stands still inside MPI keeps the lock: then no look is possible. */
static bool comm_lock_soon(struct comm *comm)
{
    enum { TRIES = 100 };
    const struct timespec pause = {.tv_nsec = 1000000};
    for (int i = 0; i < TRIES; i++) {
        if (comm_try_lock(comm))
            return true;
        nanosleep(&pause, NULL);
    }
    return false;
}

bool comm_look(struct comm *comm, const struct comm_looker *looker)
{
    comm_arrivals_look(&comm->arrivals, looker->awaited, looker->context);
    if (!comm_lock_soon(comm))
        return false;
    for (int i = 0; i < comm->requests.n; i++) {
        const struct comm_request *of = &comm->requests.of[i];
        if (of->over == comm_letter_sent)
            looker->sending(looker->context, of->what);
        else if (of->over == comm_channel_came)
            looker->channel(looker->context, of->what);
    }
    for (const struct comm_post *post = comm->stalled; post; post = post->next)
        if (post->is_channel)
            looker->channel(looker->context, (const struct comm_channel *)post);
    comm_let_go(comm);
    return true;
}
