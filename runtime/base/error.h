#ifndef DUITE_BASE_ERROR_H
#define DUITE_BASE_ERROR_H

#include <duite.h>

/* Sets this thread's message, which duite_message returns (printf form; a long one loses its
 * middle). Returns code. Any thread. */
int base_error(int code, const char *format, ...) __attribute__((cold, format(printf, 2, 3)));

/* The message of a failed allocation: "out of memory for " and `what`. Returns DUITE_E_MEMORY. */
int base_no_memory(const char *what);

/* Writes to standard error. If it is a pipe or socket that nobody reads, waits a few hundredths of
 * a second and then drops the rest: the monitor's heartbeats must go on. Any thread. */
void base_report(const char *text);

#endif
