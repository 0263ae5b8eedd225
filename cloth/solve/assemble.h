#ifndef CLOTH_SOLVE_ASSEMBLE_H
#define CLOTH_SOLVE_ASSEMBLE_H

#include "cloth/physics/element.h"
#include "cloth/solve/format.h"

/* The values of half storage (cloth/solve/format.h), from any elements. Each entry is summed up
 * as a pair (cloth/physics/element.h), which is zero at first. An element of any number of vertices
 * adds its -A_ab to the entry of each two of them, in the order of the block's table. Sums of a cut
 * entry are the same on both sides if both add in the same order. When all have been added, the
 * values are made of the sums. Pure functions. */

/* Adds n springs (w0 w1 w2 alpha each), of which spring i belongs to entry at[i]. */
void solve_assemble_springs(size_t n, const uint32_t *at, const phys_vec *value,
                            struct phys_pair *sums);

/* Adds n pairs of elements. at: of each pair twice its entry, and one more where the entry's first
 * row is the pair's second. Such a pair is transposed, which its maker sees from the same numbers.
 * SOLVE_NO_ENTRY: none of the pair's rows is here. */
#define SOLVE_NO_ENTRY 0xffffffffu
void solve_assemble_pairs(size_t n, const uint32_t *at, const struct phys_pair *pair,
                          struct phys_pair *sums);

/* The values of n entries of format SOLVE_HALF from their sums: solve_format_doubles of them. */
void solve_assembled(size_t n, const struct phys_pair *sums, double *value);

#endif
