#ifndef BENCH_CG_PARTS_H
#define BENCH_CG_PARTS_H

#include "bench/cg/state.h"
#include "cloth/solve/block.h"

/* A state cut into contiguous parts of its order, for plain loops with the kernels of the cloth:
 * springs inside a part once, springs between parts on both sides, and in each part ghosts, the
 * rows that they end at, as the cloth's blocks have them. */
struct part {
    struct solve_block matrix;
    struct solve_cut cut;
    struct solve_rows rows;
    phys_vec *value, *ghost_r, *ghost_p, *b;
    uint32_t n_ghosts, first; /* first: place of row 0 */
    uint32_t *ghosts;         /* n_parts + 1: those of part s are ghosts[s] .. */
    uint32_t *at;             /* n_ghosts: places in the halo of their part */
    double *halo[2];          /* three numbers a row */
    void *owned[8];           /* what the matrix and the cut point to */
};

struct parts {
    uint32_t n;
    struct part *part;
    uint32_t *start; /* n + 1: places */
};

/* About `size` vertices each, `least` parts at least; 0: just as many. 0, or what serve_fail
 * returns. */
int parts_make(struct parts *parts, const struct state *state, uint32_t size, uint32_t least);
void parts_free(struct parts *parts);

/* dv of all parts in the numbering of the state, n x 3. */
void parts_answer(const struct parts *parts, const struct state *state, double *dv);

#endif
