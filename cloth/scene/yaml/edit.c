/* Additions to a tree. New nodes carry their origin in their mark (tree.h). A node on the path of a
 * set is a copy that only its parent knows; the root has no parent. So writing through it changes
 * one place. Its key is new, so that the mark of a key names the last set that changed anything
 * below it. */
#include "cloth/scene/yaml/tree.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The state of an edit: the mark of new nodes, and the rest of the path. */
struct edit {
    struct scene_tree *tree;
    yaml_mark_t mark;
    const char *start, *at; /* text of the set, and the rest of its path */
    int value;              /* a node; 0: the text has it, behind the path */
    const char *whole;      /* where a key begins that may have '.' and '[' in it; NULL: nowhere */
    int parts;              /* of the path, so far */
};
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

/* Adds all nodes of a document; children come after all nodes exist. Returns the new number of its
 * root, or 0. */
static int graft_nodes(struct edit *edit, const yaml_document_t *from)
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

__attribute__((format(printf, 2, 3))) static int edit_fails(const struct edit *edit,
                                                            const char *format, ...)
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
            node = graft_nodes(edit, &document);
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

static int edit_put_value(struct edit *edit, int node);

static int no_path(const struct edit *edit)
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

static int edit_put_key(struct edit *edit, int node)
{
    struct scene_tree *tree = edit->tree;
    const char *name = edit->at + (*edit->at == '.');
    size_t length = strcspn(name, name == edit->whole ? "=" : ".[=");
    if (!length || (!name[length] && !edit->value))
        return no_path(edit);
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

static int put_index(struct edit *edit, int node)
{
    struct scene_tree *tree = edit->tree;
    char *end;
    unsigned long i = strtoul(edit->at + 1, &end, 10);
    if (edit->at[1] < '0' || edit->at[1] > '9' || *end != ']')
        return edit_fails(edit, "an index is written [0], [1], ...");
    int list = own_node(edit, node, YAML_SEQUENCE_NODE);
    if (!list)
        return 0;
    size_t n = scene_tree_length(tree, list);
    if (i > n)
        return edit_fails(edit, "'%.*s' has %zu entries; an index from 0 to %zu is expected",
                          (int)(edit->at - edit->start), edit->start, n, n);
    edit->at = end + 1;
    int value = edit_put_value(edit, i < n ? scene_tree_item(tree, list, i) : 0);
    if (value && i < n)
        scene_tree_node(tree, list)->data.sequence.items.start[i] = value;
    else if (value && !yaml_document_append_sequence_item(&tree->document, list, value))
        return edit_out_of_memory(edit->tree);
    return value ? list : 0;
}

/* The replacement of `node` (0: none) after following the rest of the path; 0 with an error. */
static int edit_put_value(struct edit *edit, int node)
{
    if (edit->value && !*edit->at)
        return edit->value;
    if (edit->parts++ == MAX_PARTS)
        return edit_fails(edit, "a key of more than 100 parts; no scene is as deep");
    if (edit->value && *edit->at == '=')
        return no_path(edit);
    if (*edit->at == '=')
        return add_value(edit, edit->at + 1);
    if (*edit->at == '[')
        return put_index(edit, node);
    return edit_put_key(edit, node);
}

static bool starts_no_path(const char *text)
{
    return *text == '=' || *text == '[' || *text == '.';
}

/* True if a set changes the phases themselves. */
static bool is_of_phases(const char *text)
{
    const size_t n = strlen("phases");
    return !strncmp(text, "phases", n) && (!text[n] || strchr(".[=", text[n]));
}

/* Behind phases[N].set. the rest of the path is one key: a path of the scene. NULL for other paths.
 */
static const char *key_of_phase(const char *text)
{
    const char *at = is_of_phases(text) ? text + strcspn(text, "]=") : "";
    return strncmp(at, "].set.", 6) ? NULL : at + 6;
}

/* Applies the tree's sets that change the phases themselves, or the others. */
static int edit_by_options(struct scene_tree *tree, bool phases)
{
    for (size_t i = 0; i < tree->n_sets; i++) {
        const char *text = tree->sets[i].text;
        struct edit edit = {.tree = tree,
                            .mark = {.index = SCENE_BY_SET, .line = i},
                            .start = text,
                            .at = text,
                            .whole = key_of_phase(text)};
        if (is_of_phases(text) != phases)
            continue;
        if (starts_no_path(text))
            no_path(&edit);
        else
            edit_put_value(&edit, 1);
        if (tree->error->code)
            return tree->error->code;
    }
    return CLOTH_OK;
}

/* The check reports a set that is no map, and faults of its keys. */
static int edit_by_phase(struct scene_tree *tree, uint32_t phase)
{
    const int map = scene_tree_phase(tree, phase), set = map ? scene_tree_get(tree, map, "set") : 0;
    if (!scene_tree_is(tree, set, YAML_MAPPING_NODE))
        return CLOTH_OK;
    for (size_t i = 0; i < scene_tree_length(tree, set) && !tree->error->code; i++) {
        const yaml_node_pair_t pair = scene_tree_pair(tree, set, i);
        const char *key = scene_tree_scalar(tree, pair.key);
        const yaml_mark_t mark = {
            .index = SCENE_BY_PHASE, .line = (size_t)pair.key, .column = phase};
        struct edit edit = {tree, mark, key, key, pair.value, NULL, 0};
        if (key && is_of_phases(key))
            edit_fails(&edit, "a phase cannot change the phases");
        else if (key && starts_no_path(key))
            no_path(&edit);
        else if (key)
            edit_put_value(&edit, 1);
    }
    return tree->error->code;
}

int scene_edit_sets(struct scene_tree *tree, uint32_t phase)
{
    int code = edit_by_options(tree, true);
    for (uint32_t i = 0; i <= phase && !code; i++)
        code = edit_by_phase(tree, i);
    return code ? code : edit_by_options(tree, false);
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
