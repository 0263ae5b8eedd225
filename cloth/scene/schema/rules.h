#ifndef CLOTH_SCENE_SCHEMA_RULES_H
#define CLOTH_SCENE_SCHEMA_RULES_H

#include <stdbool.h>
#include <stddef.h>

/* What a scene may say, as a tree of constant rules: a map has the rules of its keys, a list the
 * rule of its items. */

enum scene_type {
    SCENE_MAP,            /* inside: its keys */
    SCENE_ONE_OF,         /* a map with exactly one of the keys `inside` */
    SCENE_NAMED,          /* a map with keys of the user's choice; inside: their one rule */
    SCENE_LIST,           /* inside: the rule of its items */
    SCENE_NUMBER,         /* finite, in `range` */
    SCENE_INTEGER,        /* least <= value <= most */
    SCENE_NUMBER_OR_LIST, /* a number in `range`, or a list like SCENE_LIST */
    SCENE_TEXT,           /* not empty */
    SCENE_CHOICE          /* one of the words `choices` */
};

enum scene_range { SCENE_ANY, SCENE_POSITIVE, SCENE_NOT_NEGATIVE, SCENE_FRACTION };

struct scene_rule {
    const char *key; /* NULL ends the keys of a map */
    enum scene_type type;
    const char *unit;     /* NULL: a pure number, or not a number */
    const char *fallback; /* the default as YAML; NULL: none */
    bool required;        /* without a default: whether the key must be there */
    bool choice;          /* of the keys of a map that are choices one must be there, and no more */
    enum scene_range range;
    double least, most;       /* of integers; most 0: 2^32 - 1 */
    size_t length;            /* of lists; 0: any */
    bool filled;              /* lists: at least one entry */
    const char *const *words; /* choices, ended by NULL */
    const struct scene_rule *inside;
    const char *about; /* for the list of keys */
};

/* The rule of the whole document. */
extern const struct scene_rule scene_root;

/* What is allowed, in words: "a finite number > 0 (s)". Returns text. */
char *scene_rule_expected(const struct scene_rule *rule, char *text, size_t size);

/* The candidate nearest to a word, if it is near enough to be what was meant; else NULL.
 * Candidates: n strings. */
const char *scene_nearest_word(const char *word, const char *const *candidates, size_t n);

/* "; did you mean 'x'? Allowed: x, y, z", cut to size. Returns text. */
char *scene_allowed_words(const char *word, const char *const *candidates, size_t n, char *text,
                          size_t size);

#endif
