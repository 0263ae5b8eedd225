#ifndef DUITE_TRACE_BOUNDS_H
#define DUITE_TRACE_BOUNDS_H

#include "runtime/trace/read.h"

/* Lower bounds of the time that any schedule of a run's bodies takes, in seconds. */
struct trace_bounds {
    double path; /* the longest chain of tasks, each of which needs what the one before it wrote */
    double work; /* in bodies, all workers together */
};

/* Errors: memory; DUITE_E_ARGUMENT for a trace with losses, without a whole program, damaged or
 * without tasks. */
int trace_bounds_find(const struct trace_run *run, struct trace_bounds *bounds);

#endif
