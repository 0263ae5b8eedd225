/* An error holds the first failure only: whoever notices first knows most about it. */
#include "cloth/base/error.h"

#include <stdarg.h>
#include <stdio.h>

int cloth_fail(struct cloth_error *error, int code, const char *format, ...)
{
    if (!error)
        return code;
    if (error->code)
        return error->code;
    va_list list;
    va_start(list, format);
    vsnprintf(error->text, sizeof error->text, format, list);
    va_end(list);
    error->code = code;
    return code;
}
