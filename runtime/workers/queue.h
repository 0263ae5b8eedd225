#ifndef DUITE_WORKERS_QUEUE_H
#define DUITE_WORKERS_QUEUE_H

#include "runtime/task/task.h"

#include <duite_policy.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Queues of ready tasks, and their two parts: a deque and a heap. */

/* ---- Deque ---- */

/* A work-stealing deque without locks: its owner pushes and takes at the new end, anybody takes at
 * the old end. Chase & Lev, SPAA 2005, with the fences of Lê, Pop, Cohen & Zappa Nardelli, PPoPP
 * 2013. */
struct work_ring {
    uint64_t mask;
    struct work_ring *older; /* rings that were outgrown: thieves may still read them */
    _Atomic(struct task *) slot[];
};

struct work_deque {
    _Alignas(64) _Atomic int64_t oldest; /* thieves take here */
    _Alignas(64) _Atomic int64_t newest; /* the owner pushes here: one past the last */
    _Atomic(struct work_ring *) ring;
    int64_t seen; /* by the owner: an earlier value of `oldest` */
};

/* slots: of the first ring, a power of 2. False without memory. */
bool work_deque_start(struct work_deque *deque, uint64_t slots);
void work_deque_stop(struct work_deque *deque);

/* Owner only. False without memory: nothing was pushed. */
bool work_deque_push(struct work_deque *deque, struct task *task);
/* Owner only. NULL if it is empty. */
struct task *work_deque_take_newest(struct work_deque *deque);
/* Anybody. NULL if it is empty or another thief was faster (*again is set then). */
struct task *work_deque_take_oldest(struct work_deque *deque, bool *again);

/* ---- Heap ---- */

/* Tasks by priority, then by the longest path, then by arrival. The holder of `busy` may look
 * inside; anybody may read `n`. */
struct work_heap {
    struct work_ranked *entry;
    size_t capacity;
    uint64_t came; /* tasks so far */
    _Atomic size_t n;
    atomic_flag busy;
};

void work_heap_start(struct work_heap *heap);
void work_heap_stop(struct work_heap *heap);

/* Does not wait: false if another thread has entered. */
bool work_heap_enter(struct work_heap *heap);
void work_heap_leave(struct work_heap *heap);

/* After entering. False without memory: the task is not in it. */
bool work_heap_push(struct work_heap *heap, struct task *task);
/* After entering. NULL: empty. */
struct task *work_heap_pop(struct work_heap *heap);

/* ---- Queue ---- */

/* A queue of ready tasks: a deque for its owner and thieves, and an inbox into which anybody puts.
 * The shared queue's owner is the present holder of `token`. To serve by priority, inbox and deque
 * are emptied into the heap first. */
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
/* The owner. A mark >= -1, which differs from an earlier one while a task pushed or put since is
 * there. */
int64_t work_queue_mark(struct work_queue *queue);
/* Anybody, of a queue without owner. NULL: empty, or the token's holder will look again. */
struct task *work_queue_take_shared(struct work_queue *queue, duite_end end);
/* A thief. It may take the whole inbox of a busy owner: all but the first go to its own queue. */
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

/* True if there are tasks in the heap. A worker that finds the heap busy goes away and may sleep,
 * so one that takes a task and leaves some wakes another. */
static inline bool work_queue_ranks(struct work_queue *queue)
{
    return atomic_load_explicit(&queue->heap.n, memory_order_relaxed) != 0;
}

#pragma GCC visibility pop

#endif
