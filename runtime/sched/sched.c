/* The built-in schedulers by name (the rows of sched.h), and decisions that several of them
 * share. */
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

/* ---- Decisions ---- */

/* A function that reads its state expects a sched_state there, or a structure that begins with
 * one. */

void sched_start(void *state, unsigned worker, unsigned n_workers, uint64_t seed)
{
    struct sched_state *own = state;
    *own = (struct sched_state){.random = seed + worker, .worker = worker, .n_workers = n_workers};
}

unsigned sched_place_shared(void *state, const duite_ready *task)
{
    (void)state;
    (void)task;
    return DUITE_SHARED_QUEUE;
}

unsigned sched_place_affinity(void *state, const duite_ready *task)
{
    const struct sched_state *own = state;
    return task->affinity ? task->affinity - 1 : own->worker;
}

unsigned sched_place_owner(void *state, const duite_ready *task)
{
    return task->block % ((const struct sched_state *)state)->n_workers;
}

duite_end sched_serve_newest(void *state)
{
    (void)state;
    return DUITE_NEWEST;
}

duite_end sched_serve_oldest(void *state)
{
    (void)state;
    return DUITE_OLDEST;
}

duite_end sched_serve_highest(void *state)
{
    (void)state;
    return DUITE_HIGHEST;
}

unsigned sched_no_victim(void *state, unsigned attempt)
{
    (void)state;
    (void)attempt;
    return DUITE_NO_QUEUE;
}

unsigned sched_any_victim(void *state, unsigned attempt)
{
    struct sched_state *own = state;
    unsigned others = own->n_workers - 1;
    if (attempt >= others)
        return DUITE_NO_QUEUE;
    if (attempt == 0)
        own->first = (unsigned)(duite_random(&own->random) % others);
    return (own->worker + 1 + (own->first + attempt) % others) % own->n_workers;
}

int sched_never_chain(void *state, const duite_ready *task)
{
    (void)state;
    (void)task;
    return 0;
}

int sched_chain_affinity(void *state, const duite_ready *task)
{
    return sched_place_affinity(state, task) == ((const struct sched_state *)state)->worker;
}

int sched_chain_owner(void *state, const duite_ready *task)
{
    return sched_place_owner(state, task) == ((const struct sched_state *)state)->worker;
}
