#ifndef DUITE_TRACE_SUMS_H
#define DUITE_TRACE_SUMS_H

#include "runtime/trace/read.h"

#include <stdio.h>

/* What the events of a run add up to. */
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

/* Whether the events of each worker add up to what it counted. Only for runs of which all was
 * recorded and nothing was lost. Prints each difference. */
bool trace_sums_agree(const struct trace_run *run, FILE *file);

/* Prints the table of duite-trace, for people. */
int trace_print(const struct trace_run *run, FILE *file);

#endif
