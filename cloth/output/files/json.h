#ifndef CLOTH_OUTPUT_FILES_JSON_H
#define CLOTH_OUTPUT_FILES_JSON_H

#include "cloth/base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* The little JSON that reports and scene.json need. Numbers are printed in the "C" locale, in which
 * a program starts. */

/* A string in quotes, escaped; bytes that are not UTF-8 become U+FFFD. */
void output_json_string(FILE *file, const char *text);

/* 17 digits, which read back as the same double; null for NaN and infinities. */
void output_json_number(FILE *file, double value);

/* One number alone; several in brackets. */
void output_json_put_numbers(FILE *file, size_t n, const double *value);

/* A reader of text that ends with '\0'. After the first failure all functions return false or 0 and
 * `error` says "PATH:LINE: what was expected". */
struct output_json {
    const char *path, *text, *next;
    struct cloth_error *error;
    bool failed;
};

/* Takes the character if it comes next after white space. */
bool output_json_take(struct output_json *json, char c);
/* The same, but it is an error if it does not come. */
bool output_json_expect(struct output_json *json, char c);
/* Takes "name" and the colon after it, if they come next. */
bool output_json_key(struct output_json *json, const char *name);
/* The same, but it is an error if they do not come. */
void output_json_expect_key(struct output_json *json, const char *name);
/* Takes "word", if it comes next. */
bool output_json_word(struct output_json *json, const char *word);
double output_json_double(struct output_json *json);
/* One number alone; several in brackets. */
void output_json_numbers(struct output_json *json, size_t n, double *value);
/* True if a list has an item number i, from 0. Takes the bracket or comma before it, or the bracket
 * that ends the list. */
bool output_json_item(struct output_json *json, size_t i);
/* Fails with "expected WHAT". */
void output_json_fail(struct output_json *json, const char *what);

#endif
