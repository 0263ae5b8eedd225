/* Patches of blocks add P' A P to the coarse matrix, each patch with columns of its own, in every
 * format, with rows that are held and rows in contact. */
#include "cloth/solve/patches.h"
#include "tests/cloth/solve/system.h"
#include "tests/support/unit.h"

#include <stdlib.h>
#include <string.h>

static struct system sys;
static phys_vec basis[SYSTEM_ROWS]; /* of all rows */

static struct solve_patches patches_of(uint32_t b, uint32_t n)
{
    return solve_patches_of((uint32_t)sys.block[b].matrix.n, n);
}

static void cut(uint32_t n_blocks, uint32_t n_patches)
{
    system_cut(&sys, n_blocks);
    for (uint32_t b = 0; b < n_blocks; b++) {
        const struct system_block *block = sys.block + b;
        const struct solve_patches patches = patches_of(b, n_patches);
        for (uint32_t k = 0; k < n_patches; k++) {
            const uint32_t from = patches.start[k];
            solve_basis(patches.start[k + 1] - from, block->free + from, block->position + from,
                        basis + block->first + from);
        }
        if (block->matrix.filter)
            solve_basis_filter(block->matrix.n, block->matrix.filter, basis + block->first);
    }
}

static void make(uint32_t n_blocks, uint32_t n_patches)
{
    system_sheet(&sys, 8, 8, 20);
    system_turn(&sys, 2);
    for (uint32_t a = 0; a < sys.n; a++)
        sys.free[a] = rand() % 7 != 0;
    if (sys.filtered)
        system_filter(&sys, false);
    cut(n_blocks, n_patches);
}

/* Column i of P of patch k of a block, over all rows. */
static void column_of(uint32_t b, const struct solve_patches *patches, uint32_t k, int i,
                      phys_vec *y)
{
    const uint32_t from = sys.block[b].first + patches->start[k];
    double x[SOLVE_COARSE] = {0};
    x[i] = 1;
    memset(y, 0, sys.n * sizeof *y);
    solve_prolong(patches->start[k + 1] - patches->start[k], basis + from, x, y + from);
}

struct patch {
    uint32_t block, k, n;
};

static void check(const struct patch *here, const struct patch *there, const double *matrix)
{
    phys_vec column[SYSTEM_ROWS], product[SYSTEM_ROWS], row[SYSTEM_ROWS];
    const struct solve_patches p = patches_of(here->block, here->n);
    const struct solve_patches q = patches_of(there->block, there->n);
    for (int j = 0; j < SOLVE_COARSE; j++) {
        column_of(there->block, &q, there->k, j, column);
        system_multiply(&sys, column, product);
        for (int i = 0; i < SOLVE_COARSE; i++) {
            column_of(here->block, &p, here->k, i, row);
            ck_assert_double_eq_tol(matrix[SOLVE_COARSE * i + j], system_dot(&sys, row, product),
                                    1e-10);
        }
    }
}

/* The entries of a block into the one behind it: strips meet no other. */
static void couple_next(uint32_t b, uint32_t n, struct solve_couplings *own,
                        struct solve_couplings *off_diagonal)
{
    const struct system_block *block = sys.block + b, *next = block + 1;
    const struct solve_patches patches = patches_of(b, n);
    struct solve_patches others = patches_of(b + 1, n);
    uint32_t end[SYSTEM_SPRINGS][2], from = UINT32_MAX, count = 0;
    for (uint32_t i = 0; i < block->cut.n; i++) {
        const uint32_t other = block->ghost[block->cut.end[i][1]];
        if (other < next->first)
            continue;
        from = from < i ? from : i;
        end[count][0] = block->cut.end[i][0];
        end[count++][1] = other;
    }
    for (uint32_t k = 0; k <= SOLVE_MAX_PATCHES; k++)
        others.start[k] += next->first;
    solve_couple_patches_cut(&block->matrix, &patches, block->value,
                             block->row[block->matrix.n] + from, count, (const uint32_t(*)[2])end,
                             basis + block->first, basis, &others, own, off_diagonal);
}

UNIT_LOOP(matrix_of_patches, 0, 6)
{
    static struct solve_couplings own, off_diagonal;
    srand(1);
    sys.format = (enum solve_format)(_i % 3);
    sys.filtered = _i > 2;
    for (uint32_t n = 1; n <= SOLVE_MAX_PATCHES; n++) {
        make(2, n);
        const struct solve_patches patches = patches_of(0, n);
        solve_couple_patches(&sys.block[0].matrix, &patches, sys.block[0].value, basis, &own);
        couple_next(0, n, &own, &off_diagonal);
        for (uint32_t k = 0; k < n; k++)
            for (uint32_t l = 0; l < n; l++) {
                const struct patch here = {0, k, n}, there = {0, l, n}, other = {1, l, n};
                if (k <= l)
                    check(&here, &there, own.matrix[k][l]);
                check(&here, &other, off_diagonal.matrix[k][l]);
            }
    }
}

/* So many entries between two patches that they are added in several goes. */
UNIT_TEST(many_entries)
{
    static struct solve_couplings own;
    const struct patch one = {0, 0, 2}, two = {0, 1, 2};
    const struct solve_patches patches = solve_patches_of(SYSTEM_ROWS, 2);
    srand(2);
    sys.format = SOLVE_SPRINGS;
    sys.filtered = false;
    system_sheet(&sys, 8, 8, 20);
    sys.n_springs = 0;
    for (uint32_t a = 0; a < patches.start[1]; a++)
        for (uint32_t j = 0; j < 3; j++, sys.n_springs++) {
            sys.end[sys.n_springs][0] = a;
            sys.end[sys.n_springs][1] = patches.start[1] + 10 * j + a % 10;
            sys.value[sys.n_springs] = (phys_vec){system_draw(), system_draw(), system_draw(), 3};
        }
    cut(1, 2);
    solve_couple_patches(&sys.block[0].matrix, &patches, sys.block[0].value, basis, &own);
    check(&one, &one, own.matrix[0][0]);
    check(&one, &two, own.matrix[0][1]);
    check(&two, &two, own.matrix[1][1]);
}

UNIT_TEST(rows_of_patches)
{
    for (uint32_t rows = 0; rows < 10; rows++)
        for (uint32_t n = 1; n <= SOLVE_MAX_PATCHES; n++) {
            const struct solve_patches patches = solve_patches_of(rows, n);
            ck_assert_uint_eq(patches.start[0], 0);
            for (uint32_t k = n; k <= SOLVE_MAX_PATCHES; k++)
                ck_assert_uint_eq(patches.start[k], rows);
            for (uint32_t a = 0; a < rows; a++) {
                const uint32_t k = solve_patch_of(&patches, a);
                ck_assert_uint_lt(k, n);
                ck_assert(patches.start[k] <= a && a < patches.start[k + 1]);
            }
        }
}
