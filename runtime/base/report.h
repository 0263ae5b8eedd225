#ifndef DUITE_BASE_REPORT_H
#define DUITE_BASE_REPORT_H

/* Writes to standard error. If it is a pipe or socket that nobody reads, waits a few hundredths of
 * a second and then drops the rest: the monitor's heartbeats must go on. Any thread. */
void base_report(const char *text);

#endif
