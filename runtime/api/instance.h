#ifndef DUITE_API_INSTANCE_H
#define DUITE_API_INSTANCE_H

#include "runtime/base/policy.h"
#include "runtime/comm/comm.h"
#include "runtime/map/map.h"
#include "runtime/plan/memo.h"
#include "runtime/plan/record.h"
#include "runtime/task/body.h"
#include "runtime/trace/trace.h"
#include "runtime/workers/share.h"
#include "runtime/workers/workers.h"

#include <stdio.h>

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* A running runtime: its parts, and the error that the next get, wait or stop will return. Main
 * thread only. */
struct duite {
    MPI_Comm mpi;
    struct task_graph graph;
    struct comm *comm;   /* NULL: one rank */
    struct check *check; /* NULL: not in checking mode */
    struct work_pool *pool;
    struct worker *worker;  /* the main thread's; as is: */
    const void *thread;     /* task_thread_mark() */
    struct plan_memo *memo; /* takes forks before they become tasks; NULL: nothing does */
    struct trace *trace;    /* NULL: there is none */
    bool traced;            /* the trace is closed */
    struct base_monitor monitor;
    struct base_marks *marks; /* NULL: all policies are built in */
    struct map_policy mapping;
    const duite_balancer *balance;
    uint64_t seed;
    size_t window;
    struct work_share share;
    int oversubscribed;
    bool mpi_held;      /* the program holds MPI: between duite_mpi_begin and duite_mpi_end */
    int remembered;     /* code of a failed fork, new, ... */
    char message[1024]; /* of `remembered` */
    struct recorded_graph *recorded; /* by slot, from 1 on */
    size_t n_recorded, recorded_capacity;
    struct api_get *gets;         /* begun and not ended, the first one first */
    uint32_t gets_begun;          /* so far: numbers them in traces */
    struct api_turn *turns;       /* objects that the program has acquired, the last one first */
    struct plan_record *building; /* the one that build forks into, or NULL */
    uint64_t graphs_recorded;
    struct api_report {
        bool wanted;      /* by rank 0; the same on all ranks, as is: */
        unsigned workers; /* of all ranks */
        FILE *file;       /* of rank 0; NULL: not open */
        char *path;
        const duite_scheduler *scheduler;
        double began; /* on the clock of this rank */
    } report;
    struct instance_migration {
        uint64_t replays, due; /* so far; the number at which the homes are looked at next */
        uint64_t looked;       /* replays before the last look; */
        double since;          /* when the last look was over, on the clock of this rank; */
        double took;           /* seconds */
        uint64_t objects;      /* moved so far; the same on all ranks */
    } migration;
};

/* True once only stop is left: memory ran out in a fork, the ranks differ, or a message was
 * lost. */
bool api_is_broken(const duite *rt);

/* For a broken runtime: tells the other ranks, stops awaiting data, and returns when no task is
 * left. Does nothing the second time. */
void api_give_up(duite *rt);

/* ---- agree.c: collective ---- */

/* DUITE_OK if no rank failed so far. Else this rank's code; if it did not fail itself
 * DUITE_E_DIFFERENT (for memory DUITE_E_MEMORY), with the message of the first rank with the worst
 * failure. */
int api_agree_on_code(MPI_Comm mpi, int code);
/* This rank's parts have started, or failed with `code`. Compares codes and options of all ranks:
 * all succeed, or all fail. Errors: those of the ranks; DUITE_E_DIFFERENT, which names the
 * difference and the ranks. */
int api_agree_at_start(duite *rt, const duite_options *options, int code);

/* ---- acquire.c ---- */

/* The program's kernels with those of the runtime; to be freed. NULL without memory. */
const duite_kernel **api_add_kernels(const duite_kernel *const *kernels);
/* The graph has them: their tasks tell their end from now on. */
void api_watch_turns(struct task_graph *graph);

/* Releases all that the program has acquired. */
void api_release_all(duite *rt);

/* DUITE_E_STATE if the program has acquired an object, since `call` may then wait for itself. */
int api_check_turns(const duite *rt, const char *call);

/* ---- options.c ---- */

/* Checks of the options: first those without which the ranks cannot even talk, as they become whole
 * (duite_options.size), then the rest. The rest may be wrong on one rank alone; all ranks agree on
 * that later. Errors: arguments. */
int api_take_options(const duite_options *given, duite_options *whole);
int api_check_options_rest(const duite_options *options);

/* Policies that are not built in are watched from now on: one that does not return is named. The
 * runtime knows its ranks and threads. Local. Errors: memory, DUITE_E_SYSTEM. */
int api_mark_policies(duite *rt, const duite_options *options);

/* ---- program.c, wait.c ---- */

/* DUITE_OK if this call may be made now, else the error to return. */
int api_enter(duite *rt, const char *call);
/* The same, even while a graph is recorded. */
int api_enter_any(duite *rt, const char *call);
/* Keeps an error for the next get, wait or stop, or in a build function for the call that builds.
 * Returns code. */
int api_remember(duite *rt, int code);
/* Settles the homes of all objects. */
int api_settle(duite *rt);
/* Works while more tasks are unfinished than the window allows. Called after forks. */
void api_throttle(duite *rt);
/* Waits until all ranks made this call, found that they forked the same, and ended all tasks forked
 * before it. *first, if not NULL: the word of the first failure of all ranks, searched for only if
 * there is one. */
int api_meet(duite *rt, const char *call, struct comm_word *first);
/* The words of all ranks meet: *own, this rank's, becomes that of the first failure of all, if
 * there is one. */
int api_first_failure(duite *rt, const char *call, struct comm_word *own);
/* This rank makes a call that waits, as all do; `kind` must be the same on all. */
int api_enter_wait(duite *rt, const char *kind, const char *call);
/* Works until the copy is there, or communication broke and its task is over. */
void api_wait_for_copy(duite *rt, const struct work_why *why, struct task_copy *copy);
/* Returns the remembered error, once. */
int api_recall(duite *rt);
/* A collective call, with comm_words as its result. The fingerprint of own is filled in here. There
 * are several ranks. Errors: those of communication. */
int api_collective(duite *rt, const struct work_why *why, enum comm_collective kind,
                   struct comm_word *own);

/* ---- migrate.c ---- */

/* The `replay`-th replay of a recorded graph begins, from 0: if due, blocks of objects move where
 * the mapping, or the balancer, wants them. `*map_at`: the replay before which the mapping is to
 * see its tasks (again); it begins with 0. */
int api_migrate(duite *rt, const struct plan_record *record, uint64_t replay, uint64_t *map_at);

/* ---- wait.c, trace.c ---- */

/* duite_wait; messages name `call`. */
int api_wait(duite *rt, const char *call);
/* Ends the trace, if there is one that has not ended, as duite_trace_end; messages name `call`. */
int api_trace_end(duite *rt, const char *call);
/* Begins to record, if all steps are. All ranks have started. */
void api_trace_begin(duite *rt, const duite_options *options);
/* Sums over all ranks, as duite_count_all. */
int api_count(duite *rt, duite_counters *counters);

/* ---- report.c ---- */

/* Opens the file, on rank 0. Local. Errors: memory, DUITE_E_SYSTEM. */
int api_report_open(duite *rt, const duite_options *options);
/* Writes and closes it, if a report is wanted; code: of the stop. A broken runtime has no counters.
 * No task is left. Collective. Errors, of rank 0 alone: DUITE_E_SYSTEM. */
int api_report_write(duite *rt, int code);
void api_report_close(duite *rt);

/* Copies the bytes to `values`, or the number of elements to `count`, if not NULL, on the ranks
 * that want it. */
int api_get(duite *rt, duite_object object, int rank, void *values, size_t *count,
            const char *call);

/* ---- wait_for.c ---- */

/* DUITE_E_NOT_FREED if gets are left that were begun; frees them, no task is left. */
int api_gets_left(const duite *rt);
void api_gets_stop(duite *rt);

/* ---- graphs.c ---- */

/* Visits all graphs replayed since the last call, with the record and the number of rounds that
 * ran. No replay is under way. Errors: those of `visit`. */
int api_graphs_each(duite *rt, int (*visit)(void *context, const struct plan_record *, double),
                    void *context);

/* Keeps the first error of a call inside build. Returns code. */
int api_graphs_failed(duite *rt, int code);
/* DUITE_E_NOT_FREED if graphs are left. */
int api_graphs_left(const duite *rt);
/* Frees all graphs; no task is left. */
void api_graphs_stop(duite *rt);

/* ---- bodies.c ---- */

/* The body that runs on this thread, or NULL. Its calls follow. */
static inline struct duite_call_private *api_body(const duite *rt)
{
    return rt ? task_running(&rt->graph) : NULL;
}
int api_body_new(struct duite_call_private *body, duite_type type, size_t count, size_t max,
                 bool sized, duite_object *object);
int api_body_free(struct duite_call_private *body, duite_object object);
int api_body_fork(struct duite_call_private *body, const duite_kernel *kernel, const void *args,
                  size_t n, const duite_object *objects);
int api_body_fork_with(struct duite_call_private *body, const duite_task_options *options,
                       const duite_kernel *kernel, const void *args, size_t n,
                       const duite_object *objects);
int api_body_set(struct duite_call_private *body, duite_object object, const void *values,
                 const size_t *count, const char *call);
/* Copies the bytes to `values`, or the number of elements to `count`. */
int api_body_get(struct duite_call_private *body, duite_object object, void *values, size_t *count,
                 const char *call);
int api_body_wait(struct duite_call_private *body);
int api_body_split(struct duite_call_private *body, duite_object object, size_t n,
                   const size_t *counts, const duite_object *parts);
int api_body_join(struct duite_call_private *body, duite_object object);
int api_body_wait_for(struct duite_call_private *body, size_t n, const duite_object *objects);
int api_body_mpi_begin(struct duite_call_private *body);
int api_body_mpi_end(struct duite_call_private *body);

#pragma GCC visibility pop

#endif
