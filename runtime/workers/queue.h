#ifndef DUITE_WORKERS_QUEUE_H
#define DUITE_WORKERS_QUEUE_H

#include "runtime/task/task.h"
#include "runtime/workers/deque.h"
#include "runtime/workers/heap.h"

#include <duite_policy.h>

/* A queue of ready tasks: a deque for its owner and thieves, and an inbox into which anybody puts.
 * The shared queue has no owner: whoever gets `token` is it for a moment. When it is served by
 * priority, inbox and deque are emptied into the heap first. */
struct work_queue {
    struct work_deque deque;
    struct work_heap heap;
    _Alignas(64) _Atomic(struct task *) inbox; /* linked by next, newest first */
    atomic_flag token;
};

bool work_queue_start(struct work_queue *queue); /* false without memory */
void work_queue_stop(struct work_queue *queue);

/* Anybody. */
void work_queue_put(struct work_queue *queue, struct task *task);
/* The owner, without the detour over the inbox. */
void work_queue_push(struct work_queue *queue, struct task *task);
/* The owner. NULL: empty. */
struct task *work_queue_take(struct work_queue *queue, duite_end end);
/* The owner. Never the same after something was pushed or put and before it is taken; -1 or more.
 */
int64_t work_queue_mark(struct work_queue *queue);
/* Anybody, of a queue without owner. NULL: empty, or another one is at it and will look again. */
struct task *work_queue_take_shared(struct work_queue *queue, duite_end end);
/* A thief, who may take the whole inbox of a busy owner: all but the first go to the thief's own
 * queue. */
struct task *work_queue_steal(struct work_queue *victim, struct work_queue *own);

/* Anybody; a look without order. */
static inline bool work_queue_is_empty(const struct work_queue *queue)
{
    return !atomic_load_explicit(&queue->inbox, memory_order_relaxed) &&
           !atomic_load_explicit(&queue->heap.n, memory_order_relaxed) &&
           atomic_load_explicit(&queue->deque.oldest, memory_order_relaxed) >=
               atomic_load_explicit(&queue->deque.newest, memory_order_relaxed);
}

/* About how many tasks it has; an inbox counts as one. Anybody may look. */
static inline size_t work_queue_size(const struct work_queue *queue)
{
    int64_t newest = atomic_load_explicit(&queue->deque.newest, memory_order_relaxed);
    int64_t oldest = atomic_load_explicit(&queue->deque.oldest, memory_order_relaxed);
    return (newest > oldest ? (size_t)(newest - oldest) : 0) +
           (atomic_load_explicit(&queue->inbox, memory_order_relaxed) != NULL) +
           atomic_load_explicit(&queue->heap.n, memory_order_relaxed);
}

/* Are there tasks in the heap? Who finds another one at it goes away empty-handed, and may sleep:
 * whoever took a task and leaves some there wakes another. */
static inline bool work_queue_ranks(struct work_queue *queue)
{
    return atomic_load_explicit(&queue->heap.n, memory_order_relaxed) != 0;
}

#endif
