#ifndef CLOTH_SCENE_SCHEMA_STORE_H
#define CLOTH_SCENE_SCHEMA_STORE_H

#include "cloth/scene/schema/rules.h"
#include "cloth/scene/yaml/tree.h"

/* Values into the fields that their rules name. base: the structure that these are members of; a
 * rule without such a field stores nothing. Local; error: CLOTH_E_MEMORY. */

/* A text that has been checked. */
int scene_store_scalar(void *base, const struct scene_rule *rule, const char *text,
                       struct cloth_error *error);

/* The place of a node, and that its key is the one that was chosen. */
int scene_store_presence(void *base, const struct scene_rule *rule, const struct scene_tree *tree,
                         int node, struct cloth_error *error);

/* Room for the n items of a list or named map, zeroed where it is of any length. *step: bytes from
 * one item to the next. NULL: there is no field, or an error. */
void *scene_store_items(void *base, const struct scene_rule *rule, size_t n, size_t *step,
                        struct cloth_error *error);

/* The name of an item of a named map. */
int scene_store_name(void *item, const struct scene_rule *rule, const char *name,
                     struct cloth_error *error);

#endif
