#ifndef CLOTH_SCENE_YAML_SCALAR_H
#define CLOTH_SCENE_YAML_SCALAR_H

#include <stdbool.h>
#include <stdint.h>

/* Numbers as YAML writes them: [+-] digits [. digits] [e [+-] digits], decimal and finite, nothing
 * before or after. */
bool scene_scalar_number(const char *text, double *value);

/* [+-] digits, from 0 to 2^32 - 1. */
/* It would be a number with a point in place of its comma. */
bool scene_scalar_has_comma(const char *text);
#define SCENE_NO_COMMA "a number has no comma: its decimals follow a point, as in 0.2"
bool scene_scalar_integer(const char *text, uint32_t *value);

#endif
