#ifndef DUITE_TOOLS_TRACE_EXPORT_H
#define DUITE_TOOLS_TRACE_EXPORT_H

#include "tools/trace/read.h"

#include <stdio.h>

/* Forms of a run for other tools. A form is one file, which defines its table, and one row here;
 * duite-trace has an option for each row. */
#define TRACE_EXPORT_ROWS(ROW)                                                                     \
    ROW(paje)                                                                                      \
    ROW(chrome)                                                                                    \
    ROW(csv)

struct trace_export {
    const char *option, *help; /* of duite-trace */
    /* Writes the run to `file`, which stays open. Errors: memory. The caller sees by ferror whether
     * the file took all of it. */
    int (*write)(const struct trace_run *run, FILE *file);
};

#define TRACE_EXPORT_DECLARE(name) extern const struct trace_export trace_export_##name;
TRACE_EXPORT_ROWS(TRACE_EXPORT_DECLARE)

/* ---- Paje ---- */

/* A span of one kind. Workers of all ranks are numbered through. */
struct trace_span {
    double begin, end; /* s */
    const char *name;
    uint32_t worker;
};

/* Writes spans and messages (NULL: none) of the caller's own in the form of Paje.
 * `host_of[worker]`: its rank; `limit`: the whole time, at least. A span that ends before it begins
 * is an event. `file` stays open. Errors: memory. */
int trace_write_paje_spans(FILE *file, struct trace_span *span, size_t n,
                           const struct trace_messages *messages, const uint32_t *host_of,
                           uint32_t n_workers, double limit);

#endif
