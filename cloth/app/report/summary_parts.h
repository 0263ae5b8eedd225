#ifndef CLOTH_APP_REPORT_SUMMARY_PARTS_H
#define CLOTH_APP_REPORT_SUMMARY_PARTS_H

#include "cloth/app/report/summary.h"
#include "cloth/output/output.h"

/* Numbers that the table and the report both have. Pure; NaN where there is nothing to divide by.
 */
double summary_ratio(double a, double b);
/* The share of the time in which messages were awaited that workers had tasks in. */
double summary_hidden_fraction(const struct summary *summary);
/* CG's iterations a step. */
double summary_iterations_mean(const struct summary *summary);
/* Solves a step; those of steps that were given up count, too. */
double summary_solves_mean(const struct flow_report *report);

/* Seams in a run's summary and report: the direction of each, and how far pulled seams are open.
 * The summary leaves them out if there are none; the report has null then. Local. */
void summary_seams_print(FILE *file, const struct model *model, const struct flow_report *report);
void summary_seams_add(struct output_report *json, const struct model *model,
                       const struct flow_report *report);

#endif
