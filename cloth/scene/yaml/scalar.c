/* strtod alone would also take nan, inf, hexadecimal numbers, leading blanks and half a word: the
 * form is checked first. */
#include "cloth/scene/yaml/tree.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char DIGITS[] = "0123456789";

static const char *skip_sign(const char *at)
{
    return *at == '+' || *at == '-' ? at + 1 : at;
}

static bool is_number(const char *text)
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
    return digits && !*at;
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
    const char *start = skip_sign(text);
    double number;
    if (start[strspn(start, DIGITS)] || !scene_scalar_number(text, &number) || number < 0 ||
        number > UINT32_MAX)
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
