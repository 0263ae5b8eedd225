#ifndef CLOTH_SOLVE_PATCHES_H
#define CLOTH_SOLVE_PATCHES_H

#include "cloth/solve/coarse.h"

/* The rows of a block may have several sets of columns of P (cloth/solve/coarse.h), one for each
 * patch. A patch is a run of rows, which the order of rows keeps together. Patches take the place
 * of blocks there. Pure functions. */
enum { SOLVE_MAX_PATCHES = 4 };

/* Patch k has rows start[k] .. start[k + 1] - 1; behind the last one start is `rows`. */
struct solve_patches {
    uint32_t n;
    uint32_t start[SOLVE_MAX_PATCHES + 1];
};

/* n patches, 1 .. SOLVE_MAX_PATCHES, of so many rows; some are empty if there are fewer rows. */
static inline struct solve_patches solve_patches_of(uint32_t rows, uint32_t n)
{
    struct solve_patches patches = {.n = n};
    for (uint32_t k = 0; k <= SOLVE_MAX_PATCHES; k++)
        patches.start[k] = k < n ? (uint32_t)((uint64_t)rows * k / n) : rows;
    return patches;
}

/* The patch of a row. */
static inline uint32_t solve_patch_of(const struct solve_patches *patches, uint32_t row)
{
    uint32_t patch = 0;
    for (uint32_t k = 1; k < patches->n; k++)
        patch += row >= patches->start[k];
    return patch;
}

/* The bit for a coupling of patch k here with patch l there. */
static inline uint32_t solve_patch_bit(uint32_t k, uint32_t l)
{
    return UINT32_C(1) << (SOLVE_MAX_PATCHES * k + l);
}

/* Blocks of nine columns by nine, from patch k to patch l: matrix[k][l]. */
struct solve_couplings {
    double matrix[SOLVE_MAX_PATCHES][SOLVE_MAX_PATCHES][SOLVE_COUPLING];
};

/* Makes the couplings of inner entries and the diagonal: matrix[k][l] for k <= l. basis: of the
 * block's rows. */
void solve_couple_patches(const struct solve_block *block, const struct solve_patches *patches,
                          const void *values, const phys_vec *basis, struct solve_couplings *own);

/* Adds n entries into one other block, at `from` among the values, to the diagonal of `own`. Sets
 * off_diagonal, this block's patches by the other's. end: own row, row in other_basis. other: the
 * patches of the other block. */
void solve_couple_patches_cut(const struct solve_block *block, const struct solve_patches *patches,
                              const void *values, size_t from, size_t n, const uint32_t (*end)[2],
                              const phys_vec *basis, const phys_vec *other_basis,
                              const struct solve_patches *other, struct solve_couplings *own,
                              struct solve_couplings *off_diagonal);

#endif
