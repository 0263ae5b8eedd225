/* A task is in one place: the inbox, the deque or the heap of one queue. Only the owner moves tasks
 * from inbox to deque to heap. */
#include "runtime/workers/queue.h"

#include "runtime/base/stack.h"

enum { FIRST_SLOTS = 256 };

bool work_queue_start(struct work_queue *queue)
{
    atomic_init(&queue->inbox, NULL);
    atomic_flag_clear(&queue->token);
    work_heap_start(&queue->heap);
    return work_deque_start(&queue->deque, FIRST_SLOTS);
}

void work_queue_stop(struct work_queue *queue)
{
    work_deque_stop(&queue->deque);
    work_heap_stop(&queue->heap);
}

void work_queue_put(struct work_queue *queue, struct task *task)
{
    BASE_STACK_PUSH(&queue->inbox, task, memory_order_seq_cst);
}

void work_queue_push(struct work_queue *queue, struct task *task)
{
    if (!work_deque_push(&queue->deque, task))
        work_queue_put(queue, task); /* no memory for a larger ring: the inbox has no bound */
}

/* The inbox, oldest first. */
static struct task *empty_inbox(struct work_queue *queue)
{
    if (BASE_STACK_IS_EMPTY(&queue->inbox))
        return NULL;
    struct task *task = BASE_STACK_TAKE(&queue->inbox);
    BASE_LIST_REVERSE(task);
    return task;
}

/* A list, oldest first. What finds no memory for a larger ring goes to the inbox, which has no
 * bound. */
static void push_all(struct work_queue *queue, struct task *task)
{
    int64_t newest = work_deque_end(&queue->deque);
    for (; task && work_deque_fill(&queue->deque, newest, task); newest++)
        task = task->next;
    if (newest != work_deque_end(&queue->deque))
        work_deque_show(&queue->deque, newest);
    while (task) {
        struct task *next = task->next;
        work_queue_put(queue, task);
        task = next;
    }
}

static struct task *take_oldest(struct work_deque *deque)
{
    bool again = true;
    struct task *task = NULL;
    while (again)
        task = work_deque_take_oldest(deque, &again);
    return task;
}

/* NULL: the heap is empty, or another one is at it. */
static struct task *take_ranked(struct work_heap *heap)
{
    if (!atomic_load_explicit(&heap->n, memory_order_relaxed) || !work_heap_enter(heap))
        return NULL;
    struct task *task = work_heap_pop(heap);
    work_heap_leave(heap);
    return task;
}

static struct task *take_highest(struct work_queue *queue)
{
    struct task *task = take_oldest(&queue->deque);
    if (!work_heap_enter(&queue->heap))
        return task;
    while (task && work_heap_push(&queue->heap, task))
        task = take_oldest(&queue->deque);
    if (!task) /* else there was no memory: it runs at once */
        task = work_heap_pop(&queue->heap);
    work_heap_leave(&queue->heap);
    return task;
}

/* A scheduler may serve by priority now and otherwise later: what lies in the heap is found by all
 * ways, and who goes round the queue from its old end to the new one comes by all of it. */
static struct task *take(struct work_queue *queue, duite_end end)
{
    push_all(queue, empty_inbox(queue));
    if (end == DUITE_HIGHEST)
        return take_highest(queue);
    if (end == DUITE_NEWEST) {
        struct task *task = work_deque_take_newest(&queue->deque);
        return task ? task : take_ranked(&queue->heap);
    }
    struct task *task = take_ranked(&queue->heap);
    return task ? task : take_oldest(&queue->deque);
}

struct task *work_queue_take(struct work_queue *queue, duite_end end)
{
    if (work_queue_is_empty(queue)) /* an idle worker asks all the time */
        return NULL;
    struct task *task = take(queue, end);
    /* A ring that could not grow leaves tasks in the inbox: run them from there. */
    if (!task && (task = empty_inbox(queue)))
        push_all(queue, task->next);
    return task;
}

int64_t work_queue_mark(struct work_queue *queue)
{
    if (atomic_load_explicit(&queue->inbox, memory_order_relaxed))
        return -1;
    return atomic_load_explicit(&queue->deque.newest, memory_order_relaxed);
}

struct task *work_queue_take_shared(struct work_queue *queue, duite_end end)
{
    struct task *task;
    if (work_queue_is_empty(queue))
        return NULL;
    do {
        if (atomic_flag_test_and_set_explicit(&queue->token, memory_order_seq_cst))
            return take_oldest(&queue->deque);
        task = work_queue_take(queue, end);
        /* Others were turned away by the token, and may have been woken for what came after this
         * look: with it in the inbox, nobody would come back. */
        atomic_flag_clear_explicit(&queue->token,
                                   task ? memory_order_release : memory_order_seq_cst);
    } while (!task && atomic_load_explicit(&queue->inbox, memory_order_seq_cst));
    return task;
}

struct task *work_queue_steal(struct work_queue *victim, struct work_queue *own)
{
    struct task *task = take_ranked(&victim->heap);
    if (!task)
        task = take_oldest(&victim->deque);
    if (task || !(task = empty_inbox(victim)))
        return task;
    push_all(own, task->next);
    return task;
}
