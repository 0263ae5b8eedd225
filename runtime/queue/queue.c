/* Queues of ready tasks. A task is in one place: the inbox, the deque or the heap of one queue.
 * Only the owner moves tasks from inbox to deque to heap.
 *
 * Deque: oldest <= newest, but for the moment in which the owner takes from an empty deque. A task
 * leaves the deque to the owner, or to the thread that moves `oldest` past it. Heap: a worker that
 * entered has it alone; others only read `n`. */
#include "runtime/queue/queue.h"

#include "runtime/base/heap.h"
#include "runtime/base/memory.h"
#include "runtime/base/stack.h"

#include <stdlib.h>

enum { FIRST_SLOTS = 256 }; /* of a deque */

/* ---- Deque ---- */

static struct queue_ring *ring_new(uint64_t slots, struct queue_ring *older)
{
    struct queue_ring *ring = base_alloc(sizeof *ring + slots * sizeof ring->slot[0]);
    if (!ring)
        return NULL;
    ring->mask = slots - 1;
    ring->older = older;
    for (uint64_t i = 0; i < slots; i++)
        atomic_init(&ring->slot[i], NULL);
    return ring;
}

/* slots: of the first ring, a power of 2. False without memory. */
static bool queue_deque_start(struct queue_deque *deque, uint64_t slots)
{
    struct queue_ring *ring = ring_new(slots, NULL);
    atomic_init(&deque->oldest, 0);
    atomic_init(&deque->newest, 0);
    deque->seen = 0;
    atomic_init(&deque->ring, ring);
    return ring != NULL;
}

static void queue_deque_stop(struct queue_deque *deque)
{
    struct queue_ring *ring = atomic_load(&deque->ring);
    while (ring) {
        struct queue_ring *older = ring->older;
        base_free(ring);
        ring = older;
    }
}

static struct queue_ring *ring_grow(struct queue_deque *deque, struct queue_ring *ring,
                                    int64_t oldest, int64_t newest)
{
    struct queue_ring *larger = ring_new(2 * (ring->mask + 1), ring);
    if (!larger)
        return NULL;
    for (int64_t i = oldest; i < newest; i++) {
        struct task *task =
            atomic_load_explicit(&ring->slot[(uint64_t)i & ring->mask], memory_order_relaxed);
        atomic_store_explicit(&larger->slot[(uint64_t)i & larger->mask], task,
                              memory_order_relaxed);
    }
    atomic_store_explicit(&deque->ring, larger, memory_order_release);
    return larger;
}

/* Where the next task goes. */
static inline int64_t deque_end(const struct queue_deque *deque)
{
    return atomic_load_explicit(&deque->newest, memory_order_relaxed);
}

/* Fills the slot `newest`, at the end or beyond; deque_show shows all filled slots at once. False
 * without memory. */
static inline bool deque_fill(struct queue_deque *deque, int64_t newest, struct task *task)
{
    struct queue_ring *ring = atomic_load_explicit(&deque->ring, memory_order_relaxed);
    if (newest - deque->seen > (int64_t)ring->mask) {
        deque->seen = atomic_load_explicit(&deque->oldest, memory_order_acquire);
        if (newest - deque->seen > (int64_t)ring->mask &&
            !(ring = ring_grow(deque, ring, deque->seen, newest)))
            return false;
    }
    atomic_store_explicit(&ring->slot[(uint64_t)newest & ring->mask], task, memory_order_relaxed);
    return true;
}

static inline void deque_show(struct queue_deque *deque, int64_t newest)
{
    /* Sequentially consistent: a look for sleepers follows. */
    atomic_exchange_explicit(&deque->newest, newest, memory_order_seq_cst);
}

/* Owner only. False without memory: nothing was pushed. */
static inline bool deque_push(struct queue_deque *deque, struct task *task)
{
    int64_t newest = deque_end(deque);
    if (!deque_fill(deque, newest, task))
        return false;
    deque_show(deque, newest + 1);
    return true;
}

/* Owner only. NULL if it is empty. */
static inline struct task *deque_take_newest(struct queue_deque *deque)
{
    int64_t newest = atomic_load_explicit(&deque->newest, memory_order_relaxed) - 1;
    struct queue_ring *ring = atomic_load_explicit(&deque->ring, memory_order_relaxed);
    /* The claim on the last task must be seen before `oldest` is read: sequentially consistent on
     * both sides. */
    atomic_exchange_explicit(&deque->newest, newest, memory_order_seq_cst);
    int64_t oldest = atomic_load_explicit(&deque->oldest, memory_order_seq_cst);
    if (oldest > newest) {
        atomic_store_explicit(&deque->newest, newest + 1, memory_order_relaxed);
        return NULL;
    }
    struct task *task =
        atomic_load_explicit(&ring->slot[(uint64_t)newest & ring->mask], memory_order_relaxed);
    if (oldest < newest)
        return task;
    if (!atomic_compare_exchange_strong_explicit(&deque->oldest, &oldest, oldest + 1,
                                                 memory_order_seq_cst, memory_order_relaxed))
        task = NULL; /* a thief got the last one */
    atomic_store_explicit(&deque->newest, newest + 1, memory_order_relaxed);
    return task;
}

/* Anybody. NULL if it is empty or another thief was faster (*again is set then). */
__attribute__((noinline)) static struct task *queue_deque_take_oldest(struct queue_deque *deque,
                                                                      bool *again)
{
    int64_t oldest = atomic_load_explicit(&deque->oldest, memory_order_seq_cst);
    int64_t newest = atomic_load_explicit(&deque->newest, memory_order_seq_cst);
    *again = false;
    if (oldest >= newest)
        return NULL;
    struct queue_ring *ring = atomic_load_explicit(&deque->ring, memory_order_acquire);
    struct task *task =
        atomic_load_explicit(&ring->slot[(uint64_t)oldest & ring->mask], memory_order_relaxed);
    if (atomic_compare_exchange_strong_explicit(&deque->oldest, &oldest, oldest + 1,
                                                memory_order_seq_cst, memory_order_relaxed))
        return task;
    *again = true;
    return NULL;
}

/* ---- Heap ---- */

struct queue_ranked {
    struct task *task;
    uint64_t came;
    struct queue_rank rank;
};

/* Does not wait: false if another thread has entered. */
static bool queue_heap_enter(struct queue_heap *heap)
{
    return !atomic_flag_test_and_set_explicit(&heap->busy, memory_order_acquire);
}

static void queue_heap_leave(struct queue_heap *heap)
{
    atomic_flag_clear_explicit(&heap->busy, memory_order_release);
}

static bool heap_before(const void *left, const void *right, const void *unused)
{
    const struct queue_ranked *a = left, *b = right;
    (void)unused;
    if (a->rank.priority != b->rank.priority)
        return a->rank.priority > b->rank.priority;
    return a->rank.path != b->rank.path ? a->rank.path > b->rank.path : a->came < b->came;
}

/* After entering. False without memory: the task is not in it. */
__attribute__((noinline)) static bool queue_heap_push(struct queue_heap *heap, struct task *task)
{
    size_t n = atomic_load_explicit(&heap->n, memory_order_relaxed);
    if (!BASE_GROW(heap->entry, heap->capacity, n + 1))
        return false;
    struct queue_ranked new = {task, heap->came++, heap->rank(task)};
    atomic_store_explicit(&heap->n, n + 1, memory_order_relaxed);
    base_heap_push(heap->entry, n, &new, sizeof new, heap_before, NULL);
    return true;
}

/* After entering. NULL: empty. */
__attribute__((noinline)) static struct task *queue_heap_pop(struct queue_heap *heap)
{
    size_t n = atomic_load_explicit(&heap->n, memory_order_relaxed);
    struct queue_ranked first;
    if (!n)
        return NULL;
    atomic_store_explicit(&heap->n, n - 1, memory_order_relaxed);
    base_heap_pop(heap->entry, n, &first, sizeof first, heap_before, NULL);
    return first.task;
}

/* ---- Queue ---- */

bool queue_start(struct queue *queue, queue_ranks_by *rank)
{
    atomic_init(&queue->inbox, NULL);
    atomic_flag_clear(&queue->token);
    queue->heap = (struct queue_heap){.rank = rank};
    atomic_flag_clear(&queue->heap.busy);
    return queue_deque_start(&queue->deque, FIRST_SLOTS);
}

void queue_stop(struct queue *queue)
{
    queue_deque_stop(&queue->deque);
    free(queue->heap.entry);
}

void queue_put(struct queue *queue, struct task *task)
{
    struct queue_link *link = queue_link(task);
    BASE_STACK_PUSH(&queue->inbox, link, memory_order_seq_cst);
}

void queue_push(struct queue *queue, struct task *task)
{
    if (!deque_push(&queue->deque, task))
        queue_put(queue, task); /* no memory for a larger ring: the inbox has no bound */
}

/* The inbox, oldest first. */
static struct queue_link *inbox_take_all(struct queue *queue)
{
    if (BASE_STACK_IS_EMPTY(&queue->inbox))
        return NULL;
    struct queue_link *list = BASE_STACK_TAKE(&queue->inbox);
    BASE_LIST_REVERSE(list);
    return list;
}

/* A list, oldest first. Without memory for a larger ring the rest goes to the inbox, which has no
 * bound. */
static void queue_push_all(struct queue *queue, struct queue_link *list)
{
    int64_t newest = deque_end(&queue->deque);
    for (; list && deque_fill(&queue->deque, newest, queue_task(list)); newest++)
        list = list->next;
    if (newest != deque_end(&queue->deque))
        deque_show(&queue->deque, newest);
    while (list) {
        struct queue_link *next = list->next;
        queue_put(queue, queue_task(list));
        list = next;
    }
}

static struct task *deque_take_oldest(struct queue_deque *deque)
{
    bool again = true;
    struct task *task = NULL;
    while (again)
        task = queue_deque_take_oldest(deque, &again);
    return task;
}

/* NULL: the heap is empty, or another worker is in it. */
static struct task *heap_take(struct queue_heap *heap)
{
    if (!atomic_load_explicit(&heap->n, memory_order_relaxed) || !queue_heap_enter(heap))
        return NULL;
    struct task *task = queue_heap_pop(heap);
    queue_heap_leave(heap);
    return task;
}

static struct task *queue_take_highest(struct queue *queue)
{
    struct task *task = deque_take_oldest(&queue->deque);
    if (!queue_heap_enter(&queue->heap))
        return task;
    while (task && queue_heap_push(&queue->heap, task))
        task = deque_take_oldest(&queue->deque);
    if (!task) /* else there was no memory: it runs at once */
        task = queue_heap_pop(&queue->heap);
    queue_heap_leave(&queue->heap);
    return task;
}

/* A scheduler may serve by priority now and otherwise later, so every way of taking also looks into
 * the heap. A worker that takes at the old end and pushes at the new one thus comes by all
 * tasks. */
static struct task *queue_take_end(struct queue *queue, duite_end end)
{
    struct queue_link *came = inbox_take_all(queue);
    if (came)
        queue_push_all(queue, came);
    if (end == DUITE_HIGHEST)
        return queue_take_highest(queue);
    if (end == DUITE_NEWEST) {
        struct task *task = deque_take_newest(&queue->deque);
        return task ? task : heap_take(&queue->heap);
    }
    struct task *task = heap_take(&queue->heap);
    return task ? task : deque_take_oldest(&queue->deque);
}

struct task *queue_take(struct queue *queue, duite_end end)
{
    if (queue_is_empty(queue)) /* an idle worker asks all the time */
        return NULL;
    struct task *task = queue_take_end(queue, end);
    /* A ring that could not grow leaves tasks in the inbox: run them from there. */
    struct queue_link *list = task ? NULL : inbox_take_all(queue);
    if (!list)
        return task;
    queue_push_all(queue, list->next);
    return queue_task(list);
}

int64_t queue_mark(struct queue *queue)
{
    if (atomic_load_explicit(&queue->inbox, memory_order_relaxed))
        return -1;
    return atomic_load_explicit(&queue->deque.newest, memory_order_relaxed);
}

struct task *queue_take_shared(struct queue *queue, duite_end end)
{
    struct task *task;
    if (queue_is_empty(queue))
        return NULL;
    do {
        if (atomic_flag_test_and_set_explicit(&queue->token, memory_order_seq_cst))
            return deque_take_oldest(&queue->deque);
        task = queue_take(queue, end);
        /* Workers that did not get the token may have been woken for a task that came after this
         * look. If it stayed in the inbox, none of them would come back. */
        atomic_flag_clear_explicit(&queue->token,
                                   task ? memory_order_release : memory_order_seq_cst);
    } while (!task && atomic_load_explicit(&queue->inbox, memory_order_seq_cst));
    return task;
}

struct task *queue_steal(struct queue *victim, struct queue *own)
{
    struct task *task = heap_take(&victim->heap);
    if (!task)
        task = deque_take_oldest(&victim->deque);
    struct queue_link *list = task ? NULL : inbox_take_all(victim);
    if (!list)
        return task;
    queue_push_all(own, list->next);
    return queue_task(list);
}
