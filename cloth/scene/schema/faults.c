/* Sentences of the faults that the walk finds, so that they have one form. */
#include "cloth/scene/schema/check.h"

#include <stdio.h>
#include <string.h>

const char *scene_place_path(const struct scene_place *at, char text[SCENE_PATH])
{
    if (!at->up) {
        snprintf(text, SCENE_PATH, "the scene");
        return text;
    }
    *text = 0;
    if (at->up->up)
        scene_place_path(at->up, text);
    const size_t used = strlen(text);
    if (at->key)
        snprintf(text + used, SCENE_PATH - used, "%s%s", used ? "." : "", at->key);
    else
        snprintf(text + used, SCENE_PATH - used, "[%zu]", at->index);
    return text;
}

/* Things that are gone, with their replacements: a value of a key, or a key of a map or of the maps
 * of a list, which `map` names. */
static const struct {
    const char *map, *key, *value, *now;
} outdated[] = {
    {NULL, "contact", "project", "write contact: {mode: project}"},
    {NULL, "contact", "filter",
     "it is gone; contact: {mode: certified} or {mode: project} is there"},
    {NULL, "mode", "filter", "it is gone; certified knows of contact in the solve, too"},
    {NULL, "integrator", "midpoint", "use verlet, which has its order at half the work"},
    {"solver", "form", NULL, "conjugate gradients have one form, with one sum an iteration"},
    {"loads", "course", NULL, "its name is curve"},
    {"air", "course", NULL, "its name is curve"},
    {"cloths", "cost", NULL,
     "uneven work to try balancers on is of duite-bench ranks (migrate) and duite-compare "
     "(irregular)"}};

static bool texts_equal(const char *a, const char *b)
{
    return a && b ? !strcmp(a, b) : a == b;
}

/* NULL: there never was such a thing. */
static const char *replacement_of(const char *map, const char *key, const char *value)
{
    for (size_t i = 0; i < sizeof outdated / sizeof *outdated; i++)
        if (texts_equal(outdated[i].map, map) && texts_equal(outdated[i].key, key) &&
            texts_equal(outdated[i].value, value))
            return outdated[i].now;
    return NULL;
}

int scene_fault_value(struct scene_tree *tree, const struct scene_place *at,
                      const struct scene_rule *rule, int node)
{
    char path[SCENE_PATH], is[100], expected[300];
    const char *value = scene_tree_scalar(tree, node);
    const char *now = value && at->key ? replacement_of(NULL, at->key, value) : NULL;
    if (!now && value && scene_scalar_has_comma(value))
        now = SCENE_NO_COMMA;
    return scene_tree_fail(tree, node, "%s is %s; %s is expected%s%s", scene_place_path(at, path),
                           scene_tree_found(tree, node, SCENE_QUOTES, is, sizeof is),
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

int scene_fault_key(struct scene_tree *tree, const struct scene_place *at,
                    const struct scene_rule *keys, int node)
{
    const char *names[SCENE_MAX_KEYS], *word = scene_tree_scalar(tree, node);
    const char *map = at->key || !at->up ? at->key : at->up->key;
    const char *now = map && word ? replacement_of(map, word, NULL) : NULL;
    char path[SCENE_PATH], is[100], allowed[400];
    size_t n = 0;
    for (const struct scene_rule *key = keys; key->key && n < SCENE_MAX_KEYS; key++)
        names[n++] = key->key;
    if (now)
        return scene_tree_fail(tree, node, "%s is no longer a key of %s: %s", word,
                               scene_place_path(at, path), now);
    return scene_tree_fail(
        tree, node, "%s is not a key of %s%s",
        scene_tree_found(tree, node, SCENE_QUOTES, is, sizeof is), scene_place_path(at, path),
        scene_allowed_words(word ? word : "", names, n, allowed, sizeof allowed));
}

int scene_check_comma(struct scene_tree *tree, const struct scene_place *at, int map, size_t i)
{
    char path[SCENE_PATH], number[100];
    const yaml_node_pair_t pair = scene_tree_pair(tree, map, i);
    const yaml_node_pair_t before = scene_tree_pair(tree, map, i - 1);
    const char *whole = scene_tree_scalar(tree, before.value);
    snprintf(number, sizeof number, "%.40s,%.40s", whole ? whole : "",
             scene_tree_scalar(tree, pair.key));
    if (!scene_tree_empty(tree, pair.value) || !scene_scalar_has_comma(number))
        return CLOTH_OK;
    const struct scene_place here = {at, scene_tree_scalar(tree, before.key), 0};
    return scene_tree_fail(tree, before.value, "%s is %s; %s", scene_place_path(&here, path),
                           number, SCENE_NO_COMMA);
}
