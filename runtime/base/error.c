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

const char *duite_code_text(int code)
{
    if (code > 0)
        return "error of the program";
    switch (code) {
    case DUITE_OK:
        return "success";
    case DUITE_E_ARGUMENT:
        return "bad argument";
    case DUITE_E_MEMORY:
        return "out of memory";
    case DUITE_E_OBJECT:
        return "no such object";
    case DUITE_E_KERNEL:
        return "bad kernel";
    case DUITE_E_ACCESS:
        return "accesses do not fit the kernel";
    case DUITE_E_MPI:
        return "MPI failed";
    case DUITE_E_DIFFERENT:
        return "ranks run different programs";
    case DUITE_E_STATE:
        return "call not allowed here";
    case DUITE_E_NOT_FREED:
        return "objects or graphs were not freed";
    case DUITE_E_CHECK:
        return "a body does not keep to what its kernel declares";
    case DUITE_E_SYSTEM:
        return "the operating system refused";
    case DUITE_E_RIGHT:
        return "a right the task does not hold";
    case DUITE_E_LAW:
        return "law does not fit";
    case DUITE_E_SIZE:
        return "size out of bounds";
    case DUITE_E_LOST:
        return "a rank is lost";
    case DUITE_E_DEPTH:
        return "bodies that wait are nested too deeply for the stack";
    case DUITE_E_BINDING:
        return "an object does not fit the one it is bound to";
    default:
        return "unknown code";
    }
}
