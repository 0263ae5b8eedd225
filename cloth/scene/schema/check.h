#ifndef CLOTH_SCENE_SCHEMA_CHECK_H
#define CLOTH_SCENE_SCHEMA_CHECK_H

#include "cloth/scene/yaml/tree.h"

/* Checks a tree against the schema and adds the defaults: afterwards every key that has a default
 * is there, and every value is of its type and in its range. Errors name the place and what is
 * allowed. */
int scene_check(struct scene_tree *tree, struct cloth_error *error);

#endif
