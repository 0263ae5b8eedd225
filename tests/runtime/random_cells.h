#ifndef TESTS_RUNTIME_RANDOM_CELLS_H
#define TESTS_RUNTIME_RANDOM_CELLS_H

#include "tests/runtime/random_program.h"

/* An object as the interpreter sees it: its value, the failure it descends from, and the
 * contributions since its last other access: complete subtrees of decreasing size, oldest first, no
 * two alike. A subtree in which no task contributed is NULL. */

/* Failures are compared by their place in the reference order; PROG_NO_FAILURE is later than all.
 */
struct prog_failure {
    unsigned number;
    int code;
};
extern const struct prog_failure PROG_NO_FAILURE;

enum { PROG_MAX_LEVELS = 32 };

struct prog_cell {
    duite_type type;
    size_t count, max; /* elements; of the largest value */
    unsigned char *value;
    unsigned writes; /* accesses that may have written it */
    struct prog_failure poison;
    struct prog_failure pending; /* of the contributions */
    enum prog_law law;           /* of the contributions */
    unsigned n_subtrees, level[PROG_MAX_LEVELS];
    unsigned char *subtree[PROG_MAX_LEVELS];
};

struct prog_failure prog_first_failure(struct prog_failure a, struct prog_failure b);
size_t prog_cell_bytes(const struct prog_cell *cell);

/* A cell of such a shape, all zero. */
void prog_cell_start(struct prog_cell *cell, const struct prog_object *shape);
void prog_cell_end(struct prog_cell *cell);

/* Adds a leaf by a law, which becomes the cell's; NULL: an absent one. */
void prog_cell_contribute(struct prog_cell *cell, enum prog_law law, unsigned char *leaf);
/* Takes the tree of all contributions; NULL: none. */
unsigned char *prog_cell_fold(struct prog_cell *cell);

/* Every access but cw, and cw by another law, ends a run of contributions. Returns the cell. */
struct prog_cell *prog_cell_settle(struct prog_cell *cell);

#endif
