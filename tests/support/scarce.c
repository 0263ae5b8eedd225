/* One allocation fails, and those after it do not: what is left over then is looked at. */
#include "tests/support/scarce.h"

#include <stddef.h>

_Thread_local long scarce_left = -1;

static int fails_now(void)
{
    return scarce_left >= 0 && scarce_left-- == 0;
}

#define SCARCE(NAME, PARAMETERS, ...)                                                              \
    void *__real_##NAME PARAMETERS;                                                                \
    void *__wrap_##NAME PARAMETERS;                                                                \
    void *__wrap_##NAME PARAMETERS                                                                 \
    {                                                                                              \
        return fails_now() ? NULL : __real_##NAME(__VA_ARGS__);                                    \
    }

SCARCE(malloc, (size_t n), n)
SCARCE(calloc, (size_t n, size_t size), n, size)
SCARCE(realloc, (void *block, size_t n), block, n)
SCARCE(aligned_alloc, (size_t line, size_t n), line, n)
