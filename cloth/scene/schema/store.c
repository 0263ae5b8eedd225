/* A field is found by its offset alone, so its rule must fit its type: tests/cloth/scene/test_rules
 * compares the widths of all rules. */
#include "cloth/base/memory.h"
#include "cloth/base/number.h"
#include "cloth/scene/schema/check.h"

#include <stdlib.h>
#include <string.h>

static int store_no_memory(struct cloth_error *error)
{
    return cloth_fail(error, CLOTH_E_MEMORY, "out of memory while the scene is read");
}

static void *member_of(void *base, const struct scene_field *field)
{
    return (char *)base + field->offset;
}

static int store_text(char **field, const char *text, struct cloth_error *error)
{
    *field = strdup(text);
    return *field ? CLOTH_OK : store_no_memory(error);
}

/* A number into each of the doubles that the field has. */
static void store_number(double *field, size_t width, const char *text)
{
    cloth_number(text, field);
    for (size_t i = 1; i < width / sizeof *field; i++)
        field[i] = field[0];
}

/* Enums are ints here. */
static void store_value(void *field, size_t width, int value)
{
    if (width == sizeof(bool))
        *(bool *)field = value;
    else
        *(int *)field = value;
}

int scene_store_scalar(void *base, const struct scene_rule *rule, const char *text,
                       struct cloth_error *error)
{
    size_t step;
    if (!rule->field.width)
        return CLOTH_OK;
    void *field = scene_store_items(base, rule, 1, &step, error);
    if (!field)
        return error->code;
    if (rule->type == SCENE_TEXT)
        return store_text(field, text, error);
    bool word = false;
    const int value = rule->words ? scene_word_value(rule->words, text, &word) : 0;
    if (rule->type == SCENE_NUMBER_OR_WORD && word)
        *(double *)field = value;
    else if (rule->type == SCENE_CHOICE)
        store_value(field, rule->field.width, value);
    else if (rule->type == SCENE_INTEGER)
        scene_scalar_integer(text, field);
    else
        store_number(field, rule->field.width, text);
    return CLOTH_OK;
}

int scene_store_presence(void *base, const struct scene_rule *rule, const struct scene_tree *tree,
                         int node)
{
    if (rule->kind.width)
        store_value(member_of(base, &rule->kind), rule->kind.width, rule->value);
    if (!rule->place.width)
        return CLOTH_OK;
    char **place = member_of(base, &rule->place);
    *place = scene_tree_place(tree, node);
    return *place ? CLOTH_OK : store_no_memory(tree->error);
}

void *scene_store_items(void *base, const struct scene_rule *rule, size_t n, size_t *step,
                        struct cloth_error *error)
{
    void **array = member_of(base, &rule->field);
    const bool one =
        !rule->inside || rule->length; /* of an array: an item, whose parts these are */
    if (!rule->field.width)
        return NULL;
    if (rule->inside)
        *step = rule->count.width && !one ? rule->item : rule->inside->field.width;
    if (!rule->count.width)
        return array;
    free(*array); /* of another key that is a choice, too, which the check refuses */
    *array = cloth_alloc(one ? 1 : n, rule->item, error);
    *(uint32_t *)member_of(base, &rule->count) = !*array ? 0 : one ? 1 : (uint32_t)n;
    return *array;
}

int scene_store_name(void *item, const struct scene_rule *rule, const char *name,
                     struct cloth_error *error)
{
    return rule->name.width ? store_text(member_of(item, &rule->name), name, error) : CLOTH_OK;
}
