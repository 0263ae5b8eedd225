#ifndef DUITE_TRACE_BODIES_H
#define DUITE_TRACE_BODIES_H

#include "runtime/trace/read.h"

/* Seconds of bodies by the numbers of their tasks. Read-only once it is made, so any thread may
 * ask. */
struct trace_bodies;

/* NULL without memory. The caller frees it; NULL is fine there. */
struct trace_bodies *trace_bodies_new(const struct trace_run *run);
void trace_bodies_free(struct trace_bodies *bodies);

/* Whether the task of this number ran; and for how long, 0 if it did not. */
bool trace_bodies_find(const struct trace_bodies *bodies, uint64_t number, double *seconds);

#endif
