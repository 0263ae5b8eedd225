#ifndef CLOTH_SCENE_SCHEMA_FABRICS_H
#define CLOTH_SCENE_SCHEMA_FABRICS_H

#include "cloth/model/model.h"
#include "cloth/scene/yaml/tree.h"

/* Materials that every scene knows by name. docs/physics.md tells measured values, with their
 * sources, from derived ones. */

/* Their names, ended by one that is NULL. */
extern const struct model_word scene_fabrics[];

/* Completes a tree before it is checked: adds materials that cloths name and the scene lacks, and
 * to materials with `like` the keys that they lack. Error: CLOTH_E_MEMORY. */
int scene_fabrics_fill(struct scene_tree *tree, struct cloth_error *error);

#endif
