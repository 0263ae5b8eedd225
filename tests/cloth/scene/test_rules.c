/* Every rule fits the field that it fills: fields are found by offset, so no compiler looks. */
#include "cloth/scene/schema/rules.h"
#include "tests/support/unit.h"

#include <stdio.h>
#include <string.h>

/* The structure that a map fills, as far as it is known. */
struct structure {
    const char *name; /* NULL: not yet */
    size_t size;
};

static unsigned n_fields, n_places;

/* What a value takes. */
static size_t width_of(const struct scene_rule *rule)
{
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
        const char *name = model_integrator_name((enum model_integrator)i);
        ck_assert_int_eq(scene_word_value(model_integrators, name, &known), i);
        ck_assert(known);
    }
}
