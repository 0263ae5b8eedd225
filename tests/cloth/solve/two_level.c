/* Blocks know each other by their ghosts. */
#include "tests/cloth/solve/two_level.h"
#include "tests/support/unit.h"

#include <stdlib.h>
#include <string.h>

static uint32_t block_of(const struct system *s, uint32_t row)
{
    uint32_t b = s->n_blocks - 1;
    while (s->block[b].first > row)
        b--;
    return b;
}

static void find_neighbours(struct two_level *level)
{
    const struct system *s = level->system;
    uint32_t n = 0;
    for (uint32_t b = 0; b < s->n_blocks; b++) {
        level->first[b] = n;
        for (uint32_t i = 0; i < s->block[b].n_ghosts; i++) {
            const uint32_t other = block_of(s, s->block[b].ghost[i]);
            if (n == level->first[b] || level->neighbour[n - 1] != other)
                level->neighbour[n++] = other;
        }
    }
    level->first[s->n_blocks] = n;
}

static void couple(struct two_level *level, uint32_t b)
{
    const struct system_block *block = level->system->block + b;
    const phys_vec *basis = level->basis + block->first;
    double(*coupling)[SOLVE_COUPLING] = level->coupling[b];
    solve_couple(&block->matrix, 0, block->matrix.n, block->value, basis, coupling[0]);
    uint32_t later = 1;
    for (uint32_t s = level->first[b]; s < level->first[b + 1]; s++) {
        uint32_t at[SYSTEM_SPRINGS], end[SYSTEM_SPRINGS][2], n = 0;
        double off_diagonal[SOLVE_COUPLING] = {0};
        for (size_t i = 0; i < block->cut.n; i++) {
            const uint32_t other = block->ghost[block->cut.end[i][1]];
            if (block_of(level->system, other) != level->neighbour[s])
                continue;
            at[n] = block->row[block->matrix.n] + (uint32_t)i;
            end[n][0] = block->cut.end[i][0];
            end[n++][1] = other;
        }
        solve_couple_cut(&block->matrix, block->value, n, at, (const uint32_t(*)[2])end, basis,
                         level->basis, coupling[0], off_diagonal);
        if (level->neighbour[s] > b)
            memcpy(coupling[later++], off_diagonal, sizeof off_diagonal);
    }
}

void two_level_make(struct two_level *level, const struct system *system)
{
    *level = (struct two_level){.system = system};
    find_neighbours(level);
    for (uint32_t b = 0; b < system->n_blocks; b++) {
        const struct system_block *block = system->block + b;
        solve_basis(block->matrix.n, block->free, block->position, level->basis + block->first);
        if (block->matrix.filter)
            solve_basis_filter(block->matrix.n, block->matrix.filter, level->basis + block->first);
    }
    for (uint32_t b = 0; b < system->n_blocks; b++)
        couple(level, b);
    UNIT_FINE(solve_pattern_make(&level->pattern, system->n_blocks, level->first, level->neighbour,
                                 &error));
    level->factor =
        aligned_alloc(32, solve_coarse_doubles(&level->pattern) * sizeof *level->factor);
    ck_assert(level->factor != NULL);
    solve_coarse_clear(&level->pattern, level->factor);
    for (uint32_t b = 0; b < system->n_blocks; b++)
        solve_coarse_fill(&level->pattern, level->first, level->neighbour, b, level->coupling[b][0],
                          level->factor);
    level->dropped = solve_coarse_factor(&level->pattern, level->factor);
}

void two_level_free(struct two_level *level)
{
    solve_pattern_free(&level->pattern);
    free(level->factor);
}

void two_level_add(const struct two_level *level, const phys_vec *q, phys_vec *y)
{
    _Alignas(32) double x[SYSTEM_BLOCKS * SOLVE_COARSE_STRIDE] = {0};
    for (uint32_t b = 0; b < level->system->n_blocks; b++) {
        const struct system_block *block = level->system->block + b;
        solve_restrict(block->matrix.n, level->basis + block->first, q + block->first,
                       x + solve_coarse_at(&level->pattern, b));
    }
    solve_coarse_solve(&level->pattern, level->factor, x);
    for (uint32_t b = 0; b < level->system->n_blocks; b++) {
        const struct system_block *block = level->system->block + b;
        solve_prolong(block->matrix.n, level->basis + block->first,
                      x + solve_coarse_at(&level->pattern, b), y + block->first);
    }
}
