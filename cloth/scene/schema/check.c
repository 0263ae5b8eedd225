/* The walk of a document along the rules, which checks, adds defaults and fills structures in one.
 * Its depth is the schema's. Errors are reported by `wrong` or `unknown`, so they have one form.
 * `base` is the structure that the fields of a rule belong to; NULL: nothing is filled. */
#include "cloth/scene/schema/check.h"
#include "cloth/scene/schema/choice.h"
#include "cloth/scene/schema/store.h"
#include "cloth/scene/yaml/edit.h"
#include "cloth/scene/yaml/scalar.h"

#include <stdio.h>
#include <string.h>

struct walk {
    struct scene_tree *tree;
    struct cloth_error *error;
};

static int check(struct walk *walk, const struct scene_place *at, const struct scene_rule *rule,
                 int node, void *base);

size_t scene_place_path(const struct scene_place *at, char *text, size_t size)
{
    if (!at->up)
        return (size_t)snprintf(text, size, "the scene");
    size_t used = at->up->up ? scene_place_path(at->up, text, size) : 0;
    if (used >= size)
        return used;
    if (at->key)
        used += (size_t)snprintf(text + used, size - used, "%s%s", used ? "." : "", at->key);
    else
        used += (size_t)snprintf(text + used, size - used, "[%zu]", at->index);
    return used;
}

/* The text of a node, short and on one line. */
static const char *found(const struct walk *walk, int node, char *text, size_t size)
{
    bool list = scene_tree_is(walk->tree, node, YAML_SEQUENCE_NODE);
    size_t n = scene_tree_length(walk->tree, node);
    if (list || scene_tree_is(walk->tree, node, YAML_MAPPING_NODE)) {
        snprintf(text, size, n ? "a %s of %zu" : "an empty %s", list ? "list" : "map", n);
        return text;
    }
    if (scene_tree_empty(walk->tree, node))
        return "empty";
    bool plain = scene_tree_node(walk->tree, node)->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
    snprintf(text, size, plain ? "%.60s" : "the text '%.60s'", scene_tree_scalar(walk->tree, node));
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < 32 || *c == 127)
            *c = ' ';
    return text;
}

/* Values that are gone, and their replacements. key: the key that had them. */
static const struct {
    const char *key, *value, *now;
} outdated[] = {
    {"contact", "project", "write contact: {mode: project}"},
    {"contact", "filter", "it is gone; contact: {mode: certified} or {mode: project} is there"},
    {"mode", "filter", "it is gone; certified knows of contact in the solve, too"}};

static const char *more_of(const struct walk *walk, const struct scene_place *at, int node)
{
    const char *value = scene_tree_scalar(walk->tree, node);
    for (size_t i = 0; at->key && value && i < sizeof outdated / sizeof *outdated; i++)
        if (!strcmp(outdated[i].key, at->key) && !strcmp(outdated[i].value, value))
            return outdated[i].now;
    return value && scene_scalar_has_comma(value) ? SCENE_NO_COMMA : NULL;
}

static int wrong(struct walk *walk, const struct scene_place *at, const struct scene_rule *rule,
                 int node)
{
    char path[200], is[100], expected[300];
    const char *now = more_of(walk, at, node);
    scene_place_path(at, path, sizeof path);
    return scene_tree_fail(walk->tree, node, walk->error, "%s is %s; %s is expected%s%s", path,
                           found(walk, node, is, sizeof is),
                           scene_rule_expected(rule, expected, sizeof expected), now ? ": " : "",
                           now ? now : "");
}

const struct scene_rule *scene_rule_of(const struct scene_rule *keys, const char *name)
{
    for (const struct scene_rule *key = keys; key->key; key++)
        if (!strcmp(key->key, name))
            return key;
    return NULL;
}

enum { MAX_KEYS = 32 }; /* of a map, in sentences */

/* Keys that are gone, and their replacements. map: the key of the map, or of the list of maps, that
 * had them. */
static const struct {
    const char *map, *key, *now;
} gone[] = {{"solver", "form", "conjugate gradients have one form, with one sum an iteration"},
            {"loads", "course", "its name is curve"},
            {"air", "course", "its name is curve"},
            {"cloths", "cost",
             "uneven work to try balancers on is of duite-bench ranks (migrate) and duite-compare "
             "(irregular)"}};

/* NULL: the key never was. */
static const char *gone_of(const struct scene_place *at, const char *key)
{
    const char *map = at->key || !at->up ? at->key : at->up->key;
    for (size_t i = 0; map && i < sizeof gone / sizeof *gone; i++)
        if (!strcmp(gone[i].map, map) && !strcmp(gone[i].key, key))
            return gone[i].now;
    return NULL;
}

static int unknown(struct walk *walk, const struct scene_place *at, const struct scene_rule *keys,
                   int node)
{
    const char *names[MAX_KEYS];
    size_t n = 0;
    for (const struct scene_rule *key = keys; key->key && n < MAX_KEYS; key++)
        names[n++] = key->key;
    char path[200], is[100], allowed[400];
    scene_place_path(at, path, sizeof path);
    const char *word = scene_tree_scalar(walk->tree, node);
    const char *now = word ? gone_of(at, word) : NULL;
    if (now)
        return scene_tree_fail(walk->tree, node, walk->error, "%s is no longer a key of %s: %s",
                               word, path, now);
    return scene_tree_fail(
        walk->tree, node, walk->error, "%s is not a key of %s%s", found(walk, node, is, sizeof is),
        path, scene_allowed_words(word ? word : "", names, n, allowed, sizeof allowed));
}

static bool is_default(const struct walk *walk, int node)
{
    return scene_tree_node(walk->tree, node)->start_mark.index == SCENE_BY_DEFAULT;
}

/* {density: 0,2} is {density: 0, 2: } to YAML. Pair i is the second of these. */
static int check_comma(struct walk *walk, const struct scene_place *at, int map, size_t i)
{
    char path[200], number[100];
    const struct scene_tree *tree = walk->tree;
    const yaml_node_pair_t pair = scene_tree_pair(tree, map, i);
    const yaml_node_pair_t before = scene_tree_pair(tree, map, i - 1);
    const char *whole = scene_tree_scalar(tree, before.value);
    snprintf(number, sizeof number, "%.40s,%.40s", whole ? whole : "",
             scene_tree_scalar(tree, pair.key));
    if (!scene_tree_empty(tree, pair.value) || !scene_scalar_has_comma(number))
        return CLOTH_OK;
    scene_place_path(&(struct scene_place){at, scene_tree_scalar(tree, before.key), 0}, path,
                     sizeof path);
    return scene_tree_fail(walk->tree, before.value, walk->error, "%s is %s; %s", path, number,
                           SCENE_NO_COMMA);
}

/* Keys of a map are texts, each there once. */
static int check_names(struct walk *walk, const struct scene_place *at, int map)
{
    char path[200], is[100];
    for (size_t i = 0; i < scene_tree_length(walk->tree, map); i++) {
        int key = scene_tree_pair(walk->tree, map, i).key;
        const char *name = scene_tree_scalar(walk->tree, key);
        scene_place_path(at, path, sizeof path);
        if (!name || !*name)
            return scene_tree_fail(walk->tree, key, walk->error,
                                   "a key of %s is %s; a text is expected", path,
                                   found(walk, key, is, sizeof is));
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
static int check_values(struct walk *walk, const struct scene_place *at,
                        const struct scene_rule *keys, int map, void *base)
{
    for (size_t i = 0; i < scene_tree_length(walk->tree, map); i++) {
        yaml_node_pair_t pair = scene_tree_pair(walk->tree, map, i);
        const struct scene_rule *rule =
            scene_rule_of(keys, scene_tree_scalar(walk->tree, pair.key));
        if (!rule && is_default(walk, pair.key))
            continue; /* of another key that shares this map by an alias */
        if (!rule)
            return unknown(walk, at, keys, pair.key);
        int code = check(walk, &(struct scene_place){at, rule->key, 0}, rule, pair.value, base);
        if (code)
            return code;
    }
    return CLOTH_OK;
}

/* A default is walked like a value of the file, since a map may have defaults of its own. */
static int add_default(struct walk *walk, const struct scene_place *here,
                       const struct scene_rule *rule, int map, void *base)
{
    int code = scene_edit_default(walk->tree, map, rule->key, rule->fallback, walk->error);
    return code ? code : check(walk, here, rule, scene_tree_get(walk->tree, map, rule->key), base);
}

static int add_missing(struct walk *walk, const struct scene_place *at,
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
static int check_choice(struct walk *walk, const struct scene_place *at,
                        const struct scene_rule *keys, int map)
{
    const char *names[MAX_KEYS], *first = NULL;
    size_t n = 0;
    for (const struct scene_rule *key = keys; key->key && n < MAX_KEYS; key++)
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
static int check_map(struct walk *walk, const struct scene_place *at, const struct scene_rule *rule,
                     int node, void *base)
{
    int code = check_names(walk, at, node);
    for (size_t i = 1; !code && i < scene_tree_length(walk->tree, node); i++)
        code = check_comma(walk, at, node, i);
    scene_choice_settle(walk->tree, node, rule->inside, false);
    if (!code)
        code = check_values(walk, at, rule->inside, node, base);
    if (!code)
        code = check_choice(walk, at, rule->inside, node);
    return code ? code : add_missing(walk, at, rule->inside, node, base);
}

static int check_one_of(struct walk *walk, const struct scene_place *at,
                        const struct scene_rule *rule, int node, void *base)
{
    int code = check_names(walk, at, node);
    scene_choice_settle(walk->tree, node, rule->inside, true);
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
static char *items_of(struct walk *walk, const struct scene_rule *rule, int node, void *base,
                      size_t *step)
{
    const size_t n = scene_tree_length(walk->tree, node);
    *step = 0;
    return base ? scene_store_items(base, rule, n, step, walk->error) : NULL;
}

static int check_named(struct walk *walk, const struct scene_place *at,
                       const struct scene_rule *rule, int node, void *base)
{
    int code = check_names(walk, at, node);
    if (!code && !scene_tree_length(walk->tree, node))
        return wrong(walk, at, rule, node);
    size_t step;
    char *items = code ? NULL : items_of(walk, rule, node, base, &step);
    code = walk->error->code;
    for (size_t i = 0; !code && i < scene_tree_length(walk->tree, node); i++) {
        yaml_node_pair_t pair = scene_tree_pair(walk->tree, node, i);
        const char *name = scene_tree_scalar(walk->tree, pair.key);
        void *item = items ? items + i * step : NULL;
        code = item ? scene_store_name(item, rule, name, walk->error) : CLOTH_OK;
        if (!code)
            code = check(walk, &(struct scene_place){at, name, 0}, rule->inside, pair.value, item);
    }
    return code;
}

static int check_list(struct walk *walk, const struct scene_place *at,
                      const struct scene_rule *rule, int node, void *base)
{
    size_t n = scene_tree_length(walk->tree, node), step;
    if ((rule->length && n != rule->length) || (rule->filled && !n) ||
        (rule->max > 0 && (double)n > rule->max))
        return wrong(walk, at, rule, node);
    char *items = items_of(walk, rule, node, base, &step);
    int code = walk->error->code;
    struct scene_rule inside = *rule->inside;
    inside.unit = rule->unit; /* the unit of a list is that of its numbers */
    for (size_t i = 0; !code && i < n; i++)
        code = check(walk, &(struct scene_place){at, NULL, i}, &inside,
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

static bool is_word(const struct scene_rule *rule, const char *text)
{
    bool known;
    scene_word_value(rule->words, text, &known);
    return known;
}

static int check_scalar(struct walk *walk, const struct scene_place *at,
                        const struct scene_rule *rule, int node, void *base)
{
    const yaml_node_t *scalar = scene_tree_node(walk->tree, node);
    const char *text = scene_tree_scalar(walk->tree, node);
    bool plain = scalar->data.scalar.style == YAML_PLAIN_SCALAR_STYLE, fits;
    if (rule->type == SCENE_TEXT)
        fits = *text && !scene_tree_empty(walk->tree, node) &&
               strlen(text) == scalar->data.scalar.length;
    else if (rule->type == SCENE_CHOICE)
        fits = is_word(rule, text);
    else if (rule->type == SCENE_INTEGER)
        fits = plain && integer_fits(rule, text);
    else
        fits = (plain && number_fits(rule, text)) ||
               (rule->type == SCENE_NUMBER_OR_WORD && is_word(rule, text));
    if (!fits)
        return wrong(walk, at, rule, node);
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

static int check(struct walk *walk, const struct scene_place *at, const struct scene_rule *rule,
                 int node, void *base)
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
    return wrong(walk, at, rule, node);
}

int scene_fill(void *structure, const struct scene_rule *rule, struct scene_tree *tree, int node,
               struct cloth_error *error)
{
    struct walk walk = {tree, error};
    return check(&walk, &(struct scene_place){0}, rule, node, structure);
}

int scene_check(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    struct walk walk = {tree, error};
    const struct scene_place root = {0}, schema = {&root, "schema", 0};
    /* Another schema is reported before its keys are called unknown. */
    int node = scene_tree_get(tree, 1, "schema");
    int code = node ? check(&walk, &schema, scene_rule_of(scene_root.inside, "schema"), node, NULL)
                    : CLOTH_OK;
    return code ? code : check(&walk, &root, &scene_root, 1, model);
}
