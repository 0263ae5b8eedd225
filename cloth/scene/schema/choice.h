#ifndef CLOTH_SCENE_SCHEMA_CHOICE_H
#define CLOTH_SCENE_SCHEMA_CHOICE_H

#include "cloth/scene/schema/rules.h"
#include "cloth/scene/yaml/tree.h"

/* Among several keys of a map that exclude each other the last one that a set gave stays: a choice
 * replaces a choice. Two that the file gives, or one set, both stay, which the check refuses. all:
 * the keys exclude each other all; else those that are choices. Local. */
void scene_choice_settle(struct scene_tree *tree, int map, const struct scene_rule *keys, bool all);

#endif
