#ifndef DUITE_WORKERS_HEAP_H
#define DUITE_WORKERS_HEAP_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct task;

/* Tasks by priority; of equals the one with the longest path, then the one that came first. Whoever
 * holds `busy` may look inside; `n` anybody may read. */
struct work_heap {
    struct work_ranked *entry;
    size_t capacity;
    uint64_t came; /* tasks so far */
    _Atomic size_t n;
    atomic_flag busy;
};

void work_heap_start(struct work_heap *heap);
void work_heap_stop(struct work_heap *heap);

/* Nobody waits: false if another one is at it. */
bool work_heap_enter(struct work_heap *heap);
void work_heap_leave(struct work_heap *heap);

/* For who entered. False without memory: the task is not in it. */
bool work_heap_push(struct work_heap *heap, struct task *task);
/* For who entered. NULL: empty. */
struct task *work_heap_pop(struct work_heap *heap);

#endif
