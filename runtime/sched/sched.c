/* The built-in schedulers by name, the default first. */
#include "runtime/sched/sched.h"

#include <duite.h>
#include <string.h>

static const duite_scheduler *const schedulers[] = {&sched_steal,    &sched_fifo,   &sched_lifo,
                                                    &sched_priority, &sched_static, &sched_shuffle};
enum { N_SCHEDULERS = sizeof schedulers / sizeof schedulers[0] };

const duite_scheduler *duite_scheduler_find(const char *name)
{
    for (int i = 0; i < N_SCHEDULERS; i++)
        if (name && !strcmp(schedulers[i]->name, name))
            return schedulers[i];
    return NULL;
}

const char *const *duite_scheduler_names(void)
{
    static const char *const names[N_SCHEDULERS + 1] = {"steal",    "fifo",   "lifo",
                                                        "priority", "static", "shuffle"};
    return names;
}
