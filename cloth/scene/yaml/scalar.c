/* Whole numbers, and numbers with a comma. */
#include "cloth/base/number.h"
#include "cloth/scene/yaml/tree.h"

#include <stdio.h>
#include <string.h>

bool scene_scalar_integer(const char *text, uint32_t *value)
{
    const char *start = text + (*text == '+' || *text == '-');
    double number;
    if (start[strspn(start, "0123456789")] || !cloth_number(text, &number) || number < 0 ||
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
    double value;
    return cloth_number(number, &value);
}
