#ifndef CLOTH_FLOW_RUN_GRID_H
#define CLOTH_FLOW_RUN_GRID_H

#include <stdbool.h>
#include <stdint.h>

/* The time grid of a run. Time is an integer count of ticks, h/1024 each. A step has 1024, 512, ...
 * or 1 ticks and begins at a multiple of its length. So steps of length h begin where they do in a
 * run without shorter ones. Pure functions. */
enum { FLOW_TICKS = 1024 };

struct flow_grid {
    uint64_t now, end;   /* ticks; end: a multiple of FLOW_TICKS, at most 2^42 */
    uint64_t refused;    /* steps that were begun again with half the length */
    uint64_t later;      /* tick: steps grow from there on */
    uint32_t length;     /* of the step to come: a power of two */
    uint32_t least_done; /* the shortest step that was made */
    uint32_t patience;   /* lengths of a step that had grown and failed, until it is tried again:
                          * twice as many each time, half as many after one that went well */
    uint32_t grown;      /* not zero: the step to come is longer than the last one accepted */
};

void flow_grid_begin(struct flow_grid *grid, uint64_t n_steps);

/* Halves the next step after a refused one. Returns false if that had one tick. learns: where this
 * one had grown, steps stay short for a while. */
bool flow_grid_halve(struct flow_grid *grid, bool learns);

/* After a step that was accepted; calm: the next one may have twice the length, if the grid lets
 * it. */
void flow_grid_accept(struct flow_grid *grid, bool calm);

/* Changes of a step, and their limits. */
struct flow_verdict {
    double before, after; /* largest stretch at its begin and end; NaN: some stretch is not a
                           * number */
    double max, growth;   /* the limit of the stretch and of its growth in a step; 0: none */
    bool failed;          /* the solve failed, or a number is beyond all measure */
};

/* True if a step is refused: it failed, it ends above the limit and higher than it began, or its
 * stretch grew too much. */
bool flow_verdict_refuses(const struct flow_verdict *verdict);

/* True if twice the length should be tried: the stretch grew by at most half its limit of growth,
 * and stays below the limit if it grows on like that. */
bool flow_verdict_calm(const struct flow_verdict *verdict);

#endif
