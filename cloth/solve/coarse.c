/* The coarse factor in dense blocks of nine, by columns of blocks in the order of elimination. A
 * block is nine columns of twelve numbers, the last three zero. C = L L' is made in double; of a
 * diagonal block the entries on the diagonal are inverted, and zero for a column that was dropped.
 * A solve reads the factor once forward and once backward, and meanwhile other workers wait. So
 * where the least pivot is large against a float's rounding, the factor is kept as (I + T) E (I +
 * T'). T is in float; E is kept by the inverses of its blocks, in double, each of them one product.
 * The same T stands on both sides, so a solve is symmetric and as definite as E, however T is
 * rounded. */
#include "cloth/solve/coarse.h"

#include "cloth/solve/matrix3.h"

#include <math.h>
#include <string.h>

/* A pivot below this part of its entry in C is rounding. */
#define LEAST 1e-10

/* T is not rounded if a pivot is below this part, as in long steps of cloth that nothing holds. */
#define LEAST_OF_ROUNDED 1e-5

enum { N = SOLVE_COARSE, WIDTH = 3 };

struct dense {
    phys_vec c[N][WIDTH];
};

struct rounded {
    float c[N][4 * WIDTH];
};

/* The parts of a factor: the diagonal of C, a stride a column of blocks; the diagonal blocks of all
 * columns; the entries, which are rounded where they lie. Number N of the first stride says if T is
 * in place of L. */
struct parts {
    double *whole;
    struct dense *diagonal, *entry;
    struct rounded *rounded;
};

static struct parts parts_of(const struct solve_pattern *pattern, double *factor)
{
    double *dense = factor + (size_t)pattern->n * SOLVE_COARSE_STRIDE;
    struct dense *diagonal = (struct dense *)(void *)dense;
    struct dense *entry = diagonal + pattern->n;
    return (struct parts){factor, diagonal, entry, (struct rounded *)(void *)entry};
}

size_t solve_coarse_doubles(const struct solve_pattern *pattern)
{
    const size_t n = (size_t)pattern->n + pattern->first[pattern->n];
    return (size_t)pattern->n * SOLVE_COARSE_STRIDE + n * (sizeof(struct dense) / sizeof(double));
}

void solve_coarse_clear(const struct solve_pattern *pattern, double *factor)
{
    memset(factor, 0, solve_coarse_doubles(pattern) * sizeof *factor);
}

PHYS_INLINE double get(const phys_vec *column, int i)
{
    return ((const double *)(const void *)column)[i];
}

/* The entry of a place in a column. */
static struct dense *solve_coarse_entry_of(const struct solve_pattern *pattern, struct dense *entry,
                                           uint32_t k, uint32_t place)
{
    uint32_t i = pattern->first[k];
    while (pattern->row[i] != place)
        i++;
    return entry + i;
}

/* Copies a matrix by rows, or, transposed, its transpose. */
static void fill(const double *matrix, bool transposed, struct dense *to)
{
    for (int j = 0; j < N; j++) {
        double column[4 * WIDTH] = {0};
        for (int i = 0; i < N; i++)
            column[i] = transposed ? matrix[N * j + i] : matrix[N * i + j];
        memcpy(to->c[j], column, sizeof column);
    }
}

void solve_coarse_fill(const struct solve_pattern *pattern, const uint32_t *first,
                       const uint32_t *neighbour, uint32_t b, const double *coupling,
                       double *factor)
{
    const struct parts parts = parts_of(pattern, factor);
    const uint32_t here = pattern->place[b];
    fill(coupling, false, parts.diagonal + here);
    for (int i = 0; i < N; i++)
        parts.whole[(size_t)here * SOLVE_COARSE_STRIDE + (size_t)i] = coupling[(N + 1) * i];
    for (uint32_t i = first[b]; i < first[b + 1]; i++) {
        if (neighbour[i] < b)
            continue;
        coupling += SOLVE_COUPLING;
        if (neighbour[i] == SOLVE_LEFT_OUT)
            continue;
        const uint32_t there = pattern->place[neighbour[i]];
        if (there < here) /* rows of the later block, columns of the first */
            fill(coupling, false, solve_coarse_entry_of(pattern, parts.entry, there, here));
        else
            fill(coupling, true, solve_coarse_entry_of(pattern, parts.entry, here, there));
    }
}

/* to -= factor from, one column. */
PHYS_INLINE void subtract(double factor, const phys_vec *from, phys_vec *to)
{
    to[0] -= factor * from[0];
    to[1] -= factor * from[1];
    to[2] -= factor * from[2];
}

/* The factor of a diagonal block; whole: its entries on the diagonal in C. */
PHYS_INLINE uint32_t factor_dense(const double *whole, struct dense *d, double *least)
{
    uint32_t dropped = 0;
    for (int j = 0; j < N; j++) {
        for (int m = 0; m < j; m++)
            subtract(get(d->c[m], j), d->c[m], d->c[j]);
        const double pivot = get(d->c[j], j);
        const bool good = isfinite(pivot) && pivot > LEAST * whole[j];
        const double inverse = good ? 1 / sqrt(pivot) : 0;
        double *column = (double *)(void *)d->c[j];
        for (int i = 0; i < N; i++)
            column[i] = i > j && good ? column[i] * inverse : 0;
        column[j] = inverse;
        dropped += !good;
        *least = good ? fmin(*least, pivot / whole[j]) : *least;
    }
    return dropped;
}

/* a = a L^-T. */
PHYS_INLINE void solve_dense(const struct dense *l, struct dense *a)
{
    for (int j = 0; j < N; j++) {
        phys_vec sum[WIDTH] = {a->c[j][0], a->c[j][1], a->c[j][2]};
        for (int m = 0; m < j; m++)
            subtract(get(l->c[m], j), a->c[m], sum);
        for (int w = 0; w < WIDTH; w++)
            a->c[j][w] = sum[w] * get(l->c[j], j);
    }
}

/* c -= a b'. */
PHYS_INLINE void reduce(const struct dense *a, const struct dense *b, struct dense *c)
{
    for (int j = 0; j < N; j++) {
        phys_vec sum[WIDTH] = {c->c[j][0], c->c[j][1], c->c[j][2]};
        PHYS_UNROLL
        for (int m = 0; m < N; m++)
            subtract(get(b->c[m], j), a->c[m], sum);
        for (int w = 0; w < WIDTH; w++)
            c->c[j][w] = sum[w];
    }
}

/* Takes column k out of the columns behind it. */
PHYS_INLINE void reduce_all(const struct solve_pattern *pattern, uint32_t k, struct dense *diagonal)
{
    struct dense *entry = diagonal + pattern->n;
    const uint32_t *row = pattern->row, to = pattern->first[k + 1];
    for (uint32_t j = pattern->first[k]; j < to; j++) {
        uint32_t at = pattern->first[row[j]];
        reduce(entry + j, entry + j, diagonal + row[j]);
        for (uint32_t i = j + 1; i < to; i++) {
            while (row[at] != row[i])
                at++;
            reduce(entry + i, entry + j, entry + at);
        }
    }
}

/* y = L^-1 y of a diagonal block, zero above row j. */
PHYS_INLINE void forward_dense(const struct dense *l, int j, phys_vec *y)
{
    phys_vec sum[WIDTH] = {y[0], y[1], y[2]};
    for (; j < N; j++) {
        const double value = get(sum, j) * get(l->c[j], j);
        subtract(value, l->c[j], sum);
        ((double *)(void *)sum)[j] = value;
    }
    for (int w = 0; w < WIDTH; w++)
        y[w] = sum[w];
}

/* L^-1 of a diagonal block, a column at a time. */
PHYS_INLINE void invert_dense(const struct dense *l, struct dense *inverse)
{
    *inverse = (struct dense){0};
    for (int j = 0; j < N; j++) {
        ((double *)(void *)inverse->c[j])[j] = 1;
        forward_dense(l, j, inverse->c[j]);
    }
}

/* to = a m, of a lower triangular m, rounded. */
PHYS_INLINE void multiply(const struct dense *a, const struct dense *m, struct rounded *to)
{
    for (int j = 0; j < N; j++) {
        phys_vec sum[WIDTH] = {{0}};
        for (int k = j; k < N; k++)
            subtract(-get(m->c[j], k), a->c[k], sum);
        for (int w = 0; w < WIDTH; w++)
            for (int c = 0; c < 4; c++)
                to->c[j][4 * w + c] = (float)sum[w][c];
    }
}

/* m = m' m, to the same bits on both sides of its diagonal. */
PHYS_INLINE void square(struct dense *m)
{
    const struct dense l = *m;
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++) {
            const phys_vec *a = l.c[i < j ? i : j], *b = l.c[i < j ? j : i];
            const phys_vec sum = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            ((double *)(void *)m->c[j])[i] = phys_lanes(&sum);
        }
}

/* L of a column becomes the inverse of E and T, in place: T is written behind the reads. */
PHYS_INLINE void finish(const struct solve_pattern *pattern, uint32_t k, const struct parts *parts)
{
    struct dense inverse;
    invert_dense(parts->diagonal + k, &inverse);
    for (uint32_t i = pattern->first[k]; i < pattern->first[k + 1]; i++) {
        struct rounded t;
        multiply(parts->entry + i, &inverse, &t);
        memcpy(parts->rounded + i, &t, sizeof t);
    }
    square(&inverse);
    parts->diagonal[k] = inverse;
}

PHYS_KERNEL_OF(uint32_t, solve_coarse_factor, (const struct solve_pattern *pattern, double *factor),
               (pattern, factor))
{
    const struct parts parts = parts_of(pattern, factor);
    uint32_t dropped = 0;
    double least = 1;
    for (uint32_t k = 0; k < pattern->n; k++) {
        const double *whole = parts.whole + (size_t)k * SOLVE_COARSE_STRIDE;
        dropped += factor_dense(whole, parts.diagonal + k, &least);
        for (uint32_t i = pattern->first[k]; i < pattern->first[k + 1]; i++)
            solve_dense(parts.diagonal + k, parts.entry + i);
        reduce_all(pattern, k, parts.diagonal);
    }
    parts.whole[N] = least > LEAST_OF_ROUNDED;
    for (uint32_t k = 0; k < pattern->n && parts.whole[N] > 0; k++)
        finish(pattern, k, &parts);
    return dropped;
}

/* ---- The solution ---- */

/* y = L^-T y of a diagonal block. */
PHYS_INLINE void backward_dense(const struct dense *l, phys_vec *y)
{
    double *x = (double *)(void *)y;
    for (int j = N; j-- > 0;) {
        double sum = x[j];
        for (int i = j + 1; i < N; i++)
            sum -= get(l->c[j], i) * x[i];
        x[j] = sum * get(l->c[j], j);
    }
}

/* y = m y. */
PHYS_INLINE void times(const struct dense *m, phys_vec *y)
{
    phys_vec sum[WIDTH] = {{0}};
    PHYS_UNROLL
    for (int j = 0; j < N; j++)
        subtract(-get(y, j), m->c[j], sum);
    for (int w = 0; w < WIDTH; w++)
        y[w] = sum[w];
}

/* Column j of entry i. */
PHYS_INLINE void column_of(const struct parts *parts, bool rounded, uint32_t i, int j,
                           phys_vec to[WIDTH])
{
    PHYS_UNROLL
    for (int w = 0; w < WIDTH; w++)
        if (rounded)
            solve_widen(parts->rounded[i].c[j] + 4 * w, to + w);
        else
            to[w] = parts->entry[i].c[j][w];
}

/* y -= l x, of entry i. */
PHYS_INLINE void forward(const struct parts *parts, bool rounded, uint32_t i, const phys_vec *x,
                         phys_vec *y)
{
    phys_vec column[WIDTH], sum[WIDTH] = {y[0], y[1], y[2]};
    PHYS_UNROLL
    for (int j = 0; j < N; j++) {
        column_of(parts, rounded, i, j, column);
        subtract(get(x, j), column, sum);
    }
    for (int w = 0; w < WIDTH; w++)
        y[w] = sum[w];
}

/* y -= sum of l' x over the entries of column k, three of its nine columns: those from j on. */
PHYS_INLINE void backward(const struct solve_pattern *pattern, const struct parts *parts,
                          bool rounded, uint32_t k, int j, const phys_vec *all, double *y)
{
    phys_vec sum[3] = {{0}}, column[WIDTH], lanes;
    for (uint32_t i = pattern->first[k]; i < pattern->first[k + 1]; i++) {
        const phys_vec *x = all + WIDTH * (size_t)pattern->row[i];
        PHYS_UNROLL
        for (int c = 0; c < 3; c++) {
            column_of(parts, rounded, i, j + c, column);
            sum[c] += column[0] * x[0] + column[1] * x[1] + column[2] * x[2];
        }
    }
    solve_lanes_of(sum, sum + 1, sum + 2, &lanes);
    for (int c = 0; c < 3; c++)
        y[j + c] -= lanes[c];
}

PHYS_INLINE void solve(const struct solve_pattern *pattern, const struct parts *parts, bool rounded,
                       phys_vec *all)
{
    for (uint32_t k = 0; k < pattern->n; k++) {
        phys_vec *here = all + WIDTH * (size_t)k;
        if (!rounded)
            forward_dense(parts->diagonal + k, 0, here);
        for (uint32_t i = pattern->first[k]; i < pattern->first[k + 1]; i++)
            forward(parts, rounded, i, here, all + WIDTH * (size_t)pattern->row[i]);
    }
    for (uint32_t k = pattern->n; k-- > 0;) {
        phys_vec *here = all + WIDTH * (size_t)k;
        if (rounded)
            times(parts->diagonal + k, here);
        for (int j = 0; j < N; j += 3)
            backward(pattern, parts, rounded, k, j, all, (double *)(void *)here);
        if (!rounded)
            backward_dense(parts->diagonal + k, here);
    }
}

PHYS_KERNEL(solve_coarse_solve,
            (const struct solve_pattern *pattern, const double *factor, double *x),
            (pattern, factor, x))
{
    const struct parts parts = parts_of(pattern, (double *)(uintptr_t)factor);
    phys_vec *all = (phys_vec *)(void *)x;
    if (parts.whole[N] > 0)
        solve(pattern, &parts, true, all);
    else
        solve(pattern, &parts, false, all);
}
