/* The walk of a document along the rules, which checks, adds defaults and fills structures in one.
 * Its depth is the schema's. `base` is the structure that the fields of a rule belong to; NULL:
 * nothing is filled. */
#include "cloth/scene/schema/check.h"
#include "cloth/scene/schema/faults.h"
#include "cloth/scene/schema/store.h"
#include "cloth/scene/yaml/edit.h"
#include "cloth/scene/yaml/scalar.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

static int check_node(struct scene_walk *walk, const struct scene_place *at,
                      const struct scene_rule *rule, int node, void *base);

/* ---- Choices ---- */

/* The last set that gave a key or anything below it, from 1; 0: none did. The caller's sets come
 * after the phase's, whose keys are nodes in their order. */
static size_t set_of_pair(const struct scene_tree *tree, yaml_node_pair_t pair)
{
    const yaml_mark_t mark = scene_tree_node(tree, pair.key)->start_mark;
    if (mark.index == SCENE_BY_PHASE)
        return mark.line;
    const size_t phases = INT_MAX; /* more than there are nodes */
    return mark.index == SCENE_BY_SET ? phases + mark.line + 1 : 0;
}

static bool is_choice(const struct scene_tree *tree, const struct scene_rule *keys, bool all,
                      yaml_node_pair_t pair)
{
    const char *name = scene_tree_scalar(tree, pair.key);
    while (name && keys->key && strcmp(keys->key, name) != 0)
        keys++;
    return name && keys->key && (all || keys->choice);
}

/* Among several keys of a map that exclude each other the last one that a set gave stays: a choice
 * replaces a choice. Two that the file gives, or one set, both stay, which the check refuses. all:
 * the keys exclude each other all; else those that are choices. A map that a set changed belongs to
 * this place alone (edit.h), so keys may be taken from it. */
static void settle_choice(struct scene_tree *tree, int map, const struct scene_rule *keys, bool all)
{
    size_t last = 0;
    for (size_t i = 0; i < scene_tree_length(tree, map); i++) {
        const yaml_node_pair_t pair = scene_tree_pair(tree, map, i);
        const size_t set = set_of_pair(tree, pair);
        if (is_choice(tree, keys, all, pair) && set > last)
            last = set;
    }
    for (size_t i = scene_tree_length(tree, map); i > 0; i--) {
        const yaml_node_pair_t pair = scene_tree_pair(tree, map, i - 1);
        if (is_choice(tree, keys, all, pair) && set_of_pair(tree, pair) < last)
            scene_edit_remove(tree, map, i - 1);
    }
}

/* ---- The walk ---- */

/* Keys of a map are texts, each there once. */
static int check_names(struct scene_walk *walk, const struct scene_place *at, int map)
{
    char path[200], is[100];
    for (size_t i = 0; i < scene_tree_length(walk->tree, map); i++) {
        int key = scene_tree_pair(walk->tree, map, i).key;
        const char *name = scene_tree_scalar(walk->tree, key);
        scene_place_path(at, path, sizeof path);
        if (!name || !*name)
            return scene_tree_fail(walk->tree, key, walk->error,
                                   "a key of %s is %s; a text is expected", path,
                                   scene_tree_found(walk->tree, key, SCENE_QUOTES, is, sizeof is));
        for (size_t j = 0; j < i; j++) {
            const int other = scene_tree_pair(walk->tree, map, j).key;
            if (!strcmp(name, scene_tree_scalar(walk->tree, other)))
                return scene_tree_fail(walk->tree, key, walk->error,
                                       "%s is twice in %s; each key is allowed once", name, path);
        }
    }
    return CLOTH_OK;
}

/* Checks the values of a map whose keys are the rules `keys`. */
static int check_values(struct scene_walk *walk, const struct scene_place *at,
                        const struct scene_rule *keys, int map, void *base)
{
    for (size_t i = 0; i < scene_tree_length(walk->tree, map); i++) {
        yaml_node_pair_t pair = scene_tree_pair(walk->tree, map, i);
        const struct scene_rule *rule =
            scene_rule_of(keys, scene_tree_scalar(walk->tree, pair.key));
        if (!rule && !scene_tree_is_given(walk->tree, pair.key))
            continue; /* of another key that shares this map by an alias */
        if (!rule)
            return scene_fault_key(walk, at, keys, pair.key);
        int code =
            check_node(walk, &(struct scene_place){at, rule->key, 0}, rule, pair.value, base);
        if (code)
            return code;
    }
    return CLOTH_OK;
}

/* A default is walked like a value of the file, since a map may have defaults of its own. */
static int add_default(struct scene_walk *walk, const struct scene_place *here,
                       const struct scene_rule *rule, int map, void *base)
{
    int code = scene_edit_default(walk->tree, map, rule->key, rule->fallback, walk->error);
    return code ? code
                : check_node(walk, here, rule, scene_tree_get(walk->tree, map, rule->key), base);
}

static int add_missing(struct scene_walk *walk, const struct scene_place *at,
                       const struct scene_rule *keys, int map, void *base)
{
    char path[200], expected[300];
    for (const struct scene_rule *rule = keys; rule->key; rule++) {
        struct scene_place here = {at, rule->key, 0};
        if (scene_tree_get(walk->tree, map, rule->key))
            continue;
        scene_place_path(&here, path, sizeof path);
        if (rule->required)
            return scene_tree_fail(walk->tree, map, walk->error, "%s is missing; %s is expected",
                                   path, scene_rule_expected(rule, expected, sizeof expected));
        int code = rule->fallback ? add_default(walk, &here, rule, map, base) : CLOTH_OK;
        if (code)
            return code;
    }
    return CLOTH_OK;
}

/* Exactly one of a map's keys that are choices must be there. */
static int check_choice(struct scene_walk *walk, const struct scene_place *at,
                        const struct scene_rule *keys, int map)
{
    const char *names[SCENE_MAX_KEYS], *first = NULL;
    size_t n = 0;
    for (const struct scene_rule *key = keys; key->key && n < SCENE_MAX_KEYS; key++)
        if (key->choice)
            names[n++] = key->key;
    char path[200], allowed[300] = "";
    for (size_t i = 0; i < n; i++) {
        const size_t used = strlen(allowed);
        snprintf(allowed + used, sizeof allowed - used, "%s%s", i ? " or " : "", names[i]);
    }
    scene_place_path(at, path, sizeof path);
    for (size_t i = 0; i < scene_tree_length(walk->tree, map); i++) {
        const int key = scene_tree_pair(walk->tree, map, i).key;
        const char *name = scene_tree_scalar(walk->tree, key);
        const struct scene_rule *rule = scene_rule_of(keys, name);
        if (!rule || !rule->choice)
            continue;
        if (first)
            return scene_tree_fail(walk->tree, key, walk->error,
                                   "%s has both %s and %s; one of %s is expected", path, first,
                                   name, allowed);
        first = name;
    }
    if (!n || first)
        return CLOTH_OK;
    return scene_tree_fail(walk->tree, map, walk->error, "%s has no %s; one of them is expected",
                           path, allowed);
}

/* base: the structure that the map fills, here and in the next one. */
static int check_map(struct scene_walk *walk, const struct scene_place *at,
                     const struct scene_rule *rule, int node, void *base)
{
    int code = check_names(walk, at, node);
    for (size_t i = 1; !code && i < scene_tree_length(walk->tree, node); i++)
        code = scene_check_comma(walk, at, node, i);
    settle_choice(walk->tree, node, rule->inside, false);
    if (!code)
        code = check_values(walk, at, rule->inside, node, base);
    if (!code)
        code = check_choice(walk, at, rule->inside, node);
    return code ? code : add_missing(walk, at, rule->inside, node, base);
}

static int check_one_of(struct scene_walk *walk, const struct scene_place *at,
                        const struct scene_rule *rule, int node, void *base)
{
    int code = check_names(walk, at, node);
    settle_choice(walk->tree, node, rule->inside, true);
    if (!code)
        code = check_values(walk, at, rule->inside, node, base);
    size_t n = scene_tree_length(walk->tree, node);
    if (code || n == 1)
        return code;
    char path[200], expected[300];
    scene_place_path(at, path, sizeof path);
    int where = n ? scene_tree_pair(walk->tree, node, 1).key : node;
    return scene_tree_fail(walk->tree, where, walk->error, "%s has %zu keys; %s is expected", path,
                           n, scene_rule_expected(rule, expected, sizeof expected));
}

/* Room for the entries of a list or named map; NULL: nothing is filled, or an error. */
static char *items_of(struct scene_walk *walk, const struct scene_rule *rule, int node, void *base,
                      size_t *step)
{
    const size_t n = scene_tree_length(walk->tree, node);
    *step = 0;
    return base ? scene_store_items(base, rule, n, step, walk->error) : NULL;
}

static int check_named(struct scene_walk *walk, const struct scene_place *at,
                       const struct scene_rule *rule, int node, void *base)
{
    int code = check_names(walk, at, node);
    if (!code && !scene_tree_length(walk->tree, node))
        return scene_fault_value(walk, at, rule, node);
    size_t step;
    char *items = code ? NULL : items_of(walk, rule, node, base, &step);
    code = walk->error->code;
    for (size_t i = 0; !code && i < scene_tree_length(walk->tree, node); i++) {
        yaml_node_pair_t pair = scene_tree_pair(walk->tree, node, i);
        const char *name = scene_tree_scalar(walk->tree, pair.key);
        void *item = items ? items + i * step : NULL;
        code = item ? scene_store_name(item, rule, name, walk->error) : CLOTH_OK;
        if (!code)
            code = check_node(walk, &(struct scene_place){at, name, 0}, rule->inside, pair.value,
                              item);
    }
    return code;
}

static int check_list(struct scene_walk *walk, const struct scene_place *at,
                      const struct scene_rule *rule, int node, void *base)
{
    size_t n = scene_tree_length(walk->tree, node), step;
    if ((rule->length && n != rule->length) || (rule->filled && !n) ||
        (rule->max > 0 && (double)n > rule->max))
        return scene_fault_value(walk, at, rule, node);
    char *items = items_of(walk, rule, node, base, &step);
    int code = walk->error->code;
    struct scene_rule inside = *rule->inside;
    inside.unit = rule->unit; /* the unit of a list is that of its numbers */
    for (size_t i = 0; !code && i < n; i++)
        code = check_node(walk, &(struct scene_place){at, NULL, i}, &inside,
                          scene_tree_item(walk->tree, node, i), items ? items + i * step : NULL);
    return code;
}

static bool number_fits(const struct scene_rule *rule, const char *text)
{
    double value;
    if (!scene_scalar_number(text, &value))
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

static int check_scalar(struct scene_walk *walk, const struct scene_place *at,
                        const struct scene_rule *rule, int node, void *base)
{
    const yaml_node_t *scalar = scene_tree_node(walk->tree, node);
    const char *text = scene_tree_scalar(walk->tree, node);
    bool plain = scalar->data.scalar.style == YAML_PLAIN_SCALAR_STYLE, fits;
    if (rule->type == SCENE_TEXT)
        fits = *text && !scene_tree_empty(walk->tree, node) &&
               strlen(text) == scalar->data.scalar.length;
    else if (rule->type == SCENE_CHOICE)
        fits = is_word_of(rule, text);
    else if (rule->type == SCENE_INTEGER)
        fits = plain && integer_fits(rule, text);
    else
        fits = (plain && number_fits(rule, text)) ||
               (rule->type == SCENE_NUMBER_OR_WORD && is_word_of(rule, text));
    if (!fits)
        return scene_fault_value(walk, at, rule, node);
    return base ? scene_store_scalar(base, rule, text, walk->error) : CLOTH_OK;
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

static int check_node(struct scene_walk *walk, const struct scene_place *at,
                      const struct scene_rule *rule, int node, void *base)
{
    char path[200];
    const yaml_node_t *here = scene_tree_node(walk->tree, node);
    bool list = here->type == YAML_SEQUENCE_NODE, map = here->type == YAML_MAPPING_NODE;
    if (has_own_tag(here)) {
        scene_place_path(at, path, sizeof path);
        return scene_tree_fail(walk->tree, node, walk->error,
                               "%s has the tag %.60s; a value without a tag is expected", path,
                               (const char *)here->tag);
    }
    const int code =
        base ? scene_store_presence(base, rule, walk->tree, node, walk->error) : CLOTH_OK;
    if (code)
        return code;
    if (map && rule->type == SCENE_MAP)
        return check_map(walk, at, rule, node, structure_of(rule, base));
    if (map && rule->type == SCENE_ONE_OF)
        return check_one_of(walk, at, rule, node, structure_of(rule, base));
    if (map && rule->type == SCENE_NAMED)
        return check_named(walk, at, rule, node, base);
    if (map && rule->type == SCENE_EDITS)
        return check_names(walk, at, node);
    if (list && (rule->type == SCENE_LIST || rule->type == SCENE_NUMBER_OR_LIST))
        return check_list(walk, at, rule, node, base);
    if (!list && !map && rule->type >= SCENE_NUMBER)
        return check_scalar(walk, at, rule, node, base);
    return scene_fault_value(walk, at, rule, node);
}

int scene_fill(void *structure, const struct scene_rule *rule, struct scene_tree *tree, int node,
               struct cloth_error *error)
{
    struct scene_walk walk = {tree, error};
    return check_node(&walk, &(struct scene_place){0}, rule, node, structure);
}

int scene_check(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    struct scene_walk walk = {tree, error};
    const struct scene_place root = {0}, schema = {&root, "schema", 0};
    /* Another schema is reported before its keys are called unknown. */
    int node = scene_tree_get(tree, 1, "schema");
    int code =
        node ? check_node(&walk, &schema, scene_rule_of(scene_root.inside, "schema"), node, NULL)
             : CLOTH_OK;
    return code ? code : check_node(&walk, &root, &scene_root, 1, model);
}
