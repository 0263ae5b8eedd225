#ifndef DUITE_WORKERS_INTERNAL_H
#define DUITE_WORKERS_INTERNAL_H

#include "runtime/base/monitor.h"
#include "runtime/base/thread.h"
#include "runtime/data/packet.h"
#include "runtime/plan/node.h"
#include "runtime/queue/pool.h"
#include "runtime/task/body.h"
#include "runtime/workers/topology.h"
#include "runtime/workers/workers.h"

#include <duite_policy.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Shared by the files of this folder only. */

/* A worker that sleeps for short pauses begins with this one; each is twice as long as the last. */
#define WORK_FIRST_PAUSE_SECONDS 2e-5

/* The main program's reason to wait. Atomic, so that the monitor can look without stopping it. */
struct work_waits {
    _Atomic(const char *) call; /* written last; NULL: it does not wait */
    _Atomic(const char *) what; /* NULL: an object's version, the next three */
    _Atomic uint32_t slot, generation;
    _Atomic uint64_t number;
    _Atomic uint64_t tasks; /* of this rank then, with those that are over */
    _Atomic uint64_t turn;  /* how often it began or ended to wait */
};

struct work_standstill {
    struct base_look look;
    double patience;  /* seconds of a standstill until it is reported */
    double since;     /* when something moved last, as far as was seen; */
    uint64_t before;  /* what was read then */
    uint64_t *inside; /* by worker: its mark at the last look */
    bool reported;
    pthread_mutex_t lock; /* held while it reports, see work_leaves */
    struct work_waits waits;
};

struct work_pool {
    struct queue_pool queues; /* the part that tasks see; first */
    struct work_setup setup;
    unsigned char *states;
    uint64_t poll_ticks, spin_ticks, yield_ticks, await_ticks, brief_ticks;
    uint64_t affinity_ticks; /* of a task that leaves one; never on one worker by_affinity */
    bool plain;              /* there is neither another rank nor a trace: see run.c */
    bool plain_nodes;        /* both: see run.c */
    unsigned started;        /* threads, worker 0 among them */
    pthread_t main;
    struct work_near near;
    struct work_standstill standstill;
    struct work_balance *balance; /* NULL: nothing moves between ranks */
    _Alignas(64) _Atomic int stop;
    _Atomic int endless;             /* the scheduler named victims without an end */
    _Atomic int watched;             /* the running tasks are being read: they must not go on */
    _Alignas(64) _Atomic int poller; /* 1: an idle worker polls */
    uint64_t look; /* how many tasks the main thread forks before it counts again, see wait.c */
};

/* A worker whose task is over waits here for the end of a report. */
void work_standstill_passes(struct work_pool *pool);

/* Notes the task whose body runs from now on; NULL: one without a body. Returns the one before: a
 * body that waits has others on top of it. */
static inline const struct task *work_enters(struct worker *worker, const struct task *task)
{
    const struct task *below = atomic_load_explicit(&worker->runs, memory_order_relaxed);
    atomic_store_explicit(&worker->runs, task, memory_order_release);
    return below;
}

/* The worker's task is over, but not yet published or freed. */
static inline void work_leaves(struct worker *worker, const struct task *below)
{
    atomic_store_explicit(&worker->runs, below, memory_order_release);
    atomic_signal_fence(memory_order_seq_cst); /* the monitor has the fence: see standstill.c */
    if (atomic_load_explicit(&worker->pool->watched, memory_order_acquire))
        work_standstill_passes(worker->pool);
}

/* The task that the last one made ready, to run next on this worker; NULL: none. */
static inline struct task *work_take_next(struct worker *worker)
{
    struct task *task = worker->next;
    worker->next = NULL;
    queue_bump(&worker->counts.chained, task != NULL);
    return task;
}

static inline void work_pause_core(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ volatile("yield");
#endif
}

/* A condition that an idle worker waits for beside tasks, and how it may sleep meanwhile. */
struct work_wish {
    bool (*done)(void *context); /* NULL: nothing */
    void *context;
    bool unheard; /* nobody wakes the worker for it: sleep for a pause at most. Else it is true,
                     too, once communication broke */
};
bool work_wish_is_true(const struct work_pool *pool, const struct work_wish *wish);

/* A task that ran, and how. */
struct work_ran {
    uint64_t start, took, within;
    bool body, inlined;
};

/* ---- dispatch.c ---- */

/* Runs a ready task, by its type; returns whether a body ran. Then work_finish is due. */
bool work_run_task(struct task_graph *graph, struct worker *worker, struct task *task,
                   const duite_call *call);

/* A task that ran, was sent or received is over: ends it, by its type. */
void work_finish(struct task_graph *graph, struct worker *worker, struct task *task);

/* ---- worker.c ---- */

/* A thread of ours; the worker. Works until the pool stops. */
void *work_thread(void *worker);
/* A task, or NULL: in its own queue, in the shared one, or with a victim of the scheduler. */
struct task *work_find(struct worker *worker);
/* True if a scheduler names victims without end in one round; the next duite_wait then returns an
 * error. */
bool work_is_endless(struct work_pool *pool, unsigned attempt);
/* Counts a task stolen from a victim. */
void work_count_stolen(struct worker *worker, unsigned victim);
/* Looks for work once; idles for a moment if there is none. */
void work_look(struct worker *worker, const struct work_wish *wish);
/* Sends and receives. Returns whether anything happened. */
bool work_poll(struct worker *worker);

/* ---- run.c ---- */

/* Runs the task and those that run inline after it. */
void work_run(struct worker *worker, struct task *task);

/* For a scheduler by affinity: runs children of the body that waits on this worker, on top of it.
 * Takes them from the worker's own queue, newest first, until done(context) or the newest is
 * another task. */
void work_run_children(struct worker *worker, bool (*done)(void *context), void *context);

/* Tasks since the clock was read. It is read after each task until a batch of them in turn were
 * brief; then once a batch, until one takes longer. */
struct work_batch {
    uint64_t start;
    uint64_t outer;  /* worker->within before it began */
    uint64_t limit;  /* ticks of a brief task; */
    unsigned *brief; /* so many in turn were; NULL: not counted, nor is the time of bodies */
    unsigned tasks;
    uint64_t took, own; /* of the last batch: ticks; those of its tasks alone */
};
/* Reads the clock. */
void work_batch_end(struct worker *worker, struct work_batch *batch);

/* ---- await.c: the end of a node on a worker, which may wait for a successor ---- */

/* As plan_node_count_down. If none of the successors is the next node, the worker awaits one. */
void work_count_down_awaiting(struct worker *worker, struct task *task, struct work_batch *batch);

/* No node is left for the worker: it may await one after the next. */
void work_may_await(struct worker *worker);

/* ---- idle.c ---- */

/* Idles for one moment. */
void work_idle(struct worker *worker, const struct work_wish *wish);
/* Idling begins, now in ticks. */
void work_idles(struct worker *worker, uint64_t now);
/* Something happened: a new idle time begins. */
void work_stir(struct worker *worker);
/* The worker has something to do again. If it was the poller it wakes a sleeper, which becomes the
 * poller. Inline for workers that did not idle. */
void work_idle_over(struct worker *worker);
static inline void work_busy_again(struct worker *worker)
{
    if (worker->idle_since || worker->polls)
        work_idle_over(worker);
}
/* One idle look, now in ticks. Returns whether other programs use this worker's core; then it
 * should sleep instead of spinning. */
bool work_is_crowded(struct worker *worker, uint64_t now);

/* ---- wait.c ---- */

/* Sends what was posted and, now and then, receives and grants tasks, and tests requests of the
 * program. */
void work_serve(struct worker *worker, uint64_t now);

/* The worker finds no task: wakes the main thread if it waits and enough tasks are over. */
void work_ran_out(struct worker *worker);

/* ---- pool.c: for the trace, if there is one ---- */

/* A task that ran and is not finished yet. */
void work_note_task(struct worker *worker, const struct task *task, const struct work_ran *ran);
/* True if the ring was full: this worker may then have written it to the file. */
bool work_note_relieve(struct worker *worker);
/* The worker idled for so many ticks since idle_since. */
void work_note_idle(struct worker *worker, uint64_t idle, uint64_t exposed);
/* ---- balance.c: the workers' part of a balancer. They measure bodies, request tasks of other
 * ranks when they have none, and grant tasks that are requested. A pool has none (NULL) without a
 * balancer, with one that moves nothing, or on one rank ---- */

/* The pool has its setup and its workers. *balance NULL: nothing moves. Errors: memory. */
int work_balance_start(struct work_balance **balance, struct work_pool *pool);
void work_balance_stop(struct work_pool *pool); /* it may have none */

/* A task is about to run. Requests more if it is one of the last of other ranks' and nothing else
 * is here. Returns whether that took time. */
bool work_begins(struct worker *worker, const struct task *task);

/* The body of a task took so many ticks. */
void work_learn(struct worker *worker, const struct task *task, uint64_t ticks);

/* Between tasks: grants tasks to the ranks that request some. */
void work_grant(struct worker *worker);

/* The poller has idled for so many ticks: requests tasks if that is long. */
void work_request(struct worker *worker, uint64_t idled);

/* ---- standstill.c: the monitor looks, eight times in so many seconds, whether the main program
 * waits, or is in a function of a policy, and nothing of this rank moves. Then it reports on
 * standard error, once, who waits for what. Another standstill is reported if it lasts twice as
 * long, and so on, so that slow tasks do not fill the screen ---- */

/* Begins and ends the looks; 0 seconds: there are none; else the workers are there. Errors: memory,
 * DUITE_E_SYSTEM. */
int work_standstill_start(struct work_pool *pool, double seconds);
void work_standstill_stop(struct work_pool *pool);

/* ---- Between a worker and its policies ---- */

/* The scheduler's victim for this attempt. */
static inline unsigned work_victim(struct worker *worker, unsigned attempt)
{
    base_mark_begin(worker->mark, BASE_SCHEDULER_VICTIM);
    const unsigned victim = worker->pool->setup.scheduler->victim(worker->state, attempt);
    base_mark_end(worker->mark);
    return victim;
}

/* True if a scheduler by affinity keeps the task with the worker that made it ready. */
static inline bool work_keeps(const struct worker *worker, const struct task *task)
{
    return queue_keeps(worker, plan_task_affinity(task));
}

/* The first node that becomes ready is the next one, if the scheduler need not be asked. */
static inline void work_node_ready(struct task_graph *graph, struct worker *worker,
                                   struct task *task)
{
    if (task->type == TASK_NODE && worker->may_chain && !worker->next && work_keeps(worker, task))
        worker->next = task;
    else
        plan_node_ready(graph, worker, task);
}

/* Notes the affinity that a task leaves, which took so many ticks. */
static inline void work_set_affinity(const struct worker *worker, const struct task *task,
                                     uint64_t took)
{
    if (task->type != TASK_NODE)
        return;
    if (took >= worker->pool->affinity_ticks)
        plan_task_set_affinity(task, worker->index + 1);
    else if (plan_is_affine(task->node->plan))
        plan_task_set_affinity(task, 0);
}

#pragma GCC visibility pop

#endif
