#ifndef CLOTH_APP_REPORT_SUMMARY_NUMBERS_H
#define CLOTH_APP_REPORT_SUMMARY_NUMBERS_H

#include "cloth/app/report/summary.h"

/* Numbers that the table and the report both have. Pure; NaN where there is nothing to divide by.
 */
double summary_ratio(double a, double b);
/* The share of the time in which messages were awaited that workers had tasks in. */
double summary_hidden_fraction(const struct summary *summary);
/* CG's iterations a step. */
double summary_iterations_mean(const struct summary *summary);
/* Solves a step; those of steps that were given up count, too. */
double summary_solves_mean(const struct flow_report *report);

#endif
