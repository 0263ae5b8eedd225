#ifndef CLOTH_FLOW_STEP_GRID_H
#define CLOTH_FLOW_STEP_GRID_H

#include <stdbool.h>
#include <stdint.h>

/* The time grid of a run. Time is an integer count of ticks, h/1024 each. A step has 1024, 512, ...
 * or 1 ticks and begins at a multiple of its length. So steps of length h begin where they do in a
 * run without shorter ones. Pure functions. */
enum { FLOW_TICKS = 1024 };

struct flow_grid {
    uint64_t now, end;   /* ticks; end: a multiple of FLOW_TICKS, at most 2^42 */
    uint32_t length;     /* of the step to come: a power of two */
    uint64_t refused;    /* steps that were begun again with half the length */
    uint32_t least_done; /* the shortest step that was made */
};

void flow_grid_begin(struct flow_grid *grid, uint64_t n_steps);

/* After a step that was refused: the next one has half the length. Returns false where it was one
 * tick. */
bool flow_grid_halve(struct flow_grid *grid);

/* After a step that was accepted; calm: the next one may have twice the length, if the grid lets
 * it. */
void flow_grid_accept(struct flow_grid *grid, bool calm);

/* What a step of a run changed, and what it may. */
struct flow_verdict {
    double before, after; /* largest stretch at its begin and end; NaN: something is none */
    double max, growth;   /* the limit of the stretch and of its growth in a step; 0: none */
    bool failed;          /* the solve failed, or a number is beyond all measure */
};

/* Whether a step is refused: it failed, it ends above the limit and higher than it began, or the
 * stretch grew by more than it may. */
bool flow_verdict_refuses(const struct flow_verdict *verdict);

/* Whether twice the length should be tried: the stretch grew by at most half of what it may, and,
 * growing on like that, stays below the limit. */
bool flow_verdict_calm(const struct flow_verdict *verdict);

#endif
