/* The sentence of the last failed call, one a thread: written by the failing call, read by
 * duite_message(). */
#include "runtime/base/error.h"

#include <stdarg.h>
#include <stdio.h>

static _Thread_local char sentence[1024];

int base_error(int code, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(sentence, sizeof sentence, format, list);
    va_end(list);
    return code;
}

int base_no_memory(const char *what)
{
    return base_error(DUITE_E_MEMORY, "out of memory for %s", what);
}

const char *duite_message(void)
{
    return sentence;
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
    case DUITE_E_VIEW:
        return "a view can only be read";
    case DUITE_E_LOST:
        return "a rank is lost";
    case DUITE_E_BINDING:
        return "an object does not fit the one it is bound to";
    default:
        return "unknown code";
    }
}
