#ifndef CLOTH_APP_REPORT_SUMMARY_H
#define CLOTH_APP_REPORT_SUMMARY_H

#include "cloth/app/check/drape.h"
#include "cloth/app/check/intersections.h"
#include "cloth/app/run/options.h"
#include "cloth/app/run/phases.h"
#include "cloth/flow/run.h"
#include "cloth/untangle/untangle.h"

#include <stdio.h>

/* The summary of a finished run. Local; called on rank 0. */
struct summary {
    const struct simulate_options *options;
    const struct model *model;        /* of the last phase, as what follows, */
    const struct flow_report *report; /* but as phases_add says */
    const struct phases *phases;
    const struct untangle_result *untangled;
    const struct mesh_elastic *elastic;              /* of each material of the model */
    const struct intersections_found *intersections; /* NULL: they were not looked for */
    const struct drape_found *drape;                 /* NULL: there is no drape test */
    int ranks;
    unsigned threads, cores;           /* of rank 0 */
    const char *cores_from;            /* duite_cores */
    uint64_t workers;                  /* of all ranks together */
    uint64_t memory_bytes;             /* the largest resident size that any rank had */
    double critical_path, lower_bound; /* s, of what was traced; not a number: nothing was */
};

/* A table for people. */
void summary_print(FILE *file, const struct summary *summary);

/* The flat JSON that the man page describes. Errors as of output_report_write. */
int summary_write(const struct summary *summary, const char *path, struct cloth_error *error);

/* ---- Shared by the files of this folder ---- */

/* Numbers that the table and the report both have. Pure; NaN where there is nothing to divide by.
 */
double summary_ratio(double a, double b);
/* The share of the time in which messages were awaited that workers had tasks in. */
double summary_hidden_fraction(const struct summary *summary);
/* CG's iterations a step. */
double summary_iterations_mean(const struct summary *summary);
/* Solves a step; those of steps that were given up count, too. */
double summary_solves_mean(const struct flow_report *report);

extern const char *const summary_seam_states[MODEL_SEAMS_STATES];

/* The table of seconds in tasks of each kind. */
void summary_time_print(FILE *file, const struct flow_report *report);

/* The limit of a run: the largest of the shares of its time. A run without steps has none: it
 * prints no line, its name is NULL. */
void summary_limit_print(FILE *file, const struct summary *summary);
const char *summary_limit(const struct summary *summary);

#endif
