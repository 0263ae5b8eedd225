/* Words for people: the values that a rule allows, and guesses for a wrong word. */
#include "cloth/scene/schema/rules.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { LONGEST = 31 }; /* words beyond this length are not guessed at */

static unsigned least_of(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

/* Insertions, deletions, changes and swaps of neighbours that lead from a to b (optimal string
 * alignment). */
static unsigned word_distance(const char *a, const char *b)
{
    size_t n = strlen(a), m = strlen(b);
    unsigned d[LONGEST + 1][LONGEST + 1];
    for (size_t i = 0; i <= n; i++) {
        for (size_t j = 0; j <= m; j++) {
            if (!i || !j) {
                d[i][j] = (unsigned)(i + j);
                continue;
            }
            d[i][j] = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
            d[i][j] = least_of(d[i][j], least_of(d[i - 1][j], d[i][j - 1]) + 1);
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = least_of(d[i][j], d[i - 2][j - 2] + 1);
        }
    }
    return d[n][m];
}

const char *scene_nearest_word(const char *word, const char *const *candidates, size_t n)
{
    size_t length = strlen(word);
    unsigned limit = length < 4 ? 1 : length < 9 ? 2 : 3;
    const char *nearest = NULL;
    for (size_t i = 0; i < n && length <= LONGEST; i++) {
        size_t other = strlen(candidates[i]);
        if (other > LONGEST)
            continue;
        unsigned far = word_distance(word, candidates[i]);
        if (far <= limit && far < (length > other ? length : other)) {
            nearest = candidates[i];
            limit = far ? far - 1 : 0;
        }
    }
    return nearest;
}

int scene_word_value(const struct model_word *words, const char *word, bool *known)
{
    while (words->word && strcmp(words->word, word) != 0)
        words++;
    if (known)
        *known = words->word;
    return words->value;
}

static void append_text(char *text, size_t size, const char *more)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "%s", more);
}

char *scene_allowed_words(const char *word, const char *const *candidates, size_t n, char *text,
                          size_t size)
{
    const char *nearest = scene_nearest_word(word, candidates, n);
    *text = 0;
    if (nearest)
        snprintf(text, size, "; did you mean '%s'? Allowed: ", nearest);
    else
        append_text(text, size, "; allowed: ");
    for (size_t i = 0; i < n; i++) {
        append_text(text, size, i ? ", " : "");
        append_text(text, size, candidates[i]);
    }
    return text;
}

static void append_keys(char *text, size_t size, const struct scene_rule *keys)
{
    for (const struct scene_rule *key = keys; key->key; key++) {
        append_text(text, size, key == keys ? "" : ", ");
        append_text(text, size, key->key);
    }
}

static void integer_expected(const struct scene_rule *rule, char *text, size_t size)
{
    if (rule->max > 0 && rule->min >= rule->max)
        snprintf(text, size, "%.0f", rule->max);
    else
        snprintf(text, size, "a whole number from %.0f to %.0f", rule->min,
                 rule->max > 0 ? rule->max : (double)UINT32_MAX);
}

static void list_expected(const struct scene_rule *rule, char *text, size_t size)
{
    const char *const items[] = {[SCENE_NUMBER] = "numbers", [SCENE_INTEGER] = "whole numbers",
                                 [SCENE_LIST] = "lists",     [SCENE_CHOICE] = "words",
                                 [SCENE_MAP] = "maps",       [SCENE_ONE_OF] = "maps",
                                 [SCENE_TEXT] = "texts"};
    if (rule->length)
        snprintf(text, size, "a list of %zu %s", rule->length, items[rule->inside->type]);
    else if (rule->max > 0)
        snprintf(text, size, "a list of %s %g %s", rule->filled ? "1 to" : "at most", rule->max,
                 items[rule->inside->type]);
    else
        snprintf(text, size, "a %slist of %s", rule->filled ? "non-empty " : "",
                 items[rule->inside->type]);
}

static void number_expected(const struct scene_rule *rule, char *text, size_t size)
{
    const char *const ranges[] = {"", " > 0", " >= 0", " > 0 and < 1", " >= 0 and <= 1000"};
    snprintf(text, size, "a finite number%s", ranges[rule->range]);
    if (rule->type != SCENE_NUMBER_OR_LIST)
        return;
    size_t used = strlen(text);
    if (rule->length)
        snprintf(text + used, size - used, " or a list of %zu of them", rule->length);
    else
        snprintf(text + used, size - used, " or a list of them");
}

static void append_words(const struct scene_rule *rule, char *text, size_t size)
{
    for (const struct model_word *word = rule->words; word->word; word++) {
        append_text(text, size, *text ? " or " : "");
        append_text(text, size, word->word);
    }
}

static void append_unit(const struct scene_rule *rule, char *text, size_t size)
{
    if (!rule->unit)
        return;
    append_text(text, size, " (");
    append_text(text, size, rule->unit);
    append_text(text, size, ")");
}

char *scene_rule_expected(const struct scene_rule *rule, char *text, size_t size)
{
    *text = 0;
    switch (rule->type) {
    case SCENE_MAP:
        append_text(text, size, "a map of ");
        append_keys(text, size, rule->inside);
        break;
    case SCENE_ONE_OF:
        append_text(text, size, "a map with exactly one of ");
        append_keys(text, size, rule->inside);
        break;
    case SCENE_NAMED:
        append_text(text, size, "a non-empty map of names");
        break;
    case SCENE_EDITS:
        append_text(text, size, "a map KEY: VALUE, such as time.h: 0.002");
        break;
    case SCENE_LIST:
        list_expected(rule, text, size);
        break;
    case SCENE_INTEGER:
        integer_expected(rule, text, size);
        break;
    case SCENE_NUMBER:
    case SCENE_NUMBER_OR_LIST:
        number_expected(rule, text, size);
        break;
    case SCENE_NUMBER_OR_WORD:
        number_expected(rule, text, size);
        append_unit(rule, text, size);
        append_words(rule, text, size);
        return text;
    case SCENE_TEXT:
        append_text(text, size, "a text");
        break;
    case SCENE_CHOICE:
        append_words(rule, text, size);
        break;
    }
    append_unit(rule, text, size);
    return text;
}
