#ifndef DUITE_TOOLS_COMPARE_FIGURE_H
#define DUITE_TOOLS_COMPARE_FIGURE_H

#include "tools/compare/compare.h"

/* --figure, the number that is compared, and --same, a text that must not differ. Each is key=KEY
 * of the report (flat JSON where --report says, or DUITE_REPORT for a program), or an extended
 * regular expression: its first group, in the last line of a program's output that has one. */

/* NULL if --figure or --same can be this, else the reason, written to text. */
const char *figure_wrong(const struct compare *compare, const char *what, char *text, size_t size);

/* Fills in a run that ended well, in so many seconds, from its report and its log. NULL, or the
 * reason why it has no figure, written to text. */
const char *figure_read(const struct compare *compare, const char *report, const char *log,
                        double seconds, struct compare_run *run, char *text, size_t size);

#endif
