#ifndef DUITE_TOOLS_COMPARE_PROGRAM_H
#define DUITE_TOOLS_COMPARE_PROGRAM_H

#include "tools/compare/compare.h"

/* A program of the user's, behind --: lists reach it through the environment and as {names} in its
 * words. */

/* The letters of names. */
#define PROGRAM_NAME "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_"

/* NULL if {names} in this word are of lists that were given, else the reason, written to text. */
const char *program_word_wrong(const struct compare *compare, const char *word, char *text,
                               size_t size);
/* Returns true if a word of the program has {the name} of this dimension. */
bool program_names(const struct compare *compare, int dimension);
/* The word with values for {names}, to be freed; NULL without memory. */
char *program_fill(const struct compare *compare, const struct compare_config *config,
                   const char *word);
/* Sets the variables of --vary and, for a program of the user's, those of the lists. */
void program_environment(const struct compare *compare, const struct compare_config *config);

/* The program and its arguments, in one line. */
void program_print(const struct compare *compare, FILE *out);

#endif
