#ifndef CLOTH_SCENE_SCHEMA_RULES_H
#define CLOTH_SCENE_SCHEMA_RULES_H

#include "cloth/mannequin/pose.h"
#include "cloth/model/model.h"

#include <stdbool.h>
#include <stddef.h>

/* The schema of a scene, as a tree of constant rules: a map has the rules of its keys, a list the
 * rule of its items. A rule also says which field takes the value, so that the walk that checks a
 * scene (check.h) fills the model, too. */

enum scene_type {
    SCENE_MAP,            /* inside: its keys */
    SCENE_ONE_OF,         /* a map with exactly one of the keys `inside` */
    SCENE_ROTATION,       /* a quaternion, or a map of an axis and an angle; inside: its keys */
    SCENE_NAMED,          /* a map with keys of the user's choice; inside: their one rule */
    SCENE_EDITS,          /* a map KEY: VALUE of changes to the scene (yaml/edit.c) */
    SCENE_LIST,           /* inside: the rule of its items */
    SCENE_NUMBER,         /* finite, in `range` */
    SCENE_INTEGER,        /* min <= value <= max */
    SCENE_NUMBER_OR_LIST, /* a number in `range`, or a list like SCENE_LIST */
    SCENE_NUMBER_OR_WORD, /* a number in `range`, or one of the words `words` */
    SCENE_TEXT,           /* not empty */
    SCENE_CHOICE          /* one of the words `choices` */
};

enum scene_range {
    SCENE_ANY,
    SCENE_POSITIVE,
    SCENE_NOT_NEGATIVE,
    SCENE_FRACTION,
    SCENE_COEFFICIENT
};

/* A member of the structure that a map fills. `of` and `size` name the structure, for the test that
 * all keys of a map mean the same one. */
struct scene_field {
    size_t offset, width; /* bytes; width 0: there is no such field */
    const char *of;
    size_t size;
};

/* The lines of prose.md, ended by NULL: sections of the page of all keys (page.c), each below a
 * head that rules name. */
extern const char *const scene_prose[];

struct scene_rule {
    const char *key; /* NULL ends the keys of a map */
    enum scene_type type;
    const char *unit;     /* NULL: a pure number, or not a number */
    const char *fallback; /* the default as YAML; NULL: none */
    bool required;        /* without a default: whether the key must be there */
    bool choice;          /* of the keys of a map that are choices one must be there, and no more */
    enum scene_range range;
    double min, max; /* of integers; max 0: 2^32 - 1. max of lists: entries; 0: any */
    size_t length;   /* of lists; 0: any */
    bool filled;     /* lists: at least one entry */
    const struct model_word *words; /* choices, ended by one without a word */
    const struct scene_rule *inside;
    const char *about; /* for the list of keys and the page: no capital, no full stop */
    const char
        *needs; /* what the key does nothing without, in the words of needs.h; NULL: nothing */
    const char *section; /* of this key, by its head; NULL: it is a row of its map's table */
    const char *shared;  /* of this key and its neighbours, which other maps have, too */

    /* The fields, all of the structure that the map of this key fills. A number takes a double, a
     * whole one a uint32_t, a text a char * that the structure owns. A choice takes a bool, int or
     * enum; a list of fixed length takes an array of these. Maps without a field fill the structure
     * that they stand in. */
    struct scene_field field;
    struct scene_field count; /* lists of any length and named maps: a uint32_t; `field` is then a
                                 pointer, to calloc'ed entries; one value is an entry */
    size_t item;              /* of their `item` bytes each */
    struct scene_field name;  /* named maps: of each entry */
    struct scene_field place, kind;
    int value;
    bool apart; /* maps: its keys fill a structure that is no part of this one, by scene_fill */
};

/* The rule of the whole document, which fills a struct model. */
extern const struct scene_rule scene_root;

/* Rules of maps that stand apart, and the structures that they fill. */
struct scene_grid {
    double width, height; /* m; height 0: it is not given */
    uint32_t nx, ny;
    enum mesh_cells cells;
};
struct scene_disc {
    double radius; /* m */
    uint32_t rings;
};
struct scene_inline {
    uint32_t n_vertices, n_edges, n_triangles;
    double (*vertices)[3];
    uint32_t (*edges)[2], (*triangles)[3];
};
struct scene_measure {
    char *name;
    double value;
};
struct scene_pattern {
    double edge;          /* m; 0: it is not given */
    uint32_t vertices;    /* 0: they are not given */
    char *garment, *size; /* NULL: it is not given */
    bool notches;
    uint32_t n_measures;
    struct scene_measure *measures;
};
struct scene_figure {
    struct mannequin mannequin;
    struct mannequin_walk walk;
    uint32_t n_poses; /* 0: they are not given */
    struct mannequin_pose *poses;
    double fps; /* 1/s */
};
enum { SCENE_LAST_FRAME = -1 };
struct scene_settled {
    double frame; /* SCENE_LAST_FRAME: the last one */
    char *cloth;  /* NULL: it is not given */
};
extern const struct scene_rule scene_grid, scene_disc, scene_inline, scene_pattern, scene_settled;
extern const struct scene_rule scene_transform;  /* a struct mesh_transform */
extern const struct scene_rule scene_region;     /* a struct model_pick */
extern const struct scene_rule scene_body;       /* a struct mesh_transform */
extern const struct scene_rule scene_mannequin;  /* a struct scene_figure */
extern const struct scene_rule scene_quaternion; /* what a SCENE_ROTATION is as a list */

/* Words of choices that no field takes as they are. */
enum scene_constraint { SCENE_POINT, SCENE_LINE, SCENE_PLANE };
extern const struct model_word scene_holds[];        /* enum scene_constraint, in its order */
extern const struct model_word scene_columns[];      /* of uv */
extern const struct model_word scene_units[];        /* tenths of a millimetre */
extern const struct model_word scene_ups[];          /* an axis */
extern const struct model_word scene_rests[];        /* whether by uv */
extern const struct model_word scene_meets[];        /* whether by maps */
extern const struct model_word scene_views[];        /* an axis, or CONTACT_THINNEST */
extern const struct model_word scene_hdf5_fields[];  /* offsets of flags in a struct model_hdf5 */
extern const struct model_word scene_probe_values[]; /* offsets of flags in a struct model_probe */

/* Materials that every scene knows by name (fabrics.c). */
extern const struct model_word scene_fabrics[];

/* The value of a word among `words`; *known: true if it is among them. */
int scene_word_value(const struct model_word *words, const char *word, bool *known);

/* The allowed values in words: "a finite number > 0 (s)". Returns text. */
char *scene_rule_expected(const struct scene_rule *rule, char *text, size_t size);

/* "; did you mean 'x'? Allowed: x, y, z", of n candidates, cut to size. Returns text. */
char *scene_allowed_words(const char *word, const char *const *candidates, size_t n, char *text,
                          size_t size);

#endif
