#ifndef CLOTH_SCENE_YAML_EDIT_H
#define CLOTH_SCENE_YAML_EDIT_H

#include "cloth/scene/yaml/tree.h"

/* Applies the sets of the phases up to one, as far as the scene has phases, then the tree's sets in
 * their order. So what a phase sets holds until another phase sets it, and the tree's sets hold in
 * every phase. Sets that change the phases themselves come first. A key that is missing on a path
 * is made, one whose value is null is taken away, an index equal to a list's length appends. Maps
 * and lists on the path are copied before they change, so that nodes shared by an alias change at
 * this place only. Errors name the option, or the key in the set of the phase. */
int scene_edit_sets(struct scene_tree *tree, uint32_t phase, struct cloth_error *error);

/* Gives a map a further key, whose value is YAML text that is known to be well formed: a default.
 */
int scene_edit_default(struct scene_tree *tree, int map, const char *key, const char *value,
                       struct cloth_error *error);

/* Takes pair i from a map. */
void scene_edit_remove(struct scene_tree *tree, int map, size_t i);

#endif
