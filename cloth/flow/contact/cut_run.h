#ifndef CLOTH_FLOW_CONTACT_CUT_RUN_H
#define CLOTH_FLOW_CONTACT_CUT_RUN_H

#include <stdint.h>

/* How a row was cut lately, in words of a field of the row. A step that is given up must leave no
 * trace, but may be given up after its cuts. So two are kept: the last step that cut the row, and
 * the last accepted one before it. Steps are numbered in the order of their begins, from 1; 0:
 * none. Rows that are not cut need no work. */
struct flow_cut_run {
    uint32_t step, n;               /* which one; so many in a row cut it, with this one */
    uint32_t step_before, n_before; /* the same */
};

/* Notes that a row is cut in a step. accepted: the last accepted step. Returns the number of steps
 * in a row that cut it, with this one. Local. */
static inline uint32_t flow_cut_again(struct flow_cut_run *run, uint32_t step, uint32_t accepted)
{
    if (run->step == step) /* in a round before */
        return run->n;
    if (run->step <= accepted) {
        run->step_before = run->step;
        run->n_before = run->n;
    }
    run->n = 1 + (run->step_before && run->step_before == accepted ? run->n_before : 0);
    run->step = step;
    return run->n;
}

#endif
