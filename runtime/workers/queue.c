/* Queues of ready tasks. A task is in one place: the inbox, the deque or the heap of one queue.
 * Only the owner moves tasks from inbox to deque to heap.
 *
 * Deque: oldest <= newest, but for the moment in which the owner takes from an empty deque. A task
 * leaves the deque to the owner, or to the thread that moves `oldest` past it. Heap: a worker that
 * entered has it alone; others only read `n`. */
#include "runtime/workers/queue.h"

#include "runtime/base/heap.h"
#include "runtime/base/memory.h"
#include "runtime/base/stack.h"

#include <stdlib.h>

enum { FIRST_SLOTS = 256 }; /* of a deque */

/* ---- Deque ---- */

static struct work_ring *ring_new(uint64_t slots, struct work_ring *older)
{
    struct work_ring *ring = base_alloc(sizeof *ring + slots * sizeof ring->slot[0]);
    if (!ring)
        return NULL;
    ring->mask = slots - 1;
    ring->older = older;
    for (uint64_t i = 0; i < slots; i++)
        atomic_init(&ring->slot[i], NULL);
    return ring;
}

bool work_deque_start(struct work_deque *deque, uint64_t slots)
{
    struct work_ring *ring = ring_new(slots, NULL);
    atomic_init(&deque->oldest, 0);
    atomic_init(&deque->newest, 0);
    deque->seen = 0;
    atomic_init(&deque->ring, ring);
    return ring != NULL;
}

void work_deque_stop(struct work_deque *deque)
{
    struct work_ring *ring = atomic_load(&deque->ring);
    while (ring) {
        struct work_ring *older = ring->older;
        base_free(ring);
        ring = older;
    }
}

static struct work_ring *ring_grow(struct work_deque *deque, struct work_ring *ring, int64_t oldest,
                                   int64_t newest)
{
    struct work_ring *larger = ring_new(2 * (ring->mask + 1), ring);
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
static inline int64_t deque_end(const struct work_deque *deque)
{
    return atomic_load_explicit(&deque->newest, memory_order_relaxed);
}

/* Fills the slot `newest`, at the end or beyond; deque_show shows all filled slots at once. False
 * without memory. */
static inline bool deque_fill(struct work_deque *deque, int64_t newest, struct task *task)
{
    struct work_ring *ring = atomic_load_explicit(&deque->ring, memory_order_relaxed);
    if (newest - deque->seen > (int64_t)ring->mask) {
        deque->seen = atomic_load_explicit(&deque->oldest, memory_order_acquire);
        if (newest - deque->seen > (int64_t)ring->mask &&
            !(ring = ring_grow(deque, ring, deque->seen, newest)))
            return false;
    }
    atomic_store_explicit(&ring->slot[(uint64_t)newest & ring->mask], task, memory_order_relaxed);
    return true;
}

static inline void deque_show(struct work_deque *deque, int64_t newest)
{
    /* Sequentially consistent: a look for sleepers follows. */
    atomic_exchange_explicit(&deque->newest, newest, memory_order_seq_cst);
}

static inline bool deque_push(struct work_deque *deque, struct task *task)
{
    int64_t newest = deque_end(deque);
    if (!deque_fill(deque, newest, task))
        return false;
    deque_show(deque, newest + 1);
    return true;
}

bool work_deque_push(struct work_deque *deque, struct task *task)
{
    return deque_push(deque, task);
}

static inline struct task *deque_take_newest(struct work_deque *deque)
{
    int64_t newest = atomic_load_explicit(&deque->newest, memory_order_relaxed) - 1;
    struct work_ring *ring = atomic_load_explicit(&deque->ring, memory_order_relaxed);
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

struct task *work_deque_take_newest(struct work_deque *deque)
{
    return deque_take_newest(deque);
}

struct task *work_deque_take_oldest(struct work_deque *deque, bool *again)
{
    int64_t oldest = atomic_load_explicit(&deque->oldest, memory_order_seq_cst);
    int64_t newest = atomic_load_explicit(&deque->newest, memory_order_seq_cst);
    *again = false;
    if (oldest >= newest)
        return NULL;
    struct work_ring *ring = atomic_load_explicit(&deque->ring, memory_order_acquire);
    struct task *task =
        atomic_load_explicit(&ring->slot[(uint64_t)oldest & ring->mask], memory_order_relaxed);
    if (atomic_compare_exchange_strong_explicit(&deque->oldest, &oldest, oldest + 1,
                                                memory_order_seq_cst, memory_order_relaxed))
        return task;
    *again = true;
    return NULL;
}

/* ---- Heap ---- */

struct work_ranked {
    struct task *task;
    uint64_t came;
    int32_t priority;
    float path;
};

void work_heap_start(struct work_heap *heap)
{
    heap->entry = NULL;
    heap->capacity = 0;
    heap->came = 0;
    atomic_init(&heap->n, 0);
    atomic_flag_clear(&heap->busy);
}

void work_heap_stop(struct work_heap *heap)
{
    free(heap->entry);
}

bool work_heap_enter(struct work_heap *heap)
{
    return !atomic_flag_test_and_set_explicit(&heap->busy, memory_order_acquire);
}

void work_heap_leave(struct work_heap *heap)
{
    atomic_flag_clear_explicit(&heap->busy, memory_order_release);
}

static bool heap_before(const void *left, const void *right, const void *unused)
{
    const struct work_ranked *a = left, *b = right;
    (void)unused;
    if (a->priority != b->priority)
        return a->priority > b->priority;
    return a->path != b->path ? a->path > b->path : a->came < b->came;
}

bool work_heap_push(struct work_heap *heap, struct task *task)
{
    size_t n = atomic_load_explicit(&heap->n, memory_order_relaxed);
    void *moved = base_grow(heap->entry, &heap->capacity, n + 1, sizeof *heap->entry);
    if (!moved)
        return false;
    heap->entry = moved;
    struct work_ranked new = {task, heap->came++, task->priority, task_path(task)};
    atomic_store_explicit(&heap->n, n + 1, memory_order_relaxed);
    base_heap_push(heap->entry, n, &new, sizeof new, heap_before, NULL);
    return true;
}

struct task *work_heap_pop(struct work_heap *heap)
{
    size_t n = atomic_load_explicit(&heap->n, memory_order_relaxed);
    struct work_ranked first;
    if (!n)
        return NULL;
    atomic_store_explicit(&heap->n, n - 1, memory_order_relaxed);
    base_heap_pop(heap->entry, n, &first, sizeof first, heap_before, NULL);
    return first.task;
}

/* ---- Queue ---- */

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
    if (!deque_push(&queue->deque, task))
        work_queue_put(queue, task); /* no memory for a larger ring: the inbox has no bound */
}

/* The inbox, oldest first. */
static struct task *inbox_take_all(struct work_queue *queue)
{
    if (BASE_STACK_IS_EMPTY(&queue->inbox))
        return NULL;
    struct task *task = BASE_STACK_TAKE(&queue->inbox);
    BASE_LIST_REVERSE(task);
    return task;
}

/* A list, oldest first. Without memory for a larger ring the rest goes to the inbox, which has no
 * bound. */
static void queue_push_all(struct work_queue *queue, struct task *task)
{
    int64_t newest = deque_end(&queue->deque);
    for (; task && deque_fill(&queue->deque, newest, task); newest++)
        task = task->next;
    if (newest != deque_end(&queue->deque))
        deque_show(&queue->deque, newest);
    while (task) {
        struct task *next = task->next;
        work_queue_put(queue, task);
        task = next;
    }
}

static struct task *deque_take_oldest(struct work_deque *deque)
{
    bool again = true;
    struct task *task = NULL;
    while (again)
        task = work_deque_take_oldest(deque, &again);
    return task;
}

/* NULL: the heap is empty, or another worker is in it. */
static struct task *heap_take(struct work_heap *heap)
{
    if (!atomic_load_explicit(&heap->n, memory_order_relaxed) || !work_heap_enter(heap))
        return NULL;
    struct task *task = work_heap_pop(heap);
    work_heap_leave(heap);
    return task;
}

static struct task *queue_take_highest(struct work_queue *queue)
{
    struct task *task = deque_take_oldest(&queue->deque);
    if (!work_heap_enter(&queue->heap))
        return task;
    while (task && work_heap_push(&queue->heap, task))
        task = deque_take_oldest(&queue->deque);
    if (!task) /* else there was no memory: it runs at once */
        task = work_heap_pop(&queue->heap);
    work_heap_leave(&queue->heap);
    return task;
}

/* A scheduler may serve by priority now and otherwise later, so every way of taking also looks into
 * the heap. A worker that takes at the old end and pushes at the new one thus comes by all
 * tasks. */
static struct task *queue_take(struct work_queue *queue, duite_end end)
{
    struct task *came = inbox_take_all(queue);
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

struct task *work_queue_take(struct work_queue *queue, duite_end end)
{
    if (work_queue_is_empty(queue)) /* an idle worker asks all the time */
        return NULL;
    struct task *task = queue_take(queue, end);
    /* A ring that could not grow leaves tasks in the inbox: run them from there. */
    if (!task && (task = inbox_take_all(queue)))
        queue_push_all(queue, task->next);
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
            return deque_take_oldest(&queue->deque);
        task = work_queue_take(queue, end);
        /* Workers that did not get the token may have been woken for a task that came after this
         * look. If it stayed in the inbox, none of them would come back. */
        atomic_flag_clear_explicit(&queue->token,
                                   task ? memory_order_release : memory_order_seq_cst);
    } while (!task && atomic_load_explicit(&queue->inbox, memory_order_seq_cst));
    return task;
}

struct task *work_queue_steal(struct work_queue *victim, struct work_queue *own)
{
    struct task *task = heap_take(&victim->heap);
    if (!task)
        task = deque_take_oldest(&victim->deque);
    if (task || !(task = inbox_take_all(victim)))
        return task;
    queue_push_all(own, task->next);
    return task;
}
