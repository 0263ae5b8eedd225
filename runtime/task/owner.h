#ifndef DUITE_TASK_OWNER_H
#define DUITE_TASK_OWNER_H

#include <duite.h>

#include <stdbool.h>
#include <stdint.h>

/* The owner rule: for which of its objects a task runs, and on which rank. It stands here and
 * nowhere else: forks, forks that are only noted, recorded graphs, their plans and the predictor
 * all ask these functions. Pure; any thread. */

enum {
    TASK_ANYWHERE = -1,  /* a fork that names no rank */
    TASK_EVERYWHERE = -2 /* runs on all ranks */
};
#define TASK_NOBODY UINT32_MAX

/* The parameter that a task with n objects runs for: the first one that it writes (w, rw), else the
 * first one that it reads; TASK_NOBODY if it only accumulates. Postponed modes count like those
 * without delay. `access` has DUITE_MAX_ACCESS modes or is ended by DUITE_NONE; further parameters
 * have the mode `variadic`. */
static inline uint32_t task_owner(const uint8_t *access, duite_mode variadic, size_t n)
{
    uint32_t first_read = TASK_NOBODY;
    bool ended = false;
    for (uint32_t i = 0; i < n && i <= DUITE_MAX_ACCESS; i++) { /* further ones are like the last */
        ended |= i == DUITE_MAX_ACCESS || access[i] == DUITE_NONE;
        switch (ended ? variadic : (duite_mode)access[i]) {
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

/* True if that object's home decides where a task of the main program runs: its fork names no rank,
 * and its kernel is not replicated. */
static inline bool task_owner_decides(int at, bool replicated)
{
    return at == TASK_ANYWHERE && !replicated;
}

/* The rank that runs a task of the main program, or TASK_EVERYWHERE. home: that of the object that
 * it runs for; negative if it runs for none. */
static inline int task_owner_rank(int at, bool replicated, int home)
{
    if (replicated)
        return TASK_EVERYWHERE;
    if (!task_owner_decides(at, replicated))
        return at;
    return home < 0 ? 0 : home;
}

#endif
