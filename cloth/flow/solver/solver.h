#ifndef CLOTH_FLOW_SOLVER_SOLVER_H
#define CLOTH_FLOW_SOLVER_SOLVER_H

#include "cloth/flow/bodies.h"

/* What the files of the solver share. In reading order: system.c makes the system of a step. cg.c
 * solves it, in rounds of passes (pass.c), with a preconditioner (preconditioner.c, coarse.c) or
 * none. halo.c and ties.c are what a pass reads of other blocks. pieces.c corrects the momentum of
 * free pieces after a solve.
 *
 * Patch k of block b has the number flow->patches * b + k. */

/* ---- Tasks of a solve. Collective. They return 0 or what duite_fork returned ---- */

/* The first forks the vectors of blocks first to before end, before the first pass, and what
 * neighbours read of them. They are made of `guess` times dv, or of nothing (0). The second forks
 * pass number state->pass of a recorded round on all blocks. (pass.c) */
int flow_pass_start(struct flow_state *state, uint32_t first, uint32_t end, double guess);
int flow_pass_fork(struct flow_state *state);

/* Fork what shows a block's corners of ties, if it has any into other blocks: what the first pass
 * of a solve reads, or after a pass of a recorded round the next one. What shows the coarse
 * functions there, of all blocks, once a solve. (ties.c) */
int flow_ties_pack_start(struct flow_state *state, uint32_t block, bool guess);
int flow_ties_pack(struct flow_state *state, uint32_t block);
int flow_ties_show_basis(struct flow_state *state);

/* Fork what comes of a step's matrix before its solve: the coarse factor; the factors of blocks.
 * Nothing where there is none. (coarse.c, preconditioner.c) */
int flow_coarse_start(struct flow_state *state);
int flow_preconditioner_factor(struct flow_state *state, uint32_t first, uint32_t end);

/* Fork what takes out of dv what a solve left of the momentum of free pieces, if there are any.
 * (pieces.c) */
int flow_pieces_fork(struct flow_state *state);

/* The pattern of the coarse factor, in memory of the flow: all ranks agree on whether they have it.
 * (pattern.c) */
int flow_coarse_prepare(struct flow_state *state);
void flow_coarse_free(struct flow *flow);

/* ---- In a body: a preconditioner as a pass over a block sees it. Local ---- */

struct flow_preconditioner {
    const struct flow *flow;
    const struct flow_table *table;
    uint32_t block;
    const double *factor;                 /* NULL: there is no preconditioner */
    const phys_vec *basis, *basis_ghosts; /* of rows, ghosts; NULL: there is no coarse part */
    const double *motion;                 /* of all patches: the coarse part of s; or with levels
                                           * (levels.h) of the groups on top, and then */
    const double *lift;                   /* how all nodes lie in their groups, */
    const duite_param *seen;              /* n_seen motions of groups, ascending */
    size_t n_seen;
};

/* s = M^-1 q but for the coarse part, of which `right` gets the right side, P' q of each patch.
 * Returns q.s. (preconditioner.c) */
double flow_precondition(const struct flow_preconditioner *m, const phys_vec *q, phys_vec *s,
                         double *right);

/* Adds the coarse part to s. The first half of a pass (solve_advance) for the ghosts of one
 * neighbour, with that part; halo: of its s. `at`: of all ghosts of the block, places in what is
 * read. (coarse.c) */
void flow_coarse_prolong(const struct flow_preconditioner *m, phys_vec *s);
void flow_coarse_advance_ghosts(const struct flow_preconditioner *m, uint32_t neighbour,
                                const struct solve_scalars *scalars, const double *halo,
                                const uint32_t *at, phys_vec *z, phys_vec *p);
/* The same for the ghosts of ties of the k-th other block, s and basis there. */
void flow_coarse_advance_ties(const struct flow_preconditioner *m, const struct flow_ties *ties,
                              uint32_t k, const struct solve_scalars *scalars, const double *s,
                              const phys_vec *basis, phys_vec *z, phys_vec *p);
/* P' q of each patch. */
void flow_coarse_restrict(const struct flow_preconditioner *m, const phys_vec *q, double *right);

/* Whether a pass with these scalars makes a new q, for which there is a coarse part of s. */
static inline bool flow_coarse_moves(const struct solve_scalars *scalars)
{
    return scalars->phase == SOLVE_ON || scalars->phase == SOLVE_AGAIN;
}

/* In the task of the scalars: the coarse part of s, of the parts of all blocks, or with levels of
 * the groups on top; how many parts there are. Returns its share in q.s. (coarse.c) */
static inline uint32_t flow_parts(const struct flow *flow)
{
    return flow->n_levels ? flow->level[flow->n_levels - 1].n_groups : flow->tables.n_blocks;
}
double flow_coarse_motion(const struct flow *flow, const double *factor, const duite_param *part,
                          double *motion);

/* ---- Sizes ---- */

/* What a preconditioned pass leaves of its block: the dots, then the coarse right side of each
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

/* The patch of a row of a block. */
uint32_t flow_patch_of(const struct flow *flow, uint32_t block, uint32_t row);

/* Whether the pattern has room for what couples two patches, or a patch with itself. */
bool flow_patches_joined(const struct flow *flow, uint32_t p, uint32_t q);

/* For patches p <= q: the number of 9 x 9 blocks before theirs in the coupling of p's block. That
 * has for each patch its own block and those with its neighbours behind it, of which q is one. */
size_t flow_coupling_at(const struct flow *flow, uint32_t p, uint32_t q);

#endif
