/* A loaded tree holds one document whose root is a map. Nodes are never removed, and never change
 * their type or text. Only scene_edit adds nodes or changes the children of a map or list. */
#include "cloth/scene/yaml/tree.h"
#include "cloth/base/number.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_OF_SET = 200 }; /* bytes of a set that a message repeats: the fault must fit too */

yaml_node_t *scene_tree_node(const struct scene_tree *tree, int node)
{
    return tree->document.nodes.start + node - 1;
}

bool scene_tree_is(const struct scene_tree *tree, int node, yaml_node_type_t type)
{
    return node && scene_tree_node(tree, node)->type == type;
}

const char *scene_tree_scalar(const struct scene_tree *tree, int node)
{
    const yaml_node_t *at = scene_tree_node(tree, node);
    return at->type == YAML_SCALAR_NODE ? (const char *)at->data.scalar.value : NULL;
}

bool scene_tree_is_given(const struct scene_tree *tree, int node)
{
    return node && scene_tree_node(tree, node)->start_mark.index != SCENE_BY_DEFAULT;
}

bool scene_tree_empty(const struct scene_tree *tree, int node)
{
    const yaml_node_t *at = scene_tree_node(tree, node);
    if (at->type != YAML_SCALAR_NODE || at->data.scalar.style != YAML_PLAIN_SCALAR_STYLE)
        return false;
    const char *text = (const char *)at->data.scalar.value;
    return !*text || !strcmp(text, "~") || !strcmp(text, "null");
}

size_t scene_tree_length(const struct scene_tree *tree, int node)
{
    if (!node)
        return 0;
    const yaml_node_t *at = scene_tree_node(tree, node);
    if (at->type == YAML_SEQUENCE_NODE)
        return (size_t)(at->data.sequence.items.top - at->data.sequence.items.start);
    if (at->type == YAML_MAPPING_NODE)
        return (size_t)(at->data.mapping.pairs.top - at->data.mapping.pairs.start);
    return 0;
}

int scene_tree_item(const struct scene_tree *tree, int list, size_t i)
{
    return scene_tree_node(tree, list)->data.sequence.items.start[i];
}

int scene_tree_part(const struct scene_tree *tree, int node, size_t i)
{
    return scene_tree_scalar(tree, node) ? node : scene_tree_item(tree, node, i);
}

yaml_node_pair_t scene_tree_pair(const struct scene_tree *tree, int map, size_t i)
{
    return scene_tree_node(tree, map)->data.mapping.pairs.start[i];
}

int scene_tree_get(const struct scene_tree *tree, int map, const char *key)
{
    for (size_t i = 0; i < scene_tree_length(tree, map); i++) {
        yaml_node_pair_t pair = scene_tree_pair(tree, map, i);
        const char *name = scene_tree_scalar(tree, pair.key);
        if (name && !strcmp(name, key))
            return pair.value;
    }
    return 0;
}

int scene_tree_at(const struct scene_tree *tree, int map, const char *path)
{
    char key[60];
    for (const char *rest = path; map && *rest; rest += *rest == '.') {
        const size_t n = strcspn(rest, ".");
        snprintf(key, sizeof key, "%.*s", (int)n, rest);
        map = scene_tree_get(tree, map, key);
        rest += n;
    }
    return map;
}

int scene_tree_phase(const struct scene_tree *tree, uint32_t phase)
{
    const int list = scene_tree_get(tree, 1, "phases");
    if (!scene_tree_is(tree, list, YAML_SEQUENCE_NODE) || phase >= scene_tree_length(tree, list))
        return 0;
    const int map = scene_tree_item(tree, list, phase);
    return scene_tree_is(tree, map, YAML_MAPPING_NODE) ? map : 0;
}

static const char *file_of_mark(const struct scene_tree *tree, const yaml_mark_t *mark)
{
    const size_t i = mark->index;
    return i && i <= tree->n_included ? tree->included[i - 1] : tree->path;
}

char *scene_tree_beside(const struct scene_tree *tree, int node, const char *name)
{
    const char *file = file_of_mark(tree, &scene_tree_node(tree, node)->start_mark),
               *slash = strrchr(file, '/');
    const int folder = slash && *name != '/' ? (int)(slash - file) + 1 : 0;
    char *path;
    return asprintf(&path, "%.*s%s", folder, file, name) < 0 ? NULL : path;
}

/* The place of a key in the set of a phase. */
static char *phase_place(const struct scene_tree *tree, const yaml_mark_t *mark)
{
    char *place = NULL, *key = scene_tree_place(tree, (int)mark->line);
    const int n = key ? asprintf(&place, "%s: phases[%zu].set", key, mark->column) : -1;
    free(key);
    return n < 0 ? NULL : place;
}

char *scene_tree_mark_place(const struct scene_tree *tree, const yaml_mark_t *mark)
{
    char *place = NULL;
    int n;
    if (mark->index == SCENE_BY_PHASE)
        return phase_place(tree, mark);
    if (mark->index == SCENE_BY_DEFAULT) {
        n = asprintf(&place, "%s", tree->path);
    } else if (mark->index != SCENE_BY_SET) {
        n = asprintf(&place, "%s:%zu:%zu", file_of_mark(tree, mark), mark->line + 1,
                     mark->column + 1);
    } else if (tree->sets[mark->line].option) {
        n = asprintf(&place, "%s", tree->sets[mark->line].option);
    } else {
        const char *text = tree->sets[mark->line].text;
        n = asprintf(&place, "--set %.*s%s", MAX_OF_SET, text,
                     strlen(text) > (size_t)MAX_OF_SET ? "..." : "");
    }
    return n < 0 ? NULL : place;
}

char *scene_tree_place(const struct scene_tree *tree, int node)
{
    return scene_tree_mark_place(tree, &scene_tree_node(tree, node)->start_mark);
}

int scene_tree_fail(const struct scene_tree *tree, int node, const char *format, ...)
{
    char text[900], *place = scene_tree_place(tree, node);
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    int code = cloth_fail(tree->error, CLOTH_E_INPUT, "%s: %s", place ? place : tree->path, text);
    free(place);
    return code;
}

double scene_tree_number(const struct scene_tree *tree, int map, const char *key)
{
    double value = 0;
    cloth_number(scene_tree_scalar(tree, scene_tree_get(tree, map, key)), &value);
    return value;
}

const char *scene_tree_text(const struct scene_tree *tree, int map, const char *key)
{
    int node = scene_tree_get(tree, map, key);
    return node ? scene_tree_scalar(tree, node) : NULL;
}

void scene_tree_vector(const struct scene_tree *tree, int node, size_t n, double *value)
{
    for (size_t i = 0; i < n; i++)
        cloth_number(scene_tree_scalar(tree, scene_tree_part(tree, node, i)), &value[i]);
}

const char *scene_tree_found(const struct scene_tree *tree, int node, const char *quotes,
                             char *text, size_t size)
{
    bool list = scene_tree_is(tree, node, YAML_SEQUENCE_NODE);
    size_t n = scene_tree_length(tree, node);
    if (list || scene_tree_is(tree, node, YAML_MAPPING_NODE)) {
        snprintf(text, size, n ? "a %s of %zu" : "an empty %s", list ? "list" : "map", n);
        return text;
    }
    if (scene_tree_empty(tree, node))
        return "empty";
    bool plain = scene_tree_node(tree, node)->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
    snprintf(text, size, "%s%.60s%s", plain ? "" : quotes, scene_tree_scalar(tree, node),
             plain ? "" : quotes + strlen(quotes) - 1);
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < 32 || *c == 127)
            *c = ' ';
    return text;
}
