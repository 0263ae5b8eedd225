#ifndef TESTS_MODEL_PLAIN_QUEUE_H
#define TESTS_MODEL_PLAIN_QUEUE_H

/* In place of queue.c, where sleep and waking are explored: queues that have what matters for them,
 * in a few steps. A task is a bit, by its number. Tasks that are pushed and put are seen at once; a
 * task is there until its bit is in `taken`. */
#include "runtime/queue/queue.h"

#include "tests/model/atomics.h"

struct plain {
    _Atomic uint64_t pushed, put, taken;
};

static struct task *plain_task(uint64_t bit);

static struct plain *plain(struct queue *queue)
{
    return (struct plain *)(void *)queue->deque.ring;
}

bool queue_start(struct queue *queue, queue_ranks_by *rank)
{
    (void)rank;
    queue->deque.ring = explore_alloc(sizeof(struct plain));
    return true;
}

void queue_stop(struct queue *queue)
{
    (void)queue;
}

void queue_put(struct queue *queue, struct task *task)
{
    struct plain *all = plain(queue);
    uint64_t bit = (uint64_t)1 << task->number;
    if (explore_planted("queue_put", "the put")) /* seen late; one thread puts */
        atomic_store_explicit(&all->put, all->put | bit, memory_order_release);
    else
        atomic_fetch_add(&all->put, bit);
}

void queue_push(struct queue *queue, struct task *task)
{
    struct plain *all = plain(queue);
    uint64_t before = atomic_load_explicit(&all->pushed, memory_order_relaxed);
    atomic_exchange_explicit(&all->pushed, before | (uint64_t)1 << task->number,
                             memory_order_seq_cst);
}

static struct task *plain_take(struct queue *queue)
{
    struct plain *all = plain(queue);
    for (;;) {
        uint64_t taken = atomic_load_explicit(&all->taken, memory_order_acquire);
        uint64_t there = (atomic_load_explicit(&all->put, memory_order_acquire) |
                          atomic_load_explicit(&all->pushed, memory_order_acquire)) &
                         ~taken;
        uint64_t first = there & -there;
        if (!there)
            return NULL;
        if (atomic_compare_exchange_strong_explicit(&all->taken, &taken, taken | first,
                                                    memory_order_seq_cst, memory_order_relaxed))
            return plain_task(first);
    }
}

struct task *queue_take(struct queue *queue, duite_end end)
{
    (void)end;
    return plain_take(queue);
}

int64_t queue_mark(struct queue *queue)
{
    return (int64_t)(uintptr_t)queue;
}

struct task *queue_take_shared(struct queue *queue, duite_end end)
{
    (void)end;
    return plain_take(queue);
}

struct task *queue_steal(struct queue *victim, struct queue *own)
{
    (void)own;
    return plain_take(victim);
}

#endif
