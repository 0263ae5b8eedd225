#ifndef DUITE_TOOLS_TRACE_SUMS_H
#define DUITE_TOOLS_TRACE_SUMS_H

#include "tools/trace/read.h"

#include <stdio.h>

/* Sums over the events of a run. */
struct trace_sums {
    uint64_t tasks, stolen, chained, delegated, messages, bytes, received, migrated;
    double busy, idle, exposed, flush; /* s, over all workers; flush: writing the trace */
    double own;                        /* in the runtime's own tasks */
    double messaging;                  /* in messages: looking for them, sending and taking them */
    double first, last;                /* s: when the first event begins, and the last one ends */
    uint32_t workers;
    struct trace_kernel_sum {
        uint64_t n;
        double seconds, longest;
    } * kernel; /* run->n_kernels; to be freed */
};

/* Errors: memory. */
int trace_sum(const struct trace_run *run, struct trace_sums *sums);
void trace_sums_free(struct trace_sums *sums);

/* True if the events of each worker add up to its counters. Only for runs recorded in full, without
 * losses. Prints each difference. */
bool trace_sums_agree(const struct trace_run *run, FILE *file);

/* Prints the table of duite-trace, for people. path: seconds of the critical path; not a number:
 * unknown. */
int trace_print(const struct trace_run *run, double path, FILE *file);

/* ---- Bodies ---- */

/* Seconds of bodies by the numbers of their tasks. Never written once it is made: any thread may
 * read it. */
struct trace_bodies;

/* NULL without memory. The caller frees it; NULL is fine there. */
struct trace_bodies *trace_bodies_new(const struct trace_run *run);
void trace_bodies_free(struct trace_bodies *bodies);

/* True if the task of this number ran; *seconds: for how long, 0 if it did not. */
bool trace_bodies_find(const struct trace_bodies *bodies, uint64_t number, double *seconds);

/* ---- What limits ---- */

/* Shares of a run's time, 0 .. 1: of the workers' time, but for `path`, which is a share of the
 * span. */
struct trace_shares {
    double work;     /* bodies of tasks */
    double path;     /* the critical path; 0: unknown */
    double messages; /* MPI, and idle while messages were awaited */
    double starved;  /* idle otherwise: too few tasks are ready */
    double runtime;  /* all else: the runtime, the main program, the trace itself */
};

/* The name of the largest share; of equal ones, the first. */
const char *trace_limit_name(const struct trace_shares *shares);

#endif
