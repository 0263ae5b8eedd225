#ifndef BENCH_TASKS_TASKS_H
#define BENCH_TASKS_TASKS_H

#include "bench/bench.h"
#include "bench/problem.h"
#include "bench/tiles.h"

#include <duite.h>
#include <stdatomic.h>

/* Shared by the cases of the bench "tasks". Each case is a file: its plan, its kernels, our runs
 * and the sequential twin's. */

enum { TASKS_WORKERS = 256 };                                   /* that a tree can be counted by */
enum { TASKS_SKYNET, TASKS_QUEENS, TASKS_MATMUL, TASKS_FORKS }; /* kernels of forks.c */

/* Our process keeps one runtime from run to run; bodies find this as their context. */
struct tasks_session {
    duite *rt; /* NULL: not started */
    unsigned threads;
    char scheduler[40];
    uint64_t *mark; /* of the independent tasks */
    struct {
        _Alignas(64) uint64_t nodes;
    } counted[TASKS_WORKERS]; /* of the tree, by worker */
    atomic_int gate;          /* tasks_gate runs until it is not 0 */
    atomic_uint waiting;      /* gates that run */
    _Atomic uint64_t woken;
    double began;      /* when a task began, once woken says so */
    int32_t *matrices; /* of matmul */
    struct held *held; /* what the tasks of `event` are to fill */
};

/* Starts the runtime as the request wants it (threads=, scheduler=), with the kernels of all cases.
 */
int tasks_ready(struct tasks_session *session, struct serve_request *request);

/* The result of a run whose call of duite failed, or went well. */
int tasks_code(int code);

/* n objects, or none at all; and their end. */
int tasks_objects(struct tasks_session *session, duite_type type, size_t count, size_t n,
                  duite_object *object);
void tasks_free_objects(struct tasks_session *session, size_t n, const duite_object *object);

/* Rounds of the same tasks: forked one after the other, or recorded once and replayed. */
struct tasks_rounds {
    duite *rt;
    duite_build *fork; /* forks the tasks of a round */
    void *context;     /* of fork */
    uint64_t rounds;
    bool replayed;
    duite_graph graph;
};
/* Records, and replays once, if they are to be replayed; not timed. */
int tasks_record(struct tasks_rounds *rounds);
/* Runs all rounds; the seconds it took, from the first fork to the end of the last body. */
int tasks_run(struct tasks_rounds *rounds, double *seconds);
void tasks_forget(struct tasks_rounds *rounds);

/* A task that blocks its worker until the gate opens: with an object to write, or without any. */
extern const duite_kernel tasks_gate_write, tasks_gate;

/* ---- Plans ---- */

/* One problem solved in several ways: metrics NAME_VARIANT_ns_per_task for ours, the twin's
 * NAME_sequential_ns_per_task, the rivals' NAME_RIVAL_ns_per_task, and the ratios of each of ours
 * to each rival, NAME_VARIANT_ns_per_task_vs_RIVAL, or if they are brief NAME_VARIANT_vs_RIVAL. */
struct tasks_contest {
    const char *name;
    const char *run;  /* that serves it; NULL: called as `name` */
    const char *size; /* "points=64 steps=200" */
    double tasks;     /* in a run */
    bool brief;       /* names of ratios */
    bool core;        /* NAME_VARIANT_core_ns: nanoseconds of a core, in place of ..._ns_per_task */
    bool twice;       /* ours runs as often as an OpenMP rival does */
    const char *const *variants, *const *rivals; /* ended by NULL; a variant "" has no name */
};
void tasks_plan_contest(struct measure *measure, const struct bench_options *options,
                        const struct tasks_contest *contest);

/* Our process, with this many threads; the twin's. */
struct subject_shape tasks_ours(unsigned threads);
struct subject_shape tasks_twin(void);

/* ---- Cases ---- */

/* Those that have the cases of fib.c and forks.c. */
extern const char *const tasks_forking_rivals[];

extern const struct bench_case tasks_stencil, tasks_chain, tasks_independent, tasks_fib_case,
    tasks_skynet, tasks_queens, tasks_matmul, tasks_tree, tasks_tiles, tasks_growth, tasks_bytes,
    tasks_wake, tasks_event, tasks_instructions, tasks_adopt;
extern const duite_kernel tasks_stencil_combine, tasks_stencil_empty, tasks_stencil_padded,
    tasks_chain_next, tasks_adopt_change, tasks_independent_mark, tasks_wake_up, tasks_event_hold,
    tasks_fib, tasks_fib_flow, tasks_fib_put, tasks_fib_add, tasks_tree_node,
    tasks_forks_kernels[TASKS_FORKS], tasks_tiles_kernels[TILES_ROUTINES];

#endif
