#ifndef CLOTH_APP_REPORT_SUMMARY_TIME_H
#define CLOTH_APP_REPORT_SUMMARY_TIME_H

#include "cloth/app/report/summary.h"
#include "cloth/output/output.h"

/* The time of a run by kinds of task, and its limit. Local; called on rank 0. */

/* A line for each kind of task that ran: the seconds in its tasks. */
void summary_time_print(FILE *file, const struct flow_report *report);

/* Prints what limited the run, in one sentence with reasons, by the rule of docs/tracing.md. A run
 * without steps prints nothing. */
void summary_limit_print(FILE *file, const struct summary *summary);

/* limited_by: the name of the limit, as duite-trace has it; null for a run that made no step. */
void summary_limit_add(struct output_report *json, const struct summary *summary);

#endif
