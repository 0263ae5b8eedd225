/* From one file to a document. A file is read whole, so that a byte's offset can be turned into
 * line and column. */
#include "cloth/scene/yaml/tree.h"

#include "cloth/base/file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* No file is larger; a device that never ends stops here. */
static const size_t MAX_BYTES = (size_t)256 << 20;

/* A scene may come through a pipe, too. */
static int yaml_load_read_bytes(const struct scene_tree *tree, char **bytes, size_t *size)
{
    const char *path = tree->path, *noun = tree->words->noun;
    FILE *file = tree->words == &scene_words ? fopen(path, "rb") : cloth_file_open(path);
    if (!file)
        return cloth_fail(tree->error, CLOTH_E_INPUT, "%s: cannot open the %s file: %s", path, noun,
                          cloth_file_why());
    const int code = cloth_file_read(file, MAX_BYTES, bytes, size);
    if (code == CLOTH_E_MEMORY)
        cloth_fail(tree->error, code, "%s: out of memory", path);
    else if (code == CLOTH_E_INPUT)
        cloth_fail(tree->error, code, "%s: larger than 256 MiB%s", path,
                   tree->words == &scene_words ? "; a large mesh belongs into a file of its own"
                                               : "");
    else if (code)
        cloth_fail(tree->error, CLOTH_E_INPUT, "%s: cannot read the %s file: %s", path, noun,
                   strerror(errno));
    fclose(file);
    return tree->error->code;
}

/* The parser takes the square of the depth: brackets that open this often without closing are no
 * scene, wherever they stand. */
enum { MAX_DEPTH = 1000 };

static int check_depth(const struct scene_tree *tree, const char *bytes, size_t size)
{
    size_t depth = 0, line = 1;
    for (size_t i = 0; i < size; i++) {
        const bool closes = bytes[i] == ']' || bytes[i] == '}';
        line += bytes[i] == '\n';
        depth += bytes[i] == '[' || bytes[i] == '{';
        depth -= closes && depth > 0;
        if (depth > MAX_DEPTH)
            return cloth_fail(tree->error, CLOTH_E_INPUT,
                              "%s:%zu: more than %d brackets [ and { are open here; a %s needs "
                              "a few",
                              tree->path, line, MAX_DEPTH, tree->words->noun);
    }
    return CLOTH_OK;
}

/* The parser looks for each anchor among all that it has seen. */
enum { MAX_ANCHORS = 1000 };

static bool is_word(char c)
{
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
}

static int check_anchors(const struct scene_tree *tree, const char *bytes, size_t size)
{
    size_t n = 0, line = 1;
    for (size_t i = 0; i + 1 < size; i++) {
        line += bytes[i] == '\n';
        n += bytes[i] == '&' && is_word(bytes[i + 1]) && (i == 0 || !is_word(bytes[i - 1]));
        if (n > MAX_ANCHORS)
            return cloth_fail(tree->error, CLOTH_E_INPUT,
                              "%s:%zu: more than %d anchors, such as &name, are in the file; a %s "
                              "needs a few",
                              tree->path, line, MAX_ANCHORS, tree->words->noun);
    }
    return CLOTH_OK;
}

/* JSON is read as YAML, which would take a comment of other languages for something else. */
static int check_comments(const struct scene_tree *tree, const char *bytes, size_t size)
{
    size_t line = 1, begin = 0; /* of the line */
    bool text = false;
    for (size_t i = 0; i + 1 < size && !strcmp(tree->words->form, "JSON"); i++) {
        if (bytes[i] == '\n') {
            line++;
            begin = i + 1;
        }
        if (!text && bytes[i] == '/' && (bytes[i + 1] == '/' || bytes[i + 1] == '*'))
            return cloth_fail(tree->error, CLOTH_E_INPUT,
                              "%s:%zu:%zu: a comment begins here, and JSON has none: take it out",
                              tree->path, line, i - begin + 1);
        if (bytes[i] == '"')
            text = !text;
        i += text && bytes[i] == '\\'; /* the next character does not end the text */
    }
    return CLOTH_OK;
}

/* Characters, not bytes, are counted: a byte 10xxxxxx continues one. */
static void line_and_column(const char *bytes, size_t offset, size_t *line, size_t *column)
{
    *line = *column = 1;
    for (size_t i = 0; i < offset; i++) {
        if (bytes[i] == '\n') {
            ++*line;
            *column = 1;
        } else if ((bytes[i] & 0xc0) != 0x80) {
            ++*column;
        }
    }
}

static int parser_fails(const struct scene_tree *tree, const yaml_parser_t *parser,
                        const char *bytes, size_t size)
{
    const struct scene_words *words = tree->words;
    size_t line = parser->problem_mark.line + 1, column = parser->problem_mark.column + 1;
    if (parser->error == YAML_MEMORY_ERROR)
        return cloth_fail(tree->error, CLOTH_E_MEMORY, "%s: out of memory", tree->path);
    if (parser->error == YAML_READER_ERROR) {
        size_t offset = parser->problem_offset < size ? parser->problem_offset : size;
        line_and_column(bytes, offset, &line, &column);
        return cloth_fail(tree->error, CLOTH_E_INPUT,
                          "%s:%zu:%zu: not readable as text: %s; a %s is %s in UTF-8", tree->path,
                          line, column, parser->problem, words->noun, words->form);
    }
    return cloth_fail(tree->error, CLOTH_E_INPUT, "%s:%zu:%zu: not %s: %s%s%s", tree->path, line,
                      column, words->form, parser->problem, parser->context ? ", " : "",
                      parser->context ? parser->context : "");
}

static int check_root(const struct scene_tree *tree)
{
    if (!yaml_document_get_root_node((yaml_document_t *)&tree->document))
        return cloth_fail(tree->error, CLOTH_E_INPUT, "%s:1:1: the file is empty; %s", tree->path,
                          tree->words->start);
    if (scene_tree_empty(tree, 1))
        return scene_tree_fail(tree, 1, "the file is empty; %s", tree->words->start);
    if (!scene_tree_is(tree, 1, YAML_MAPPING_NODE))
        return scene_tree_fail(tree, 1, "the file is not a map; %s", tree->words->start);
    return CLOTH_OK;
}

/* The keys of a map are compared with each other. */
enum { MAX_KEYS = 4096 };

static int check_maps(const struct scene_tree *tree)
{
    const int n = (int)(tree->document.nodes.top - tree->document.nodes.start);
    for (int node = 1; node <= n; node++)
        if (scene_tree_is(tree, node, YAML_MAPPING_NODE) &&
            scene_tree_length(tree, node) > MAX_KEYS)
            return scene_tree_fail(tree, node, "a map of %zu keys; a %s has at most %d in one map",
                                   scene_tree_length(tree, node), tree->words->noun, MAX_KEYS);
    return CLOTH_OK;
}

/* Part k of a list or map, keys before their values; 0: there are no more. */
static int yaml_load_part_of(const yaml_node_t *node, size_t k)
{
    if (node->type == YAML_SEQUENCE_NODE) {
        const yaml_node_item_t *item = node->data.sequence.items.start + k;
        return item < node->data.sequence.items.top ? *item : 0;
    }
    if (node->type == YAML_SCALAR_NODE)
        return 0;
    const yaml_node_pair_t *pair = node->data.mapping.pairs.start + k / 2;
    return pair < node->data.mapping.pairs.top ? (k % 2 ? pair->value : pair->key) : 0;
}

/* An alias names a node that ended before it, or one that it is in. */
int scene_tree_circle(const yaml_document_t *document, size_t *line)
{
    const yaml_node_t *first = document->nodes.start;
    for (const yaml_node_t *node = first; node < document->nodes.top; node++) {
        *line = node->start_mark.line;
        for (size_t k = 0; yaml_load_part_of(node, k); k++) {
            const yaml_node_t *part = first + yaml_load_part_of(node, k) - 1;
            if (part <= node && part->type != YAML_SCALAR_NODE &&
                part->end_mark.index >= node->end_mark.index)
                return yaml_load_part_of(node, k);
        }
    }
    return 0;
}

static int check_circles(struct scene_tree *tree)
{
    size_t line;
    const int node = scene_tree_circle(&tree->document, &line);
    return node ? scene_tree_fail(
                      tree, node,
                      "this %s is in itself, by an alias * of its anchor & in or below line "
                      "%zu; " SCENE_CIRCLE,
                      scene_tree_is(tree, node, YAML_SEQUENCE_NODE) ? "list" : "map", line + 1)
                : CLOTH_OK;
}

static int parse_document(struct scene_tree *tree, yaml_parser_t *parser, const char *bytes,
                          size_t size)
{
    yaml_document_t second;
    yaml_parser_set_input_string(parser, (const unsigned char *)bytes, size);
    if (!yaml_parser_load(parser, &tree->document))
        return parser_fails(tree, parser, bytes, size);
    tree->loaded = true;
    if (check_root(tree) || check_maps(tree) || check_circles(tree))
        return tree->error->code;
    for (yaml_node_t *node = tree->document.nodes.start; node < tree->document.nodes.top; node++)
        node->start_mark.index = 0; /* of the file itself (tree.h) */
    if (!yaml_parser_load(parser, &second))
        return parser_fails(tree, parser, bytes, size);
    if (yaml_document_get_root_node(&second))
        cloth_fail(tree->error, CLOTH_E_INPUT,
                   "%s:%zu:%zu: a second document starts here; a %s file holds one", tree->path,
                   second.start_mark.line + 1, second.start_mark.column + 1, tree->words->noun);
    yaml_document_delete(&second);
    return tree->error->code;
}

const struct scene_words scene_words = {
    .noun = "scene", .form = "YAML", .start = "a scene starts with 'schema: 1'"};

int scene_tree_load(struct scene_tree *tree, const char *path, const struct scene_words *words,
                    struct cloth_error *error)
{
    char *bytes = NULL;
    *tree = (struct scene_tree){.path = path, .words = words, .error = error};
    size_t size = 0;
    yaml_parser_t parser;
    if (!yaml_parser_initialize(&parser))
        return cloth_fail(error, CLOTH_E_MEMORY, "%s: out of memory", path);
    if (!yaml_load_read_bytes(tree, &bytes, &size) && !check_depth(tree, bytes, size) &&
        !check_anchors(tree, bytes, size) && !check_comments(tree, bytes, size))
        parse_document(tree, &parser, bytes, size);
    yaml_parser_delete(&parser);
    free(bytes);
    return error->code;
}

void scene_tree_free(struct scene_tree *tree)
{
    if (tree->loaded)
        yaml_document_delete(&tree->document);
    for (size_t i = 0; i < tree->n_included; i++)
        free(tree->included[i]);
    tree->loaded = false;
    tree->n_included = 0;
}
