#ifndef CLOTH_SCENE_PATTERN_READER_H
#define CLOTH_SCENE_PATTERN_READER_H

#include "cloth/garment/pattern.h"
#include "cloth/scene/yaml/tree.h"

/* A pattern file while it is read. JSON is YAML to its parser, so that each node knows its line.
 * Functions return 0, or another number after a failure, which the tree's error tells. Local. */
struct pattern_reader {
    const struct scene_tree *tree;
    struct garment_pattern *pattern;
    double unit;          /* m: the file's unit of length */
    bool absolute;        /* control points are places, not parts of their edge */
    bool centre;          /* the middle of a panel's vertices becomes its origin */
    const char *panel;    /* that is being read; NULL: none */
    int64_t edge, stitch; /* that is being read; below 0: none */
    size_t n_edges;       /* of all panels so far */
};

enum { PATTERN_KEYS = 8 };

/* Fails with "FILE:LINE:COLUMN: panel 'NAME', edge N: message". */
int pattern_wrong(const struct pattern_reader *reader, int node, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Checks that a node is a map which has each of `keys` (up to PATTERN_KEYS, the rest NULL) at most
 * once, and no other. `what` names the map. value[k]: the value of key k; 0: not there. */
int pattern_map(const struct pattern_reader *reader, int node, const char *what,
                const char *const keys[PATTERN_KEYS], int value[PATTERN_KEYS]);

/* The same, and the first two keys are there. */
int pattern_both(const struct pattern_reader *reader, int node, const char *what,
                 const char *const keys[PATTERN_KEYS], int value[PATTERN_KEYS]);

/* Checks that a node is a list of at least `least` and at most `most` entries. */
int pattern_list(const struct pattern_reader *reader, int node, const char *what, size_t least,
                 size_t most);

/* A finite number, not a text in quotes, of a magnitude of at most 1e9. */
int pattern_number(const struct pattern_reader *reader, int node, const char *what, double *value);
int pattern_vector(const struct pattern_reader *reader, int node, const char *what, size_t n,
                   double *value);
/* A whole number below `below`; things: the noun of the things counted. */
int pattern_index(const struct pattern_reader *reader, int node, const char *what, uint32_t below,
                  const char *things, uint32_t *value);
/* true or false, 1 or 0. */
int pattern_flag(const struct pattern_reader *reader, int node, const char *what, bool *value);
/* One of two words; *second: which. */
int pattern_word(const struct pattern_reader *reader, int node, const char *what,
                 const char *const words[2], bool *second);

/* The parts of the file. */
int pattern_read_panels(struct pattern_reader *reader, int node);

/* The name of a panel from a node, as patterns keep it: to be freed; NULL after an error. */
char *pattern_name(const struct pattern_reader *reader, int node);

#endif
