#ifndef CLOTH_SCENE_YAML_TREE_H
#define CLOTH_SCENE_YAML_TREE_H

#include "cloth/base/error.h"
#include "cloth/scene/scene.h"

#include <stdbool.h>
#include <stdint.h>
#include <yaml.h>

/* The words by which errors name a file. */
struct scene_words {
    const char *noun, *form; /* "scene", "YAML" */
    const char *start;       /* a sentence: how one starts */
};
extern const struct scene_words scene_words;

enum { SCENE_MOST_INCLUDED = 9 };

/* A scene's document, and what is made of it. Nodes are known by their number (1 is the root, 0 is
 * none), since additions move them. */
struct scene_tree {
    yaml_document_t document;
    bool loaded;
    const char *path; /* of the file, as the user wrote it */
    size_t n_included;
    char *included[SCENE_MOST_INCLUDED]; /* paths of the files below it (include.c) */
    const struct scene_words *words;
    struct cloth_error *error;    /* takes the first failure of all that read the tree */
    struct cloth_error inner;     /* of a part that the scene names, without its place there */
    struct model *model;          /* that the scene fills */
    size_t n_sets;                /* of the caller */
    const struct scene_set *sets; /* of the caller */
    struct scene_made *made;      /* what the phases of a scene share (cloth/scene/build/build.h) */
};

/* The origin of a node is kept in its mark. A node from a file has the index 0, or 1 + the number
 * of the included file. Else it is one of these, and line is the set's number; by a phase: line is
 * the key in its set, column the phase's number. */
#define SCENE_BY_SET     (SIZE_MAX)
#define SCENE_BY_DEFAULT (SIZE_MAX - 1)
#define SCENE_BY_PHASE   (SIZE_MAX - 2)

/* Reads the one document of a file; its root is a map. Errors: CLOTH_E_INPUT with file:line:column.
 * `error` stays the tree's, and is not NULL. The second function is for scenes, which may include
 * another: the document is that one, edited by the keys of the file. */
int scene_tree_load(struct scene_tree *tree, const char *path, const struct scene_words *words,
                    struct cloth_error *error);
int scene_tree_load_scene(struct scene_tree *tree, const char *path, struct cloth_error *error);
void scene_tree_free(struct scene_tree *tree);

/* `name`, relative to the folder of the file that a node is from, of other nodes of the scene.
 * NULL: out of memory. */
char *scene_tree_beside(const struct scene_tree *tree, int node, const char *name);

/* The number of a node that an alias within it names; *line: a line of the alias's node, counted
 * from 0. 0: there is none. */
int scene_tree_circle(const yaml_document_t *document, size_t *line);
#define SCENE_CIRCLE "an alias may stand only behind what its anchor is of"

/* Fails with CLOTH_E_INPUT and "place: sentence", where the place is the file, line and column of a
 * node, or the option it came by. */
int scene_tree_fail(const struct scene_tree *tree, int node, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The node's type and parts. A scalar's value is a string that lives as long as the tree is not
 * changed. */
yaml_node_t *scene_tree_node(const struct scene_tree *tree, int node);
bool scene_tree_is(const struct scene_tree *tree, int node, yaml_node_type_t type); /* 0 is none */
const char *scene_tree_scalar(const struct scene_tree *tree, int node); /* NULL: not a scalar */
bool scene_tree_empty(const struct scene_tree *tree, int node);    /* null: '', '~' or 'null' */
bool scene_tree_is_given(const struct scene_tree *tree, int node); /* there, and no default */
size_t scene_tree_length(const struct scene_tree *tree, int node); /* of a list or map; of 0: 0 */
int scene_tree_item(const struct scene_tree *tree, int list, size_t i);
int scene_tree_part(const struct scene_tree *tree, int node, size_t i); /* or the one value */
yaml_node_pair_t scene_tree_pair(const struct scene_tree *tree, int map, size_t i);
int scene_tree_get(const struct scene_tree *tree, int map, const char *key); /* 0: no such key */
int scene_tree_at(const struct scene_tree *tree, int map, const char *path); /* "time.fps" */
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
const char *scene_tree_text(const struct scene_tree *tree, int map,
                            const char *key); /* NULL: none */
void scene_tree_vector(const struct scene_tree *tree, int node, size_t n, double *value);

/* ---- Scalars (scalar.c) ---- */

/* Whole numbers as YAML writes them: [+-] digits, from 0 to 2^32 - 1. */
bool scene_scalar_integer(const char *text, uint32_t *value);
/* It would be a number with a point in place of its comma. */
bool scene_scalar_has_comma(const char *text);
#define SCENE_NO_COMMA "a number has no comma: its decimals follow a point, as in 0.2"

/* ---- Edits (edit.c) ---- */

/* Edits the tree by the keys of a document that includes it, KEY: VALUE. */
int scene_edit_layer(struct scene_tree *tree, const yaml_document_t *layer);

/* Applies the sets of the phases up to one, as far as the scene has phases, then the tree's sets in
 * their order. So what a phase sets holds until another phase sets it, and the tree's sets hold in
 * every phase. Sets that change the phases themselves come first. A key that is missing on a path
 * is made, one whose value is null is taken away, an index equal to a list's length appends. Maps
 * and lists on the path are copied before they change, so that nodes shared by an alias change at
 * this place only. Errors name the option, or the key in the set of the phase. */
int scene_edit_sets(struct scene_tree *tree, uint32_t phase);

/* Gives a map a further key, whose value is YAML text that is known to be well formed: a default.
 */
int scene_edit_default(struct scene_tree *tree, int map, const char *key, const char *value);

/* Takes pair i from a map. */
void scene_edit_remove(struct scene_tree *tree, int map, size_t i);

#endif
