#ifndef CLOTH_FLOW_SOLVER_LEVELS_H
#define CLOTH_FLOW_SOLVER_LEVELS_H

#include "cloth/flow/solver/solver.h"
#include "cloth/flow/state/bodies.h"

/* The coarse part by groups (cloth/solve/levels.h), on flow->n_levels levels. Without levels these
 * functions do nothing. Collective unless they say local; they return the runtime's code. */

/* Take the memory of groups (flow_take). Make their objects, when those of blocks are made; the
 * next get returns a failure. Local. */
void flow_levels_take(struct flow_state *state);
void flow_levels_make(struct flow_state *state);

/* Fork the tasks of all groups: the lifts of nodes into their groups, once a run; the factors, in
 * each step; the motions, before the first pass of a solve and after each recorded one. */
int flow_levels_initialise(struct flow_state *state);
int flow_levels_factor(struct flow_state *state);
int flow_levels_solve(struct flow_state *state);

/* Forks a kernel on top. Its last parameter is ALL of `part`, or of `coupling`. With levels it gets
 * those of the highest level's groups instead. */
int flow_levels_fork_top(struct flow_state *state, const struct flow_kernel *kernel,
                         const void *args, bool couplings);

/* Appends to the n objects in state->refs the motions that a pass over a block needs, of its own
 * patches, its neighbours' and those that ties join it with. Returns the new number of objects. */
size_t flow_levels_seen(struct flow_state *state, uint32_t block, size_t n);

/* The graph of the nodes on top: patches, or groups of the highest level. Local. */
struct flow_graph {
    uint32_t n;
    const uint32_t *first, *neighbour; /* n + 1 */
};
static inline struct flow_graph flow_levels_graph(const struct flow *flow)
{
    if (!flow->n_levels)
        return (struct flow_graph){flow->patches * flow->tables.n_blocks, flow->patch_first,
                                   flow->patch_neighbour};
    const struct solve_level *top = flow->level + flow->n_levels - 1;
    return (struct flow_graph){top->n_groups, top->group_first, top->group_neighbour};
}

/* For a node of a level or on top: the holder of its numbers, the begin of its coupling there, its
 * right side in a part. Local. */
uint32_t flow_levels_holder(const struct flow *flow, uint32_t level, uint32_t node);
size_t flow_levels_coupling_at(const struct flow *flow, uint32_t level, uint32_t node);
const double *flow_levels_right(const struct flow *flow, uint32_t level, uint32_t node,
                                const double *part);

/* A motion of a group begins with its number among all; the solution follows. */
enum { FLOW_MOTION = 4 };

/* How the nodes of a level lie in their groups (solve_lift); lift: of all levels. Local. */
static inline const double (*flow_lifts_of(const struct flow *flow, uint32_t level,
                                           const double *lift))[FLOW_LIFT]
{
    return (const double(*)[FLOW_LIFT])lift + flow->first_lifted[level];
}

/* In a pass: the motion of a patch, of all levels. Local. */
void flow_levels_motion(const struct flow_preconditioner *m, uint32_t patch,
                        double x[SOLVE_COARSE]);

#endif
