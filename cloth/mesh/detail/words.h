#ifndef CLOTH_MESH_DETAIL_WORDS_H
#define CLOTH_MESH_DETAIL_WORDS_H

#include <locale.h>
#include <stdbool.h>

/* The words of a line: blanks stand between them, a word that starts with # and all behind it is a
 * comment. Local. */

/* The next word at or behind `at`, or NULL. */
const char *mesh_word(const char *at);
/* The first byte behind the word. */
const char *mesh_word_end(const char *word);
/* If the line starts with this keyword, what stands behind it; else NULL. */
const char *mesh_word_after(const char *line, const char *keyword);

/* The word as a decimal number; false if it is none or not finite. c: a "C" locale. */
bool mesh_word_number(const char *word, locale_t c, double *number);

/* A corner: v, v/vt, v//vn or v/vt/vn, in whole numbers, those left out 0. Numbers beyond +-2^31
 * become 2^31 + 1 or -2^31 - 1. False if the word is something else. */
struct mesh_corner {
    long long v, vt, vn;
};
bool mesh_word_corner(const char *word, struct mesh_corner *corner);

/* A printable copy of the word, cut to what a sentence can hold. */
struct mesh_quote {
    char text[48];
};
struct mesh_quote mesh_word_quote(const char *word);

#endif
