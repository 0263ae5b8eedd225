#ifndef DUITE_INSTANCE_H
#define DUITE_INSTANCE_H

#include "runtime/comm/comm.h"
#include "runtime/graph/graph.h"
#include "runtime/graph/record.h"
#include "runtime/workers/workers.h"

/* A running runtime: the parts, and the errors that the next get, wait or stop still has to tell.
 * Main thread only. */
struct duite {
    MPI_Comm mpi;
    struct graph graph;
    struct comm *comm;   /* NULL: one rank */
    struct check *check; /* NULL: not in checking mode */
    struct work_pool *pool;
    const duite_mapping *mapping;
    uint64_t seed;
    size_t window;
    unsigned threads;
    int oversubscribed;
    bool mpi_held;                   /* by the program: between duite_mpi_begin and duite_mpi_end */
    int remembered;                  /* code of a failed fork, new, ... */
    char sentence[1024];             /* of `remembered` */
    struct recorded_graph *recorded; /* by slot, from 1 on */
    size_t n_recorded, recorded_capacity;
    struct graph_record *building; /* the one that build forks into, or NULL */
    uint64_t graphs_recorded;
};

/* True once nothing but stop is left: memory ran out in a fork, the ranks differ, a message was
 * lost. */
bool instance_is_broken(const duite *rt);

/* It is broken: tells the other ranks, awaits nothing any more, and returns when no task is left.
 * Does nothing the second time. */
void instance_give_up(duite *rt);

/* ---- Shared by program.c, objects.c and recorded.c ---- */

/* May this call be made now? */
int program_enter(duite *rt, const char *call);
/* The same, even while a graph is recorded. */
int program_enter_any(duite *rt, const char *call);
/* Keeps an error for the next get, wait or stop, or, inside build, for who called it. Returns code.
 */
int program_remember(duite *rt, int code);
/* Settles the homes of all objects. */
int program_settle(duite *rt);
/* Works while more tasks than the window allows are unfinished. Called after forks. */
void program_throttle(duite *rt);
/* duite_wait, under the name of who calls it. */
int program_wait(duite *rt, const char *call);
/* Copies to the values, or tells the count, whichever is wanted here. */
int program_get(duite *rt, duite_object object, int rank, void *values, size_t *count,
                const char *call);

/* Keeps the first error of a call inside build. Returns code. */
int recorded_failed(duite *rt, int code);
/* DUITE_E_NOT_FREED if graphs are left. */
int recorded_left(const duite *rt);
/* Frees all graphs; no task is left. */
void recorded_stop(duite *rt);
/* The body that runs on this thread, or NULL; and its calls (inside.c). */
struct duite_call_private *inside_body(const duite *rt);
int inside_new(struct duite_call_private *body, duite_type type, size_t count, size_t most,
               bool sized, duite_object *object);
int inside_free(struct duite_call_private *body, duite_object object);
int inside_fork(struct duite_call_private *body, const duite_how *how, const duite_kernel *kernel,
                const void *args, size_t n, const duite_object *objects);
int inside_set(struct duite_call_private *body, duite_object object, const void *values,
               const size_t *count, const char *call);
/* Copies to the values, or tells the count. */
int inside_get(struct duite_call_private *body, duite_object object, void *values, size_t *count,
               const char *call);
int inside_wait(struct duite_call_private *body);

#endif
