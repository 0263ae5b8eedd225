#ifndef CLOTH_SCENE_YAML_EDIT_H
#define CLOTH_SCENE_YAML_EDIT_H

#include "cloth/scene/yaml/tree.h"

/* One edit of a document, KEY=VALUE or KEY: VALUE: the mark of new nodes, and the rest of the path.
 */
struct edit {
    struct scene_tree *tree;
    yaml_mark_t mark;
    const char *start, *at; /* text of the set, and the rest of its path */
    int value;              /* a node; 0: the text has it, behind the path */
    const char *whole;      /* where a key begins that may have '.' and '[' in it; NULL: nowhere */
    int parts;              /* of the path, so far */
};

/* The replacement of `node` (0: none) after following the rest of the path; 0 with an error. */
int edit_put_value(struct edit *edit, int node);

/* Adds all nodes of another document. Returns the new number of its root; 0 with an error. */
int edit_graft(struct edit *edit, const yaml_document_t *from);

/* 0, with an error at the edit's place; the same where there is no path. */
int edit_fails(const struct edit *edit, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
int edit_no_path(const struct edit *edit);

#endif
