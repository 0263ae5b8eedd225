#ifndef CLOTH_SCENE_SCHEMA_FAULTS_H
#define CLOTH_SCENE_SCHEMA_FAULTS_H

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

enum { SCENE_MAX_KEYS = 32 }; /* of a map, in sentences */

/* A walk of a document along the rules. */
struct scene_walk {
    struct scene_tree *tree;
    struct cloth_error *error;
};

/* The error of a value that its rule does not allow, and of a key that a map has not. */
int scene_fault_value(struct scene_walk *walk, const struct scene_place *at,
                      const struct scene_rule *rule, int node);
int scene_fault_key(struct scene_walk *walk, const struct scene_place *at,
                    const struct scene_rule *keys, int node);

/* Refuses a comma in a number: {density: 0,2} is {density: 0, 2: } to YAML. Pair i of the map is
 * the second of these. */
int scene_check_comma(struct scene_walk *walk, const struct scene_place *at, int map, size_t i);

#endif
