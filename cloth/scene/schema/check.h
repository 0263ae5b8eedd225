#ifndef CLOTH_SCENE_SCHEMA_CHECK_H
#define CLOTH_SCENE_SCHEMA_CHECK_H

#include "cloth/scene/schema/rules.h"
#include "cloth/scene/yaml/tree.h"

/* A place in a scene: a chain up to the root, for the names of keys in sentences. */
struct scene_place {
    const struct scene_place *up;
    const char *key; /* NULL: entry `index` of a list */
    size_t index;
};

/* Writes "cloths[0].mesh"; the root is "the scene". Returns its length, as snprintf does. */
size_t scene_place_path(const struct scene_place *at, char *text, size_t size);

/* The rule of a key among those of a map; NULL: there is none. */
const struct scene_rule *scene_rule_of(const struct scene_rule *keys, const char *name);

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
