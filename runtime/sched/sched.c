/* The built-in schedulers by name: the rows of sched.h. */
#include "runtime/sched/sched.h"

#include "runtime/base/policy.h"

#include <duite.h>

#define SCHED_TABLE(name) &sched_##name,

static const char *const sched_names[] = {SCHED_ROWS(BASE_POLICY_NAME) NULL,
                                          SCHED_TEST_ROWS(BASE_POLICY_NAME) NULL};
static const void *const sched_tables[] = {SCHED_ROWS(SCHED_TABLE) NULL,
                                           SCHED_TEST_ROWS(SCHED_TABLE) NULL};
static const struct base_policies schedulers = {"scheduler", "duite_own_scheduler", sched_names,
                                                sched_tables};

const duite_scheduler *duite_scheduler_find(const char *name)
{
    return base_policy_find(&schedulers, name);
}

const char *const *duite_scheduler_names(void)
{
    return sched_names;
}

const char *const *sched_test_names(void)
{
    return base_policy_test_names(&schedulers);
}

bool sched_is_foreign(const duite_scheduler *scheduler)
{
    return !base_policy_is_ours(&schedulers, scheduler);
}
