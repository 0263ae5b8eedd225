#ifndef DUITE_TRACE_BOUNDS_H
#define DUITE_TRACE_BOUNDS_H

#include "runtime/trace/read.h"

/* What no schedule could have done better with the bodies of a run, in seconds. */
struct trace_bounds {
    double path; /* the longest chain of tasks, each of which needs what the one before it wrote */
    double work; /* in bodies, all workers together */
};

/* Errors: memory; DUITE_E_ARGUMENT for a trace with losses, without a whole program, damaged or
 * without tasks. */
int trace_bounds_find(const struct trace_run *run, struct trace_bounds *bounds);

#endif
