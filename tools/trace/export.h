#ifndef DUITE_TOOLS_TRACE_EXPORT_H
#define DUITE_TOOLS_TRACE_EXPORT_H

#include "tools/trace/read.h"

#include <stdio.h>

/* Forms of a run for other tools. A form is one file, which defines its table, and one row here;
 * duite-trace has an option for each row. */
#define TRACE_EXPORT_ROWS(ROW)                                                                     \
    ROW(paje)                                                                                      \
    ROW(chrome)                                                                                    \
    ROW(otf2)                                                                                      \
    ROW(csv)

/* One of the two functions is there. Errors of both: memory. */
struct trace_export {
    const char *option, *help; /* of duite-trace */
    /* Writes the run to `file`, which stays open. The caller sees by ferror whether the file took
     * all of it. */
    int (*write)(const struct trace_run *run, FILE *file);
    /* Writes the run into a folder, and makes it unless it is there. DUITE_E_SYSTEM, too; the
     * message says what cannot be written. */
    int (*write_folder)(const struct trace_run *run, const char *folder);
};

#define TRACE_EXPORT_DECLARE(name) extern const struct trace_export trace_export_##name;
TRACE_EXPORT_ROWS(TRACE_EXPORT_DECLARE)

/* ---- Spans and moments: moments.c ---- */

/* A span of one kind. Workers of all ranks are numbered through. A span that ends before it begins
 * is something without a duration. */
struct trace_span {
    double begin, end; /* s */
    const char *name;
    uint32_t worker;
    const struct trace_event *event; /* NULL: of a prediction */
};

struct trace_spans {
    struct trace_span *span;
    size_t n;
    uint32_t *host_of; /* by worker: its rank */
    uint32_t n_workers;
};

/* The events of a run, those of a worker in the order of their ends. Errors: memory;
 * trace_spans_free is due all the same. */
int trace_spans_find(const struct trace_run *run, struct trace_spans *spans);
void trace_spans_free(struct trace_spans *spans);

/* The beginning or the end of a span, something without a duration, or an end of a message. */
struct trace_moment {
    double time, begin, end;             /* begin, end: of its span */
    const struct trace_span *span;       /* NULL: of a message */
    const struct trace_message *message; /* NULL: of a span */
    enum { MOMENT_END, MOMENT_BEGIN, MOMENT_MARK, MOMENT_SENT, MOMENT_RECEIVED } what;
    uint32_t worker;
    size_t key; /* of a message: from 1 on */
};

/* By time; as qsort wants it. */
int trace_moment_compare(const void *a, const void *b);

/* All moments of spans and messages (NULL: none), in the order of time: *moment is to be freed by
 * base_free. Errors: memory. */
int trace_moments_find(const struct trace_spans *spans, const struct trace_messages *messages,
                       struct trace_moment **moment, size_t *n);

/* ---- Paje ---- */

/* Writes spans and messages (NULL: none) of the caller's own in the form of Paje. `limit`: the
 * whole time, at least. `file` stays open. Errors: memory. */
int trace_write_paje_spans(FILE *file, const struct trace_spans *spans,
                           const struct trace_messages *messages, double limit);

#endif
