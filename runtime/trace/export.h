#ifndef DUITE_TRACE_EXPORT_H
#define DUITE_TRACE_EXPORT_H

#include "runtime/trace/read.h"

#include <stdio.h>

/* A run in the forms of others: a file of this folder each, and a row in the table FORMS of
 * duite-trace.c, which has the option, its help and the function. Written to `file`, which stays
 * open; 0, or DUITE_E_MEMORY. What the file could not take is told by ferror. */

/* What lasted, of one kind: on workers of all ranks, numbered through. */
struct trace_span {
    double begin, end; /* s */
    const char *name;
    uint32_t worker;
};

/* Paje (Schnorr, de Oliveira Stein & Chassin de Kergommeaux, 2013), which ViTE opens: ranks hold
 * workers, whose states are pushed and popped; steals and messages are events. */
int trace_write_paje(const struct trace_run *run, FILE *file);
/* The same form for spans of one's own: `host_of[worker]`; `limit`: the whole time, at least. A
 * span that ends before it begins is an event. */
int trace_write_paje_spans(FILE *file, struct trace_span *span, size_t n, const uint32_t *host_of,
                           uint32_t n_workers, double limit);
/* The JSON of Chrome's trace viewer, which Perfetto opens. */
int trace_write_chrome(const struct trace_run *run, FILE *file);
/* A line an event, with a head line. */
int trace_write_csv(const struct trace_run *run, FILE *file);

#endif
