#ifndef TESTS_SUPPORT_KERNEL_H
#define TESTS_SUPPORT_KERNEL_H

#include <duite.h>

/* A kernel of a test, with its name and its body, which may name the kernel:
 *
 *     KERNEL(MARK, "mark", .access = {DUITE_RW})
 *     {
 *         duite_out(call, 0, int32_t)[0] += 1;
 *         return 0;
 *     }
 *
 * KERNEL_SHARED is that of a file which shows it to others by its header. Another kernel with the
 * same body has .body = MARK_body. */
#define KERNEL(NAME, ...)        KERNEL_AS(static, NAME, __VA_ARGS__)
#define KERNEL_SHARED(NAME, ...) KERNEL_AS(, NAME, __VA_ARGS__)
#define KERNEL_AS(LINKAGE, NAME, ...)                                                              \
    static int NAME##_body(const duite_call *call);                                                \
    LINKAGE const duite_kernel NAME = {.body = NAME##_body, .name = __VA_ARGS__};                  \
    static int NAME##_body(const duite_call *call)

#endif
