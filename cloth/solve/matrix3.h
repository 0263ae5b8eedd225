#ifndef CLOTH_SOLVE_MATRIX3_H
#define CLOTH_SOLVE_MATRIX3_H

#include "cloth/physics/vec.h"

#include <stdbool.h>

/* 3 x 3 matrices in vectors of four lanes, of which the last is zero unless said otherwise.
 * Everything is inlined and written for registers. */

/* A symmetric one: xx yy zz 0 and xy yz zx 0. */
struct solve_symmetric {
    phys_vec diagonal, off_diagonal;
};

/* Columns. */
struct solve_columns {
    phys_vec c[3];
};

typedef int64_t solve_lanes __attribute__((vector_size(32)));

/* y z x 0 of x y z 0; z x y 0. */
#define SOLVE_YZX(v) __builtin_shufflevector(v, v, 1, 2, 0, 3)
#define SOLVE_ZXY(v) __builtin_shufflevector(v, v, 2, 0, 1, 3)

/* alpha I + w w' of a spring w0 w1 w2 alpha (cloth/solve/block.h). */
PHYS_INLINE void solve_spring(const phys_vec *value, struct solve_symmetric *m)
{
    const phys_vec w = {(*value)[0], (*value)[1], (*value)[2], 0};
    const double alpha = (*value)[3];
    m->diagonal = w * w + (phys_vec){alpha, alpha, alpha, 0};
    m->off_diagonal = w * SOLVE_YZX(w);
}

/* Four floats anywhere. */
typedef float solve_four_floats __attribute__((vector_size(16), aligned(4), may_alias));

/* One by one, which compilers turn into one conversion; GCC 12 makes two of __builtin_convertvector
 * and puts them together. */
PHYS_INLINE void solve_widen(const float *from, phys_vec *to)
{
    const solve_four_floats *four = (const void *)from;
    *to =
        (phys_vec){(double)(*four)[0], (double)(*four)[1], (double)(*four)[2], (double)(*four)[3]};
}

/* Four floats of a vector, again one by one. */
PHYS_INLINE void solve_narrow(const phys_vec *from, float *to)
{
    solve_four_floats *four = (void *)to;
    *four = (solve_four_floats){(float)(*from)[0], (float)(*from)[1], (float)(*from)[2],
                                (float)(*from)[3]};
}

/* m v. */
PHYS_INLINE void solve_times(const struct solve_symmetric *m, const phys_vec *v, phys_vec *y)
{
    *y = m->diagonal * *v + m->off_diagonal * SOLVE_YZX(*v) +
         SOLVE_ZXY(m->off_diagonal) * SOLVE_ZXY(*v);
}

/* m v. */
PHYS_INLINE void solve_columns_times(const struct solve_columns *m, const phys_vec *v, phys_vec *y)
{
    *y = (*v)[0] * m->c[0] + (*v)[1] * m->c[1] + (*v)[2] * m->c[2];
}

/* The sums of the lanes of three vectors: m' v, when each column of m is multiplied by v. */
PHYS_INLINE void solve_lanes_of(const phys_vec *a, const phys_vec *b, const phys_vec *c,
                                phys_vec *sums)
{
    const phys_vec none = {0};
    const phys_vec ab =
        __builtin_shufflevector(*a, *b, 0, 4, 2, 6) + __builtin_shufflevector(*a, *b, 1, 5, 3, 7);
    const phys_vec c0 = __builtin_shufflevector(*c, none, 0, 4, 2, 6) +
                        __builtin_shufflevector(*c, none, 1, 5, 3, 7);
    *sums =
        __builtin_shufflevector(ab, c0, 0, 1, 4, 5) + __builtin_shufflevector(ab, c0, 2, 3, 6, 7);
}

/* The columns of a symmetric one. */
PHYS_INLINE void solve_columns_of(const struct solve_symmetric *m, struct solve_columns *columns)
{
    const phys_vec d = m->diagonal, e = m->off_diagonal;
    columns->c[0] = __builtin_shufflevector(d, e, 0, 4, 6, 3);
    columns->c[1] = __builtin_shufflevector(d, e, 4, 1, 5, 3);
    columns->c[2] = __builtin_shufflevector(d, e, 6, 5, 2, 3);
}

/* The inverse, unless a pivot of m is not above `least` times the diagonal entries of `whole`. */
PHYS_INLINE bool solve_invert(const struct solve_symmetric *m, const phys_vec *whole, double least,
                              struct solve_symmetric *inverse)
{
    const double xx = m->diagonal[0], yy = m->diagonal[1], zz = m->diagonal[2];
    const double xy = m->off_diagonal[0], yz = m->off_diagonal[1], zx = m->off_diagonal[2];
    const double l10 = xy / xx, l20 = zx / xx;
    const double d1 = yy - l10 * xy, e = yz - l10 * zx, l21 = e / d1;
    const double d2 = zz - l20 * zx - l21 * e;
    if (!(xx > least * (*whole)[0]) || !(d1 > least * (*whole)[1]) || !(d2 > least * (*whole)[2]))
        return false;
    /* L^-1 has -l10, -l21 and k below its diagonal of ones. */
    const double k = l10 * l21 - l20, i0 = 1 / xx, i1 = 1 / d1, i2 = 1 / d2;
    inverse->diagonal = (phys_vec){i0 + l10 * l10 * i1 + k * k * i2, i1 + l21 * l21 * i2, i2, 0};
    inverse->off_diagonal = (phys_vec){-l10 * i1 - k * l21 * i2, -l21 * i2, k * i2, 0};
    return true;
}

#endif
