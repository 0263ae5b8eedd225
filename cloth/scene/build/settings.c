/* The settings of a scene, key by key: two runs of the same settings and files have the same
 * state. */
#include "cloth/scene/build/build.h"

#include "cloth/scene/schema/check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_PATH = 600 };

/* These change no state; phases are in the settings of each phase. */
static bool settings_is_free(const char *path)
{
    static const char *const keys[] = {"name", "phases", "output", "time.end"};
    bool is = false;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        is = is || !strcmp(path, keys[i]);
    return is;
}

/* A line is one value, whatever is in it. */
static void settings_put_line(FILE *file, const char *path, const char *value)
{
    fprintf(file, "%s: ", path);
    for (; *value; value++)
        fputc(*value == '\n' ? ' ' : *value, file);
    fputc('\n', file);
}

static void put_node(FILE *file, const struct scene_tree *tree, int node, const char *path)
{
    char inner[MAX_PATH];
    const char *value = scene_tree_scalar(tree, node);
    if (settings_is_free(path))
        return;
    if (value)
        settings_put_line(file, path, value);
    for (size_t i = 0; !value && i < scene_tree_length(tree, node); i++) {
        if (scene_tree_is(tree, node, YAML_SEQUENCE_NODE)) {
            snprintf(inner, sizeof inner, "%s[%zu]", path, i);
            put_node(file, tree, scene_tree_item(tree, node, i), inner);
            continue;
        }
        const yaml_node_pair_t pair = scene_tree_pair(tree, node, i);
        const char *key = scene_tree_scalar(tree, pair.key);
        snprintf(inner, sizeof inner, "%s%s%s", path, *path ? "." : "", key ? key : "");
        put_node(file, tree, pair.value, inner);
    }
}

static int compare_lines(const void *a, const void *b)
{
    const char *const *left = a, *const *right = b;
    return strcmp(*left, *right);
}

/* Lines in the order of their keys: a set puts a key at the end of its map. */
static int sort_lines(const char *text, char **sorted, struct cloth_error *error)
{
    size_t n = 0, size;
    char *copy = strdup(text), **line = NULL, *rest = copy;
    for (const char *c = text; *c; c++)
        n += *c == '\n';
    line = calloc(n + 1, sizeof *line);
    FILE *file = copy && line ? open_memstream(sorted, &size) : NULL;
    for (size_t i = 0; file && i < n; i++)
        line[i] = strsep(&rest, "\n");
    if (file)
        qsort(line, n, sizeof *line, compare_lines);
    for (size_t i = 0; file && i < n; i++)
        fprintf(file, "%s\n", line[i]);
    const int bad = !file || ferror(file);
    const int closed = file ? fclose(file) : 0;
    free(line);
    free(copy);
    return bad || closed ? cloth_fail(error, CLOTH_E_MEMORY, "no memory for the settings") : 0;
}

char *scene_build_text(const struct scene_tree *tree, int node, const char *path,
                       struct cloth_error *error)
{
    char *text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    if (file)
        put_node(file, tree, node, path);
    const int bad = !file || ferror(file), closed = file ? fclose(file) : 0;
    if (!bad && !closed)
        return text;
    free(text);
    cloth_fail(error, CLOTH_E_MEMORY, "no memory for the settings of the scene");
    return NULL;
}

int scene_build_settings(struct model *model, struct scene_tree *tree, struct cloth_error *error)
{
    char *text = scene_build_text(tree, 1, "", error);
    const int code = text ? sort_lines(text, &model->settings, error) : CLOTH_E_MEMORY;
    free(text);
    return code;
}
