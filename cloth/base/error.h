#ifndef CLOTH_BASE_ERROR_H
#define CLOTH_BASE_ERROR_H

#include <stddef.h>

/* How every function of the cloth that can fail reports: an int code, and one error message. The
 * first failure wins: cloth_fail does not overwrite an error that is already set. */

enum cloth_code {
    CLOTH_OK = 0,
    CLOTH_E_INPUT = 1,   /* a file, key, option or value that cannot be used: exit code 2 */
    CLOTH_E_MEMORY = 2,  /* an allocation failed */
    CLOTH_E_IO = 3,      /* a file could not be opened, read or written */
    CLOTH_E_RUN = 4,     /* the simulation failed: diverged, or a task failed */
    CLOTH_E_LIBRARY = 5, /* a library underneath (METIS, MPI, EGL, ...) failed */
    CLOTH_E_LOST = 6     /* a rank is lost, or MPI failed: there is nobody to agree with */
};

struct cloth_error {
    int code; /* CLOTH_OK while nothing failed */
    char text[1024];
};

/* Sets code and message (printf form, no trailing newline; one that is too long loses its middle)
 * unless an error is already set. Returns the code that is set, so that `return cloth_fail(...)`
 * reads well. `error` may be NULL. Local. */
int cloth_fail(struct cloth_error *error, int code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Adds to a text (printf form) as far as its size allows. Local. */
void cloth_text_add(char *text, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
