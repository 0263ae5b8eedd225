#ifndef CLOTH_APP_RUN_SHIPPED_H
#define CLOTH_APP_RUN_SHIPPED_H

#include <stdio.h>

/* The scenes that make install puts into share/duite/scenes. Local. */

/* The path of the shipped scene of this file name, to be freed. NULL: the name has a folder, a file
 * of this name is here, or no shipped scene has it. */
char *shipped_scene(const char *name);

/* Prints a line for each: its file name and its first line's text. Returns how many there are. */
size_t shipped_print(FILE *file);

#endif
