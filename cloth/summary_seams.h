#ifndef CLOTH_SUMMARY_SEAMS_H
#define CLOTH_SUMMARY_SEAMS_H

#include "cloth/flow/run.h"
#include "cloth/output/output.h"

#include <stdio.h>

/* What the summary and the report of a run say of seams: which way round each is sewn, and how far
 * those that are pulled are open. Nothing where there are no seams; the report has null then.
 * Local.
 */
void summary_seams_print(FILE *file, const struct model *model, const struct flow_report *report);
void summary_seams_add(struct output_report *json, const struct model *model,
                       const struct flow_report *report);

#endif
