#ifndef CLOTH_SCENE_SCHEMA_FABRICS_H
#define CLOTH_SCENE_SCHEMA_FABRICS_H

#include "cloth/model/model.h"
#include "cloth/scene/yaml/tree.h"

/* Materials that every scene knows by name. docs/physics.md says what was measured, by whom, and
 * what is derived. */

/* Their names, ended by one that is NULL. */
extern const struct model_word scene_fabrics[];

/* Gives a tree, before it is checked, the materials that cloths name and that the scene does not
 * have itself, and those with `like` the keys that they do not have themselves. Error:
 * CLOTH_E_MEMORY. */
int scene_fabrics_fill(struct scene_tree *tree, struct cloth_error *error);

#endif
