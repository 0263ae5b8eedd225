#ifndef TESTS_SUPPORT_SAID_H
#define TESTS_SUPPORT_SAID_H

/* A program's standard error, for tests of its sentences while it runs. One thread begins and ends;
 * any may count. */

/* From now on standard error goes to a file. */
void said_begin(void);

/* How many lines begin with `begin` and contain `part`. */
int said_lines(const char *begin, const char *part);

/* Standard error is what it was, and has all that was written meanwhile. */
void said_end(void);

#endif
