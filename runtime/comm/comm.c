/* Posts wait in a lock-free stack until somebody polls; requests live in two arrays that only the
 * holder of `lock` touches. */
#include "runtime/comm/comm.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/base/pool.h"
#include "runtime/comm/arrivals.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Something to send, or being sent. */
struct post {
    struct post *next;
    struct graph_task *task; /* SEND: finished once the bytes are gone */
    struct data_packet
        *packet; /* freed once they are gone; NULL: the task's version is sent as it lies */
    int to;
};

/* Requests under way, and what each is about: a post or a packet. */
struct requests {
    MPI_Request *request;
    void **what;
    int *index; /* scratch for MPI_Testsome */
    int n;
    size_t capacity[3];
};

struct comm {
    MPI_Comm mpi;
    MPI_Datatype line; /* 64 bytes: see data_packet_lines */
    struct graph *graph;
    atomic_flag lock;
    _Atomic(struct post *) posts;
    struct requests sends, receives;
    struct comm_arrivals arrivals;
    _Atomic int broken;
    char sentence[MPI_MAX_ERROR_STRING + 64]; /* of `broken`, written once before it is set */
    _Atomic uint64_t messages, bytes;
};

/* What one poll found, delivered after the lock is let go. */
struct found {
    struct data_packet *packets;
    struct post *sent;
    bool any;
};

static void broke(struct comm *comm, int code, const char *what, int mpi)
{
    if (atomic_load(&comm->broken))
        return;
    char reason[MPI_MAX_ERROR_STRING] = "";
    int length = 0;
    if (code == DUITE_E_MPI)
        MPI_Error_string(mpi, reason, &length);
    snprintf(comm->sentence, sizeof comm->sentence, "%s: %s", what,
             code == DUITE_E_MPI ? reason : "out of memory");
    atomic_store(&comm->broken, code);
}

static bool mpi_ok(struct comm *comm, int mpi, const char *what)
{
    if (mpi != MPI_SUCCESS)
        broke(comm, DUITE_E_MPI, what, mpi);
    return mpi == MPI_SUCCESS;
}

int comm_broken(struct comm *comm)
{
    int code = atomic_load(&comm->broken);
    return code ? base_error(code, "%s", comm->sentence) : DUITE_OK;
}

static bool try_lock(struct comm *comm)
{
    return !atomic_flag_test_and_set_explicit(&comm->lock, memory_order_acquire);
}

static void unlock(struct comm *comm)
{
    atomic_flag_clear_explicit(&comm->lock, memory_order_release);
}

int comm_start(struct comm **out, MPI_Comm mpi, struct graph *graph)
{
    struct comm *comm = *out = base_alloc_zero(sizeof *comm);
    if (!comm)
        return base_no_memory("communication");
    comm->graph = graph;
    comm->mpi = mpi;
    atomic_flag_test_and_set(&comm->lock); /* until comm_open */
    atomic_init(&comm->posts, NULL);
    comm_arrivals_start(&comm->arrivals);
    if (MPI_Type_contiguous(sizeof(struct data_packet), MPI_BYTE, &comm->line) ||
        MPI_Type_commit(&comm->line)) {
        comm_arrivals_stop(&comm->arrivals);
        base_free(comm);
        *out = NULL;
        return base_error(DUITE_E_MPI, "MPI_Type_contiguous failed");
    }
    return DUITE_OK;
}

void comm_open(struct comm *comm)
{
    if (comm)
        unlock(comm);
}

static void requests_free(struct requests *requests)
{
    free(requests->request);
    free(requests->what);
    free(requests->index);
}

void comm_stop(struct comm *comm)
{
    if (!comm)
        return;
    MPI_Type_free(&comm->line);
    requests_free(&comm->sends);
    requests_free(&comm->receives);
    comm_arrivals_stop(&comm->arrivals);
    base_free(comm);
}

/* ---- Requests: only under the lock ---- */

/* A place for one more request, counted by whoever starts it; NULL without memory. */
static MPI_Request *requests_place(struct comm *comm, struct requests *requests)
{
    size_t needed = (size_t)requests->n + 1;
    void *moved[3] = {
        base_grow(requests->request, &requests->capacity[0], needed, sizeof(MPI_Request)),
        base_grow(requests->what, &requests->capacity[1], needed, sizeof(void *)),
        base_grow(requests->index, &requests->capacity[2], needed, sizeof(int))};
    if (moved[0])
        requests->request = moved[0];
    if (moved[1])
        requests->what = moved[1];
    if (moved[2])
        requests->index = moved[2];
    if (moved[0] && moved[1] && moved[2])
        return &requests->request[requests->n];
    broke(comm, DUITE_E_MEMORY, "messages", 0);
    return NULL;
}

/* Tests all; moves what is done to the end of the arrays and returns how many that are: what[n .. n
 * + done). */
static int requests_test(struct comm *comm, struct requests *requests)
{
    int done = 0;
    if (!requests->n)
        return 0;
    int mpi =
        MPI_Testsome(requests->n, requests->request, &done, requests->index, MPI_STATUSES_IGNORE);
    if (!mpi_ok(comm, mpi, "MPI_Testsome") || done == MPI_UNDEFINED)
        return 0;
    void *finished;
    int last = requests->n;
    for (int i = last - 1; i >= 0 && done; i--) {
        if (requests->request[i] != MPI_REQUEST_NULL)
            continue;
        finished = requests->what[i];
        requests->n--;
        requests->request[i] = requests->request[requests->n];
        requests->what[i] = requests->what[requests->n];
        requests->what[requests->n] = finished;
    }
    return last - requests->n;
}

/* ---- Sending ---- */

static void push(struct comm *comm, struct post *post)
{
    struct post *first = atomic_load_explicit(&comm->posts, memory_order_relaxed);
    do
        post->next = first;
    while (!atomic_compare_exchange_weak_explicit(&comm->posts, &first, post, memory_order_release,
                                                  memory_order_relaxed));
}

static void send_post(struct comm *comm, struct graph_task *task, struct data_packet *packet,
                      int to)
{
    struct post *post = base_pool_take(sizeof *post);
    if (!post || (!task && !packet)) {
        broke(comm, DUITE_E_MEMORY, "a message", 0);
        base_pool_give(post, sizeof *post);
        data_packet_free(packet);
        return;
    }
    *post = (struct post){.task = task, .packet = packet, .to = to};
    push(comm, post);
}

void comm_send(struct comm *comm, struct graph_task *task)
{
    send_post(comm, task, NULL, task->send->to);
}

void comm_send_packet(struct comm *comm, struct data_packet *packet, int to)
{
    send_post(comm, NULL, packet, to);
}

bool comm_posted(struct comm *comm)
{
    return atomic_load_explicit(&comm->posts, memory_order_relaxed) != NULL;
}

static void start_send(struct comm *comm, struct post *post)
{
    bool own = false;
    struct data_packet *packet = post->packet;
    if (!packet)
        packet = graph_send_packet(post->task, &own);
    if (own)
        post->packet = packet;
    MPI_Request *request = packet ? requests_place(comm, &comm->sends) : NULL;
    if (!request) {
        broke(comm, DUITE_E_MEMORY, "a message", 0);
        return;
    }
    size_t lines = data_packet_lines(packet->bytes);
    int mpi = MPI_Isend(packet, (int)lines, comm->line, post->to, 0, comm->mpi, request);
    if (!mpi_ok(comm, mpi, "MPI_Isend"))
        return;
    comm->sends.what[comm->sends.n++] = post;
    atomic_fetch_add_explicit(&comm->messages, 1, memory_order_relaxed);
    atomic_fetch_add_explicit(&comm->bytes, lines * sizeof *packet, memory_order_relaxed);
}

static void start_sends(struct comm *comm, struct found *found)
{
    struct post *posts = atomic_exchange_explicit(&comm->posts, NULL, memory_order_acquire);
    struct post *in_order = NULL;
    while (posts) {
        struct post *next = posts->next;
        posts->next = in_order;
        in_order = posts;
        posts = next;
    }
    while (in_order) {
        struct post *post = in_order;
        in_order = post->next;
        start_send(comm, post);
        found->any = true;
    }
    int done = requests_test(comm, &comm->sends);
    for (int i = 0; i < done; i++) {
        struct post *post = comm->sends.what[comm->sends.n + i];
        post->next = found->sent;
        found->sent = post;
    }
}

/* ---- Receiving ---- */

static bool start_receive(struct comm *comm)
{
    int there = 0, lines = 0;
    MPI_Message message;
    MPI_Status status;
    int mpi = MPI_Improbe(MPI_ANY_SOURCE, 0, comm->mpi, &there, &message, &status);
    if (!mpi_ok(comm, mpi, "MPI_Improbe") || !there)
        return false;
    mpi = MPI_Get_count(&status, comm->line, &lines);
    if (!mpi_ok(comm, mpi, "MPI_Get_count") || lines < 1)
        return false;
    size_t bytes = ((size_t)lines - 1) * sizeof(struct data_packet);
    struct data_packet *packet = data_packet_new(bytes, false);
    MPI_Request *request = packet ? requests_place(comm, &comm->receives) : NULL;
    if (!request) {
        broke(comm, DUITE_E_MEMORY, "a message", 0);
        data_packet_free(packet);
        return false;
    }
    mpi = MPI_Imrecv(packet, lines, comm->line, &message, request);
    if (!mpi_ok(comm, mpi, "MPI_Imrecv")) {
        data_packet_free(packet);
        return false;
    }
    comm->receives.what[comm->receives.n++] = packet;
    return true;
}

static void receive(struct comm *comm, struct found *found)
{
    while (start_receive(comm))
        found->any = true;
    int done = requests_test(comm, &comm->receives);
    for (int i = 0; i < done; i++) {
        struct data_packet *packet = comm->receives.what[comm->receives.n + i];
        packet->next = found->packets;
        found->packets = packet;
    }
}

static void deliver_to(struct comm *comm, void *worker, struct comm_target target,
                       struct data_packet *packet)
{
    if (target.version)
        graph_arrived(comm->graph, worker, target.version, packet);
    else
        graph_pieces_arrived(comm->graph, worker, target.sum, packet);
}

static void deliver(struct comm *comm, void *worker, struct found *found)
{
    while (found->packets) {
        struct data_packet *packet = found->packets;
        struct comm_target target = {0};
        bool lost = false;
        found->packets = packet->next;
        if (comm_arrivals_take(&comm->arrivals, packet, &target, &lost))
            deliver_to(comm, worker, target, packet);
        if (lost)
            broke(comm, DUITE_E_MEMORY, "a message that came early", 0);
    }
    while (found->sent) {
        struct post *post = found->sent;
        found->sent = post->next;
        if (post->task)
            graph_finish(comm->graph, worker, post->task);
        data_packet_free(post->packet);
        base_pool_give(post, sizeof *post);
    }
}

int comm_expect(struct comm *comm, void *worker, struct data_key key, struct data_version *version,
                struct data_sum *sum, uint32_t packets)
{
    struct comm_target target = {.version = version, .sum = sum};
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

/* ---- Progress ---- */

bool comm_poll(struct comm *comm, void *worker)
{
    bool any = false;
    do {
        struct found found = {0};
        if (!try_lock(comm))
            return any;
        start_sends(comm, &found);
        receive(comm, &found);
        unlock(comm);
        any = any || found.any || found.packets || found.sent;
        deliver(comm, worker, &found);
        /* What was pushed while the lock was held here must not wait for the next poll. */
    } while (comm_posted(comm) && !atomic_load(&comm->broken));
    return any;
}

/* Runs `between` until the request is done. */
static int finish(struct comm *comm, int mpi, MPI_Request *request, void (*between)(void *),
                  void *context)
{
    int done = 0;
    bool fine = mpi_ok(comm, mpi, "a collective call");
    unlock(comm);
    while (fine && !done) {
        if (try_lock(comm)) {
            fine = mpi_ok(comm, MPI_Test(request, &done, MPI_STATUS_IGNORE), "MPI_Test");
            unlock(comm);
        }
        if (!done)
            between(context);
    }
    return comm_broken(comm);
}

static void lock(struct comm *comm, void (*between)(void *), void *context)
{
    while (!try_lock(comm))
        between(context);
}

int comm_agree(struct comm *comm, const struct comm_word *own, struct comm_word *all,
               void (*between)(void *context), void *context)
{
    MPI_Request request = MPI_REQUEST_NULL;
    lock(comm, between, context);
    int mpi =
        MPI_Iallgather(own, sizeof *own, MPI_BYTE, all, sizeof *all, MPI_BYTE, comm->mpi, &request);
    return finish(comm, mpi, &request, between, context);
}

int comm_sum(struct comm *comm, double *values, int n, void (*between)(void *context),
             void *context)
{
    MPI_Request request = MPI_REQUEST_NULL;
    lock(comm, between, context);
    int mpi = MPI_Iallreduce(MPI_IN_PLACE, values, n, MPI_DOUBLE, MPI_SUM, comm->mpi, &request);
    return finish(comm, mpi, &request, between, context);
}

void comm_count(struct comm *comm, uint64_t *messages, uint64_t *bytes)
{
    *messages = atomic_load_explicit(&comm->messages, memory_order_relaxed);
    *bytes = atomic_load_explicit(&comm->bytes, memory_order_relaxed);
}
