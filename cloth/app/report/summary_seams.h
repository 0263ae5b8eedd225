#ifndef CLOTH_APP_REPORT_SUMMARY_SEAMS_H
#define CLOTH_APP_REPORT_SUMMARY_SEAMS_H

#include "cloth/flow/run.h"
#include "cloth/output/output.h"

#include <stdio.h>

/* Seams in a run's summary and report: the direction of each, and how far pulled seams are open.
 * The summary leaves them out if there are none; the report has null then. Local. */
void summary_seams_print(FILE *file, const struct model *model, const struct flow_report *report);
void summary_seams_add(struct output_report *json, const struct model *model,
                       const struct flow_report *report);

#endif
