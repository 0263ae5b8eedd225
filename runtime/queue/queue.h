#ifndef DUITE_WORKERS_QUEUE_H
#define DUITE_WORKERS_QUEUE_H

#include <duite_policy.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Queues of ready tasks, and their two parts: a deque and a heap. They know where a task's link is,
 * and its rank, for which they ask. */
struct task;

/* For whoever holds the task: a queue's inbox, or a list. */
struct queue_link {
    struct queue_link *next;
};

enum { QUEUE_LINK_AT = 8 }; /* bytes before the link of a task; task.h checks it */
static inline struct queue_link *queue_link(struct task *task)
{
    return (struct queue_link *)(void *)((char *)task + QUEUE_LINK_AT);
}
static inline struct task *queue_task(struct queue_link *link)
{
    return (struct task *)(void *)((char *)link - QUEUE_LINK_AT);
}

/* A task's urgency, see DUITE_HIGHEST. */
struct queue_rank {
    int32_t priority;
    float path; /* seconds from its begin to the end of the round, or 0 */
};
typedef struct queue_rank queue_ranks_by(const struct task *task);

/* ---- Deque ---- */

/* A work-stealing deque without locks: its owner pushes and takes at the new end, anybody takes at
 * the old end. Chase & Lev, SPAA 2005, with the fences of Lê, Pop, Cohen & Zappa Nardelli, PPoPP
 * 2013. */
struct queue_ring {
    uint64_t mask;
    struct queue_ring *older; /* rings that were outgrown: thieves may still read them */
    _Atomic(struct task *) slot[];
};

struct queue_deque {
    _Alignas(64) _Atomic int64_t oldest; /* thieves take here */
    _Alignas(64) _Atomic int64_t newest; /* the owner pushes here: one past the last */
    _Atomic(struct queue_ring *) ring;
    int64_t seen; /* by the owner: an earlier value of `oldest` */
};

/* ---- Heap ---- */

/* Tasks by priority, then by the longest path, then by arrival. The holder of `busy` may look
 * inside; anybody may read `n`. */
struct queue_heap {
    struct queue_ranked *entry;
    queue_ranks_by *rank;
    size_t capacity;
    uint64_t came; /* tasks so far */
    _Atomic size_t n;
    atomic_flag busy;
};

/* ---- Queue ---- */

/* A queue of ready tasks: a deque for its owner and thieves, and an inbox into which anybody puts.
 * The shared queue's owner is the present holder of `token`. To serve by priority, inbox and deque
 * are emptied into the heap first. */
struct queue {
    struct queue_deque deque;
    struct queue_heap heap;
    _Alignas(64) _Atomic(struct queue_link *) inbox; /* linked by next, newest first */
    atomic_flag token;
};

bool queue_start(struct queue *queue, queue_ranks_by *rank); /* false without memory */
void queue_stop(struct queue *queue);

/* Anybody. */
void queue_put(struct queue *queue, struct task *task);
/* The owner, without the detour over the inbox. */
void queue_push(struct queue *queue, struct task *task);
/* The owner. NULL: empty. */
struct task *queue_take(struct queue *queue, duite_end end);
/* The owner. A mark >= -1, which differs from an earlier one while a task pushed or put since is
 * there. */
int64_t queue_mark(struct queue *queue);
/* Anybody, of a queue without owner. NULL: empty, or the token's holder will look again. */
struct task *queue_take_shared(struct queue *queue, duite_end end);
/* A thief. It may take the whole inbox of a busy owner: all but the first go to its own queue. */
struct task *queue_steal(struct queue *victim, struct queue *own);

/* Anybody; a look without order. */
static inline bool queue_is_empty(const struct queue *queue)
{
    return !atomic_load_explicit(&queue->inbox, memory_order_relaxed) &&
           !atomic_load_explicit(&queue->heap.n, memory_order_relaxed) &&
           atomic_load_explicit(&queue->deque.oldest, memory_order_relaxed) >=
               atomic_load_explicit(&queue->deque.newest, memory_order_relaxed);
}

/* About how many tasks it has; an inbox counts as one. Anybody may look. */
static inline size_t queue_size(const struct queue *queue)
{
    int64_t newest = atomic_load_explicit(&queue->deque.newest, memory_order_relaxed);
    int64_t oldest = atomic_load_explicit(&queue->deque.oldest, memory_order_relaxed);
    return (newest > oldest ? (size_t)(newest - oldest) : 0) +
           (atomic_load_explicit(&queue->inbox, memory_order_relaxed) != NULL) +
           atomic_load_explicit(&queue->heap.n, memory_order_relaxed);
}

/* True if there are tasks in the heap. A worker that finds the heap busy goes away and may sleep,
 * so one that takes a task and leaves some wakes another. */
static inline bool queue_ranks(struct queue *queue)
{
    return atomic_load_explicit(&queue->heap.n, memory_order_relaxed) != 0;
}

#pragma GCC visibility pop

#endif
