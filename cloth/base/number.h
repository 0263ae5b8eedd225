#ifndef CLOTH_BASE_NUMBER_H
#define CLOTH_BASE_NUMBER_H

#include <stdbool.h>

/* The text as a number: [+-] digits [. digits] [e [+-] digits], nothing before or after; false if
 * it is none, or not finite. strtod alone would also take nan, inf, hexadecimal numbers, leading
 * blanks and half a word. Local. */
bool cloth_number(const char *text, double *value);

#endif
