#ifndef CLOTH_FLOW_SOLVER_SOLVER_H
#define CLOTH_FLOW_SOLVER_SOLVER_H

#include "cloth/flow/state/bodies.h"

/* Shared by the files of the solver. In reading order: system.c makes the system of a step. cg.c
 * solves it, in rounds of passes (pass.c), with a preconditioner that may have a coarse part
 * (coarse.c). halo.c and ties.c bring other blocks' data to a pass. pieces.c corrects the momentum
 * of free pieces after a solve.
 *
 * Patch k of block b has the number flow->patches * b + k. */

/* ---- Tasks of a solve. Collective. They return 0 or what duite_fork returned ---- */

/* The first forks the vectors of blocks first .. end - 1 before the first pass, and the halos that
 * neighbours read. They begin with `guess` times dv, or with zero (0). The second forks pass number
 * state->pass of a recorded round on all blocks. (pass.c) */
int flow_pass_start(struct flow_state *state, uint32_t first, uint32_t end, double guess);
int flow_pass_fork(struct flow_state *state);

/* Fork the tasks that show a block's corners of ties into other blocks, if it has any. The first
 * serves the first pass of a solve, the second the next pass of a recorded round. The third shows
 * the coarse functions there, of all blocks, once a solve. (ties.c) */
int flow_ties_pack_start(struct flow_state *state, uint32_t block, bool guess);
int flow_ties_pack(struct flow_state *state, uint32_t block);
int flow_ties_show_basis(struct flow_state *state);

/* Fork the factors of a step's matrix before its solve: the coarse one; those of blocks. Each does
 * nothing if there is none. (coarse.c, pass.c) */
int flow_coarse_start(struct flow_state *state);
int flow_pass_factor(struct flow_state *state, uint32_t first, uint32_t end);

/* Forks the tasks that correct dv by the momentum that a solve lost to free pieces, if there are
 * any. (pieces.c) */
int flow_pieces_fork(struct flow_state *state);

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

/* The first adds the coarse part to s. The second is the first half of a pass (solve_advance) for
 * the ghosts of one neighbour, with that part; halo: of its s; `at`: of all ghosts of the block,
 * their places in the halos read. (coarse.c) */
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

/* True if a pass with these scalars makes a new q, and so needs a coarse part of s. */
static inline bool flow_coarse_moves(const struct solve_scalars *scalars)
{
    return scalars->phase == SOLVE_ON || scalars->phase == SOLVE_AGAIN;
}

/* In the task of the scalars: the number of parts, those of all blocks or, with levels, of the
 * groups on top; then the coarse part of s from these parts. Returns its share in q.s.
 * (coarse.c) */
static inline uint32_t flow_parts(const struct flow *flow)
{
    return flow->n_levels ? flow->level[flow->n_levels - 1].n_groups : flow->tables.n_blocks;
}
double flow_coarse_motion(const struct flow *flow, const double *factor, const duite_param *part,
                          double *motion);

/* ---- Sizes ---- */

/* The part of a block after a preconditioned pass: the dots, then the coarse right side of each
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

/* True if the pattern has room for the coupling of two patches, or of a patch with itself. */
bool flow_patches_joined(const struct flow *flow, uint32_t p, uint32_t q);

/* For patches p <= q: the number of 9 x 9 blocks before theirs in the coupling of p's block. The
 * coupling has each patch's own block, then those with its later neighbours, q among them. */
size_t flow_coupling_at(const struct flow *flow, uint32_t p, uint32_t q);

#endif
