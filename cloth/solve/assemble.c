/* Entries are rounded one by one; turns are summed over the rounded entries, in their order. */
#include "cloth/solve/assemble.h"

#include "cloth/solve/format.h"

#include <string.h>

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

/* Adds the turn of N to row a, and that of N' to row b, if b is here. */
PHYS_INLINE void add_turns(const struct solve_block *block, const struct solve_cut *cut,
                           const void *entry, phys_vec *turn)
{
    struct solve_symmetric symmetric;
    const size_t inner = block->row[block->n];
    phys_vec w;
    for (size_t a = 0; a < block->n; a++)
        for (size_t i = block->row[a]; i < block->row[a + 1]; i++) {
            solve_entry_of(SOLVE_HALF_FLOAT, entry, i, &symmetric, &w);
            turn[a] += w;
            turn[block->column[i]] -= w;
        }
    for (size_t i = 0; i < cut->n; i++) {
        solve_entry_of(SOLVE_HALF_FLOAT, entry, inner + i, &symmetric, &w);
        turn[cut->end[i][0]] += w;
    }
}

/* Four numbers are written of each three: the fourth, a zero, is where the next three begin, or the
 * one behind all. So all memory of the values is written; floats may fill half of the last double.
 */
PHYS_INLINE void write_doubles(size_t n, const struct phys_pair *sums, double *value)
{
    value[SOLVE_NINE * n] = 0;
    for (size_t i = 0; i < n; i++) {
        PHYS_UNROLL
        for (size_t k = 0; k < 3; k++)
            *(solve_four *)(void *)(value + SOLVE_NINE * i + 3 * k) = sums[i].cyclic[k];
    }
}

PHYS_INLINE void write_floats(size_t n, const struct phys_pair *sums, float *value)
{
    value[SOLVE_NINE * n] = 0;
    if (n % 2 == 0)
        value[SOLVE_NINE * n + 1] = 0;
    for (size_t i = 0; i < n; i++) {
        PHYS_UNROLL
        for (size_t k = 0; k < 3; k++) {
            const phys_vec *a = sums[i].cyclic + k;
            *(solve_four_floats *)(void *)(value + SOLVE_NINE * i + 3 * k) =
                (solve_four_floats){(float)(*a)[0], (float)(*a)[1], (float)(*a)[2], (float)(*a)[3]};
        }
    }
}

PHYS_KERNEL(solve_assembled,
            (const struct solve_block *block, const struct solve_cut *cut,
             const struct phys_pair *sums, double *memory),
            (block, cut, sums, memory))
{
    const size_t n = block->row[block->n] + cut->n;
    if (block->format == SOLVE_HALF) {
        write_doubles(n, sums, memory);
        return;
    }
    phys_vec *turn = (phys_vec *)(void *)memory;
    float *value = (float *)(void *)(turn + block->n);
    write_floats(n, sums, value);
    memset(turn, 0, block->n * sizeof *turn);
    add_turns(block, cut, value, turn);
}
