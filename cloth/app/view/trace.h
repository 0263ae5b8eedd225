#ifndef CLOTH_APP_VIEW_TRACE_H
#define CLOTH_APP_VIEW_TRACE_H

#include "cloth/base/error.h"
#include "tools/chart/chart.h"

/* Draws the Gantt chart of the trace of a run into files, each of which is NULL or written whole or
 * not at all. Errors: CLOTH_E_INPUT for a trace, window or size that cannot be used, CLOTH_E_IO,
 * CLOTH_E_MEMORY, CLOTH_E_LIBRARY. */
int view_trace(const char *trace, const struct chart_options *options, const char *svg,
               const char *png, struct cloth_error *error);

#endif
