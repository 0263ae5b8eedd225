#ifndef TESTS_RUNTIME_RANDOM_RUN_H
#define TESTS_RUNTIME_RANDOM_RUN_H

#include "tests/runtime/random_program.h"

/* A run of a random program, shared by the files that make its calls and check its places. */

struct run_graph {
    struct run *run;
    duite_graph name;
    int alive, rebound;
    size_t first, again; /* as in random_interpret.h */
};

/* The main program or a body: the runtime it calls and its table of objects. */
struct run_scope {
    duite *rt;
    const struct prog *prog;
    const duite_call *call; /* NULL: the main program */
    int rank;
    duite_object name[PROG_MAX_TABLE];
    struct prog_object shape[PROG_MAX_TABLE];
    unsigned char *bytes; /* for the largest object */
    size_t largest;
};

/* Memory of the program's own on this rank, for an object. */
struct run_memory {
    unsigned char *block; /* with guards; NULL: the object has none here */
    void *values;
    size_t freed;          /* the operation that freed the object, plus 1 */
    atomic_int given_back; /* times */
};

/* A turn of the main program. */
struct run_turn {
    int acquired;
    duite_mode mode;
    void *data;
    size_t count;
    uint64_t seed;
};

struct run {
    const struct prog *prog;
    const struct prog_answers *answers;
    struct prog_report *report;
    struct run_scope main;
    size_t at;
    int home[PROG_MAX_TABLE]; /* when last asked; -1 before, and of what is freed if... */
    int moves;                /* ... homes change: then they are asked for at the end only */
    struct run_graph *graph;  /* n_graphs */
    unsigned char **got;      /* n_ops: where the gets that were begun go */
    struct run_memory memory[PROG_MAX_TABLE];
    struct run_turn turn[PROG_MAX_TABLE];
    int check; /* checking mode */
};

/* Keeps what is wrong at the operation `at`, if it is the first. Main thread. */
__attribute__((format(printf, 2, 3))) void prog_found(struct run *run, const char *format, ...);

/* Keeps a call's code that is not as it should be. */
void prog_expect_code(struct run *run, const char *call, int code, int expected);

/* Calls that the main program and bodies make alike; they return the code. */
int prog_call_new(struct run_scope *scope, const struct prog_op *op);
int prog_call_set(struct run_scope *scope, const struct prog_op *op);
int prog_call_fork(struct run_scope *scope, const struct prog_op *op);
int prog_call_split(struct run_scope *scope, const struct prog_op *op);

/* Adopted memory and turns (random_memory.c). `wait`: a wait has returned, so what was freed was
 * given back; else the runtime is stopped, and everything was. */
int prog_call_adopt(struct run *run, const struct prog_op *op);
void prog_call_acquire(struct run *run, const struct prog_op *op, const struct prog_expect *answer);
void prog_call_release(struct run *run, const struct prog_op *op);
void prog_check_memory(struct run *run, int wait);

/* An operation on a graph. */
void prog_call_graph(struct run *run, const struct prog_op *op, const struct prog_expect *answer);

/* Followers live with their leaders, and tasks ran where they should, as often as they should. */
void prog_check_places(struct run *run, const struct prog_context *context,
                       const struct prog_setup *setup);

#endif
