#ifndef CLOTH_SOLVE_FORMAT_H
#define CLOTH_SOLVE_FORMAT_H

#include "cloth/solve/matrix3.h"

#include <stddef.h>

/* How the off-diagonal part of a matrix is kept. An entry joins two rows, a and b: with N = -A_ab
 * it adds N d, d = p_a - p_b, to row a and takes N' d from row b. So the diagonal is not kept. Its
 * block a is the row's own part (mass, h times drag, kg) plus the sum of N over the row's entries
 * as rounded. The sum has no effect on a uniform motion, in every format. */
enum solve_format {
    SOLVE_SPRINGS, /* N = alpha I + w w', four doubles an entry: w0 w1 w2 alpha */
    SOLVE_HALF     /* any N, nine doubles an entry: n00 n11 n22, n01 n12 n20, n02 n10 n21 */
};
enum { SOLVE_NINE = 9 };

/* Doubles of so many entries, aligned to 32 bytes. */
static inline size_t solve_format_doubles(enum solve_format format, size_t entries)
{
    if (format == SOLVE_SPRINGS)
        return 4 * entries;
    return SOLVE_NINE * entries + 1; /* a read of four numbers may end behind the last */
}

/* Four numbers anywhere. */
typedef double solve_four __attribute__((vector_size(32), aligned(8), may_alias));

/* N of one entry as it lies in memory, three lanes and rubbish each. */
struct solve_nine {
    phys_vec diagonal, upper, lower;
};
PHYS_INLINE void solve_nine_of(const void *entry, size_t i, struct solve_nine *n)
{
    const double *at = (const double *)entry + SOLVE_NINE * i;
    n->diagonal = *(const solve_four *)(const void *)at;
    n->upper = *(const solve_four *)(const void *)(at + 3);
    n->lower = *(const solve_four *)(const void *)(at + 6);
}

/* True if a spring's value adds nothing. */
PHYS_INLINE bool solve_is_nothing(const phys_vec *value)
{
    return (*value)[0] == 0 && (*value)[1] == 0 && (*value)[2] == 0 && (*value)[3] == 0;
}

/* alpha d + w (w . d) of a spring; lane 3 becomes rubbish. */
PHYS_INLINE void solve_spring_times(const phys_vec *value, const phys_vec *d, phys_vec *y)
{
    const phys_vec product = *value * *d; /* lane 3: d is zero there */
    phys_vec dot;
    phys_lanes_each(&product, &dot);
    *y = (*value)[3] * *d + dot * *value;
}

/* N d and N' d of one entry, of a d that is zero in lane 3. */
PHYS_INLINE void solve_entry_times(enum solve_format format, const void *entry, size_t i,
                                   const phys_vec *d, phys_vec *y, phys_vec *transposed)
{
    if (format == SOLVE_SPRINGS) {
        solve_spring_times((const phys_vec *)entry + i, d, y);
        *transposed = *y;
        return;
    }
    struct solve_nine n;
    solve_nine_of(entry, i, &n);
    const phys_vec same = n.diagonal * *d, lower = n.lower * *d, upper = n.upper * *d;
    *y = same + n.upper * SOLVE_YZX(*d) + n.lower * SOLVE_ZXY(*d);
    *transposed = same + SOLVE_YZX(lower) + SOLVE_ZXY(upper);
}

/* N = symmetric + [turn]x of one entry. */
PHYS_INLINE void solve_entry_of(enum solve_format format, const void *entry, size_t i,
                                struct solve_symmetric *symmetric, phys_vec *turn)
{
    if (format == SOLVE_SPRINGS) {
        solve_spring((const phys_vec *)entry + i, symmetric);
        *turn = (phys_vec){0};
        return;
    }
    const phys_vec three = {1, 1, 1, 0};
    struct solve_nine n;
    solve_nine_of(entry, i, &n);
    const phys_vec below = SOLVE_YZX(n.lower); /* n10 n21 n02 */
    const phys_vec z_x_y = 0.5 * (below - n.upper);
    symmetric->diagonal = three * n.diagonal;
    symmetric->off_diagonal = 0.5 * three * (n.upper + below);
    *turn = three * SOLVE_YZX(z_x_y);
}

/* The columns of symmetric + [turn]x. */
PHYS_INLINE void solve_entry_columns(const struct solve_symmetric *symmetric, const phys_vec *turn,
                                     struct solve_columns *columns)
{
    const double x = (*turn)[0], y = (*turn)[1], z = (*turn)[2];
    solve_columns_of(symmetric, columns);
    columns->c[0] += (phys_vec){0, z, -y, 0};
    columns->c[1] += (phys_vec){-z, 0, x, 0};
    columns->c[2] += (phys_vec){y, -x, 0, 0};
}

#endif
