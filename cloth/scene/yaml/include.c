/* A scene that includes another is that one with its own keys put over it, each KEY: VALUE as by a
 * set. The last file of a chain of these is the document; the files that lead to it edit it, from
 * the last to the first. */
#include "cloth/scene/yaml/tree.h"

#include <stdlib.h>
#include <string.h>

/* Takes the key `include` out of a file. Returns its value, or 0. */
static int take_include(struct scene_tree *file)
{
    for (size_t i = 0; i < scene_tree_length(file, 1); i++) {
        const yaml_node_pair_t pair = scene_tree_pair(file, 1, i);
        const char *key = scene_tree_scalar(file, pair.key);
        if (!key || strcmp(key, "include") != 0)
            continue;
        scene_edit_remove(file, 1, i);
        return pair.value;
    }
    return 0;
}

/* Loads the file that a node of the one before it, the n-th, names. */
static int load_included(struct scene_tree *file, char **path, size_t n, int node)
{
    const struct scene_tree *by = file - 1;
    const char *name = scene_tree_scalar(by, node);
    struct cloth_error own = {0};
    if (!name || !*name)
        return scene_tree_fail(by, node, "include has no text; the path of a scene is expected");
    if (n == SCENE_MOST_INCLUDED)
        return scene_tree_fail(by, node,
                               "more than %d scenes are included one by another; is one of them "
                               "included by itself?",
                               SCENE_MOST_INCLUDED);
    *path = scene_tree_beside(by, node, name);
    if (!*path)
        return cloth_fail(by->error, CLOTH_E_MEMORY, "out of memory while the scene is read");
    if (scene_tree_load(file, *path, &scene_words, &own)) {
        char *place = scene_tree_place(by, node);
        cloth_fail(by->error, own.code, "%.900s; included at %.100s", own.text, place ? place : "");
        free(place);
        scene_tree_free(file);
        free(*path);
    }
    file->error = by->error;
    for (yaml_node_t *at = file->document.nodes.start; at < file->document.nodes.top; at++)
        at->start_mark.index = n + 1;
    return by->error->code;
}

int scene_tree_load_scene(struct scene_tree *tree, const char *path, struct cloth_error *error)
{
    struct scene_tree file[SCENE_MOST_INCLUDED + 1];
    char *included[SCENE_MOST_INCLUDED];
    size_t n = 0;
    int node = scene_tree_load(file, path, &scene_words, error) ? 0 : take_include(file);
    while (node && !load_included(file + n + 1, included + n, n, node)) {
        n++;
        node = take_include(file + n);
    }
    *tree = file[n];
    tree->path = path;
    tree->n_included = n;
    memcpy(tree->included, included, n * sizeof *included);
    for (; n > 0; n--) {
        if (!error->code)
            scene_edit_layer(tree, &file[n - 1].document);
        scene_tree_free(file + n - 1);
    }
    return error->code;
}
