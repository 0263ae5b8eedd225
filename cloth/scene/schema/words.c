/* Words for people: the values that a rule allows, and guesses for a wrong word. */
#include "cloth/scene/schema/rules.h"

#include <stdint.h>
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

/* The candidate nearest to a word, if it is near enough to be meant; else NULL. */
static const char *nearest_word(const char *word, const char *const *candidates, size_t n)
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

char *scene_allowed_words(const char *word, const char *const *candidates, size_t n, char *text,
                          size_t size)
{
    const char *nearest = nearest_word(word, candidates, n);
    *text = 0;
    if (nearest)
        cloth_text_add(text, size, "; did you mean '%s'? Allowed: ", nearest);
    else
        cloth_text_add(text, size, "; allowed: ");
    for (size_t i = 0; i < n; i++)
        cloth_text_add(text, size, "%s%s", i ? ", " : "", candidates[i]);
    return text;
}

static void append_keys(const struct scene_rule *keys, char *text, size_t size)
{
    for (const struct scene_rule *key = keys; key->key; key++)
        cloth_text_add(text, size, "%s%s", key == keys ? "" : ", ", key->key);
}

static void append_integer(const struct scene_rule *rule, char *text, size_t size)
{
    if (rule->max > 0 && rule->min >= rule->max)
        cloth_text_add(text, size, "%.0f", rule->max);
    else
        cloth_text_add(text, size, "a whole number from %.0f to %.0f", rule->min,
                       rule->max > 0 ? rule->max : (double)UINT32_MAX);
}

static void append_list(const struct scene_rule *rule, char *text, size_t size)
{
    const char *const all[] = {[SCENE_NUMBER] = "numbers",     [SCENE_INTEGER] = "whole numbers",
                               [SCENE_LIST] = "lists",         [SCENE_CHOICE] = "words",
                               [SCENE_MAP] = "maps",           [SCENE_ONE_OF] = "maps",
                               [SCENE_ROTATION] = "rotations", [SCENE_TEXT] = "texts"};
    const char *items = all[rule->inside->type];
    if (rule->length)
        cloth_text_add(text, size, "a list of %zu %s", rule->length, items);
    else if (rule->max > 0)
        cloth_text_add(text, size, "a list of %s %g %s", rule->filled ? "1 to" : "at most",
                       rule->max, items);
    else
        cloth_text_add(text, size, "a %slist of %s", rule->filled ? "non-empty " : "", items);
}

static void append_number(const struct scene_rule *rule, char *text, size_t size)
{
    const char *const ranges[] = {"", " > 0", " >= 0", " > 0 and < 1", " >= 0 and <= 1000"};
    cloth_text_add(text, size, "a finite number%s", ranges[rule->range]);
    if (rule->type == SCENE_NUMBER_OR_LIST && rule->length)
        cloth_text_add(text, size, " or a list of %zu of them", rule->length);
    else if (rule->type == SCENE_NUMBER_OR_LIST)
        cloth_text_add(text, size, " or a list of them");
}

static void append_words(const struct scene_rule *rule, char *text, size_t size)
{
    for (const struct model_word *word = rule->words; word->word; word++)
        cloth_text_add(text, size, "%s%s", *text ? " or " : "", word->word);
}

static void append_unit(const struct scene_rule *rule, char *text, size_t size)
{
    if (rule->unit)
        cloth_text_add(text, size, " (%s)", rule->unit);
}

char *scene_rule_expected(const struct scene_rule *rule, char *text, size_t size)
{
    *text = 0;
    switch (rule->type) {
    case SCENE_MAP:
    case SCENE_ONE_OF:
        cloth_text_add(text, size, "a map %s ",
                       rule->type == SCENE_MAP ? "of" : "with exactly one of");
        append_keys(rule->inside, text, size);
        break;
    case SCENE_ROTATION:
        cloth_text_add(text, size, "a quaternion [w, x, y, z] or a map of ");
        append_keys(rule->inside, text, size);
        break;
    case SCENE_NAMED:
        cloth_text_add(text, size, "a non-empty map of names");
        break;
    case SCENE_EDITS:
        cloth_text_add(text, size, "a map KEY: VALUE, such as time.h: 0.002");
        break;
    case SCENE_LIST:
        append_list(rule, text, size);
        break;
    case SCENE_INTEGER:
        append_integer(rule, text, size);
        break;
    case SCENE_NUMBER:
    case SCENE_NUMBER_OR_LIST:
    case SCENE_NUMBER_OR_WORD:
        append_number(rule, text, size);
        break;
    case SCENE_TEXT:
        cloth_text_add(text, size, "a text");
        break;
    case SCENE_CHOICE:
        break;
    }
    append_unit(rule, text, size);
    if (rule->type == SCENE_CHOICE || rule->type == SCENE_NUMBER_OR_WORD)
        append_words(rule, text, size);
    return text;
}
