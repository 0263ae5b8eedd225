/* Checks of single nodes of a pattern. Every error passes through pattern_wrong, which says where
 * it is in the pattern's own terms. */
#include "cloth/base/memory.h"
#include "cloth/base/number.h"
#include "cloth/scene/pattern/reader.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double MOST = 1e9;
enum { NAME = 200 }; /* bytes of a panel's name */

int pattern_wrong(const struct pattern_reader *reader, int node, const char *format, ...)
{
    char text[500], where[NAME + 80] = "";
    int n = 0;
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (reader->panel)
        n = snprintf(where, sizeof where, "panel '%s'", reader->panel);
    if (reader->stitch >= 0)
        n = snprintf(where, sizeof where, "stitch %jd", (intmax_t)reader->stitch);
    if (reader->panel && reader->edge >= 0)
        n += snprintf(where + n, sizeof where - (size_t)n, ", edge %jd", (intmax_t)reader->edge);
    return scene_tree_fail(reader->tree, node, "%s%s%s", where, n ? ": " : "", text);
}

static int fail_expected(const struct pattern_reader *reader, int node, const char *what,
                         const char *kind)
{
    char text[100];
    return pattern_wrong(reader, node, "%s is %s; it has to be %s", what,
                         scene_tree_found(reader->tree, node, "\"", text, sizeof text), kind);
}

static int key_number(const char *name, const char *const keys[PATTERN_KEYS])
{
    for (int k = 0; name && k < PATTERN_KEYS && keys[k]; k++)
        if (!strcmp(keys[k], name))
            return k;
    return -1;
}

static int fail_unknown_key(const struct pattern_reader *reader, int node, const char *what,
                            const char *const keys[PATTERN_KEYS])
{
    char text[100], known[200] = "";
    size_t n = 0;
    for (int k = 0; k < PATTERN_KEYS && keys[k] && n < sizeof known; k++)
        n += (size_t)snprintf(known + n, sizeof known - n, "%s%s", k ? ", " : "", keys[k]);
    return pattern_wrong(reader, node, "unknown key %s in %s, which may have %s",
                         scene_tree_found(reader->tree, node, "\"", text, sizeof text), what,
                         known);
}

int pattern_map(const struct pattern_reader *reader, int node, const char *what,
                const char *const keys[PATTERN_KEYS], int value[PATTERN_KEYS])
{
    memset(value, 0, PATTERN_KEYS * sizeof *value);
    if (!scene_tree_is(reader->tree, node, YAML_MAPPING_NODE))
        return fail_expected(reader, node, what, "a map");
    for (size_t i = 0; i < scene_tree_length(reader->tree, node); i++) {
        const yaml_node_pair_t pair = scene_tree_pair(reader->tree, node, i);
        const int k = key_number(scene_tree_scalar(reader->tree, pair.key), keys);
        if (k < 0)
            return fail_unknown_key(reader, pair.key, what, keys);
        if (value[k])
            return pattern_wrong(reader, pair.key, "%s has the key %s twice", what, keys[k]);
        value[k] = pair.value;
    }
    return CLOTH_OK;
}

int pattern_both(const struct pattern_reader *reader, int node, const char *what,
                 const char *const keys[PATTERN_KEYS], int value[PATTERN_KEYS])
{
    const int code = pattern_map(reader, node, what, keys, value);
    if (code || (value[0] && value[1]))
        return code;
    return pattern_wrong(reader, node, "%s has to have both %s and %s", what, keys[0], keys[1]);
}

int pattern_list(const struct pattern_reader *reader, int node, const char *what, size_t least,
                 size_t most)
{
    const size_t n = scene_tree_length(reader->tree, node);
    if (!scene_tree_is(reader->tree, node, YAML_SEQUENCE_NODE))
        return fail_expected(reader, node, what, "a list");
    if (n < least || n > most)
        return pattern_wrong(reader, node, "%s has %zu entries; it has to have %zu%s%.0zu", what, n,
                             least, least == most ? "" : " to ", least == most ? 0 : most);
    return CLOTH_OK;
}

static bool is_plain(const struct pattern_reader *reader, int node)
{
    return scene_tree_scalar(reader->tree, node) &&
           scene_tree_node(reader->tree, node)->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
}

int pattern_number(const struct pattern_reader *reader, int node, const char *what, double *value)
{
    if (!is_plain(reader, node) || !cloth_number(scene_tree_scalar(reader->tree, node), value) ||
        fabs(*value) > MOST)
        return fail_expected(reader, node, what, "a number of at most 1e9");
    return CLOTH_OK;
}

int pattern_vector(const struct pattern_reader *reader, int node, const char *what, size_t n,
                   double *value)
{
    int code = pattern_list(reader, node, what, n, n);
    for (size_t i = 0; i < n && !code; i++)
        code = pattern_number(reader, scene_tree_item(reader->tree, node, i), what, &value[i]);
    return code;
}

int pattern_index(const struct pattern_reader *reader, int node, const char *what, uint32_t below,
                  const char *things, uint32_t *value)
{
    if (!is_plain(reader, node) ||
        !scene_scalar_integer(scene_tree_scalar(reader->tree, node), value))
        return fail_expected(reader, node, what, "a whole number from 0 on");
    if (*value >= below)
        return pattern_wrong(reader, node, "%s is %u, but there are %u %s, counted from 0", what,
                             *value, below, things);
    return CLOTH_OK;
}

int pattern_flag(const struct pattern_reader *reader, int node, const char *what, bool *value)
{
    const char *text = is_plain(reader, node) ? scene_tree_scalar(reader->tree, node) : "";
    *value = !strcmp(text, "true") || !strcmp(text, "1");
    if (!*value && strcmp(text, "false") != 0 && strcmp(text, "0") != 0)
        return fail_expected(reader, node, what, "true or false, or 1 or 0");
    return CLOTH_OK;
}

int pattern_word(const struct pattern_reader *reader, int node, const char *what,
                 const char *const words[2], bool *second)
{
    const char *text = scene_tree_scalar(reader->tree, node);
    char kind[100];
    *second = text && !strcmp(text, words[1]);
    if (*second || (text && !strcmp(text, words[0])))
        return CLOTH_OK;
    snprintf(kind, sizeof kind, "\"%s\" or \"%s\"", words[0], words[1]);
    return fail_expected(reader, node, what, kind);
}

/* One word of an OBJ file is the name of a group. */
char *pattern_name(const struct pattern_reader *reader, int node)
{
    const char *text = scene_tree_scalar(reader->tree, node);
    if (!text || !*text || strlen(text) > NAME) {
        fail_expected(reader, node, "the name of a panel", "a text of 1 to 200 bytes");
        return NULL;
    }
    char *name = cloth_alloc(strlen(text) + 1, 1, reader->tree->error);
    for (size_t i = 0; name && text[i]; i++) {
        const unsigned char c = (unsigned char)text[i];
        name[i] = c <= 32 || c == 127 ? '_' : text[i];
    }
    return name;
}
