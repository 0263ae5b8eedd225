/* Sleeping and waking (runtime/workers/idle.c, worker.c, run.c, wait.c and pool.c): no task waits
 * while all who could run it sleep for ever, no message while nobody polls, each task runs once,
 * and a stop ends. The workers are the real ones: thread 0 is the main thread, the others are those
 * that work_start makes. Queues are plain_queue.h's, or with REAL_QUEUES the real ones. */
#include "tests/model/runtime.h"
#include "tests/model/silent_comm.h"

#include "runtime/workers/internal.h"

#include "runtime/base/clock.h"
#include "runtime/sched/sched.h"
#include "runtime/workers/topology.h"

enum { TASKS = 4 };

static struct {
    struct task_graph graph;
    struct work_pool *pool;
    struct task *task[TASKS];
    int ran[TASKS];
    uint64_t ticks[EXPLORE_THREADS];
    _Atomic int n_over, done;   /* tasks; 1 when all are */
    _Atomic int over[TASKS];    /* 1 when that task is */
    _Atomic int sent, received; /* messages; each makes the task of its number ready */
    bool copies;                /* bodies do as duite_get's copy does: they set copied and notify */
    _Atomic int copied;
    int looks;
    bool long_body; /* task 0 sees message 1 sent, and lasts until task 1 is over */
} its;

/* ---- What the workers call ---- */

/* Each thread's own: every look at the clock finds that long has passed. */
static uint64_t stepping(void)
{
    return its.ticks[explore_self()] += 1000000;
}

static int nothing(void)
{
    return 0;
}

/* The task among a function's arguments. */
static struct task *task_in(int n, const void *const *argument)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < TASKS; j++)
            if (argument[i] == its.task[j])
                return its.task[j];
    explore_check_that(false, "there is a task among the arguments");
    return NULL;
}

static void receive(int message)
{
    atomic_fetch_add(&its.sent, 1);
    explore_check(message == its.sent - 1);
}

static bool run_task(const struct task *task)
{
    its.ran[task->number]++;
    if (its.copies) {
        atomic_store_explicit(&its.copied, 1, memory_order_release);
        queue_notify(its.graph.pool);
    }
    if (its.long_body && task->number == 0) {
        receive(1);
        explore_await(&its.over[1]);
    }
    return true;
}

static void finish_task(struct worker *worker, const struct task *task)
{
    atomic_store(&its.over[task->number], 1);
    if (atomic_fetch_add(&its.n_over, 1) + 1 == (int)its.graph.tasks)
        atomic_store(&its.done, 1);
    queue_over(its.graph.pool, worker);
}

#define TASK_IN(...)                                                                               \
    task_in(sizeof(const void *[]){__VA_ARGS__} / sizeof(void *), (const void *[]){__VA_ARGS__})
#define work_run_task(...)               run_task(TASK_IN(__VA_ARGS__))
#define work_finish(graph, worker, task) finish_task(worker, TASK_IN(task))

bool comm_poll(struct comm *comm, struct worker *worker)
{
    (void)comm;
    int next = atomic_load_explicit(&its.received, memory_order_acquire);
    if (next >= atomic_load_explicit(&its.sent, memory_order_acquire) ||
        !atomic_compare_exchange_strong_explicit(&its.received, &next, next + 1,
                                                 memory_order_acq_rel, memory_order_relaxed))
        return false;
    task_ready(&its.graph, worker, its.task[next]);
    return true;
}

#define base_ticks()                          stepping()
#define base_tick_seconds()                   1e-6
#define sched_yield()                         nothing()
#define sched_getaffinity(process, size, set) nothing()
#define sched_setaffinity(process, size, set) nothing()
#define work_cores_bind(unit)                 nothing()

#ifdef REAL_QUEUES
#include "runtime/queue/queue.c"
#else
#include "tests/model/plain_queue.h"
#endif

/* The model has no watch for standstills, no moves between ranks, no replays and no requests of the
 * program. */
#include "runtime/workers/internal.h"
#define work_balance_start(balance, pool)    nothing()
#define work_balance_stop(pool)              nothing()
#define work_begins(worker, task)            ((void)(task), false)
#define work_learn(worker, task, ticks)      ((void)(task))
#define work_grant(worker)                   ((void)(worker))
#define work_request(worker, idle)           ((void)(idle))
#define work_standstill_start(pool, seconds) nothing()
#define work_standstill_stop(pool)           nothing()
#define work_waits(pool, why)                ((void)(why))
#define comm_guests_are_here(guests)         ((void)(guests), false)
#define work_enters(worker, task)            NULL
#define work_leaves(worker, below)           ((void)(below))

/* No other program runs on these cores. */
#include <sys/resource.h>
#define getrusage(who, usage) ((usage)->ru_nivcsw = 0)

#include "runtime/base/thread.h"
#define base_thread_start(thread, what, run, context)                                              \
    ((void)(what), pthread_create(thread, NULL, run, context))

/* A plant that is no operation of its own: the announcement comes after the last look. */
static struct task *look_last(struct worker *worker)
{
    if (!explore_planted("idle_sleep", "the announcement"))
        return work_find(worker);
    queue_park_cancel(&worker->park);
    struct task *task = work_find(worker);
    queue_park_announce(&worker->park);
    return task;
}

#define work_find look_last
#include "runtime/workers/idle.c"
#undef work_find
#include "runtime/queue/pool.c"
#include "runtime/task/place.c"
#include "runtime/workers/pool.c"
#include "runtime/workers/run.c"
#include "runtime/workers/wait.c"
#include "runtime/workers/worker.c"

#ifndef REAL_QUEUES
static struct task *plain_task(uint64_t bit)
{
    return its.task[__builtin_ctzll(bit)];
}
#endif

static bool drained(void *context)
{
    (void)context;
    return !work_unfinished(its.pool);
}

static void begin(void)
{
    memset(&its, 0, sizeof its);
    for (int i = 0; i < TASKS; i++) {
        its.task[i] = explore_alloc(sizeof *its.task[i]);
        its.task[i]->type = TASK_COPY;
        its.task[i]->number = (uint64_t)i;
    }
}

/* ---- Main programs ---- */

static void start_workers(unsigned threads, const duite_scheduler *scheduler, bool comm)
{
    static char network;
    int code = work_start(&its.pool, &(struct work_setup){.graph = &its.graph,
                                                          .comm = comm ? (void *)&network : NULL,
                                                          .scheduler = scheduler,
                                                          .threads = threads,
                                                          .seed = 1});
    explore_check(!code);
}

static void ready(int task)
{
    task_ready(&its.graph, work_main(its.pool), its.task[task]);
}

static void stop(int tasks)
{
    work_stop(its.pool);
    for (int i = 0; i < TASKS; i++)
        explore_check(its.ran[i] == (i < tasks));
}

/* Makes tasks ready and does something else: the other threads must see to them. */
static void leave(unsigned threads, const duite_scheduler *scheduler, int tasks)
{
    start_workers(threads, scheduler, false);
    its.graph.tasks = (uint64_t)tasks;
    for (int i = 0; i < tasks; i++)
        ready(i);
    explore_await(&its.done);
}

/* Makes tasks ready and waits. */
static void wait(unsigned threads, const duite_scheduler *scheduler, int tasks)
{
    start_workers(threads, scheduler, false);
    its.graph.tasks = (uint64_t)tasks;
    for (int i = 0; i < tasks; i++)
        ready(i);
    work_until(its.pool, NULL, drained, NULL);
}

static void start_stop(void)
{
    start_workers(2, &sched_steal, false);
    stop(0);
}

static void leave_one_stop(void)
{
    leave(2, &sched_steal, 1);
    stop(1);
}

static void leave_one(void)
{
    leave(2, &sched_steal, 1);
}

static void leave_two(void)
{
    leave(2, &sched_fifo, 2);
}

static void leave_one_to_two(void)
{
    leave(3, &sched_fifo, 1);
}

static void wait_one(void)
{
    wait(2, &sched_steal, 1);
}

static bool copied(void *context)
{
    (void)context;
    return atomic_load_explicit(&its.copied, memory_order_acquire);
}

static void wait_copy(void)
{
    its.copies = true;
    start_workers(2, &sched_steal, false);
    its.graph.tasks = 2;
    ready(0);
    work_until(its.pool, NULL, copied, NULL);
}

static void wait_one_stop(void)
{
    wait(2, &sched_steal, 1);
    stop(1);
}

static void wait_two(void)
{
    wait(2, &sched_fifo, 2);
}

/* ---- With messages: nobody is woken by them ---- */

static bool looked_around(void *context)
{
    (void)context;
    return its.looks++ >= 4;
}

/* Idles a few times, as in a collective call, and may become the poller; then does something else:
 * the other thread must receive. */
static void idle_then_leave(void)
{
    start_workers(2, &sched_steal, true);
    its.graph.tasks = 1;
    work_drain(its.pool, looked_around, NULL);
    receive(0);
    explore_await(&its.over[0]);
}

/* Waits for both; whoever runs task 0 is busy meanwhile: the other one must receive. */
static void wait_beside(void)
{
    its.long_body = true;
    start_workers(2, &sched_steal, true);
    its.graph.tasks = 2;
    receive(0);
    work_until(its.pool, NULL, drained, NULL);
}

#ifdef REAL_QUEUES
enum { MOST = 20000, MOST_DEEP = 1000000 }; /* executions; 0: all */
#else
enum { MOST = 0, MOST_DEEP = 0 };
#endif

#define CASE(title, main)                                                                          \
    {                                                                                              \
        .name = title, .start = begin, .thread = {main}, .max = MOST, .max_deep = MOST_DEEP        \
    }
/* Without a stop at the end, the other threads may sleep for ever then. */
#define SERVED(title, main)                                                                        \
    {                                                                                              \
        .name = title, .start = begin, .thread = {main}, .served = true, .timeouts = 1,            \
        .max = MOST, .max_deep = MOST_DEEP                                                         \
    }
#define LARGE(title, main)                                                                         \
    {                                                                                              \
        .name = title, .start = begin, .thread = {main}, .served = true, .max = 10000,             \
        .max_deep = 1000000                                                                        \
    }

static const struct explore_case cases[] = {
    CASE("start, stop", start_stop),
    CASE("one task for another, stop", leave_one_stop),
    SERVED("one task for another", leave_one),
    SERVED("one task waited for", wait_one),
    SERVED("a copy waited for", wait_copy),
    SERVED("main polled, and leaves", idle_then_leave),
    LARGE("the poller gets busy", wait_beside),
};

static const struct explore_case deep[] = {
    CASE("one task waited for, stop", wait_one_stop),
    SERVED("two tasks for another", leave_two),
    SERVED("one task for two others", leave_one_to_two),
    LARGE("two tasks waited for", wait_two),
};

static const struct {
    const struct explore_case small;
    struct explore_plant plant;
} plants[] = {
    {SERVED("one task for another", leave_one), {"idle_sleep", "the announcement", EXPLORE_DROP}},
    {SERVED("one task for another", leave_one), {"queue_park_wake", "lock", EXPLORE_DROP}},
    {SERVED("one task for another", leave_one), {"queue_park_wake", "condition", EXPLORE_DROP}},
    {CASE("start, stop", start_stop), {"idle_sleep", "&pool->stop", EXPLORE_DROP}},
#ifndef REAL_QUEUES /* there it takes too long */
    {SERVED("one task for another", leave_one), {"queue_put", "the put", EXPLORE_RELAX}},
    {SERVED("one task waited for", wait_one),
     {"queue_main_has_enough", "&pool->awaited", EXPLORE_DROP}},
    {SERVED("main polled, and leaves", idle_then_leave),
     {"poller_leave", "&worker->pool->poller", EXPLORE_RELAX}},
    {SERVED("main polled, and leaves", idle_then_leave),
     {"poller_leave", "&worker->pool->poller", EXPLORE_DROP}},
    {LARGE("the poller gets busy", wait_beside),
     {"poller_leave", "&worker->pool->poller", EXPLORE_DROP}},
#endif
};

int main(int argc, char **argv)
{
    explore_begin(argc, argv);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        explore_passes(&cases[i]);
    for (size_t i = 0; i < sizeof deep / sizeof deep[0] && explore_deep(); i++)
        explore_passes(&deep[i]);
    for (size_t i = 0; i < sizeof plants / sizeof plants[0]; i++)
        explore_finds(&plants[i].small, plants[i].plant);
    return explore_end();
}
