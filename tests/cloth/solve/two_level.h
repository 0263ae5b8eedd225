#ifndef TESTS_CLOTH_SOLVE_TWO_LEVEL_H
#define TESTS_CLOTH_SOLVE_TWO_LEVEL_H

#include "cloth/solve/coarse.h"
#include "tests/cloth/solve/system.h"

/* The coarse part of a preconditioner of a system that is cut into blocks, as tasks put it
 * together. */
struct two_level {
    const struct system *system;
    uint32_t first[SYSTEM_BLOCKS + 1], neighbour[SYSTEM_BLOCKS * SYSTEM_BLOCKS];
    phys_vec basis[SYSTEM_ROWS];                                   /* of all rows */
    double coupling[SYSTEM_BLOCKS][SYSTEM_BLOCKS][SOLVE_COUPLING]; /* own, later neighbours */
    struct solve_pattern pattern;
    double *factor;
    uint32_t dropped;
};
void two_level_make(struct two_level *level, const struct system *system);
void two_level_free(struct two_level *level);

/* y += P C^-1 P' q over all rows. */
void two_level_add(const struct two_level *level, const phys_vec *q, phys_vec *y);

#endif
