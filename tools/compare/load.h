#ifndef DUITE_TOOLS_COMPARE_LOAD_H
#define DUITE_TOOLS_COMPARE_LOAD_H

#include <stddef.h>

/* Other programs on the machine: before a measurement by the load average, during it by the time
 * that they have on the cores. */

struct load {
    double cores;
    double average;       /* of the last minute; NAN: the system does not tell */
    double busy, own, at; /* s: of all cores; of this process and its children that ended; when */
};

/* Takes down how things are. */
void load_begin(struct load *load);
/* How many cores others had on average since then; a child counts as other until it was waited for.
 * NAN if the system does not tell, or less than half a second ago. */
double load_others(const struct load *load);

/* A warning, written to text, if more than a quarter of the cores is taken; else NULL. */
const char *load_warn_average(double average, double cores, char *text, size_t size);
const char *load_warn_others(double others, double cores, char *text, size_t size);

#endif
