#ifndef CLOTH_FLOW_SOLVER_PATCHES_H
#define CLOTH_FLOW_SOLVER_PATCHES_H

#include "cloth/flow/tasks.h"

/* Sizes of what a coarse space needs, and where in it a patch is. Patch k of block b is number
 * flow->patches * b + k. Local functions. */

/* What a preconditioned pass leaves of its block: the dots, then the coarse right side, of each
 * patch. */
enum { FLOW_PART_COARSE = SOLVE_DOTS };
static inline size_t flow_part_doubles(const struct flow *flow)
{
    return FLOW_PART_COARSE + SOLVE_COARSE * (size_t)flow->patches;
}

/* Numbers of a motion: a vector of the coarse space. */
static inline size_t flow_motion_doubles(const struct flow *flow)
{
    return SOLVE_COARSE_STRIDE * (size_t)flow->pattern.n;
}

/* Of patches p <= q: how many blocks of nine by nine are before theirs in the coupling of p's
 * block, which has for each patch its own and those of its neighbours behind it; q is one of these.
 */
size_t flow_coupling_at(const struct flow *flow, uint32_t p, uint32_t q);

#endif
