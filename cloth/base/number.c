/* The form is checked before the value is read. */
#include "cloth/base/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char DIGITS[] = "0123456789";

static const char *skip_sign(const char *at)
{
    return *at == '+' || *at == '-' ? at + 1 : at;
}

bool cloth_number(const char *text, double *value)
{
    const char *at = skip_sign(text);
    size_t digits = strspn(at, DIGITS);
    at += digits;
    if (*at == '.') {
        const size_t decimals = strspn(at + 1, DIGITS);
        at += 1 + decimals;
        digits += decimals;
    }
    if (digits && (*at == 'e' || *at == 'E')) {
        at = skip_sign(at + 1);
        digits = strspn(at, DIGITS);
        at += digits;
    }
    if (!digits || *at)
        return false;
    *value = strtod(text, NULL);
    return isfinite(*value);
}
