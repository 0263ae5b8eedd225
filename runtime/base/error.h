#ifndef DUITE_BASE_ERROR_H
#define DUITE_BASE_ERROR_H

#include <duite.h>

/* Sets the sentence of this thread (printf form) and returns code. */
int base_error(int code, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The usual sentence of a failed allocation; returns DUITE_E_MEMORY. */
int base_no_memory(const char *what);

#endif
