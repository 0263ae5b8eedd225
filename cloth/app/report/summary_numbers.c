/* Numbers that the table and the report both have: NaN where there is nothing to divide by. */
#include "cloth/app/report/summary_numbers.h"

#include <math.h>

double summary_ratio(double a, double b)
{
    return b > 0 ? a / b : NAN;
}

double summary_hidden_fraction(const struct summary *summary)
{
    const duite_counters *counters = &summary->report->counters;
    return 1 - summary_ratio(counters->exposed, counters->awaited);
}

double summary_iterations_mean(const struct summary *summary)
{
    const struct flow_report *report = summary->report;
    bool implicit = model_is_implicit(summary->model);
    return implicit ? summary_ratio((double)report->cg_iterations_total, (double)report->steps)
                    : NAN;
}

double summary_solves_mean(const struct flow_report *report)
{
    const uint64_t solves =
        report->steps + report->steps_halved + report->steps_retaken + report->contact_solves;
    return summary_ratio((double)solves, (double)report->steps);
}
