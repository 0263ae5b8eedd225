#ifndef DUITE_WORKERS_WORKERS_H
#define DUITE_WORKERS_WORKERS_H

#include "runtime/base/policy.h"
#include "runtime/check/check.h"
#include "runtime/comm/comm.h"
#include "runtime/task/task.h"
#include "runtime/trace/trace.h"

#include <duite_policy.h>

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* The workers of a rank: worker 0 is the main thread, which works while the main program waits; the
 * others are threads of ours. A worker runs tasks of its own queue, the shared one, or those of the
 * victims that the scheduler names. Between tasks it polls for messages. When it finds nothing it
 * spins for a while and then sleeps. One of the idle workers keeps polling. */
struct work_pool;
struct worker;

struct work_setup {
    struct task_graph *graph; /* its `pool` is set by work_start */
    struct comm *comm;        /* NULL: one rank */
    struct check *check;      /* NULL: bodies are called directly */
    struct trace *trace;      /* NULL: there is none */
    const duite_scheduler *scheduler;
    const duite_balancer *balancer; /* NULL: nothing moves */
    struct base_monitor *monitor;   /* of this rank */
    struct base_marks *marks;       /* of policies that are not built in; NULL: all are */
    bool measures;                  /* bodies are timed even if the balancer does not need it */
    void *context;                  /* for bodies */
    duite *rt;                      /* for bodies */
    unsigned threads;
    uint64_t seed;
    double spin_seconds;  /* 0: workers outnumber cores */
    double stuck_seconds; /* of a standstill until it is reported; 0: never */
    const int *cores; /* threads of them to bind to, as the operating system numbers them; NULL: no
                         binding */
};

/* For comm_start, whose context is the task graph; the second with a trace. It notes messages, and
 * the work of a busy worker on them: looking for them, sending, taking them. A begin within another
 * one does not count. Times below a microsecond are not noted. */
extern const struct comm_owner work_messages;
comm_guest_over work_guest_over;
extern const struct comm_report work_report;

/* Errors: memory, DUITE_E_SYSTEM. The calling thread becomes worker 0. */
int work_start(struct work_pool **pool, const struct work_setup *setup);
/* All tasks are over. Frees the pool; the calling thread gets its old binding back. */
void work_stop(struct work_pool *pool);

/* Worker 0, for calls by the main thread. */
struct worker *work_main(struct work_pool *pool);

/* The main program's reason to wait, for the report of a standstill: words, or a version. */
struct work_why {
    const char *call, *what; /* constants; what NULL: the version */
    const struct data_key *key;
};

/* The main program waits from now on; NULL: it does not. Main thread. */
void work_waits(struct work_pool *pool, const struct work_why *why);

/* Works until done(context) or communication broke. Main thread. */
void work_until(struct work_pool *pool, const struct work_why *why, bool (*done)(void *context),
                void *context);

/* The same, even after communication broke, and for conditions that wake nobody: asks done() again
 * and again. */
void work_drain(struct work_pool *pool, bool (*done)(void *context), void *context);

/* When a rank was last seen to move; zero at first. */
struct work_stillness {
    uint64_t movement, since;
};

/* True if for a moment no worker has run a body and nothing of this rank has moved: the unfinished
 * tasks wait for something that never comes. The main thread asks again and again, and works
 * meanwhile. */
bool work_stands_still(struct work_pool *pool, struct work_stillness *still);

/* Works until done(context) in the middle of a body, which waits with its scope: runs tasks that
 * task_may_run on top of it, on its stack. Returns early if communication broke. Called by the
 * body's worker. DUITE_E_DEPTH: its stack has no room for a further body; it did not wait. */
int work_inside(struct worker *worker, const struct task_scope *scope, bool (*done)(void *context),
                void *context);

/* Runs a ready task and those inline after it, or looks for messages. Main thread. */
void work_turn(struct work_pool *pool);

/* Sends what was posted and, now and then, polls: the main thread calls it as it forks. */
void work_tick(struct work_pool *pool);

/* Tasks of this rank that are not over. Main thread. */
uint64_t work_unfinished(const struct work_pool *pool);

/* True if the pool has none. Cheap: the main thread asks after each task. */
bool work_is_drained(void *pool);

/* The name of the scheduler if it named victims without an end, which is an error; else NULL. */
const char *work_endless(const struct work_pool *pool);

/* If more than `max` tasks are unfinished: works until at most 3/4 of `max` are, or communication
 * broke. Main thread. */
void work_throttle(struct work_pool *pool, uint64_t max);

/* Between these two no report of a standstill is made. Main thread. */
void work_hold_reports(struct work_pool *pool);
void work_let_reports_go(struct work_pool *pool);

/* The graph has a kernel more; no task is left. Errors: memory. */
int work_kernel_added(struct work_pool *pool);

/* Counts of all workers of this rank. Exact when no task is left. */
void work_count(struct work_pool *pool, duite_counters *counters);

/* For a balancer that moves homes, on several ranks. The first: seconds since the last call in
 * bodies of tasks that run for a block of this rank, or for DUITE_NO_BLOCK. The second: the
 * balancer's answer, see duite_balancer.migrate. Main thread. */
double work_block_seconds(struct work_pool *pool, uint32_t block);
uint64_t work_migrate(struct work_pool *pool, const duite_blocks *blocks, int *home);

/* For the trace: the counts of each worker of this rank. Main thread. */
void work_note_counters(struct work_pool *pool, struct trace_counters *counters);

/* True if the calling thread is the main thread and not inside a body. */
bool work_may_fork(struct work_pool *pool);

#pragma GCC visibility pop

#endif
