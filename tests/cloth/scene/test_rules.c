/* Every rule fits the field that it fills: fields are found by offset, so no compiler looks. The
 * examples of the page of all keys are what the rules allow. */
#include "cloth/scene/schema/check.h"
#include "cloth/scene/schema/needs.h"
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <stdio.h>
#include <string.h>

/* The structure that a map fills, as far as it is known. */
struct structure {
    const char *name; /* NULL: not yet */
    size_t size;
};

static unsigned n_fields, n_places;

/* The kinds of a value. */
static size_t width_of(const struct scene_rule *rule)
{
    if (rule->count.width)
        return sizeof(void *);
    switch (rule->type) {
    case SCENE_NUMBER:
    case SCENE_NUMBER_OR_WORD:
        return sizeof(double);
    case SCENE_INTEGER:
        return sizeof(uint32_t);
    case SCENE_TEXT:
        return sizeof(char *);
    case SCENE_NAMED:
        return sizeof(void *);
    case SCENE_LIST:
    case SCENE_NUMBER_OR_LIST:
        return rule->length ? rule->length * width_of(rule->inside) : sizeof(void *);
    default:
        return rule->field.width;
    }
}

static bool is_one_value(size_t width)
{
    return width == sizeof(bool) || width == sizeof(int);
}

/* All fields of one map are of one structure, and inside it. */
static void check_field(const char *key, const struct scene_field *field, struct structure *in)
{
    if (!field->width || !field->of)
        return;
    if (!in->name)
        in->name = field->of;
    ck_assert_msg(!in->size || in->size == field->size,
                  "%s is of %s, which is not what the map fills", key, field->of);
    ck_assert_msg(!strcmp(in->name, field->of), "%s is of %s among keys of %s", key, field->of,
                  in->name);
    ck_assert_uint_le(field->offset + field->width, field->size);
}

static void check_rule(const struct scene_rule *rule, struct structure *in);

static void check_keys(const struct scene_rule *keys, struct structure *in)
{
    for (const struct scene_rule *key = keys; key->key; key++)
        check_rule(key, in);
}

static void check_map(const struct scene_rule *rule, struct structure *in)
{
    struct structure own = {NULL, rule->apart ? 0 : rule->field.width};
    check_keys(rule->inside, rule->apart || rule->field.width ? &own : in);
}

static void check_items(const char *key, const struct scene_rule *rule, struct structure *in)
{
    struct structure item = {NULL, rule->item};
    check_field(key, &rule->count, in);
    check_field(key, &rule->name, &item);
    if (rule->field.width && !rule->count.width)
        ck_assert_msg(rule->inside->field.width == width_of(rule->inside),
                      "%s: its items have no width", key);
    if (rule->count.width) {
        ck_assert_uint_eq(rule->count.width, sizeof(uint32_t));
        ck_assert_uint_ge(rule->item, width_of(rule->inside));
    }
    check_rule(rule->inside, &item);
}

static void check_rule(const struct scene_rule *rule, struct structure *in)
{
    const char *key = rule->key ? rule->key : "an item";
    const bool map = rule->type == SCENE_MAP || rule->type == SCENE_ONE_OF;
    check_field(key, &rule->field, in);
    check_field(key, &rule->place, in);
    check_field(key, &rule->kind, in);
    n_fields += rule->field.of && !map;
    n_places += rule->place.width > 0;
    ck_assert_msg(!rule->field.width || rule->field.width == width_of(rule), "%s is %zu bytes wide",
                  key, rule->field.width);
    if (rule->type == SCENE_CHOICE && rule->field.width)
        ck_assert(is_one_value(rule->field.width));
    ck_assert(!rule->kind.width || is_one_value(rule->kind.width));
    ck_assert(!rule->place.width || rule->place.width == sizeof(char *));
    if (map)
        check_map(rule, in);
    else if (rule->inside)
        check_items(key, rule, in);
}

UNIT_TEST(rules_fit_their_fields)
{
    struct structure model = {NULL, sizeof(struct model)}, pick = {NULL, sizeof(struct model_pick)};
    check_rule(&scene_root, &model);
    ck_assert_str_eq(model.name, "struct model");
    check_map(&scene_region, &pick);
    ck_assert_str_eq(pick.name, "struct model_pick");
    ck_assert_uint_ge(n_fields, 90);
    ck_assert_uint_ge(n_places, 8);
}

/* A word that means two things, or two words for one thing. */
static void check_words(const struct model_word *words)
{
    for (const struct model_word *a = words; a->word; a++)
        for (const struct model_word *b = words; b < a; b++) {
            ck_assert_str_ne(a->word, b->word);
            ck_assert_msg(a->value != b->value, "%s and %s mean the same", a->word, b->word);
        }
}

static void check_all_words(const struct scene_rule *rule)
{
    const bool map = rule->type == SCENE_MAP || rule->type == SCENE_ONE_OF;
    if (rule->words)
        check_words(rule->words);
    for (const struct scene_rule *key = rule->inside; map && key->key; key++)
        check_all_words(key);
    if (!map && rule->inside)
        check_all_words(rule->inside);
}

UNIT_TEST(words_mean_one_thing)
{
    check_all_words(&scene_root);
    for (int i = 0; i < MODEL_INTEGRATORS; i++) {
        bool known;
        const char *name = model_schemes[i].name;
        ck_assert_int_eq(scene_word_value(model_integrators, name, &known), i);
        ck_assert(known);
    }
}

/* The map of a rule, and the maps around it. */
struct scope {
    const struct scope *up;
    const struct scene_rule *map;
};

static unsigned n_examples;

static const struct scene_rule *rule_in(const struct scope *scope, const char *name)
{
    const struct scene_rule *rule = NULL;
    for (; scope && !rule; scope = scope->up)
        rule = scene_rule_of(scope->map->inside, name);
    return rule;
}

/* The section of a line of prose.md; NULL: it is no head. */
static const char *head_of(const char *line)
{
    return *line == '#' ? strchr(line, ' ') + 1 : NULL;
}

/* The YAML of a section; empty: it has none. */
static const char *example_of(const char *section, char *text, size_t size)
{
    const char *const *line = scene_prose;
    bool inside = false;
    while (*line && (!head_of(*line) || strcmp(head_of(*line), section) != 0))
        line++;
    ck_assert_msg(*line, "prose.md has no section %s", section);
    *text = 0;
    for (line++; *line && !head_of(*line); line++) {
        const size_t n = strlen(text);
        if (inside && **line != '`')
            snprintf(text + n, size - n, "%s\n", *line);
        inside = inside ? **line != '`' : !strcmp(*line, "```yaml");
    }
    return text;
}

/* Whole scenes run in tests/whole/test_options.sh. */
static void check_example(const struct scope *scope, const char *section)
{
    char text[4000];
    const char *example = example_of(section, text, sizeof text);
    struct cloth_error error = {0};
    struct scene_tree tree;
    if (!*example || !strncmp(example, "schema:", 7))
        return;
    scene_write_file("scene.yaml", example, strlen(example));
    int code = scene_tree_load(&tree, scene_path(), &scene_words, &error);
    for (size_t i = 0; !code && i < scene_tree_length(&tree, 1); i++) {
        const char *name = scene_tree_scalar(&tree, scene_tree_pair(&tree, 1, i).key);
        const struct scene_rule *rule = rule_in(scope, name);
        ck_assert_msg(rule, "%s is no key", name);
        code = scene_fill(NULL, rule, &tree, scene_tree_pair(&tree, 1, i).value);
    }
    ck_assert_msg(!code, "%s in the example\n%s", error.text, example);
    scene_tree_free(&tree);
    n_examples++;
}

static void check_examples(const struct scene_rule *map, const struct scope *up)
{
    const struct scope scope = {up, map};
    for (const struct scene_rule *key = map->inside; key->key; key++) {
        const struct scene_rule *inside = key;
        if (key->section)
            check_example(&scope, key->section);
        if (key->shared)
            check_example(&scope, key->shared);
        while (inside->type == SCENE_LIST || inside->type == SCENE_NAMED)
            inside = inside->inside;
        if (inside->type == SCENE_MAP || inside->type == SCENE_ONE_OF)
            check_examples(inside, &scope);
    }
}

UNIT_TEST(examples_are_allowed)
{
    check_examples(&scene_root, NULL);
    ck_assert_uint_ge(n_examples, 25);
}

/* The map whose keys stand behind a rule; NULL: none. */
static const struct scene_rule *map_inside(const struct scene_rule *rule)
{
    while (rule->type == SCENE_LIST || rule->type == SCENE_NAMED)
        rule = rule->inside;
    return rule->type == SCENE_MAP || rule->type == SCENE_ONE_OF ? rule : NULL;
}

/* The map whose keys are rows of a section's table, or its key where that has none; NULL: no key of
 * the map has the section. */
static const struct scene_rule *rows_of(const struct scene_rule *map, const char *head)
{
    const struct scene_rule *found = NULL;
    for (const struct scene_rule *key = map->inside; key->key && !found; key++) {
        const struct scene_rule *inside = map_inside(key);
        if (key->shared && !strcmp(key->shared, head))
            found = map;
        else if (key->section && !strcmp(key->section, head))
            found = inside ? inside : key;
        else if (inside)
            found = rows_of(inside, head);
    }
    return found;
}

static void check_note(const struct scene_rule *rows, const char *note)
{
    char text[200], *rest = text;
    snprintf(text, sizeof text, "%.*s", (int)strcspn(note, "`"), note);
    for (const char *word; (word = strsep(&rest, ".")); rows = map_inside(rows)) {
        ck_assert_msg(rows && rows->inside, "the note on %s has no table", note);
        rows = scene_rule_of(rows->inside, word);
        ck_assert_msg(rows, "the note on %s is of no key", note);
    }
}

/* Each section of prose.md is of a key, but for that of the whole scene; each note is of a row. */
UNIT_TEST(prose_is_of_keys)
{
    const struct scene_rule *rows = NULL;
    for (const char *const *line = scene_prose; *line; line++) {
        if (head_of(*line))
            rows = line == scene_prose ? &scene_root : rows_of(&scene_root, head_of(*line));
        ck_assert_msg(rows, "no key has %s", *line);
        if (!strncmp(*line, "- `", 3))
            check_note(rows, *line + 3);
    }
}

static unsigned n_terms;

/* Cuts a text where another one begins in it. Returns what stands behind that; NULL: nothing does.
 */
static char *cut(char *text, const char *at)
{
    char *found = strstr(text, at);
    if (!found)
        return NULL;
    *found = 0;
    return found + strlen(at);
}

/* A term of needs.h that is no fact: its keys are there, and its words are theirs. */
static void check_term(const struct scope *scope, char *term)
{
    char *rest = !strncmp(term, "no ", 3) ? term + 3 : term, *value = strpbrk(rest, "=>");
    char *next, *more, *key;
    if (value)
        value[-1] = 0;
    for (; rest; rest = next) {
        const struct scene_rule *rule = NULL;
        next = cut(rest, " or ");
        for (bool first = true; (key = strsep(&rest, ".")); first = false) {
            rule = first ? rule_in(scope, key) : scene_rule_of(rule->inside, key);
            ck_assert_msg(rule, "%s is no key", key);
        }
        for (char *word = value ? value + 2 : NULL; word && rule->words; word = more) {
            bool known;
            more = cut(word, " or ");
            scene_word_value(rule->words, word, &known);
            ck_assert_msg(known, "%s is no word of %s", word, rule->key);
        }
    }
    n_terms++;
}

static void check_needs(const struct scope *scope, const struct scene_rule *rule)
{
    static const char *const facts[] = {NEEDS_TRIANGLES, NEEDS_WIND,          NEEDS_NO_SINE,
                                        NEEDS_SPRINGS,   NEEDS_ONLY_SPRINGS,  NEEDS_MEETINGS,
                                        NEEDS_GUARDED,   NEEDS_OWN_TRIANGLES, NEEDS_OWN_LINKS,
                                        NEEDS_OWN_EDGES, NEEDS_DIAGONALS};
    char text[200], *rest = text, *value = rule->needs ? strstr(rule->needs, ": ") : NULL;
    snprintf(text, sizeof text, "%s", !rule->needs ? "" : value ? value + 2 : rule->needs);
    while (rest && *rest) {
        char *term = rest;
        size_t i = 0;
        while (i < sizeof facts / sizeof *facts && strncmp(term, facts[i], strlen(facts[i])))
            i++;
        const bool is_fact = i < sizeof facts / sizeof *facts;
        rest = cut(is_fact ? term + strlen(facts[i]) : term, " and ");
        if (!is_fact)
            check_term(scope, term);
    }
}

static void check_all_needs(const struct scene_rule *rule, const struct scope *up)
{
    const bool map = rule->type == SCENE_MAP || rule->type == SCENE_ONE_OF;
    const struct scope own = {up, rule}, *scope = map ? &own : up;
    check_needs(scope, rule);
    for (const struct scene_rule *key = rule->inside; map && key->key; key++)
        check_all_needs(key, scope);
    if (!map && rule->inside)
        check_all_needs(rule->inside, scope);
}

UNIT_TEST(needs_are_keys_or_facts)
{
    check_all_needs(&scene_root, NULL);
    ck_assert_uint_ge(n_terms, 25);
}
