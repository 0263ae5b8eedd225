#ifndef DUITE_QUEUE_POOL_H
#define DUITE_QUEUE_POOL_H

#include "runtime/base/policy.h"
#include "runtime/base/stack.h"
#include "runtime/base/thread.h"
#include "runtime/queue/queue.h"

#include <duite.h>
#include <duite_policy.h>
#include <pthread.h>
#include <sched.h>

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* The workers of a rank as tasks see them: queues that take what is ready, sleepers that are woken
 * for it, and counts of what is over. The loops that run tasks are in workers/. */

/* The place where one worker sleeps. A worker announces its sleep, looks once more for what it
 * waits for, and then sleeps or cancels. A thread that makes something available reads `asleep`
 * afterwards. Both sides are sequentially consistent, so at least one sees the other: no wake-up is
 * missed. */
struct queue_park {
    _Atomic int asleep;
    pthread_mutex_t lock;
    pthread_cond_t wake;
};

struct queue_counts {
    _Atomic uint64_t over, more; /* tasks that are over, of all kinds; to come, beside the forked */
    _Atomic uint64_t tasks, placed, stolen, chained, delegated;
    _Atomic uint64_t far;                 /* of those stolen: not from the nearest */
    _Atomic uint64_t busy, idle, exposed; /* ticks; the last: idle while messages were awaited */
};

static inline void queue_bump(_Atomic uint64_t *count, uint64_t by)
{
    uint64_t now = atomic_load_explicit(count, memory_order_relaxed);
    atomic_store_explicit(count, now + by, memory_order_relaxed);
}

/* The node that a worker awaits, see workers/await.c. */
struct work_awaits {
    struct task *node; /* NULL: none */
    bool on;           /* it may await one */
    uint8_t pass;      /* it runs out of nodes so often before it may again */
    uint8_t vain;      /* `pass` after the last wait; 0: the node came */
};

struct worker {
    struct queue queue;
    struct queue_park park;
    struct queue_pool *queues; /* of all workers of the rank */
    void *state;               /* of the scheduler */
    struct base_mark *mark;    /* set around the scheduler's calls; NULL: it is built in */
    unsigned index;
    bool finishing;                    /* a task of this worker makes others ready right now */
    bool may_chain;                    /* ... and may run one of them inline, as its next */
    struct task *next;                 /* inline: to run directly after this one */
    const struct task_scope *waits;    /* of the body that waits on top; NULL: none does */
    unsigned nested;                   /* bodies that wait on its stack */
    _Atomic(const struct task *) runs; /* whose body runs, for the monitor */
    struct queue_counts counts;
    /* The rest is for the loops alone. */
    struct work_pool *pool;
    struct trace_ring *ring; /* of the trace; NULL: there is none */
    bool polls;              /* is the poller */
    bool left_some; /* the heap from which it took a task has more: another worker is to be woken */
    struct base_stack stack;
    uint64_t within;                    /* ticks of tasks, messages and idling inside the body that
                                           runs */
    uint64_t gap;                       /* ticks between inline tasks, when last looked at */
    unsigned brief_bodies, brief_nodes; /* in turn, see work_batch */
    uint64_t polled, idle_since;        /* when, in ticks; 0: busy */
    uint64_t messaging;                 /* when it began with messages, in ticks; 0: it does not */
    uint64_t looked, crowded_until;     /* in ticks, see idle.c */
    long switches;         /* involuntary context switches of its thread; -1: not counted yet */
    uint64_t awaited_then; /* comm_awaited_ticks when it began to idle */
    double pause;
    struct work_awaits awaits; /* what it awaits, if no task is next */
    duite_call call;
    pthread_t thread;
    int unit;          /* to be bound to, or -1 */
    cpu_set_t binding; /* of worker 0 before start */
};

struct queue_pool {
    unsigned n; /* workers; worker 0 is the main thread */
    struct worker *worker;
    const duite_scheduler *scheduler;
    bool by_affinity; /* its `place` and `chain` are those of sched.h by affinity */
    bool straight;    /* ... and nothing goes away */
    double tick;      /* seconds */
    /* A balancer's: true if the ready task was sent to another rank. NULL: none ever is. */
    bool (*goes_away)(struct worker *worker, struct task *task);
    struct queue shared;
    _Alignas(64) _Atomic int parked; /* workers that sleep or are about to */
    /* The main thread that waits: of so many tasks ... ; 0: it does not */
    _Alignas(64) _Atomic uint64_t awaited;
    _Atomic uint64_t
        wanted; /* ... fewer are to be unfinished than that, if it is throttled; or 0 */
};

/* True if a body runs on the worker's thread. */
static inline bool queue_in_body(const struct worker *worker)
{
    return atomic_load_explicit(&worker->runs, memory_order_relaxed) != NULL;
}

/* True if so few bodies wait on the worker's stack that its depth does not matter. Then tasks that
 * may run on top run in the order of the queues, which is faster. */
enum { QUEUE_NESTED_FREELY = 64 };
static inline bool queue_nests_freely(const struct worker *worker)
{
    return worker->nested <= QUEUE_NESTED_FREELY;
}

/* True if a scheduler by affinity keeps a task of this affinity (see duite_ready) with the worker
 * that made it ready. */
static inline bool queue_keeps(const struct worker *worker, uint32_t affinity)
{
    return !affinity || affinity == worker->index + 1;
}

bool queue_park_start(struct queue_park *park);
void queue_park_stop(struct queue_park *park);

void queue_park_announce(struct queue_park *park);
void queue_park_cancel(struct queue_park *park);
/* Sleeps until woken, or for so many seconds if they are > 0. */
void queue_park_sleep(struct queue_park *park, double seconds);

/* Wakes the worker if it sleeps or is about to. Returns whether it did. */
bool queue_park_wake(struct queue_park *park);

/* Wakes a worker for a task in `queue`: its owner if that one sleeps, else any worker, which may
 * steal the task. Before the call the task was published by a sequentially consistent
 * read-modify-write, or before a fence: a worker that announces its sleep then sees it. */
void queue_wake_one(struct queue_pool *pool, unsigned queue);

/* Something happened that the main program may wait for. pool NULL: nobody waits any more. */
void queue_notify(struct queue_pool *pool);

/* One more task of the main program is over; one more is to come. `worker` is the caller. */
void queue_over(struct queue_pool *pool, struct worker *worker);
void queue_more(struct worker *worker);

/* All that are over so far, less those to come. */
uint64_t queue_all_over(const struct queue_pool *pool);

/* True if the main thread waits and enough tasks are over. */
bool queue_main_has_enough(const struct queue_pool *pool);

/* About how many bodies ran on this rank so far, and the seconds in them. Main thread. */
void queue_bodies(struct queue_pool *pool, uint64_t *bodies, double *seconds);

#pragma GCC visibility pop

#endif
