#ifndef CLOTH_SOLVE_LOCAL_H
#define CLOTH_SOLVE_LOCAL_H

#include "cloth/solve/block.h"

/* Preconditioners of one block of rows, made of B, the block's own part of S A S + (I - S). B has
 * the inner entries between free rows and the whole diagonals of the rows, to which entries into
 * other blocks, entries to held rows and ties add. They are symmetric and positive definite,
 * leave held rows at zero, and commute with S: a row that may move along a line or plane alone
 * stays in it. Pure functions; nothing is allocated. */
enum solve_local {
    SOLVE_IDENTITY, /* s is q: it has no factor, and nothing applies it */
    SOLVE_JACOBI,   /* the inverses of the 3 x 3 blocks on the diagonal */
    SOLVE_IC0 /* (I + T') E (I + T), the incomplete Cholesky factorisation in 3 x 3 blocks on the
               * pattern of B (Meijerink & van der Vorst 1977), exact where that has no fill but for
               * T in float */
};

/* How many doubles the factor of so many rows and inner entries has. */
size_t solve_local_doubles(size_t n, size_t entries, enum solve_local kind);

/* Makes the factor of a block, aligned to 32 bytes. A pivot of IC(0) may fail where B itself is
 * positive definite, or the factor be far from B. Then IC(0) is tried again with the diagonal of B
 * times 1.01, 1.05, 1.2 and 2 (Manteuffel 1980). If all fail the factor is that of SSOR, which
 * cannot fail. Returns how often it was tried again: 0 .. SOLVE_SSOR. */
enum { SOLVE_SSOR = 5 };
int solve_local_factor(const struct solve_block *block, const struct solve_cut *cut,
                       const void *values, enum solve_local kind, double *factor);

/* s = M^-1 q, of a q that is zero in held rows. Returns q.s. */
double solve_local_apply(const struct solve_block *block, enum solve_local kind,
                         const double *factor, const phys_vec *q, phys_vec *s);

#endif
