#ifndef DUITE_BASE_POOL_H
#define DUITE_BASE_POOL_H

#include <stddef.h>

/* Small blocks that live briefly and die on another thread than they were born on: tasks, versions,
 * messages. Each thread keeps some of each size at hand; whole batches move between threads. The
 * general allocator locks here, and a futex costs more than a task. */

/* size bytes, not cleared, aligned to a cache line if they are whole lines, to 16 bytes if they are
 * a multiple of that, else to 8. NULL without memory. */
void *base_pool_take(size_t size);
/* Gives back what was taken with the same size, on any thread. NULL is fine. */
void base_pool_give(void *memory, size_t size);

/* A runtime begins, and ends; with the last one all memory goes back. */
void base_pool_enter(void);
void base_pool_leave(void);

/* The calling thread ends: what it has at hand goes to the others. */
void base_pool_thread_end(void);

#endif
