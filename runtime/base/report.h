#ifndef DUITE_BASE_REPORT_H
#define DUITE_BASE_REPORT_H

/* Writes to standard error. Where that is a pipe or a socket that nobody reads it waits for a few
 * hundredths of a second and then drops the rest: for the monitor, whose heartbeats must go on. Any
 * thread. */
void base_report(const char *text);

#endif
