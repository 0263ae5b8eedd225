#ifndef CLOTH_SOLVE_SYSTEM_H
#define CLOTH_SOLVE_SYSTEM_H

#include "cloth/base/error.h"

#include <stddef.h>
#include <stdint.h>

/* The system of one implicit step in plain arrays and the input's numbering, for other uses: S A S
 * dv = S b with S = diag(free) and
 *
 *     A = diagonal + the sum over the pairs of their N (cloth/solve/format.h),
 *
 * where a pair of vertices a, b adds -N to block (a, b), -N' to (b, a), and (N + N') / 2 to (a, a)
 * and (b, b). Vertices that nothing uses have mass, diagonal and free of zero. */
struct solve_system {
    uint32_t n;                     /* vertices */
    double h;                       /* s */
    double *mass, *diagonal, *free; /* n: kg; kg, mass + h drag; 1, or 0 where held */
    double *b, *dv;                 /* n x 3: kg m/s; m/s, as the step found it */
    double *x, *v;                  /* n x 3: m, m/s after the step */
    size_t n_pairs;
    uint32_t (*end)[2]; /* n_pairs: lower vertex, higher; sorted by both */
    /* One of these is there, the other NULL. */
    double (*value)[4]; /* n_pairs: springs, w0 w1 w2 alpha (phys_springs_matrix) */
    double (*block)[9]; /* n_pairs: N of the lower vertex towards the higher, by rows */
};

/* Zeroed arrays of these sizes; of springs or of any pairs. Error: CLOTH_E_MEMORY, and nothing is
 * left to be freed. Local. */
enum solve_pairs { SOLVE_PAIRS_OF_SPRINGS, SOLVE_PAIRS_OF_BLOCKS };
int solve_system_make(struct solve_system *system, uint32_t n, size_t n_pairs,
                      enum solve_pairs pairs, struct cloth_error *error);

/* N of a pair, of either kind. Local. */
void solve_system_pair(const struct solve_system *system, size_t i, double n[3][3]);

/* Sorts the ends of each pair, and the pairs. Pairs of equal ends keep their order. Error:
 * CLOTH_E_MEMORY. Local. */
int solve_system_sort(struct solve_system *system, struct cloth_error *error);

/* y = S A S p, n x 3 each. Local. */
void solve_system_multiply(const struct solve_system *system, const double *p, double *y);

/* Frees the arrays and clears the structure; a zeroed one is fine. */
void solve_system_free(struct solve_system *system);

#endif
