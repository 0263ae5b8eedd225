/* A map that a set changed belongs to this place alone (edit.h), so keys may be taken from it. */
#include "cloth/scene/schema/choice.h"
#include "cloth/scene/yaml/edit.h"

#include <limits.h>
#include <string.h>

/* The last set that gave a key or anything below it, from 1; 0: none did. The caller's sets come
 * after the phase's, whose keys are nodes in their order. */
static size_t set_of_pair(const struct scene_tree *tree, yaml_node_pair_t pair)
{
    const yaml_mark_t mark = scene_tree_node(tree, pair.key)->start_mark;
    if (mark.index == SCENE_BY_PHASE)
        return mark.line;
    const size_t phases = INT_MAX; /* more than there are nodes */
    return mark.index == SCENE_BY_SET ? phases + mark.line + 1 : 0;
}

static bool is_choice(const struct scene_tree *tree, const struct scene_rule *keys, bool all,
                      yaml_node_pair_t pair)
{
    const char *name = scene_tree_scalar(tree, pair.key);
    while (name && keys->key && strcmp(keys->key, name) != 0)
        keys++;
    return name && keys->key && (all || keys->choice);
}

void scene_choice_settle(struct scene_tree *tree, int map, const struct scene_rule *keys, bool all)
{
    size_t last = 0;
    for (size_t i = 0; i < scene_tree_length(tree, map); i++) {
        const yaml_node_pair_t pair = scene_tree_pair(tree, map, i);
        const size_t set = set_of_pair(tree, pair);
        if (is_choice(tree, keys, all, pair) && set > last)
            last = set;
    }
    for (size_t i = scene_tree_length(tree, map); i > 0; i--) {
        const yaml_node_pair_t pair = scene_tree_pair(tree, map, i - 1);
        if (is_choice(tree, keys, all, pair) && set_of_pair(tree, pair) < last)
            scene_edit_remove(tree, map, i - 1);
    }
}
