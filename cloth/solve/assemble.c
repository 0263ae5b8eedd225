/* Entries are rounded one by one; turns are summed over what they were rounded to, in the order of
 * entries. */
#include "cloth/solve/assemble.h"

#include "cloth/solve/format.h"

#include <string.h>

void solve_assemble_springs(size_t n, const uint32_t *at, const phys_vec *value, double *sums)
{
    for (size_t i = 0; i < n; i++) {
        double *sum = sums + SOLVE_NINE * (size_t)at[i];
        const double x = value[i][0], y = value[i][1], z = value[i][2], alpha = value[i][3];
        const double nine[SOLVE_NINE] = {x * x + alpha, y * y + alpha, z * z + alpha, x * y, y * z,
                                         z * x,         z * x,         x * y,         y * z};
        for (int k = 0; k < SOLVE_NINE; k++)
            sum[k] += nine[k];
    }
}

void solve_assemble_pairs(size_t n, const uint32_t *at, const struct phys_pair *pair, double *sums)
{
    for (size_t i = 0; i < n; i++) {
        if (at[i] == SOLVE_NO_ENTRY)
            continue;
        double *sum = sums + SOLVE_NINE * (size_t)(at[i] >> 1);
        const phys_vec *upper = pair[i].cyclic + 1, *lower = pair[i].cyclic + 2;
        const phys_vec one = at[i] & 1 ? SOLVE_YZX(*lower) : *upper;
        const phys_vec two = at[i] & 1 ? SOLVE_ZXY(*upper) : *lower;
        for (int k = 0; k < 3; k++) {
            sum[k] += pair[i].cyclic[0][k];
            sum[3 + k] += one[k];
            sum[6 + k] += two[k];
        }
    }
}

/* Adds the turn of N to row a, and that of N' to row b, if b is here. */
static void add_turns(const struct solve_block *block, const struct solve_cut *cut,
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

void solve_assembled(const struct solve_block *block, const struct solve_cut *cut,
                     const double *sums, double *memory)
{
    const size_t n = SOLVE_NINE * (block->row[block->n] + cut->n);
    if (block->format == SOLVE_HALF) {
        memmove(memory, sums, n * sizeof *memory);
        memory[n] = 0;
        return;
    }
    phys_vec *turn = (phys_vec *)(void *)memory;
    float *value = (float *)(void *)(turn + block->n);
    for (size_t i = 0; i < n; i++)
        value[i] = (float)sums[i];
    value[n] = 0;
    memset(turn, 0, block->n * sizeof *turn);
    add_turns(block, cut, value, turn);
}
