#ifndef CLOTH_SCENE_SCHEMA_CHECK_H
#define CLOTH_SCENE_SCHEMA_CHECK_H

#include "cloth/scene/schema/rules.h"
#include "cloth/scene/yaml/tree.h"

/* Checks a tree against the schema, adds the defaults and fills a zeroed model. Afterwards every
 * key that has a default is there. Every value is of its type and in its range, and stands in the
 * field that its rule names. Allocations belong to the model, also after an error. Errors name the
 * place and the allowed values. */
int scene_check(struct scene_tree *tree);

/* Fills a zeroed structure from a map of a checked tree by the rule of this map. Allocations belong
 * to the structure, also after an error. Error: CLOTH_E_MEMORY. */
int scene_fill(void *structure, const struct scene_rule *rule, struct scene_tree *tree, int node);

/* Completes a tree before it is checked: adds materials that cloths name and the scene lacks, and
 * to materials with `kes`, `fast` or `like` the keys that they lack; the second function those of
 * one material by its sheet of an instrument. Error: CLOTH_E_MEMORY. */
int scene_fabrics_fill(struct scene_tree *tree);
int scene_instruments_fill(struct scene_tree *tree, int material);

/* ---- Places and faults (faults.c) ---- */

/* A place in a scene: a chain up to the root, for the names of keys in sentences. */
struct scene_place {
    const struct scene_place *up;
    const char *key; /* NULL: entry `index` of a list */
    size_t index;
};

/* Writes "cloths[0].mesh", cut to size; the root is "the scene". Returns text. */
enum { SCENE_PATH = 200 };
const char *scene_place_path(const struct scene_place *at, char text[SCENE_PATH]);

/* The rule of a key among those of a map; NULL: there is none. */
const struct scene_rule *scene_rule_of(const struct scene_rule *keys, const char *name);

enum { SCENE_MAX_KEYS = 32 }; /* of a map, in sentences */

/* The error of a value that its rule does not allow, and of a key that a map has not. */
int scene_fault_value(struct scene_tree *tree, const struct scene_place *at,
                      const struct scene_rule *rule, int node);
int scene_fault_key(struct scene_tree *tree, const struct scene_place *at,
                    const struct scene_rule *keys, int node);

/* Refuses a comma in a number: {density: 0,2} is {density: 0, 2: } to YAML. Pair i of the map is
 * the second of these. */
int scene_check_comma(struct scene_tree *tree, const struct scene_place *at, int map, size_t i);

/* ---- Fields (store.c) ---- */

/* Values into the fields that their rules name. base: the structure that these are members of; a
 * rule without such a field stores nothing. Local; error: CLOTH_E_MEMORY. */

/* A text that has been checked. */
int scene_store_scalar(void *base, const struct scene_rule *rule, const char *text,
                       struct cloth_error *error);

/* The place of a node, and that its key is the one that was chosen. */
int scene_store_presence(void *base, const struct scene_rule *rule, const struct scene_tree *tree,
                         int node);

/* Room for the n items of a list or named map, or for the value of an array of one; zeroed in
 * arrays. *step: bytes from one item to the next. NULL: there is no field, or an error. */
void *scene_store_items(void *base, const struct scene_rule *rule, size_t n, size_t *step,
                        struct cloth_error *error);

/* The name of an item of a named map. */
int scene_store_name(void *item, const struct scene_rule *rule, const char *name,
                     struct cloth_error *error);

#endif
