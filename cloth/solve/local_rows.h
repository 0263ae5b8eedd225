#ifndef CLOTH_SOLVE_LOCAL_ROWS_H
#define CLOTH_SOLVE_LOCAL_ROWS_H

#include "cloth/solve/block.h"
#include "cloth/solve/matrix3.h"

/* A factor in memory, and the two halves of its application.
 *
 * A factor has for each row the inverse of a 3 x 3 block (struct solve_symmetric). Behind them
 * IC(0) has for each inner entry its block of T, transposed. A row gives multiples of columns of
 * T', by its own three numbers, to later rows. Its sum from them runs over its entries first, over
 * lanes at the end. The same T stands on both sides of E, so M is exactly symmetric and as definite
 * as E. T is kept in float: a solve reads it far more often than it is made, and half the bytes
 * take less time. */

struct local_rounded {
    float c[SOLVE_NINE]; /* a read of four numbers may end behind the last */
};

struct local_factor {
    struct solve_symmetric *inverse; /* n */
    struct solve_columns *t;         /* row[n]: T', by columns, while they are made; then */
    struct local_rounded *rounded;
};

PHYS_INLINE struct local_factor local_factor_of(const struct solve_block *block, double *memory)
{
    struct solve_symmetric *inverse = (struct solve_symmetric *)(void *)memory;
    return (struct local_factor){inverse, (struct solve_columns *)(void *)(inverse + block->n),
                                 (struct local_rounded *)(void *)(inverse + block->n)};
}

PHYS_INLINE void local_widen(const struct local_rounded *t, phys_vec *x, phys_vec *y, phys_vec *z)
{
    solve_widen(t->c, x);
    solve_widen(t->c + 3, y);
    solve_widen(t->c + 6, z);
}

/* s = (I + T')^-1 q, then E^-1 of it; a row is final when all before it are. Its lane 3 is rubbish
 * until then. */
PHYS_INLINE void local_forward(const struct solve_block *block, const struct local_factor *f,
                               phys_vec *s)
{
    for (size_t a = 0; a < block->n; a++) {
        const phys_vec own = s[a];
        for (uint32_t i = block->row[a]; i < block->row[a + 1]; i++) {
            phys_vec x, y, z;
            local_widen(f->rounded + i, &x, &y, &z);
            s[block->column[i]] -= own[0] * x + own[1] * y + own[2] * z;
        }
        solve_times(f->inverse + a, &own, s + a);
    }
}

/* s = (I + T)^-1 s. Returns q.s. */
PHYS_INLINE double local_backward(const struct solve_block *block, const struct local_factor *f,
                                  const phys_vec *q, phys_vec *s)
{
    phys_vec dot = {0};
    for (size_t a = block->n; a-- > 0;) {
        phys_vec sum_x = {0}, sum_y = {0}, sum_z = {0}, sum;
        for (uint32_t i = block->row[a + 1]; i-- > block->row[a];) { /* the latest last */
            const phys_vec other = s[block->column[i]];
            phys_vec x, y, z;
            local_widen(f->rounded + i, &x, &y, &z);
            sum_x += x * other;
            sum_y += y * other;
            sum_z += z * other;
        }
        solve_lanes_of(&sum_x, &sum_y, &sum_z, &sum);
        s[a] -= sum;
        dot += q[a] * s[a];
    }
    return phys_lanes(&dot);
}

#endif
