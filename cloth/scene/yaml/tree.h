#ifndef CLOTH_SCENE_YAML_TREE_H
#define CLOTH_SCENE_YAML_TREE_H

#include "cloth/base/error.h"
#include "cloth/scene/scene.h"

#include <stdbool.h>
#include <stdint.h>
#include <yaml.h>

/* A scene's document. Nodes are known by their number (1 is the root, 0 is none), since additions
 * move them. */
struct scene_tree {
    yaml_document_t document;
    bool loaded;
    const char *path;             /* of the file, as the user wrote it */
    size_t n_sets;                /* of the caller */
    const struct scene_set *sets; /* of the caller */
    struct scene_made *made;      /* what the phases of a scene share (cloth/scene/build/made.h) */
};

/* The origin of a node that is not from the file. It is kept in its mark: index is one of these,
 * line the set's number; by a phase: line is the key in its set, column the phase's number. */
#define SCENE_BY_SET     (SIZE_MAX)
#define SCENE_BY_DEFAULT (SIZE_MAX - 1)
#define SCENE_BY_PHASE   (SIZE_MAX - 2)

/* The words by which errors name a file. */
struct scene_words {
    const char *noun, *form; /* "scene", "YAML" */
    const char *start;       /* a sentence: how one starts */
    const char *large;       /* the advice for too large a file; "" */
};
extern const struct scene_words scene_words;

/* Reads the one document of a file; its root is a map. Errors: CLOTH_E_INPUT with file:line:column.
 */
int scene_tree_load(struct scene_tree *tree, const char *path, const struct scene_words *words,
                    struct cloth_error *error);
void scene_tree_free(struct scene_tree *tree);

/* The number of a node that an alias within it names; *line: a line of the alias's node, counted
 * from 0. 0: there is none. */
int scene_tree_circle(const yaml_document_t *document, size_t *line);
#define SCENE_CIRCLE "an alias may stand only behind what its anchor is of"

/* Fails with CLOTH_E_INPUT and "place: sentence", where the place is the file, line and column of a
 * node, or the option it came by. */
int scene_tree_fail(const struct scene_tree *tree, int node, struct cloth_error *error,
                    const char *format, ...) __attribute__((format(printf, 4, 5)));

/* The node's type and parts. A scalar's value is a string that lives as long as the tree is not
 * changed. */
yaml_node_t *scene_tree_node(const struct scene_tree *tree, int node);
bool scene_tree_is(const struct scene_tree *tree, int node, yaml_node_type_t type); /* 0 is none */
const char *scene_tree_scalar(const struct scene_tree *tree, int node); /* NULL: not a scalar */
bool scene_tree_empty(const struct scene_tree *tree, int node);    /* null: '', '~' or 'null' */
bool scene_tree_is_given(const struct scene_tree *tree, int node); /* there, and no default */
size_t scene_tree_length(const struct scene_tree *tree, int node); /* of a list or map; of 0: 0 */
int scene_tree_item(const struct scene_tree *tree, int list, size_t i);
yaml_node_pair_t scene_tree_pair(const struct scene_tree *tree, int map, size_t i);
int scene_tree_get(const struct scene_tree *tree, int map, const char *key); /* 0: no such key */
/* The map of a phase, counted from 0; 0: there is none, or it is no map. */
int scene_tree_phase(const struct scene_tree *tree, uint32_t phase);

/* Describes a node on one line: 3, a list of 2, or a text in quotes. quotes: they stand before a
 * text, their last character also behind it. Returns text, or a constant. */
#define SCENE_QUOTES "the text '"
const char *scene_tree_found(const struct scene_tree *tree, int node, const char *quotes,
                             char *text, size_t size);

/* The place of a node, or of a mark, as scene_tree_fail names it; the caller frees it. NULL: out of
 * memory. */
char *scene_tree_place(const struct scene_tree *tree, int node);
char *scene_tree_mark_place(const struct scene_tree *tree, const yaml_mark_t *mark);

/* Values of a document that the schema has accepted. */
double scene_tree_number(const struct scene_tree *tree, int map, const char *key);
uint32_t scene_tree_integer(const struct scene_tree *tree, int map, const char *key);
const char *scene_tree_text(const struct scene_tree *tree, int map,
                            const char *key); /* NULL: none */
void scene_tree_vector(const struct scene_tree *tree, int list, size_t n, double *value);

#endif
