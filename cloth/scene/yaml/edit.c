/* Additions to a tree. New nodes carry their origin in their mark (tree.h). A node on the path of a
 * set is a copy that only its parent knows; the root has no parent. So writing through it changes
 * one place. Its key is new, so that the mark of a key names the last set that changed anything
 * below it. */
#include "cloth/scene/yaml/edit.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* No scene is as deep; each part of a path is a call. */
enum { MAX_PARTS = 100 };

static int edit_out_of_memory(const struct scene_tree *tree)
{
    cloth_fail(tree->error, CLOTH_E_MEMORY, "out of memory while the scene is read");
    return 0;
}

/* Adds a node of the type, tag and text of another, without its children. Returns its number, or 0.
 */
static int edit_add_node(struct edit *edit, const yaml_node_t *like)
{
    yaml_document_t *document = &edit->tree->document;
    int node = 0;
    if (like->type == YAML_SCALAR_NODE)
        node = yaml_document_add_scalar(document, like->tag, like->data.scalar.value,
                                        (int)like->data.scalar.length, like->data.scalar.style);
    else if (like->type == YAML_SEQUENCE_NODE)
        node = yaml_document_add_sequence(document, like->tag, YAML_FLOW_SEQUENCE_STYLE);
    else
        node = yaml_document_add_mapping(document, like->tag, YAML_FLOW_MAPPING_STYLE);
    if (!node)
        return edit_out_of_memory(edit->tree);
    scene_tree_node(edit->tree, node)->start_mark = edit->mark;
    return node;
}

/* Copies the children of a map or list, shifting their numbers. */
static bool copy_children(struct scene_tree *tree, int to, const yaml_node_t *from, int shift)
{
    if (from->type == YAML_SEQUENCE_NODE) {
        for (int *item = from->data.sequence.items.start; item < from->data.sequence.items.top;
             item++)
            if (!yaml_document_append_sequence_item(&tree->document, to, *item + shift))
                return false;
    } else if (from->type == YAML_MAPPING_NODE) {
        for (yaml_node_pair_t *pair = from->data.mapping.pairs.start;
             pair < from->data.mapping.pairs.top; pair++)
            if (!yaml_document_append_mapping_pair(&tree->document, to, pair->key + shift,
                                                   pair->value + shift))
                return false;
    }
    return true;
}

/* Children come after all nodes exist. */
int edit_graft(struct edit *edit, const yaml_document_t *from)
{
    struct scene_tree *tree = edit->tree;
    int shift = (int)(tree->document.nodes.top - tree->document.nodes.start);
    for (const yaml_node_t *node = from->nodes.start; node < from->nodes.top; node++)
        if (!edit_add_node(edit, node))
            return 0;
    int to = shift + 1;
    for (const yaml_node_t *node = from->nodes.start; node < from->nodes.top; node++, to++)
        if (!copy_children(tree, to, node, shift))
            return edit_out_of_memory(edit->tree);
    return shift + 1;
}

int edit_fails(const struct edit *edit, const char *format, ...)
{
    char what[400], *place = scene_tree_mark_place(edit->tree, &edit->mark);
    va_list list;
    va_start(list, format);
    vsnprintf(what, sizeof what, format, list);
    va_end(list);
    if (place)
        cloth_fail(edit->tree->error, CLOTH_E_INPUT, "%s: %s", place, what);
    else
        edit_out_of_memory(edit->tree);
    free(place);
    return 0;
}

/* Parses a value and adds it. Returns its node, or 0. */
static int add_value(struct edit *edit, const char *text)
{
    yaml_parser_t parser;
    yaml_document_t document;
    if (!yaml_parser_initialize(&parser))
        return edit_out_of_memory(edit->tree);
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, strlen(text));
    int node = 0;
    if (!yaml_parser_load(&parser, &document)) {
        node = parser.error == YAML_MEMORY_ERROR
                   ? edit_out_of_memory(edit->tree)
                   : edit_fails(edit, "the value is not YAML: %s", parser.problem);
    } else {
        size_t line;
        if (scene_tree_circle(&document, &line))
            node = edit_fails(
                edit, "the value is in itself, by an alias * of its anchor &; " SCENE_CIRCLE);
        else if (yaml_document_get_root_node(&document))
            node = edit_graft(edit, &document);
        else
            node = edit_fails(edit, "there is no value; KEY=VALUE is expected");
        yaml_document_delete(&document);
    }
    yaml_parser_delete(&parser);
    return node;
}

/* A copy of a map or list that the caller may change; a new one of that type if there is none yet.
 * 0 with an error if the node is of another type. */
static int own_node(struct edit *edit, int node, yaml_node_type_t type)
{
    struct scene_tree *tree = edit->tree;
    const yaml_node_t like = {.type = type};
    if (node == 1 && type == YAML_MAPPING_NODE)
        return node;
    if (!node || scene_tree_empty(tree, node))
        return edit_add_node(edit, &like);
    if (!scene_tree_is(tree, node, type))
        return edit_fails(edit, "'%.*s' is not a %s", (int)(edit->at - edit->start), edit->start,
                          type == YAML_SEQUENCE_NODE ? "list" : "map");
    int copy = edit_add_node(edit, &like);
    if (!copy)
        return 0;
    const yaml_node_t *from = scene_tree_node(tree, node);
    scene_tree_node(tree, copy)->start_mark = from->start_mark;
    return copy_children(tree, copy, from, 0) ? copy : edit_out_of_memory(edit->tree);
}

int edit_no_path(const struct edit *edit)
{
    return edit_fails(edit, edit->value ? "KEY: VALUE is expected, such as time.h: 0.002"
                                        : "KEY=VALUE is expected, such as time.h=0.002");
}

static int edit_add_key(struct edit *edit, const char *name, size_t length)
{
    yaml_node_t key = {.type = YAML_SCALAR_NODE};
    key.data.scalar.value = (yaml_char_t *)name;
    key.data.scalar.length = length;
    key.data.scalar.style = YAML_PLAIN_SCALAR_STYLE;
    return edit_add_node(edit, &key);
}

/* Puts the rest of the path behind the one key of a map: the kind of an obstacle. */
static int put_behind_key(struct edit *edit, int node)
{
    struct scene_tree *tree = edit->tree;
    const int map = own_node(edit, node, YAML_MAPPING_NODE);
    if (!map)
        return 0;
    const yaml_node_pair_t pair = scene_tree_pair(tree, map, 0);
    const int value = edit_put_value(edit, pair.value);
    const int key = value ? edit_add_node(edit, scene_tree_node(tree, pair.key)) : 0;
    if (key)
        scene_tree_node(tree, map)->data.mapping.pairs.start[0] = (yaml_node_pair_t){key, value};
    return key ? map : 0;
}

/* Puts the rest of the path, from `rest` on, into entry i of a list. put: how, from there on. */
static int put_entry(struct edit *edit, int node, size_t i, const char *rest,
                     int put(struct edit *, int))
{
    struct scene_tree *tree = edit->tree;
    const int list = own_node(edit, node, YAML_SEQUENCE_NODE);
    if (!list)
        return 0;
    const size_t n = scene_tree_length(tree, list);
    if (i > n)
        return edit_fails(edit, "'%.*s' has %zu entries; an index from 0 to %zu is expected",
                          (int)(edit->at - edit->start), edit->start, n, n);
    edit->at = rest;
    const int value = put(edit, i < n ? scene_tree_item(tree, list, i) : 0);
    if (value && i < n)
        scene_tree_node(tree, list)->data.sequence.items.start[i] = value;
    else if (value && !yaml_document_append_sequence_item(&tree->document, list, value))
        return edit_out_of_memory(tree);
    return value ? list : 0;
}

static int put_index(struct edit *edit, int node)
{
    char *end;
    const unsigned long i = strtoul(edit->at + 1, &end, 10);
    if (edit->at[1] < '0' || edit->at[1] > '9' || *end != ']')
        return edit_fails(edit, "an index is written [0], [1], ...");
    return put_entry(edit, node, i, end + 1, edit_put_value);
}

/* The text of the key name of a map; NULL: it has none, or it is no map. */
static const char *name_of_map(const struct scene_tree *tree, int map)
{
    const bool is_map = scene_tree_is(tree, map, YAML_MAPPING_NODE);
    const int name = is_map ? scene_tree_get(tree, map, "name") : 0;
    return name ? scene_tree_scalar(tree, name) : NULL;
}

/* The name of a list's entry. *behind: the entry is a map of one key, whose map has the name. */
static const char *name_of_entry(const struct scene_tree *tree, int entry, bool *behind)
{
    const char *name = name_of_map(tree, entry);
    *behind = !name && scene_tree_is(tree, entry, YAML_MAPPING_NODE) &&
              scene_tree_length(tree, entry) == 1;
    return *behind ? name_of_map(tree, scene_tree_pair(tree, entry, 0).value) : name;
}

/* Puts the rest of the path into the entry of a list that has a name. */
static int put_named(struct edit *edit, int list, const char *name, size_t length)
{
    const struct scene_tree *tree = edit->tree;
    char names[200] = "";
    for (size_t i = 0; i < scene_tree_length(tree, list); i++) {
        bool behind;
        const char *is = name_of_entry(tree, scene_tree_item(tree, list, i), &behind);
        if (is && strlen(is) == length && !strncmp(is, name, length))
            return put_entry(edit, list, i, name + length,
                             behind ? put_behind_key : edit_put_value);
        if (is)
            cloth_text_add(names, sizeof names, "%s%s", *names ? ", " : "", is);
    }
    return edit_fails(edit, "'%.*s' is a list with no entry of the name '%.*s'; %s%s",
                      (int)(edit->at - edit->start), edit->start, (int)length, name,
                      *names ? "it has " : "an index is expected, such as [0]", names);
}

static int edit_put_key(struct edit *edit, int node)
{
    struct scene_tree *tree = edit->tree;
    const char *name = edit->at + (*edit->at == '.');
    size_t length = strcspn(name, name == edit->whole ? "=" : ".[=");
    if (!length || (!name[length] && !edit->value))
        return edit_no_path(edit);
    if (scene_tree_is(tree, node, YAML_SEQUENCE_NODE))
        return put_named(edit, node, name, length);
    int map = own_node(edit, node, YAML_MAPPING_NODE);
    if (!map)
        return 0;
    size_t i = 0, n = scene_tree_length(tree, map);
    for (; i < n; i++) {
        const char *key = scene_tree_scalar(tree, scene_tree_pair(tree, map, i).key);
        if (key && strlen(key) == length && !strncmp(key, name, length))
            break;
    }
    const bool ends = edit->value ? !name[length] : name[length] == '=';
    edit->at = name + length;
    int value = edit_put_value(edit, i < n ? scene_tree_pair(tree, map, i).value : 0);
    if (value && ends && scene_tree_empty(tree, value)) { /* the key has its default again */
        if (i < n)
            scene_edit_remove(tree, map, i);
        return map;
    }
    int key = value ? edit_add_key(edit, name, length) : 0;
    if (key && i < n)
        scene_tree_node(tree, map)->data.mapping.pairs.start[i] = (yaml_node_pair_t){key, value};
    else if (key && !yaml_document_append_mapping_pair(&tree->document, map, key, value))
        key = edit_out_of_memory(edit->tree);
    return key ? map : 0;
}

int edit_put_value(struct edit *edit, int node)
{
    if (edit->value && !*edit->at)
        return edit->value;
    if (edit->parts++ == MAX_PARTS)
        return edit_fails(edit, "a key of more than 100 parts; no scene is as deep");
    if (edit->value && *edit->at == '=')
        return edit_no_path(edit);
    if (*edit->at == '=')
        return add_value(edit, edit->at + 1);
    if (*edit->at == '[')
        return put_index(edit, node);
    return edit_put_key(edit, node);
}

int scene_edit_default(struct scene_tree *tree, int map, const char *key, const char *value)
{
    struct edit edit = {tree, {.index = SCENE_BY_DEFAULT}, value, value, 0, NULL, 0};
    int value_node = add_value(&edit, value);
    int key_node = value_node ? edit_add_key(&edit, key, strlen(key)) : 0;
    if (key_node && !yaml_document_append_mapping_pair(&tree->document, map, key_node, value_node))
        key_node = edit_out_of_memory(tree);
    return key_node ? CLOTH_OK : tree->error->code;
}

void scene_edit_remove(struct scene_tree *tree, int map, size_t i)
{
    yaml_node_t *node = scene_tree_node(tree, map);
    yaml_node_pair_t *pair = node->data.mapping.pairs.start + i;
    node->data.mapping.pairs.top--;
    memmove(pair, pair + 1, (size_t)(node->data.mapping.pairs.top - pair) * sizeof *pair);
}
