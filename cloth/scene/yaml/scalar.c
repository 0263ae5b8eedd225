/* strtod alone would also take nan, inf, hexadecimal numbers, leading blanks and half a word: the
 * form is checked first. */
#include "cloth/scene/yaml/scalar.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char *skip_digits(const char *at)
{
    while (*at >= '0' && *at <= '9')
        at++;
    return at;
}

static const char *skip_sign(const char *at)
{
    return *at == '+' || *at == '-' ? at + 1 : at;
}

static bool is_number(const char *text)
{
    const char *start = skip_sign(text), *at = skip_digits(start);
    bool any = at > start;
    if (*at == '.') {
        const char *fraction = at + 1;
        at = skip_digits(fraction);
        any = any || at > fraction;
    }
    if (!any)
        return false;
    if (*at == 'e' || *at == 'E') {
        const char *exponent = skip_sign(at + 1);
        at = skip_digits(exponent);
        if (at == exponent)
            return false;
    }
    return !*at;
}

bool scene_scalar_number(const char *text, double *value)
{
    if (!is_number(text))
        return false;
    *value = strtod(text, NULL);
    return isfinite(*value);
}

bool scene_scalar_integer(const char *text, uint32_t *value)
{
    const char *start = skip_sign(text), *end = skip_digits(start);
    double number;
    if (end == start || *end || !scene_scalar_number(text, &number))
        return false;
    if (number < 0 || number > UINT32_MAX)
        return false;
    *value = (uint32_t)number;
    return true;
}

bool scene_scalar_has_comma(const char *text)
{
    char number[60];
    char *comma = number + snprintf(number, sizeof number, "%.59s", text);
    while (comma > number && *comma != ',')
        comma--;
    if (*comma != ',')
        return false;
    *comma = '.';
    return is_number(number);
}
