#ifndef DUITE_BASE_THREAD_H
#define DUITE_BASE_THREAD_H

#include <pthread.h>
#include <stddef.h>

/* pthread_create with the default attributes. `what`: the thread's name in messages, "worker thread
 * 1 of 4". Errors: DUITE_E_MEMORY, with the stack's bytes, if the system has no room for it; else
 * DUITE_E_SYSTEM with the system's reason. Local. */
int base_thread_start(pthread_t *thread, const char *what, void *(*body)(void *), void *context);

/* The calling thread's stack. */
struct base_stack {
    size_t bytes;      /* of all of it; 0: unknown */
    const char *floor; /* below this address lies the last quarter of what was left at the call;
                          NULL: unknown */
};
struct base_stack base_stack_here(void);

#endif
