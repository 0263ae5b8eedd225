#ifndef BENCH_REPORT_H
#define BENCH_REPORT_H

#include "bench/measure.h"
#include "tools/compare/load.h"

#include <stdio.h>

/* Figures as lines on stdout and, flat, as JSON. */

struct report {
    FILE *json; /* in memory; NULL: none is wanted */
    char *text;
    size_t size;
    struct load load; /* before the first subject */
};

/* `json`: whether there is to be a file. 1, said on stderr, without memory. */
int report_start(struct report *report, bool json);

/* Something about the run: `# key: value`, and "key": "value" (or the number) in the file. */
void report_text(struct report *report, const char *key, const char *value);
void report_number(struct report *report, const char *key, double value);

/* `name: median unit [low .. high]`, the quartiles in brackets; or why there is none. After it, if
 * there is a target, `, target <= bound: pass`, `miss` or `not measured`. In the file name,
 * name_low and name_high, or null, and name_target. */
void report_metric(struct report *report, const struct measure_metric *metric);

/* The machine, the compiler, the load. A high one draws a warning, on stderr, too. */
void report_host(struct report *report);
/* When all subjects have ended: how many cores other programs had since report_host; likewise. */
void report_others(struct report *report);

/* Writes the file, whole or not at all, if path is not NULL. 1, said on stderr, if it cannot. */
int report_finish(struct report *report, const char *path);

#endif
