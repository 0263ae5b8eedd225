/* The walk of a document along the rules, which checks, adds defaults and fills structures in one.
 * Its depth is the schema's. `base` is the structure that the fields of a rule belong to; NULL:
 * nothing is filled. */
#include "cloth/scene/schema/check.h"
#include "cloth/base/number.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

static int check_node(struct scene_tree *tree, const struct scene_place *at,
                      const struct scene_rule *rule, int node, void *base);

/* ---- Choices ---- */

/* The last set that gave a key or anything below it, from 1; 0: none did. The caller's sets come
 * after the phase's, whose keys are nodes in their order. */
static size_t set_of_pair(const struct scene_tree *tree, yaml_node_pair_t pair)
{
    const yaml_mark_t mark = scene_tree_node(tree, pair.key)->start_mark;
    if (mark.index == SCENE_BY_PHASE)
        return tree->n_included + mark.line;
    const size_t phases = INT_MAX; /* more than there are nodes */
    if (mark.index == SCENE_BY_SET)
        return phases + mark.line + 1;
    return mark.index == SCENE_BY_DEFAULT ? 0 : tree->n_included - mark.index;
}

static bool is_choice(const struct scene_tree *tree, const struct scene_rule *keys,
                      yaml_node_pair_t pair)
{
    const char *name = scene_tree_scalar(tree, pair.key);
    const struct scene_rule *rule = name ? scene_rule_of(keys, name) : NULL;
    return rule && rule->choice;
}

/* Among several keys of a map that exclude each other the last one that a set gave stays: a choice
 * replaces a choice. Two that the file gives, or one set, both stay, which the check refuses. A map
 * that a set changed belongs to this place alone (edit.c), so keys may be taken from it. */
static void settle_choice(struct scene_tree *tree, int map, const struct scene_rule *keys)
{
    size_t last = 0;
    for (size_t i = 0; i < scene_tree_length(tree, map); i++) {
        const yaml_node_pair_t pair = scene_tree_pair(tree, map, i);
        const size_t set = set_of_pair(tree, pair);
        if (is_choice(tree, keys, pair) && set > last)
            last = set;
    }
    for (size_t i = scene_tree_length(tree, map); i > 0; i--) {
        const yaml_node_pair_t pair = scene_tree_pair(tree, map, i - 1);
        if (is_choice(tree, keys, pair) && set_of_pair(tree, pair) < last)
            scene_edit_remove(tree, map, i - 1);
    }
}

/* ---- The walk ---- */

/* Keys of a map are texts, each there once. */
static int check_names(struct scene_tree *tree, const struct scene_place *at, int map)
{
    char path[SCENE_PATH], is[100];
    for (size_t i = 0; i < scene_tree_length(tree, map); i++) {
        int key = scene_tree_pair(tree, map, i).key;
        const char *name = scene_tree_scalar(tree, key);
        if (!name || !*name)
            return scene_tree_fail(tree, key, "a key of %s is %s; a text is expected",
                                   scene_place_path(at, path),
                                   scene_tree_found(tree, key, SCENE_QUOTES, is, sizeof is));
        for (size_t j = 0; j < i; j++) {
            const int other = scene_tree_pair(tree, map, j).key;
            if (!strcmp(name, scene_tree_scalar(tree, other)))
                return scene_tree_fail(tree, key, "%s is twice in %s; each key is allowed once",
                                       name, scene_place_path(at, path));
        }
    }
    return CLOTH_OK;
}

/* Checks the values of a map whose keys are the rules `keys`. */
static int check_values(struct scene_tree *tree, const struct scene_place *at,
                        const struct scene_rule *keys, int map, void *base)
{
    for (size_t i = 0; i < scene_tree_length(tree, map); i++) {
        yaml_node_pair_t pair = scene_tree_pair(tree, map, i);
        const struct scene_rule *rule = scene_rule_of(keys, scene_tree_scalar(tree, pair.key));
        if (!rule && !scene_tree_is_given(tree, pair.key))
            continue; /* of another key that shares this map by an alias */
        if (!rule)
            return scene_fault_key(tree, at, keys, pair.key);
        if (check_node(tree, &(struct scene_place){at, rule->key, 0}, rule, pair.value, base))
            return tree->error->code;
    }
    return CLOTH_OK;
}

/* A default is walked like a value of the file, since a map may have defaults of its own. */
static int add_missing(struct scene_tree *tree, const struct scene_place *at,
                       const struct scene_rule *keys, int map, void *base)
{
    char path[SCENE_PATH], expected[300];
    for (const struct scene_rule *rule = keys; rule->key; rule++) {
        const struct scene_place here = {at, rule->key, 0};
        if (scene_tree_get(tree, map, rule->key))
            continue;
        if (rule->required)
            return scene_tree_fail(tree, map, "%s is missing; %s is expected",
                                   scene_place_path(&here, path),
                                   scene_rule_expected(rule, expected, sizeof expected));
        if (rule->fallback &&
            (scene_edit_default(tree, map, rule->key, rule->fallback) ||
             check_node(tree, &here, rule, scene_tree_get(tree, map, rule->key), base)))
            return tree->error->code;
    }
    return CLOTH_OK;
}

/* Exactly one of a map's keys that are choices must be there. */
static int check_choice(struct scene_tree *tree, const struct scene_place *at,
                        const struct scene_rule *keys, int map)
{
    char path[SCENE_PATH], allowed[300] = "";
    const char *first = NULL;
    for (const struct scene_rule *key = keys; key->key; key++) {
        const size_t used = strlen(allowed);
        if (key->choice)
            snprintf(allowed + used, sizeof allowed - used, "%s%s", used ? " or " : "", key->key);
    }
    for (size_t i = 0; i < scene_tree_length(tree, map); i++) {
        const int key = scene_tree_pair(tree, map, i).key;
        const char *name = scene_tree_scalar(tree, key);
        const struct scene_rule *rule = scene_rule_of(keys, name);
        if (!rule || !rule->choice)
            continue;
        if (first)
            return scene_tree_fail(tree, key, "%s has both %s and %s; one of %s is expected",
                                   scene_place_path(at, path), first, name, allowed);
        first = name;
    }
    return first || !*allowed ? CLOTH_OK
                              : scene_tree_fail(tree, map, "%s has no %s; one of them is expected",
                                                scene_place_path(at, path), allowed);
}

/* base: the structure that the map fills, here and in the next one. */
static int check_map(struct scene_tree *tree, const struct scene_place *at,
                     const struct scene_rule *rule, int node, void *base)
{
    const struct scene_rule *keys = rule->inside;
    int code = check_names(tree, at, node);
    for (size_t i = 1; !code && i < scene_tree_length(tree, node); i++)
        code = scene_check_comma(tree, at, node, i);
    settle_choice(tree, node, keys);
    return code || check_values(tree, at, keys, node, base) || check_choice(tree, at, keys, node) ||
           add_missing(tree, at, keys, node, base);
}

static int check_one_of(struct scene_tree *tree, const struct scene_place *at,
                        const struct scene_rule *rule, int node, void *base)
{
    char path[SCENE_PATH], expected[300];
    int code = check_names(tree, at, node);
    settle_choice(tree, node, rule->inside);
    const size_t n = scene_tree_length(tree, node);
    if (code || check_values(tree, at, rule->inside, node, base) || n == 1)
        return tree->error->code;
    return scene_tree_fail(tree, n ? scene_tree_pair(tree, node, 1).key : node,
                           "%s has %zu keys; %s is expected", scene_place_path(at, path), n,
                           scene_rule_expected(rule, expected, sizeof expected));
}

/* Room for the entries of a list or named map; NULL: nothing is filled, or an error. */
static char *items_of(struct scene_tree *tree, const struct scene_rule *rule, int node, void *base,
                      size_t *step)
{
    const size_t n = scene_tree_length(tree, node);
    *step = 0;
    return base ? scene_store_items(base, rule, n, step, tree->error) : NULL;
}

static int check_named(struct scene_tree *tree, const struct scene_place *at,
                       const struct scene_rule *rule, int node, void *base)
{
    size_t step;
    if (check_names(tree, at, node))
        return tree->error->code;
    if (!scene_tree_length(tree, node))
        return scene_fault_value(tree, at, rule, node);
    char *items = items_of(tree, rule, node, base, &step);
    int code = tree->error->code;
    for (size_t i = 0; !code && i < scene_tree_length(tree, node); i++) {
        const yaml_node_pair_t pair = scene_tree_pair(tree, node, i);
        const char *name = scene_tree_scalar(tree, pair.key);
        void *item = items ? items + i * step : NULL;
        code = (item && scene_store_name(item, rule, name, tree->error)) ||
               check_node(tree, &(struct scene_place){at, name, 0}, rule->inside, pair.value, item);
    }
    return code;
}

static int check_list(struct scene_tree *tree, const struct scene_place *at,
                      const struct scene_rule *rule, int node, void *base)
{
    size_t n = scene_tree_length(tree, node), step;
    if ((rule->length && n != rule->length) || (rule->filled && !n) ||
        (rule->max > 0 && (double)n > rule->max))
        return scene_fault_value(tree, at, rule, node);
    char *items = items_of(tree, rule, node, base, &step);
    int code = tree->error->code;
    struct scene_rule inside = *rule->inside;
    inside.unit = rule->unit; /* the unit of a list is that of its numbers */
    for (size_t i = 0; !code && i < n; i++)
        code = check_node(tree, &(struct scene_place){at, NULL, i}, &inside,
                          scene_tree_item(tree, node, i), items ? items + i * step : NULL);
    return code;
}

static bool number_fits(const struct scene_rule *rule, const char *text)
{
    double value;
    if (!cloth_number(text, &value))
        return false;
    if (rule->range == SCENE_FRACTION)
        return value > 0 && value < 1;
    if (rule->range == SCENE_COEFFICIENT)
        return value >= 0 && value <= 1000;
    return rule->range == SCENE_ANY || value > 0 ||
           (rule->range == SCENE_NOT_NEGATIVE && value >= 0);
}

static bool integer_fits(const struct scene_rule *rule, const char *text)
{
    uint32_t value;
    return scene_scalar_integer(text, &value) && value >= rule->min &&
           (rule->max <= 0 || value <= rule->max);
}

static bool is_word_of(const struct scene_rule *rule, const char *text)
{
    bool known;
    scene_word_value(rule->words, text, &known);
    return known;
}

static int check_scalar(struct scene_tree *tree, const struct scene_place *at,
                        const struct scene_rule *rule, int node, void *base)
{
    const yaml_node_t *scalar = scene_tree_node(tree, node);
    const char *text = scene_tree_scalar(tree, node);
    bool plain = scalar->data.scalar.style == YAML_PLAIN_SCALAR_STYLE, fits;
    if (rule->type == SCENE_TEXT)
        fits = *text && !scene_tree_empty(tree, node) && strlen(text) == scalar->data.scalar.length;
    else if (rule->type == SCENE_CHOICE)
        fits = is_word_of(rule, text);
    else if (rule->type == SCENE_INTEGER)
        fits = plain && integer_fits(rule, text);
    else
        fits = (plain && number_fits(rule, text)) ||
               (rule->type == SCENE_NUMBER_OR_WORD && is_word_of(rule, text));
    if (!fits)
        return scene_fault_value(tree, at, rule, node);
    return base ? scene_store_scalar(base, rule, text, tree->error) : CLOTH_OK;
}

static bool has_own_tag(const yaml_node_t *node)
{
    static const char *const usual[] = {[YAML_SCALAR_NODE] = YAML_STR_TAG,
                                        [YAML_SEQUENCE_NODE] = YAML_SEQ_TAG,
                                        [YAML_MAPPING_NODE] = YAML_MAP_TAG};
    return node->tag && strcmp((const char *)node->tag, usual[node->type]) != 0;
}

/* The structure that a map fills: a member of that which it stands in, or this itself. */
static void *structure_of(const struct scene_rule *rule, void *base)
{
    return base && !rule->apart ? (char *)base + rule->field.offset : NULL;
}

static int check_node(struct scene_tree *tree, const struct scene_place *at,
                      const struct scene_rule *rule, int node, void *base)
{
    char path[SCENE_PATH];
    const yaml_node_t *here = scene_tree_node(tree, node);
    const bool list = here->type == YAML_SEQUENCE_NODE, map = here->type == YAML_MAPPING_NODE;
    if (has_own_tag(here))
        return scene_tree_fail(tree, node,
                               "%s has the tag %.60s; a value without a tag is expected",
                               scene_place_path(at, path), (const char *)here->tag);
    if (base && scene_store_presence(base, rule, tree, node))
        return tree->error->code;
    if (list && rule->type == SCENE_ROTATION)
        return check_list(tree, at, &scene_quaternion, node, NULL);
    if (map && rule->type == SCENE_ROTATION)
        return check_map(tree, at, rule, node, NULL);
    if (map && rule->type == SCENE_MAP)
        return check_map(tree, at, rule, node, structure_of(rule, base));
    if (map && rule->type == SCENE_ONE_OF)
        return check_one_of(tree, at, rule, node, structure_of(rule, base));
    if (map && rule->type == SCENE_NAMED)
        return check_named(tree, at, rule, node, base);
    if (map && rule->type == SCENE_EDITS)
        return check_names(tree, at, node);
    if (list && (rule->type == SCENE_LIST || rule->type == SCENE_NUMBER_OR_LIST))
        return check_list(tree, at, rule, node, base);
    if (!list && !map && rule->type >= SCENE_NUMBER)
        return check_scalar(tree, at, rule, node, base);
    return scene_fault_value(tree, at, rule, node);
}

int scene_fill(void *structure, const struct scene_rule *rule, struct scene_tree *tree, int node)
{
    return check_node(tree, &(struct scene_place){0}, rule, node, structure);
}

int scene_check(struct scene_tree *tree)
{
    const struct scene_place root = {0}, schema = {&root, "schema", 0};
    /* Another schema is reported before its keys are called unknown. */
    const int node = scene_tree_get(tree, 1, "schema");
    return (node &&
            check_node(tree, &schema, scene_rule_of(scene_root.inside, "schema"), node, NULL)) ||
           check_node(tree, &root, &scene_root, 1, tree->model);
}
