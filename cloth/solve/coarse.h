#ifndef CLOTH_SOLVE_COARSE_H
#define CLOTH_SOLVE_COARSE_H

#include "cloth/base/error.h"
#include "cloth/solve/block.h"

/* The coarse part of a two-level preconditioner, P C^-1 P' (Nicolaides 1987). P has nine columns a
 * block: a uniform motion, and motions that grow along u and v, two axes of the block at rest. P is
 * zero in held rows, so that P' and C = P' A P are of the filtered system. A block adds to C its
 * diagonal 9 x 9 block and one for each later neighbour. C is kept in 9 x 9 blocks on its sparse
 * pattern and factorised in an order of least degree. Columns that add nothing (a block that is
 * held, two vertices, vertices on a line) are dropped. So the sum with another preconditioner
 * remains positive definite. Pure functions but for solve_pattern. */
enum { SOLVE_COARSE = 9, SOLVE_COUPLING = SOLVE_COARSE * SOLVE_COARSE };

/* Row a of P: 1 u v 0 for each of x, y and z; zero where the row is held. */
void solve_basis(size_t n, const double *free, const phys_vec *position, phys_vec *basis);

/* Takes out of the basis of n rows the axes that their filters (cloth/solve/block.h) hold; where a
 * filter is not along axes, the whole row. Lane 3 of a row says which: 1 for x, 2 for y, 4 for z.
 */
void solve_basis_filter(size_t n, const phys_vec *filter, phys_vec *basis);

/* Makes the diagonal block of rows from .. to - 1 and the entries among them, row by row, own[3 k +
 * c][3 l + d]: function k along axis c. */
void solve_couple(const struct solve_block *block, size_t from, size_t to, const void *values,
                  const phys_vec *basis, double own[SOLVE_COUPLING]);

/* Adds n entries, numbers at[] of the values, from rows of one set of columns to rows of another.
 * They go to `own`, the diagonal block of the first set, and to off_diagonal, its rows by the
 * columns of the other set. end: own row, row in other_basis. */
void solve_couple_cut(const struct solve_block *block, const void *values, size_t n,
                      const uint32_t *at, const uint32_t (*end)[2], const phys_vec *basis,
                      const phys_vec *other_basis, double own[SOLVE_COUPLING],
                      double off_diagonal[SOLVE_COUPLING]);

/* P' of one row with a weight, or the sum over several rows: [3 k + c] of function k along axis c.
 */
struct solve_lifted {
    double c[SOLVE_COARSE];
};
void solve_lift_corner(double weight, const phys_vec *basis, struct solve_lifted *sum);

/* Adds a N b', N a value of SOLVE_SPRINGS, to a block of C. */
void solve_couple_lifted(const phys_vec *value, const struct solve_lifted *a,
                         const struct solve_lifted *b, double block[SOLVE_COUPLING]);

/* P' y of a block; y += P x of a block. */
void solve_restrict(size_t n, const phys_vec *basis, const phys_vec *y, double x[SOLVE_COARSE]);
void solve_prolong(size_t n, const phys_vec *basis, const double x[SOLVE_COARSE], phys_vec *y);

/* solve_advance_ghosts (cloth/solve/cg.h) for an s that still lacks P x: of ghosts of one other
 * block, whose x is given. They get the bits that solve_prolong leaves there. */
void solve_advance_ghosts_coarse(size_t n, double alpha, double beta, const double *s,
                                 const uint32_t *at, const phys_vec *basis,
                                 const double x[SOLVE_COARSE], phys_vec *z, phys_vec *p);

/* The pattern of the factor. Memory is its own. */
struct solve_pattern {
    uint32_t n;
    uint32_t *block; /* n: in the order of elimination */
    uint32_t *place; /* n: of each block in that order */
    uint32_t *first; /* n + 1: the entries of column k are first[k] .., its diagonal block not among
                      * them */
    uint32_t *row;   /* places, ascending in a column */
};

/* A neighbour that the pattern does not have: its couplings are left out. */
#define SOLVE_LEFT_OUT UINT32_MAX

/* Makes the pattern from the neighbours of each block: those of block b are neighbour[first[b]] ..
 * neighbour[first[b + 1] - 1]. Time grows as n^3: many blocks are solved by parts
 * (cloth/solve/levels.h). Error: CLOTH_E_MEMORY. Local. */
int solve_pattern_make(struct solve_pattern *pattern, uint32_t n, const uint32_t *first,
                       const uint32_t *neighbour, struct cloth_error *error);
void solve_pattern_free(struct solve_pattern *pattern);

/* Doubles of a factor, aligned to 32 bytes. */
size_t solve_coarse_doubles(const struct solve_pattern *pattern);

/* Puts the coupling of block b into the factor: its diagonal block, then one for each neighbour
 * with a higher number, ascending. first and neighbour as above. solve_coarse_clear comes once,
 * before all blocks. */
void solve_coarse_clear(const struct solve_pattern *pattern, double *factor);
void solve_coarse_fill(const struct solve_pattern *pattern, const uint32_t *first,
                       const uint32_t *neighbour, uint32_t b, const double *coupling,
                       double *factor);

/* Factorises the filled matrix. Returns how many columns were dropped. */
uint32_t solve_coarse_factor(const struct solve_pattern *pattern, double *factor);

/* A vector of the coarse space, aligned to 32 bytes: SOLVE_COARSE_STRIDE doubles a block, nine of
 * them its own and three zero, in the order of elimination. */
enum { SOLVE_COARSE_STRIDE = 12 };
static inline size_t solve_coarse_at(const struct solve_pattern *pattern, uint32_t b)
{
    return SOLVE_COARSE_STRIDE * (size_t)pattern->place[b];
}

/* x = C^-1 x. */
void solve_coarse_solve(const struct solve_pattern *pattern, const double *factor, double *x);

#endif
