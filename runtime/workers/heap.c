/* The heap of base/heap.h, of tasks: who entered has it alone, others read `n` at most. */
#include "runtime/workers/heap.h"

#include "runtime/base/heap.h"
#include "runtime/base/memory.h"
#include "runtime/task/task.h"

#include <stdlib.h>

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

static bool work_ranked_before(const void *left, const void *right, const void *unused)
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
    base_heap_push(heap->entry, n, &new, sizeof new, work_ranked_before, NULL);
    return true;
}

struct task *work_heap_pop(struct work_heap *heap)
{
    size_t n = atomic_load_explicit(&heap->n, memory_order_relaxed);
    struct work_ranked first;
    if (!n)
        return NULL;
    atomic_store_explicit(&heap->n, n - 1, memory_order_relaxed);
    base_heap_pop(heap->entry, n, &first, sizeof first, work_ranked_before, NULL);
    return first.task;
}
