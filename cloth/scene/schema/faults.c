/* Sentences of the faults that the walk finds, so that they have one form. */
#include "cloth/scene/schema/faults.h"
#include "cloth/scene/yaml/scalar.h"

#include <stdio.h>
#include <string.h>

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

/* Values that are gone, and their replacements. key: the key that had them. */
static const struct {
    const char *key, *value, *now;
} outdated[] = {
    {"contact", "project", "write contact: {mode: project}"},
    {"contact", "filter", "it is gone; contact: {mode: certified} or {mode: project} is there"},
    {"mode", "filter", "it is gone; certified knows of contact in the solve, too"},
    {"integrator", "midpoint", "use verlet, which has its order at half the work"}};

static const char *more_of(const struct scene_walk *walk, const struct scene_place *at, int node)
{
    const char *value = scene_tree_scalar(walk->tree, node);
    for (size_t i = 0; at->key && value && i < sizeof outdated / sizeof *outdated; i++)
        if (!strcmp(outdated[i].key, at->key) && !strcmp(outdated[i].value, value))
            return outdated[i].now;
    return value && scene_scalar_has_comma(value) ? SCENE_NO_COMMA : NULL;
}

int scene_fault_value(struct scene_walk *walk, const struct scene_place *at,
                      const struct scene_rule *rule, int node)
{
    char path[200], is[100], expected[300];
    const char *now = more_of(walk, at, node);
    scene_place_path(at, path, sizeof path);
    return scene_tree_fail(walk->tree, node, walk->error, "%s is %s; %s is expected%s%s", path,
                           scene_tree_found(walk->tree, node, SCENE_QUOTES, is, sizeof is),
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

int scene_fault_key(struct scene_walk *walk, const struct scene_place *at,
                    const struct scene_rule *keys, int node)
{
    const char *names[SCENE_MAX_KEYS];
    size_t n = 0;
    for (const struct scene_rule *key = keys; key->key && n < SCENE_MAX_KEYS; key++)
        names[n++] = key->key;
    char path[200], is[100], allowed[400];
    scene_place_path(at, path, sizeof path);
    const char *word = scene_tree_scalar(walk->tree, node);
    const char *now = word ? gone_of(at, word) : NULL;
    if (now)
        return scene_tree_fail(walk->tree, node, walk->error, "%s is no longer a key of %s: %s",
                               word, path, now);
    return scene_tree_fail(
        walk->tree, node, walk->error, "%s is not a key of %s%s",
        scene_tree_found(walk->tree, node, SCENE_QUOTES, is, sizeof is), path,
        scene_allowed_words(word ? word : "", names, n, allowed, sizeof allowed));
}

int scene_check_comma(struct scene_walk *walk, const struct scene_place *at, int map, size_t i)
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
