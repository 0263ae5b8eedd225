/* Each entry is summed in the order of the block's table, so both blocks of a cut entry have the
 * same bits. */
#include "cloth/solve/assemble.h"

PHYS_KERNEL(solve_assemble_springs,
            (size_t n, const uint32_t *at, const phys_vec *value, struct phys_pair *sums),
            (n, at, value, sums))
{
    for (size_t i = 0; i < n; i++) {
        struct solve_symmetric m;
        struct phys_pair *sum = sums + at[i];
        solve_spring(value + i, &m);
        sum->cyclic[0] += m.diagonal;
        sum->cyclic[1] += m.off_diagonal;
        sum->cyclic[2] += SOLVE_ZXY(m.off_diagonal);
    }
}

PHYS_KERNEL(solve_assemble_pairs,
            (size_t n, const uint32_t *at, const struct phys_pair *pair, struct phys_pair *sums),
            (n, at, pair, sums))
{
    for (size_t i = 0; i < n; i++) {
        if (at[i] == SOLVE_NO_ENTRY)
            continue;
        struct phys_pair *sum = sums + (at[i] >> 1);
        sum->cyclic[0] += pair[i].cyclic[0];
        sum->cyclic[1] += pair[i].cyclic[1];
        sum->cyclic[2] += pair[i].cyclic[2];
    }
}

/* Four numbers are written of each three: the fourth, a zero, is where the next three begin, or the
 * one behind all. So all memory of the values is written. */
PHYS_KERNEL(solve_assembled, (size_t n, const struct phys_pair *sums, double *value),
            (n, sums, value))
{
    value[SOLVE_NINE * n] = 0;
    for (size_t i = 0; i < n; i++) {
        PHYS_UNROLL
        for (size_t k = 0; k < 3; k++)
            *(solve_four *)(void *)(value + SOLVE_NINE * i + 3 * k) = sums[i].cyclic[k];
    }
}
