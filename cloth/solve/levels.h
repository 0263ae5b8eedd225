#ifndef CLOTH_SOLVE_LEVELS_H
#define CLOTH_SOLVE_LEVELS_H

#include "cloth/solve/coarse.h"

#include <stdbool.h>

/* The coarse system C x = y (cloth/solve/coarse.h) of many patches, solved by parts, which tasks
 * can do side by side. A level has nodes: patches, or groups of the level below. It puts runs of
 * nodes together to groups, which are the nodes of the level above. A group covers its nodes and
 * their neighbours. In place of C^-1 there is
 *
 *     sum over groups g of w R_g' (R_g C R_g')^-1 R_g  +  o Q (Q' C Q)^-1 Q'
 *
 * R_g takes the nodes that g covers. w is 1/2, since most nodes near a border are covered twice or
 * more; it is 1 for a single group. Q has nine columns a group, motions that are affine on its
 * nodes. This is additive Schwarz of two levels (Dryja & Widlund 1987). Q tears smooth motions at
 * the borders of groups, so Q' C Q is too stiff for them, and o is 2 (Braess 1995 found 1.8). Q' C
 * Q is like C, so one more level may solve it in the same way, with w = 3/2 for its groups; o then
 * applies to the topmost level alone. These weights take 56 iterations for 160,000 vertices in
 * steps of 8 ms; w = 1/4 and o = 1 take 67. Each term is symmetric and semidefinite, so their sum
 * with another preconditioner remains positive definite. One group that covers all solves C itself.
 * The order of sums follows from the numbers of nodes and groups.
 *
 * Blocks of C and of Q' C Q lie alike: a node has its diagonal block, then one for each neighbour
 * with a higher number, ascending. That is the coupling of the node. */

/* The nodes that a group covers. */
struct solve_cover {
    uint32_t n;
    uint32_t *node;               /* n: ascending */
    uint32_t *first, *neighbour;  /* n + 1: their graph, by places in `node`; later nodes that are
                                   * not covered are SOLVE_LEFT_OUT, for solve_coarse_fill */
    struct solve_pattern pattern; /* of their factor */
};

/* A group that covers a node, and the node's place there. */
struct solve_covering {
    uint32_t group, place;
};

struct solve_level {
    uint32_t n;                        /* nodes */
    const uint32_t *first, *neighbour; /* n + 1: neighbours of each node, ascending; of the caller
                                        */
    double weight;                     /* w */
    uint32_t n_groups;
    uint32_t *start;                         /* n_groups + 1: a group has the nodes from there on */
    uint32_t *group;                         /* n: of each node */
    struct solve_cover *cover;               /* of each group */
    uint32_t *covering_first;                /* n + 1: which of `covering` are of a node; */
    struct solve_covering *covering;         /* ascending by group */
    uint32_t *group_first, *group_neighbour; /* n_groups + 1: neighbours of each group, likewise */
};

/* Makes a level of n nodes in n_groups groups. start: their first nodes, then n, copied. lowest:
 * its nodes are patches. Error: CLOTH_E_MEMORY. To be freed in any case. Local. */
int solve_level_make(struct solve_level *level, uint32_t n, const uint32_t *first,
                     const uint32_t *neighbour, uint32_t n_groups, const uint32_t *start,
                     bool lowest, struct cloth_error *error);
void solve_level_free(struct solve_level *level);

/* How many 9 x 9 blocks the coupling of a group has. */
uint32_t solve_level_couplings(const struct solve_level *level, uint32_t group);

/* Adds the part of a group's node in Q' C Q to the coupling of the group, `to`. lift: of each node
 * of the level, solve_lift (cloth/solve/frame.h) to its group. */
void solve_level_couple(const struct solve_level *level, uint32_t node, const double *coupling,
                        const double (*lift)[9], double *to);

/* x = w (R_g C R_g')^-1 x, by the factor of a group. */
void solve_level_solve(const struct solve_level *level, uint32_t group, const double *factor,
                       double *x);
/* x = o (Q' C Q)^-1 x, of the topmost level, by its factor. */
void solve_level_solve_top(const struct solve_pattern *pattern, const double *factor, double *x);

/* sum += Q' x of one node; x = Q x of one node. */
void solve_level_restrict(const double lift[9], const double x[SOLVE_COARSE],
                          double sum[SOLVE_COARSE]);
void solve_level_prolong(const double lift[9], double x[SOLVE_COARSE]);

#endif
