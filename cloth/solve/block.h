#ifndef CLOTH_SOLVE_BLOCK_H
#define CLOTH_SOLVE_BLOCK_H

#include "cloth/solve/cg.h"
#include "cloth/solve/format.h"

#include <stddef.h>
#include <stdint.h>

/* One block of rows of the matrix of an implicit step, A = diagonal + entries, in any format
 * (cloth/solve/format.h). Entries with both ends in the block are stored once, in the row of their
 * lower end. Entries between two blocks are stored in both, each for its own row. In half storage
 * two rows share one entry at most; each spring is an entry of its own. The system is S A S dv = S
 * b (Baraff & Witkin 1998), S = free times the filter of each row. */
struct solve_block {
    size_t n;               /* rows */
    const double *diagonal; /* n: mass + h (drag), kg, > 0 */
    const double *free;     /* n: 1, or 0 for a particle that is held */
    const uint32_t *row;    /* n + 1: the inner entries of row a are row[a] .. row[a + 1] - 1 */
    const uint32_t *column; /* row[n]: the higher end of each inner entry, ascending in a row */
    uint32_t span;          /* no inner entry ends more rows away */
    enum solve_format format;
    const phys_vec *filter; /* n: rows of S that are more than free (solve_filter); NULL: none */
};

/* A row's part of S: c I + (1 - 2 c) d d', c and d given as d0 d1 d2 c. All is free: 0 0 0 1; held
 * in a plane: its normal, 1; on a line: its direction, 0; at a point: 0 0 0 0. Directions have
 * length 1. */
PHYS_INLINE void solve_filter(const phys_vec *filter, phys_vec *y)
{
    const phys_vec three = {1, 1, 1, 0}, d = *filter * three;
    const double c = (*filter)[3];
    *y = c * *y + ((1 - 2 * c) * phys_dot(&d, y)) * d;
}

/* Ties join rows for some solves only, in a block of any format. A tie has up to four corners with
 * weights w_k. It adds w_i w_k N to row i and column k, N a value of SOLVE_SPRINGS: with u the sum
 * of w_k p_k it adds w_i N u to row i. Every block with a corner knows the whole tie. Ties that add
 * nothing may be left out. Corners that are rows of the block come first, and ties of as many of
 * them are side by side: a product then has no branch, which no processor would predict. */
enum { SOLVE_TIE_CORNERS = 4 };

/* Kinds of ties, in their order: one corner alone; 1, 2 or 3 rows, the other corners ghosts; rows
 * alone. */
enum { SOLVE_TIE_ALONE, SOLVE_TIE_INNER = SOLVE_TIE_CORNERS, SOLVE_TIE_KINDS };

struct solve_ties {
    size_t n;
    const uint32_t
        *start; /* SOLVE_TIE_KINDS + 1: ties of kind k are start[k] .. start[k + 1] - 1 */
    const uint32_t (*corner)[SOLVE_TIE_CORNERS]; /* n: rows; those behind the block's are ghosts */
    const double (*weight)[SOLVE_TIE_CORNERS];   /* n: 0: it has no such corner, but any number */
    const phys_vec *value;                       /* n */
    const phys_vec *p_other;                     /* p of the ghosts */
};

/* Entries into other blocks, whose values follow those of the inner ones: `own` the row here,
 * `other` the row in an array of ghosts. The halo is the rows that they, and ties, end at here. */
struct solve_cut {
    size_t n;
    const uint32_t (*end)[2]; /* n: own, other */
    size_t n_halo;
    const uint32_t *halo;          /* n_halo: ascending */
    const struct solve_ties *ties; /* NULL: none */
};

/* The vectors of a block, n rows each. z = M^-1 r and s = M^-1 q, M the preconditioner
 * (cloth/solve/local.h, coarse.h); without one z is r and s is q. */
struct solve_rows {
    phys_vec *dv, *r, *p, *q, *z, *s;
};

/* Those of a solve without a preconditioner. */
static inline struct solve_rows solve_rows_plain(phys_vec *dv, phys_vec *r, phys_vec *p,
                                                 phys_vec *q)
{
    return (struct solve_rows){dv, r, p, q, .z = r, .s = q};
}

/* A pass over a block (cloth/solve/cg.h), without the factors. With a preconditioner, its function
 * makes s and q.s from the new q afterwards. values: of the entries, in the block's format.
 * p_other: p of the ghosts after the first half of this pass. */
void solve_pass(const struct solve_block *block, const struct solve_cut *cut, const void *values,
                const phys_vec *p_other, double alpha, double beta, const struct solve_rows *rows,
                double dots[SOLVE_DOTS]);

/* SOLVE_CHECK: r = S (b - A dv), of dv as it is; dv_other: that of the ghosts. p becomes dv, q
 * becomes S A dv. Writes r.r, the drift, and the norms of both. */
void solve_residual(const struct solve_block *block, const struct solve_cut *cut,
                    const void *values, const phys_vec *b, const phys_vec *dv_other,
                    const struct solve_rows *rows, double dots[SOLVE_DOTS]);

/* SOLVE_OPEN, after solve_start_guess: p is the guess, q = S A p, dv = 0. guess_other: of the
 * ghosts. Writes r.r, p.q, and p.r as RQ. */
void solve_open(const struct solve_block *block, const struct solve_cut *cut, const void *values,
                const phys_vec *guess_other, const struct solve_rows *rows,
                double dots[SOLVE_DOTS]);

/* Adds the sum over the free rows of b - A dv to lost[3] (kg m/s), for a dv that is zero where
 * particles are held. The entries between free rows cancel in this sum, wherever their ends are;
 * those to held ends remain. They are given by their free row and their place among the values. */
struct solve_held {
    size_t n;
    const uint32_t (*at)[2]; /* n: row, place */
};
void solve_lost(const struct solve_block *block, const struct solve_held *held, const void *values,
                const phys_vec *b, const phys_vec *dv, double lost[3]);

#endif
