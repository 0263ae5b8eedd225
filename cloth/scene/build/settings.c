/* The settings of a scene, key by key: two runs of the same settings and files have the same
 * state. */
#include "cloth/scene/build/build.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_PATH = 600 };

/* These change no state; phases are in the settings of each phase. */
static bool settings_is_free(const char *path)
{
    static const char *const keys[] = {"name", "phases", "output", "time.end"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (!strcmp(path, keys[i]))
            return true;
    return false;
}

/* A line is one value, whatever is in it. */
static void add_line(struct cloth_list *lines, const char *path, const char *value,
                     struct cloth_error *error)
{
    char **line = cloth_list_add(lines, sizeof *line, 1, error);
    if (!line)
        return;
    if (asprintf(line, "%s: %s", path, value) < 0)
        *line = scene_build_out_of_memory(error);
    for (char *c = *line; c && (c = strchr(c, '\n')); c++)
        *c = ' ';
}

static void add_lines(struct cloth_list *lines, const struct scene_tree *tree, int node,
                      const char *path)
{
    char inner[MAX_PATH];
    const char *value = scene_tree_scalar(tree, node);
    if (settings_is_free(path))
        return;
    if (value)
        add_line(lines, path, value, tree->error);
    for (size_t i = 0; !value && i < scene_tree_length(tree, node); i++) {
        if (scene_tree_is(tree, node, YAML_SEQUENCE_NODE)) {
            snprintf(inner, sizeof inner, "%s[%zu]", path, i);
            add_lines(lines, tree, scene_tree_item(tree, node, i), inner);
            continue;
        }
        const yaml_node_pair_t pair = scene_tree_pair(tree, node, i);
        const char *key = scene_tree_scalar(tree, pair.key);
        snprintf(inner, sizeof inner, "%s%s%s", path, *path ? "." : "", key ? key : "");
        add_lines(lines, tree, pair.value, inner);
    }
}

static int compare_lines(const void *a, const void *b)
{
    const char *const *left = a, *const *right = b;
    return strcmp(*left, *right);
}

/* Lines are in the order of their keys: a set puts a key at the end of its map. */
char *scene_build_text(const struct scene_tree *tree, int node, const char *path)
{
    struct cloth_list lines = {0};
    char *text = NULL;
    size_t size;
    add_lines(&lines, tree, node, path);
    char **line = lines.items;
    FILE *file = tree->error->code ? NULL : open_memstream(&text, &size);
    if (file && lines.n)
        qsort(line, lines.n, sizeof *line, compare_lines);
    for (size_t i = 0; i < lines.n; i++) {
        if (file)
            fprintf(file, "%s\n", line[i]);
        free(line[i]);
    }
    free(lines.items);
    const int bad = !file || ferror(file), closed = file ? fclose(file) : 0;
    if (!bad && !closed)
        return text;
    free(text);
    return scene_build_out_of_memory(tree->error);
}

int scene_build_settings(struct scene_tree *tree)
{
    tree->model->settings = scene_build_text(tree, 1, "");
    return tree->error->code;
}
