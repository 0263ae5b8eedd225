/* The message of the last failed call, one a thread: written by the failing call, read by
 * duite_message(). */
#include "runtime/base/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static _Thread_local char message[1024];

/* A message that is too long, say by a path, loses its middle; the reason is at its end. */
static void message_cut_middle(const char *whole)
{
    enum { HEAD = sizeof message / 4, GAP = 6, TAIL = sizeof message - HEAD - GAP };
    snprintf(message, sizeof message, "%.*s ... %s", (int)HEAD, whole,
             whole + strlen(whole) - TAIL);
}

/* The arguments may point into the previous message, so the new one is written elsewhere first. */
int base_error(int code, const char *format, ...)
{
    char *whole = NULL;
    va_list list;
    va_start(list, format);
    if (vasprintf(&whole, format, list) < 0)
        snprintf(message, sizeof message, "out of memory for the message of an error");
    else if (strlen(whole) < sizeof message)
        memcpy(message, whole, strlen(whole) + 1);
    else
        message_cut_middle(whole);
    free(whole);
    va_end(list);
    return code;
}

int base_no_memory(const char *what)
{
    return base_error(DUITE_E_MEMORY, "out of memory for %s", what);
}

const char *duite_message(void)
{
    return message;
}

static const char *const TEXTS[] = {
    [DUITE_OK] = "success",
    [-DUITE_E_ARGUMENT] = "bad argument",
    [-DUITE_E_MEMORY] = "out of memory",
    [-DUITE_E_OBJECT] = "no such object",
    [-DUITE_E_KERNEL] = "bad kernel",
    [-DUITE_E_ACCESS] = "accesses do not fit the kernel",
    [-DUITE_E_MPI] = "MPI failed",
    [-DUITE_E_DIFFERENT] = "ranks run different programs",
    [-DUITE_E_STATE] = "call not allowed here",
    [-DUITE_E_NOT_FREED] = "objects or graphs were not freed",
    [-DUITE_E_CHECK] = "a body does not keep to what its kernel declares",
    [-DUITE_E_SYSTEM] = "the operating system refused",
    [-DUITE_E_RIGHT] = "a right the task does not hold",
    [-DUITE_E_LAW] = "law does not fit",
    [-DUITE_E_SIZE] = "size out of bounds",
    [-DUITE_E_LOST] = "a rank is lost",
    [-DUITE_E_DEPTH] = "bodies that wait are nested too deeply for the stack",
    [-DUITE_E_BINDING] = "an object does not fit the one it is bound to",
};

const char *duite_code_text(int code)
{
    if (code > 0)
        return "error of the program";
    const size_t i = -(size_t)code;
    return i < sizeof TEXTS / sizeof *TEXTS && TEXTS[i] ? TEXTS[i] : "unknown code";
}
