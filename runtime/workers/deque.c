/* oldest <= newest, but for the moment in which the owner takes from an empty deque. A task leaves
 * by the owner, or by whoever moves `oldest` past it. */
#include "runtime/workers/deque.h"

#include "runtime/base/memory.h"

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

static struct work_ring *grow(struct work_deque *deque, struct work_ring *ring, int64_t oldest,
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

int64_t work_deque_end(const struct work_deque *deque)
{
    return atomic_load_explicit(&deque->newest, memory_order_relaxed);
}

bool work_deque_fill(struct work_deque *deque, int64_t newest, struct task *task)
{
    struct work_ring *ring = atomic_load_explicit(&deque->ring, memory_order_relaxed);
    if (newest - deque->seen > (int64_t)ring->mask) {
        deque->seen = atomic_load_explicit(&deque->oldest, memory_order_acquire);
        if (newest - deque->seen > (int64_t)ring->mask &&
            !(ring = grow(deque, ring, deque->seen, newest)))
            return false;
    }
    atomic_store_explicit(&ring->slot[(uint64_t)newest & ring->mask], task, memory_order_relaxed);
    return true;
}

void work_deque_show(struct work_deque *deque, int64_t newest)
{
    /* Sequentially consistent: whoever pushes looks for sleepers next. */
    atomic_exchange_explicit(&deque->newest, newest, memory_order_seq_cst);
}

bool work_deque_push(struct work_deque *deque, struct task *task)
{
    int64_t newest = work_deque_end(deque);
    if (!work_deque_fill(deque, newest, task))
        return false;
    work_deque_show(deque, newest + 1);
    return true;
}

struct task *work_deque_take_newest(struct work_deque *deque)
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
