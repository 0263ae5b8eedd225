/* A thread fails with EAGAIN if its stack cannot be mapped, and beyond the limit of processes:
 * mapping as much tells which it was. */
#include "runtime/base/thread.h"

#include "runtime/base/error.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>
#include <sys/mman.h>

static size_t thread_stack_bytes(void)
{
    pthread_attr_t attributes;
    size_t bytes = 0;
    if (pthread_attr_init(&attributes))
        return 0;
    if (pthread_attr_getstacksize(&attributes, &bytes))
        bytes = 0;
    pthread_attr_destroy(&attributes);
    return bytes;
}

static bool thread_stack_fits(size_t bytes)
{
    void *room =
        bytes ? mmap(NULL, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK, -1, 0) : NULL;
    if (room == MAP_FAILED)
        return false;
    if (room)
        munmap(room, bytes);
    return true;
}

struct base_stack base_stack_here(void)
{
    struct base_stack stack = {0};
    pthread_attr_t attributes;
    void *lowest = NULL;
    if (pthread_getattr_np(pthread_self(), &attributes))
        return stack;
    if (!pthread_attr_getstack(&attributes, &lowest, &stack.bytes)) {
        const char *here = __builtin_frame_address(0);
        stack.floor = here - (here - (const char *)lowest) / 4 * 3;
    }
    pthread_attr_destroy(&attributes);
    return stack;
}

int base_thread_start(pthread_t *thread, const char *what, void *(*body)(void *), void *context)
{
    const int reason = pthread_create(thread, NULL, body, context);
    if (!reason)
        return DUITE_OK;
    const size_t bytes = thread_stack_bytes();
    if (reason == ENOMEM || (reason == EAGAIN && !thread_stack_fits(bytes)))
        return base_error(DUITE_E_MEMORY,
                          "out of memory for %s: pthread_create cannot map its stack of %zu bytes "
                          "(ulimit -v limits the memory of a process, ulimit -s sets the stack)",
                          what, bytes);
    return base_error(DUITE_E_SYSTEM, "cannot start %s: pthread_create: %s%s", what,
                      strerror(reason),
                      reason == EAGAIN ? " (is there a limit of threads, as by ulimit -u?)" : "");
}
