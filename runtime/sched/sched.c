/* The built-in schedulers: their decisions, which several of them share, and their tables. Queues,
 * stealing, sleep and wake-up are the runtime's, so no policy can lose a task. */
#include "runtime/sched/sched.h"

#include "runtime/base/policy.h"

#include <duite.h>

#define SCHED_TABLE(name) &sched_##name,

static const char *const sched_names[] = {SCHED_ROWS(BASE_POLICY_NAME) NULL,
                                          SCHED_TEST_ROWS(BASE_POLICY_NAME) NULL};
static const void *const sched_tables[] = {SCHED_ROWS(SCHED_TABLE) NULL,
                                           SCHED_TEST_ROWS(SCHED_TABLE) NULL};
const struct base_policies sched_policies = {.kind = "scheduler",
                                             .type = "duite_scheduler",
                                             .symbol = "duite_own_scheduler",
                                             .size = sizeof(duite_scheduler),
                                             .names = sched_names,
                                             .tables = sched_tables};

const duite_scheduler *duite_scheduler_find(const char *name)
{
    return base_policy_find(&sched_policies, name);
}

const char *const *duite_scheduler_names(void)
{
    return sched_names;
}

const char *const *sched_test_names(void)
{
    return base_policy_test_names(&sched_policies);
}

/* ---- Decisions ---- */

/* A function that reads its state expects a sched_state there, or a structure that begins with
 * one. */

struct sched_state {
    uint64_t random;
    unsigned worker, n_workers;
    unsigned first; /* of the victims of this round */
};

static void sched_start(void *state, unsigned worker, unsigned n_workers, uint64_t seed)
{
    struct sched_state *own = state;
    *own = (struct sched_state){.random = seed + worker, .worker = worker, .n_workers = n_workers};
}

/* Where a ready task goes: all to one queue. */
static unsigned sched_place_shared(void *state, const duite_ready *task)
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

/* To the worker of the task's block. */
static unsigned sched_place_owner(void *state, const duite_ready *task)
{
    return task->block % ((const struct sched_state *)state)->n_workers;
}

#define SERVE(name, end)                                                                           \
    static duite_end name(void *state)                                                             \
    {                                                                                              \
        (void)state;                                                                               \
        return end;                                                                                \
    }
SERVE(sched_serve_newest, DUITE_NEWEST)
SERVE(sched_serve_oldest, DUITE_OLDEST)
SERVE(sched_serve_highest, DUITE_HIGHEST)

static unsigned sched_no_victim(void *state, unsigned attempt)
{
    (void)state;
    (void)attempt;
    return DUITE_NO_QUEUE;
}

/* Each other worker once a round, from a random one on. */
static unsigned sched_any_victim(void *state, unsigned attempt)
{
    struct sched_state *own = state;
    unsigned others = own->n_workers - 1;
    if (attempt >= others)
        return DUITE_NO_QUEUE;
    if (attempt == 0)
        own->first = (unsigned)(duite_random(&own->random) % others);
    return (own->worker + 1 + (own->first + attempt) % others) % own->n_workers;
}

static int sched_never_chain(void *state, const duite_ready *task)
{
    (void)state;
    (void)task;
    return 0;
}

int sched_chain_affinity(void *state, const duite_ready *task)
{
    return sched_place_affinity(state, task) == ((const struct sched_state *)state)->worker;
}

/* True if the owner is this worker. */
static int sched_chain_owner(void *state, const duite_ready *task)
{
    return sched_place_owner(state, task) == ((const struct sched_state *)state)->worker;
}

/* ---- The schedulers ---- */

/* steal: a worker keeps what it makes ready and works on the newest, whose data are warm; an idle
 * one takes the oldest of a random victim. After Blumofe & Leiserson, Scheduling multithreaded
 * computations by work stealing, JACM 46(5), 1999. In a replay the next task on the same data goes
 * to the worker that ran the last one: stolen data stay with the thief. After Acar, Blelloch &
 * Blumofe, The data locality of work stealing, SPAA 2000. */
const duite_scheduler sched_steal = {
    .size = sizeof(duite_scheduler),
    .name = "steal",
    .summary = "own newest first, steal the oldest of a random victim",
    .state_size = sizeof(struct sched_state),
    .start = sched_start,
    .place = sched_place_affinity,
    .serve = sched_serve_newest,
    .victim = sched_any_victim,
    .chain = sched_chain_affinity,
};

/* locality: as `steal`, but an idle worker tries the others by their distance in the machine. The
 * ring of those that share most with it (a core, a cache, a package) comes first, from a random one
 * on; then the next ring. So data leave a cache or a package only when no work is left in it.
 * Without distances all others are one ring. After Quintin & Wagner, Hierarchical work-stealing,
 * Euro-Par 2010. */
struct locality_state {
    struct sched_state own; /* first */
    const duite_near *near;
    unsigned begin, end; /* the attempts of the ring that is tried */
};

static void locality_locate(void *state, const duite_near *near)
{
    ((struct locality_state *)state)->near = near;
}

static unsigned locality_victim(void *state, unsigned attempt)
{
    struct locality_state *own = state;
    const duite_near *near = own->near;
    if (attempt >= near->n)
        return DUITE_NO_QUEUE;
    if (attempt == 0)
        own->end = 0;
    if (attempt == own->end) {
        own->begin = attempt;
        while (own->end < near->n && near->distance[own->end] == near->distance[attempt])
            own->end++;
        own->own.first = (unsigned)(duite_random(&own->own.random) % (own->end - own->begin));
    }
    unsigned size = own->end - own->begin;
    return near->worker[own->begin + (own->own.first + attempt - own->begin) % size];
}

const duite_scheduler sched_locality = {
    .size = sizeof(duite_scheduler),
    .name = "locality",
    .summary = "own newest first, steal the oldest of the nearest in the machine",
    .state_size = sizeof(struct locality_state),
    .start = sched_start,
    .place = sched_place_affinity,
    .serve = sched_serve_newest,
    .victim = locality_victim,
    .chain = sched_chain_affinity,
    .locate = locality_locate,
};

/* owner: each block of objects has a worker, which gets its tasks, newest first; an idle worker
 * takes the oldest of a random other. Data stay in the cache of one core, as with `static`, and
 * stealing evens out unequal work. After Markatos & LeBlanc, Using processor affinity in loop
 * scheduling on shared-memory multiprocessors, IEEE TPDS 5(4), 1994. */
const duite_scheduler sched_owner = {
    .size = sizeof(duite_scheduler),
    .name = "owner",
    .summary = "the worker of each block of objects, newest first; idle ones steal",
    .state_size = sizeof(struct sched_state),
    .start = sched_start,
    .place = sched_place_owner,
    .serve = sched_serve_newest,
    .victim = sched_any_victim,
    .chain = sched_chain_owner,
};

/* fifo: one queue for all, served in the order in which tasks became ready. The baseline that
 * balances best and ignores affinity. */
const duite_scheduler sched_fifo = {
    .size = sizeof(duite_scheduler),
    .name = "fifo",
    .summary = "one queue for all, oldest first",
    .place = sched_place_shared,
    .serve = sched_serve_oldest,
    .victim = sched_no_victim,
    .chain = sched_never_chain,
};

/* lifo: one queue for all, newest first. A new task runs while its data are warm, on any worker;
 * the oldest may starve until the rest is done. */
const duite_scheduler sched_lifo = {
    .size = sizeof(duite_scheduler),
    .name = "lifo",
    .summary = "one queue for all, newest first",
    .place = sched_place_shared,
    .serve = sched_serve_newest,
    .victim = sched_no_victim,
    .chain = sched_never_chain,
};

/* priority: one queue for all, served by the priorities that forks name. Equals come by the longest
 * path to the end of their recorded graph, then the one ready first. No task runs inline: a more
 * urgent one may wait. Longest paths: the critical path method of Kelley & Walker, 1959; as a rule
 * for schedules Hu, Parallel sequencing and assembly line problems, Operations Research 9(6),
 * 1961. */
const duite_scheduler sched_priority = {
    .size = sizeof(duite_scheduler),
    .name = "priority",
    .summary = "one queue for all, the largest priority first, then the longest path to the end",
    .place = sched_place_shared,
    .serve = sched_serve_highest,
    .victim = sched_no_victim,
    .chain = sched_never_chain,
    .paths = 1,
};

/* static: the worker of each block is fixed, its tasks run in the order in which they became ready,
 * and nobody steals. The baseline of every comparison: data stay where they are, and uneven blocks
 * stay uneven. */
const duite_scheduler sched_static = {
    .size = sizeof(duite_scheduler),
    .name = "static",
    .summary = "a fixed worker for each block of objects, no stealing",
    .state_size = sizeof(struct sched_state),
    .start = sched_start,
    .place = sched_place_owner,
    .serve = sched_serve_oldest,
    .victim = sched_no_victim,
    .chain = sched_chain_owner,
};

/* shuffle: an adversary for tests. Every decision is a coin toss from the seed: any queue, any
 * order, any victim or none, so that tasks run in orders that no sensible scheduler would choose.
 */
static void shuffle_start(void *state, unsigned worker, unsigned n_workers, uint64_t seed)
{
    sched_start(state, worker, n_workers, seed * 1000003);
}

static unsigned shuffle_draw(void *state, unsigned below)
{
    return (unsigned)(duite_random(&((struct sched_state *)state)->random) % below);
}

static unsigned shuffle_place(void *state, const duite_ready *task)
{
    (void)task;
    unsigned n_workers = ((struct sched_state *)state)->n_workers;
    unsigned queue = shuffle_draw(state, n_workers + 1);
    return queue == n_workers ? DUITE_SHARED_QUEUE : queue;
}

static duite_end shuffle_serve(void *state)
{
    return (duite_end)shuffle_draw(state, DUITE_HIGHEST + 1);
}

static unsigned shuffle_victim(void *state, unsigned attempt)
{
    unsigned n_workers = ((struct sched_state *)state)->n_workers;
    if (attempt >= n_workers || shuffle_draw(state, 8) == 0)
        return DUITE_NO_QUEUE;
    return shuffle_draw(state, n_workers);
}

static int shuffle_chain(void *state, const duite_ready *task)
{
    (void)task;
    return (int)shuffle_draw(state, 2);
}

const duite_scheduler sched_shuffle = {
    .size = sizeof(duite_scheduler),
    .name = "shuffle",
    .summary = "random decisions from the seed, for tests",
    .state_size = sizeof(struct sched_state),
    .start = shuffle_start,
    .place = shuffle_place,
    .serve = shuffle_serve,
    .victim = shuffle_victim,
    .chain = shuffle_chain,
};
