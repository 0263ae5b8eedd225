/* A binary heap in an array: no entry comes before its parent, (i - 1) / 2. */
#include "runtime/workers/heap.h"

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

static bool before(const struct work_ranked *a, const struct work_ranked *b)
{
    if (a->priority != b->priority)
        return a->priority > b->priority;
    return a->path != b->path ? a->path > b->path : a->came < b->came;
}

bool work_heap_push(struct work_heap *heap, struct task *task)
{
    size_t i = atomic_load_explicit(&heap->n, memory_order_relaxed);
    void *moved = base_grow(heap->entry, &heap->capacity, i + 1, sizeof *heap->entry);
    if (!moved)
        return false;
    heap->entry = moved;
    struct work_ranked new = {task, heap->came++, task->priority, task_path(task)};
    atomic_store_explicit(&heap->n, i + 1, memory_order_relaxed);
    for (; i && before(&new, &heap->entry[(i - 1) / 2]); i = (i - 1) / 2)
        heap->entry[i] = heap->entry[(i - 1) / 2];
    heap->entry[i] = new;
    return true;
}

struct task *work_heap_pop(struct work_heap *heap)
{
    size_t n = atomic_load_explicit(&heap->n, memory_order_relaxed), i = 0;
    if (!n)
        return NULL;
    struct task *first = heap->entry[0].task;
    struct work_ranked last = heap->entry[--n];
    atomic_store_explicit(&heap->n, n, memory_order_relaxed);
    for (size_t child = 1; child < n; child = 2 * i + 1) {
        if (child + 1 < n && before(&heap->entry[child + 1], &heap->entry[child]))
            child++;
        if (before(&last, &heap->entry[child]))
            break;
        heap->entry[i] = heap->entry[child];
        i = child;
    }
    heap->entry[i] = last;
    return first;
}
