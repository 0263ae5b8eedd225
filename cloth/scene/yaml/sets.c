/* A document is edited by the file that includes it, then by phases, then by the caller's sets. */
#include "cloth/scene/yaml/edit.h"

#include <string.h>

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

/* Behind phases[N].set. or phases.NAME.set. the rest of the path is one key: a path of the scene.
 * NULL for other paths. */
static const char *key_of_phase(const char *text)
{
    static const char set[] = ".set.";
    const char *at = is_of_phases(text) ? strstr(text, set) : NULL;
    return at && at < text + strcspn(text, "=") ? at + strlen(set) : NULL;
}

int scene_edit_layer(struct scene_tree *tree, const yaml_document_t *layer)
{
    const yaml_node_t *nodes = layer->nodes.start;
    struct edit graft = {.tree = tree, .mark = nodes->start_mark};
    const int root = edit_graft(&graft, layer);
    for (int i = 0; root && nodes + i < layer->nodes.top; i++)
        scene_tree_node(tree, root + i)->start_mark = nodes[i].start_mark;
    for (size_t i = 0; root && i < scene_tree_length(tree, root) && !tree->error->code; i++) {
        const yaml_node_pair_t pair = scene_tree_pair(tree, root, i);
        const char *key = scene_tree_scalar(tree, pair.key);
        struct edit edit = {.tree = tree,
                            .mark = scene_tree_node(tree, pair.key)->start_mark,
                            .start = key,
                            .at = key,
                            .value = pair.value};
        if (!key || starts_no_path(key)) {
            edit_no_path(&edit);
        } else {
            edit.whole = key_of_phase(key);
            edit_put_value(&edit, 1);
        }
    }
    return tree->error->code;
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
            edit_no_path(&edit);
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
            edit_no_path(&edit);
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
