/* Entries between two patches are gathered, and added when there are some: kernels add many to one
 * pair of patches. Their order is that of the values. */
#include "cloth/solve/patches.h"

#include <string.h>

enum { MANY = 64 };

/* Entries from one patch to another. */
struct gathered {
    uint32_t n, at[MANY], end[MANY][2];
};

struct gathering {
    const struct solve_block *block;
    const void *values;
    const phys_vec *basis, *other_basis;
    struct gathered pair[SOLVE_MAX_PATCHES][SOLVE_MAX_PATCHES];
    struct solve_couplings *own, *off_diagonal;
    bool inside; /* both ends are of this block */
};

/* Adds the far end's own share of an inner entry; the coupling was added from the near end. */
static void add_far(const struct gathering *all, const struct gathered *gathered, double *own)
{
    double off_diagonal[SOLVE_COUPLING] = {0};
    uint32_t end[MANY][2];
    for (uint32_t i = 0; i < gathered->n; i++) {
        end[i][0] = gathered->end[i][1];
        end[i][1] = gathered->end[i][0];
    }
    solve_couple_cut(all->block, all->values, gathered->n, gathered->at, (const uint32_t(*)[2])end,
                     all->other_basis, all->basis, own, off_diagonal);
}

static void flush(struct gathering *all, uint32_t k, uint32_t l)
{
    struct gathered *gathered = &all->pair[k][l];
    if (!gathered->n)
        return;
    solve_couple_cut(all->block, all->values, gathered->n, gathered->at,
                     (const uint32_t(*)[2])gathered->end, all->basis, all->other_basis,
                     all->own->matrix[k][k], all->off_diagonal->matrix[k][l]);
    if (all->inside)
        add_far(all, gathered, all->own->matrix[l][l]);
    gathered->n = 0;
}

static void patches_gather(struct gathering *all, uint32_t k, uint32_t l, uint32_t at,
                           uint32_t here, uint32_t there)
{
    struct gathered *gathered = &all->pair[k][l];
    gathered->at[gathered->n] = at;
    gathered->end[gathered->n][0] = here;
    gathered->end[gathered->n][1] = there;
    if (++gathered->n == MANY)
        flush(all, k, l);
}

static void flush_all(struct gathering *all)
{
    for (uint32_t k = 0; k < SOLVE_MAX_PATCHES; k++)
        for (uint32_t l = 0; l < SOLVE_MAX_PATCHES; l++)
            flush(all, k, l);
}

static void patches_begin(struct gathering *all)
{
    for (uint32_t k = 0; k < SOLVE_MAX_PATCHES; k++)
        for (uint32_t l = 0; l < SOLVE_MAX_PATCHES; l++)
            all->pair[k][l].n = 0;
}

void solve_couple_patches(const struct solve_block *block, const struct solve_patches *patches,
                          const void *values, const phys_vec *basis, struct solve_couplings *own)
{
    struct gathering all;
    patches_begin(&all);
    all.block = block;
    all.values = values;
    all.basis = all.other_basis = basis;
    all.own = all.off_diagonal = own;
    all.inside = true;
    memset(own, 0, sizeof *own);
    for (uint32_t k = 0; k < patches->n; k++)
        solve_couple(block, patches->start[k], patches->start[k + 1], values, basis,
                     own->matrix[k][k]);
    for (uint32_t k = 0; k + 1 < patches->n; k++)
        for (uint32_t a = patches->start[k]; a < patches->start[k + 1]; a++) {
            uint32_t i = block->row[a + 1]; /* those that leave the patch come last */
            while (i > block->row[a] && block->column[i - 1] >= patches->start[k + 1])
                i--;
            for (; i < block->row[a + 1]; i++)
                patches_gather(&all, k, solve_patch_of(patches, block->column[i]), i, a,
                               block->column[i]);
        }
    flush_all(&all);
}

void solve_couple_patches_cut(const struct solve_block *block, const struct solve_patches *patches,
                              const void *values, size_t from, size_t n, const uint32_t (*end)[2],
                              const phys_vec *basis, const phys_vec *other_basis,
                              const struct solve_patches *other, struct solve_couplings *own,
                              struct solve_couplings *off_diagonal)
{
    struct gathering all;
    patches_begin(&all);
    all.block = block;
    all.values = values;
    all.basis = basis;
    all.other_basis = other_basis;
    all.own = own;
    all.off_diagonal = off_diagonal;
    all.inside = false;
    memset(off_diagonal, 0, sizeof *off_diagonal);
    for (size_t i = 0; i < n; i++)
        patches_gather(&all, solve_patch_of(patches, end[i][0]), solve_patch_of(other, end[i][1]),
                       (uint32_t)(from + i), end[i][0], end[i][1]);
    flush_all(&all);
}
