/* Each of the balancer's states belongs to one worker. Any worker may write the time of the rank's
 * next request: a request too many or too few does no harm. */
#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/offload/offload.h"
#include "runtime/workers/cost.h"
#include "runtime/workers/internal.h"

#include <math.h>
#include <string.h>

enum {
    DEPTH = 64, /* tasks of a queue looked at for one request */
    STOCK = 4, /* offloaded tasks a worker, the running one included: with fewer it requests more */
};

#define FIRST_REQUEST_SECONDS   2e-5 /* so long a worker idles before its rank requests tasks */
#define LONGEST_REQUEST_SECONDS 1e6
#define GRANT_SECONDS           2e-5 /* between two looks for tasks to grant */

struct work_balance {
    const duite_balancer *balancer;
    unsigned char *states; /* one a worker, lines apart */
    size_t stride;
    uint64_t first_request, grant_ticks;
    struct work_cost cost;
    _Atomic uint64_t next, granted; /* ticks: when to request, when it was granted last */
    _Atomic unsigned attempt;
    _Atomic int giver;
};

static bool balance_goes_away(struct worker *worker, struct task *task);

int work_balance_start(struct work_balance **out, struct work_pool *pool)
{
    const duite_balancer *balancer = pool->setup.balancer;
    const struct task_graph *graph = pool->setup.graph;
    unsigned n = pool->setup.threads;
    *out = NULL;
    bool measures = pool->setup.measures || (balancer && balancer->migrate);
    if (!balancer || graph->n_ranks == 1 || !(balancer->victim || balancer->place || measures))
        return DUITE_OK;
    struct work_balance *balance = *out = base_alloc_zero(sizeof *balance);
    if (!balance)
        return base_no_memory("the balancer");
    balance->balancer = balancer;
    pool->queues.goes_away = balance_goes_away;
    pool->queues.straight = false;
    balance->first_request = (uint64_t)(FIRST_REQUEST_SECONDS / pool->queues.tick);
    balance->grant_ticks = (uint64_t)(GRANT_SECONDS / pool->queues.tick);
    balance->giver = DUITE_NO_RANK;
    balance->stride = (balancer->state_size / BASE_LINE + 2) * BASE_LINE;
    balance->states = base_alloc_zero(n * balance->stride);
    if (!work_cost_start(&balance->cost, n, graph->n_kernels, measures) || !balance->states)
        return base_no_memory("the balancer");
    for (unsigned i = 0; i < n && balancer->start; i++) {
        struct base_mark *mark = base_mark_of(pool->setup.marks, BASE_BALANCER, i);
        base_mark_begin(mark, BASE_BALANCER_START);
        balancer->start(balance->states + i * balance->stride, graph->rank, graph->n_ranks, i,
                        pool->setup.seed);
        base_mark_end(mark);
    }
    return DUITE_OK;
}

int work_kernel_added(struct work_pool *pool)
{
    struct work_balance *balance = pool->balance;
    return !balance || work_cost_grow(&balance->cost, pool->setup.graph->n_kernels)
               ? DUITE_OK
               : base_no_memory("a kernel");
}

void work_balance_stop(struct work_pool *pool)
{
    struct work_balance *balance = pool->balance;
    if (!balance)
        return;
    work_cost_stop(&balance->cost);
    base_free(balance->states);
    base_free(balance);
}

static void *balance_state(const struct worker *worker)
{
    const struct work_balance *balance = worker->pool->balance;
    return balance->states + worker->index * balance->stride;
}

/* ---- The balancer's functions, with the worker's mark around them ---- */

static struct base_mark *balance_mark(const struct worker *worker)
{
    return base_mark_of(worker->pool->setup.marks, BASE_BALANCER, worker->index);
}

static int balancer_victim(const struct worker *worker, unsigned attempt, int giver,
                           double *seconds)
{
    base_mark_begin(balance_mark(worker), BASE_BALANCER_VICTIM);
    const int rank =
        worker->pool->balance->balancer->victim(balance_state(worker), attempt, giver, seconds);
    base_mark_end(balance_mark(worker));
    return rank;
}

static bool balancer_grants(const struct worker *worker, const duite_request *asked,
                            const duite_leaf *leaf)
{
    base_mark_begin(balance_mark(worker), BASE_BALANCER_GRANT);
    const int given = worker->pool->balance->balancer->grant(balance_state(worker), asked, leaf);
    base_mark_end(balance_mark(worker));
    return given;
}

static int balancer_place(const struct worker *worker, const duite_leaf *leaf)
{
    base_mark_begin(balance_mark(worker), BASE_BALANCER_PLACE);
    const int rank = worker->pool->balance->balancer->place(balance_state(worker), leaf);
    base_mark_end(balance_mark(worker));
    return rank;
}

/* A balancer that is built in may ask the mapping, which is not. */
uint64_t work_migrate(struct work_pool *pool, const duite_blocks *blocks, int *home)
{
    const struct work_balance *balance = pool->balance;
    struct base_mark *own = balance_mark(&pool->queues.worker[0]);
    struct base_mark *mark = own ? own : base_mark_of(pool->setup.marks, BASE_MAPPING, 0);
    base_mark_begin(mark, own ? BASE_BALANCER_MIGRATE : BASE_MAPPING_MAP);
    const uint64_t next = balance->balancer->migrate(balance->states, blocks, home);
    base_mark_end(mark);
    return next;
}

void work_learn(struct worker *worker, const struct task *task, uint64_t ticks)
{
    work_cost_learn(&worker->pool->balance->cost, worker->index, task, ticks);
}

double work_block_seconds(struct work_pool *pool, uint32_t block)
{
    return pool->queues.tick * (double)work_cost_take(&pool->balance->cost, block);
}

/* ---- Tasks that may go ---- */

/* Estimated seconds of a ready task; 0: unknown. Earlier bodies tell nothing of a task whose
 * children do the work. */
static double task_cost(const struct work_pool *pool, const struct task *task)
{
    if (task->cost > 0)
        return task->cost;
    return task->inner ? 0 : pool->queues.tick * work_cost_mean(&pool->balance->cost, task->kernel);
}

/* False: it may not go. */
static bool leaf_describe(const struct work_pool *pool, const struct task *task, duite_leaf *leaf)
{
    const struct task_graph *graph = pool->setup.graph;
    size_t bytes;
    if (!offload_may_go(graph, task, &bytes))
        return false;
    *leaf = (duite_leaf){.kernel = graph->kernels[task->kernel]->name,
                         .number = task->number,
                         .cost = task_cost(pool, task),
                         .bytes = bytes,
                         .transfer = comm_transfer(pool->setup.comm, bytes),
                         .forks = task->inner != NULL};
    return true;
}

/* Its subtree may be of any size. */
static bool leaf_is_unknown(const duite_leaf *leaf)
{
    return leaf->forks && leaf->cost <= 0;
}

static bool leaf_send(struct worker *worker, struct task *task, int to)
{
    bool nested;
    const uint64_t number = task_main_number(task, &nested);
    if (!offload_send(worker->pool->setup.graph, worker, task, to))
        return false;
    queue_bump(&worker->counts.delegated, 1);
    trace_mark(worker->ring, TRACE_DELEGATE, (uint32_t)to, number);
    return true;
}

/* Grants the leaf to a requesting rank before a worker here can take it. In a tree whose tasks
 * become ready a few at a time, hardly a leaf is left between two tasks. Subtrees of unknown size
 * do not go: those in the queue are mostly larger. */
static bool leaf_grant_at_once(struct worker *worker, struct task *task, const duite_leaf *leaf)
{
    const struct work_pool *pool = worker->pool;
    size_t others = queue_size(&worker->queue) + queue_size(&pool->queues.shared);
    struct comm_requester requester;
    if (!comm_take_request(pool->setup.comm, &requester))
        return false;
    const duite_request asked = {
        .rank = requester.rank, .idle = requester.idle, .ready = 1 + (unsigned)others};
    bool given = balancer_grants(worker, &asked, leaf) && leaf_send(worker, task, requester.rank);
    if (!given)
        comm_return_request(pool->setup.comm, &requester);
    return given;
}

/* A task of another rank came: that rank may have more. */
static void offloaded_came(struct work_balance *balance, const struct task *task)
{
    atomic_store(&balance->giver, offload_home(task));
    atomic_store(&balance->attempt, 0);
    atomic_store(&balance->next, 0);
}

/* For queue_pool.goes_away. */
static bool balance_goes_away(struct worker *worker, struct task *task)
{
    const struct work_pool *pool = worker->pool;
    const duite_balancer *balancer = pool->balance->balancer;
    if (task->type == TASK_OFFLOADED)
        offloaded_came(pool->balance, task);
    int own = pool->setup.graph->rank, to = own;
    duite_leaf leaf;
    bool asked = balancer->grant && comm_has_requests(pool->setup.comm);
    if ((!balancer->place && !asked) || !leaf_describe(pool, task, &leaf))
        return false;
    if (balancer->place)
        to = balancer_place(worker, &leaf);
    if (to >= 0 && to < pool->setup.graph->n_ranks && to != own)
        return leaf_send(worker, task, to);
    return asked && !leaf_is_unknown(&leaf) && leaf_grant_at_once(worker, task, &leaf);
}

/* ---- Granting ---- */

struct grant {
    struct worker *worker;
    duite_request asked;
};

/* Grants oldest first: the owner works on the newest. The other tasks go back in their old
 * order. */
static void grant_or_keep(struct grant *grant, struct queue *queue, struct queue_link *taken)
{
    const struct work_pool *pool = grant->worker->pool;
    while (taken) {
        struct task *task = queue_task(taken);
        taken = taken->next;
        duite_leaf leaf;
        if (leaf_describe(pool, task, &leaf) &&
            balancer_grants(grant->worker, &grant->asked, &leaf) &&
            leaf_send(grant->worker, task, grant->asked.rank)) {
            grant->asked.granted++;
            grant->asked.unknown += leaf_is_unknown(&leaf);
        } else {
            queue_push(queue, task);
        }
    }
}

static void grant_from(struct grant *grant, struct queue *queue)
{
    struct queue_link *taken = NULL;
    struct task *task;
    for (unsigned i = 0; i < DEPTH && (task = queue_take(queue, DUITE_NEWEST)); i++) {
        task->link.next = taken;
        taken = &task->link;
        grant->asked.ready++;
    }
    grant_or_keep(grant, queue, taken);
}

/* Returns how many tasks were granted. */
static unsigned grant_queues(struct worker *worker, const struct comm_requester *requester)
{
    struct work_pool *pool = worker->pool;
    struct grant grant = {.worker = worker,
                          .asked = {.rank = requester->rank, .idle = requester->idle}};
    grant_from(&grant, &worker->queue);
    if (!atomic_flag_test_and_set_explicit(&pool->queues.shared.token, memory_order_acquire)) {
        grant_from(&grant, &pool->queues.shared);
        atomic_flag_clear_explicit(&pool->queues.shared.token, memory_order_seq_cst);
    }
    /* The tasks could not be found meanwhile: a worker looks again. */
    atomic_thread_fence(memory_order_seq_cst);
    if (grant.asked.ready > grant.asked.granted)
        queue_wake_one(&pool->queues, DUITE_NO_QUEUE);
    return grant.asked.granted;
}

void work_grant(struct worker *worker)
{
    struct work_balance *balance = worker->pool->balance;
    struct comm *comm = worker->pool->setup.comm;
    struct comm_requester requester;
    uint64_t now = base_ticks();
    if (!comm_has_requests(comm) || now - atomic_load(&balance->granted) < balance->grant_ticks)
        return;
    atomic_store(&balance->granted, now);
    for (unsigned given = 1; given && comm_take_request(comm, &requester);) {
        given = grant_queues(worker, &requester);
        if (!given)
            comm_return_request(comm, &requester);
    }
    work_poll(worker);
}

/* ---- Requesting ---- */

/* Unless the last request still stands. */
void work_request(struct worker *worker, uint64_t idled)
{
    struct work_pool *pool = worker->pool;
    struct work_balance *balance = pool->balance;
    uint64_t now = base_ticks();
    double seconds = 0;
    if (idled < balance->first_request || !balance->balancer->victim ||
        task_has_given_up(pool->setup.graph) || now < atomic_load(&balance->next))
        return;
    unsigned attempt = atomic_load(&balance->attempt);
    int giver = atomic_load(&balance->giver);
    int rank = balancer_victim(worker, attempt, giver, &seconds);
    seconds = fmin(fmax(seconds, 0), LONGEST_REQUEST_SECONDS); /* whatever it says */
    unsigned idle = 1 + (unsigned)atomic_load(&pool->queues.parked);
    bool other = rank >= 0 && rank < pool->setup.graph->n_ranks && rank != pool->setup.graph->rank;
    if (other && !comm_request(pool->setup.comm, worker, rank, idle, seconds))
        return;
    atomic_store(&balance->next, now + (uint64_t)(seconds / pool->queues.tick));
    atomic_store(&balance->attempt, attempt + 1);
    /* A message may have ended the last task: running out of work again tells the main thread. */
    if (work_poll(worker))
        work_stir(worker);
}

bool work_begins(struct worker *worker, const struct task *task)
{
    const struct work_pool *pool = worker->pool;
    if (task->type != TASK_OFFLOADED)
        return false;
    uint64_t offloaded = offload_count(pool->setup.graph);
    size_t ready = queue_size(&worker->queue) + queue_size(&pool->queues.shared);
    bool last = offloaded <= STOCK * pool->setup.threads && ready < offloaded;
    if (last)
        work_request(worker, UINT64_MAX);
    return last;
}
