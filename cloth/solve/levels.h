#ifndef CLOTH_SOLVE_LEVELS_H
#define CLOTH_SOLVE_LEVELS_H

#include "cloth/solve/coarse.h"

/* The coarse system C x = y (cloth/solve/coarse.h) of many patches, solved by parts, which tasks
 * can do side by side. A level has nodes: patches, or clusters of the level below. What is known of
 * them lies together in holders: blocks, or groups of the level below. The level puts runs of nodes
 * together twice: to clusters, which are the nodes of the level above, and to groups, each of some
 * clusters. A group covers its nodes and one layer more: the holders of all nodes that they are
 * joined with. In place of C^-1 there is
 *
 *     sum over groups g of w R_g' (R_g C R_g')^-1 R_g  +  Q (Q' C Q)^-1 Q'
 *
 * R_g takes what g covers, and w is 1/2, as most nodes near a border are covered twice or more; of
 * one group alone it is 1. Q has nine columns a cluster, motions that are affine on its nodes. This
 * is additive Schwarz of two levels (Dryja & Widlund 1987). The matrix Q' C Q of the clusters is
 * like C, so it may be solved in the same way, by one more level. Each term is symmetric and
 * semidefinite, so their sum with another preconditioner remains positive definite. One group that
 * covers all solves C itself. The order of sums follows from the numbers of nodes and groups.
 *
 * Blocks of C and of Q' C Q lie alike: a node has its diagonal block, then one for each neighbour
 * with a higher number, ascending. That is the coupling of the node. */

/* What a group covers. */
struct solve_cover {
    uint32_t n;
    uint32_t *node;              /* n: ascending */
    uint32_t *first, *neighbour; /* n + 1: their graph, by places in `node`; what is not covered and
                                  * comes later is SOLVE_LEFT_OUT, as solve_coarse_fill reads it */
    struct solve_pattern pattern; /* of their factor */
};

/* A group that covers a node, and the node's place there. */
struct solve_covering {
    uint32_t group, place;
};

/* Runs of nodes: run k has the nodes start[k] .. start[k + 1] - 1. */
struct solve_runs {
    uint32_t n;
    uint32_t *start; /* n + 1 */
    uint32_t *of;    /* of each node: its run */
};

struct solve_level {
    uint32_t n;                        /* nodes */
    const uint32_t *first, *neighbour; /* n + 1: whom a node is joined with, ascending; of the
                                        * caller */
    struct solve_runs holder, group, cluster;
    uint32_t *first_cluster;                     /* a group, and one more: its clusters */
    struct solve_cover *cover;                   /* of each group */
    uint32_t *covering_first;                    /* n + 1: which of `covering` are of a node; */
    struct solve_covering *covering;             /* ascending by group */
    uint32_t *cluster_first, *cluster_neighbour; /* whom a cluster is joined with, likewise */
};

/* Runs by where they start, which is copied: so many holders, groups, and clusters. No group cuts a
 * holder or a cluster. Error: CLOTH_E_MEMORY. To be freed in any case. Local. */
struct solve_starts {
    uint32_t n_holders, n_groups, n_clusters;
    const uint32_t *holder, *group, *cluster;
};
int solve_level_make(struct solve_level *level, uint32_t n, const uint32_t *first,
                     const uint32_t *neighbour, const struct solve_starts *starts,
                     struct cloth_error *error);
void solve_level_free(struct solve_level *level);

/* Of the couplings of the clusters of a group, one behind the other, in 9 x 9 blocks: how many come
 * before a cluster's; with the first cluster of the next group, how many there are. */
size_t solve_level_coupling_at(const struct solve_level *level, uint32_t group, uint32_t cluster);

/* Adds what one of a group's own nodes has of Q' C Q to the couplings of the group's clusters,
 * `to`. lift: of each node of the level, solve_lift (cloth/solve/frame.h) to its cluster. */
void solve_level_couple(const struct solve_level *level, uint32_t node, const double *coupling,
                        const double (*lift)[9], double *to);

/* x = w (R_g C R_g')^-1 x, by the factor of a group. */
void solve_level_solve(const struct solve_level *level, uint32_t group, const double *factor,
                       double *x);

/* sum += Q' x of one node; x = Q x of one node. */
void solve_level_restrict(const double lift[9], const double x[SOLVE_COARSE],
                          double sum[SOLVE_COARSE]);
void solve_level_prolong(const double lift[9], double x[SOLVE_COARSE]);

#endif
