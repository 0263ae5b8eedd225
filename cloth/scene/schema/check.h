#ifndef CLOTH_SCENE_SCHEMA_CHECK_H
#define CLOTH_SCENE_SCHEMA_CHECK_H

#include "cloth/scene/schema/rules.h"
#include "cloth/scene/yaml/tree.h"

/* Checks a tree against the schema, adds the defaults and fills a zeroed model. Afterwards every
 * key that has a default is there. Every value is of its type and in its range, and stands in the
 * field that its rule names. Allocations belong to the model, also after an error. Errors name the
 * place and the allowed values. */
int scene_check(struct model *model, struct scene_tree *tree, struct cloth_error *error);

/* Fills a zeroed structure from a map of a checked tree by the rule of this map. Allocations belong
 * to the structure, also after an error. Error: CLOTH_E_MEMORY. */
int scene_fill(void *structure, const struct scene_rule *rule, struct scene_tree *tree, int node,
               struct cloth_error *error);

#endif
