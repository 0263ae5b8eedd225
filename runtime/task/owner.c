/* The owner rule: only the modes and the number of objects decide. */
#include "runtime/task/owner.h"

uint32_t task_owner(const duite_mode *access, duite_mode variadic, size_t n)
{
    uint32_t first_read = TASK_NOBODY;
    bool ended = false;
    for (uint32_t i = 0; i < n && i <= DUITE_MAX_ACCESS; i++) { /* further ones are like the last */
        ended |= i == DUITE_MAX_ACCESS || access[i] == DUITE_NONE;
        switch (ended ? variadic : access[i]) {
        case DUITE_W:
        case DUITE_WP:
        case DUITE_RW:
        case DUITE_RWP:
            return i;
        case DUITE_R:
        case DUITE_RP:
            if (first_read == TASK_NOBODY)
                first_read = i;
            break;
        case DUITE_CW:
        case DUITE_CWP:
        case DUITE_NONE:
            break;
        }
    }
    return first_read;
}
