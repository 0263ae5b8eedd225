/* The built-in schedulers by name, the default first. */
#include "runtime/sched/sched.h"

#include "runtime/base/policy.h"
#include "runtime/sched/front.h"

#include <duite.h>

static const char *const names[] = {"steal",    "locality", "owner",   "fifo", "lifo",
                                    "priority", "static",   "shuffle", NULL};
static const void *const tables[] = {&sched_steal, &sched_locality, &sched_owner,  &sched_fifo,
                                     &sched_lifo,  &sched_priority, &sched_static, &sched_shuffle};

static const struct base_policies all = {"scheduler", "duite_own_scheduler", names, tables};

const duite_scheduler *duite_scheduler_find(const char *name)
{
    return base_policy_find(&all, name);
}

const char *const *duite_scheduler_names(void)
{
    return names;
}

bool sched_is_foreign(const duite_scheduler *scheduler)
{
    return !base_policy_is_ours(&all, scheduler);
}
