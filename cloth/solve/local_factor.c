/* A factor of IC(0) is handed out only if its pivots have passed and it is near its block. Each try
 * begins with the block's own values. T is made in double, and rounded to float at the end, in the
 * first part of its memory. */
#include "cloth/solve/local.h"
#include "cloth/solve/local_rows.h"

#include <stdbool.h>
#include <string.h>

/* A pivot below this part of its row's diagonal is rounding. */
#define LEAST 1e-9

/* Pivots of B are not below its masses; a pivot of IC(0) so far below them is as good as zero. */
#define LEAST_OF_MASS 1e-3

size_t solve_local_doubles(size_t n, size_t entries, enum solve_local kind)
{
    const size_t blocks = kind == SOLVE_IC0 ? entries : 0;
    return (n * sizeof(struct solve_symmetric) + blocks * sizeof(struct solve_columns)) /
           sizeof(double);
}

PHYS_INLINE void add(struct solve_symmetric *to, const struct solve_symmetric *m)
{
    to->diagonal += m->diagonal;
    to->off_diagonal += m->off_diagonal;
}

/* m = S m. */
PHYS_INLINE void filter_left(const phys_vec *filter, struct solve_columns *m)
{
    for (int k = 0; k < 3; k++)
        solve_filter(filter, m->c + k);
}

/* m = m S. */
PHYS_INLINE void filter_right(const phys_vec *filter, struct solve_columns *m)
{
    const phys_vec d = {(*filter)[0], (*filter)[1], (*filter)[2], 0};
    const double c = (*filter)[3];
    phys_vec y;
    solve_columns_times(m, &d, &y);
    for (int k = 0; k < 3; k++)
        m->c[k] = c * m->c[k] + ((1 - 2 * c) * d[k]) * y;
}

/* m = S m S + t (I - S), t as large as m is. */
PHYS_INLINE void filter_diagonal(const phys_vec *filter, struct solve_symmetric *m)
{
    const double t = (m->diagonal[0] + m->diagonal[1] + m->diagonal[2]) / 3;
    const phys_vec d = {(*filter)[0], (*filter)[1], (*filter)[2], 0};
    const double c = (*filter)[3], across = t * (1 - c), along = t * (1 - 2 * c);
    struct solve_columns columns;
    if (c > 0 && phys_dot(&d, &d) <= 0)
        return;
    solve_columns_of(m, &columns);
    filter_left(filter, &columns);
    filter_right(filter, &columns);
    m->diagonal = (phys_vec){columns.c[0][0], columns.c[1][1], columns.c[2][2], 0} +
                  (phys_vec){across, across, across, 0} - along * d * d;
    m->off_diagonal =
        (phys_vec){columns.c[1][0], columns.c[2][1], columns.c[0][2], 0} - along * d * SOLVE_YZX(d);
}

PHYS_INLINE void gather_ties(size_t n_rows, const struct solve_ties *ties,
                             struct solve_symmetric *sum)
{
    for (size_t i = 0; i < ties->n; i++) {
        struct solve_symmetric m = {{0}, {0}};
        solve_spring(ties->value + i, &m);
        PHYS_UNROLL
        for (int k = 0; k < SOLVE_TIE_CORNERS; k++) {
            const double square = ties->weight[i][k] * ties->weight[i][k];
            const struct solve_symmetric share = {square * m.diagonal, square * m.off_diagonal};
            if (square > 0 && ties->corner[i][k] < n_rows)
                add(sum + ties->corner[i][k], &share);
        }
    }
}

/* The blocks on the diagonal of B. */
PHYS_INLINE void gather(const struct solve_block *block, const struct solve_cut *cut,
                        const void *values, struct solve_symmetric *sum)
{
    const enum solve_format format = block->format;
    struct solve_symmetric m = {{0}, {0}};
    phys_vec turn; /* of a row they come to nothing */
    for (size_t a = 0; a < block->n; a++) {
        const double d = block->diagonal[a];
        sum[a] = (struct solve_symmetric){{d, d, d, 0}, {0}};
    }
    for (size_t a = 0; a < block->n; a++)
        for (uint32_t i = block->row[a]; i < block->row[a + 1]; i++) {
            solve_entry_of(format, values, i, &m, &turn);
            add(sum + a, &m);
            add(sum + block->column[i], &m);
        }
    for (size_t i = 0; i < cut->n; i++) {
        solve_entry_of(format, values, block->row[block->n] + i, &m, &turn);
        add(sum + cut->end[i][0], &m);
    }
    if (cut->ties)
        gather_ties(block->n, cut->ties, sum);
    for (size_t a = 0; a < block->n; a++)
        if (block->free[a] == 0)
            sum[a] = (struct solve_symmetric){{1, 1, 1, 0}, {0}};
        else if (block->filter)
            filter_diagonal(block->filter + a, sum + a);
}

/* Rounding of a stiff spring may leave a row's block singular: then its diagonal is made larger. */
PHYS_INLINE void invert_surely(struct solve_symmetric *m)
{
    const phys_vec whole = m->diagonal;
    struct solve_symmetric inverse;
    for (double more = 0; !solve_invert(m, &whole, LEAST, &inverse); more = 2 * more + 1e-6) {
        m->diagonal = (1 + more) * whole;
        if (more > 1) { /* not a number: conjugate gradients will say so */
            inverse = *m;
            break;
        }
    }
    *m = inverse;
}

/* The inner entries of B, transposed: zero where an end is held. An entry is put together in
 * registers: a vector that is read just after its numbers were written one by one waits for them.
 */
PHYS_INLINE void spread(const struct solve_block *block, const void *values,
                        struct solve_columns *t)
{
    for (size_t a = 0; a < block->n; a++)
        for (uint32_t i = block->row[a]; i < block->row[a + 1]; i++) {
            struct solve_symmetric m = {{0}, {0}};
            struct solve_columns entry;
            phys_vec turn;
            solve_entry_of(block->format, values, i, &m, &turn);
            turn = -turn; /* of N' */
            solve_entry_columns(&m, &turn, &entry);
            const double sign = -block->free[a] * block->free[block->column[i]];
            for (int k = 0; k < 3; k++)
                t[i].c[k] = sign * entry.c[k];
            if (block->filter) {
                filter_left(block->filter + block->column[i], t + i);
                filter_right(block->filter + a, t + i);
            }
        }
}

/* t = t inverse. */
PHYS_INLINE void scale(const struct solve_symmetric *inverse, struct solve_columns *t)
{
    const phys_vec *d = &inverse->diagonal, *e = &inverse->off_diagonal;
    const phys_vec x = t->c[0], y = t->c[1], z = t->c[2];
    t->c[0] = (*d)[0] * x + (*e)[0] * y + (*e)[2] * z;
    t->c[1] = (*e)[0] * x + (*d)[1] * y + (*e)[1] * z;
    t->c[2] = (*e)[2] * x + (*e)[1] * y + (*d)[2] * z;
}

/* b -= T' W of one entry, which is symmetric. t, w: T' and W', by columns. */
PHYS_INLINE void reduce_diagonal(const struct solve_columns *t, const struct solve_columns *w,
                                 struct solve_symmetric *b)
{
    const phys_vec x = w->c[0], y = w->c[1], z = w->c[2];
    b->diagonal -= t->c[0] * x + t->c[1] * y + t->c[2] * z;
    b->off_diagonal -= t->c[0] * SOLVE_YZX(x) + t->c[1] * SOLVE_YZX(y) + t->c[2] * SOLVE_YZX(z);
}

/* Column k of W' T. */
PHYS_INLINE void reduce_column(const struct solve_columns *w, const struct solve_columns *t, int k,
                               phys_vec *column)
{
    *column -= t->c[0][k] * w->c[0] + t->c[1][k] * w->c[1] + t->c[2][k] * w->c[2];
}

/* The entry of (b, c), transposed, -= W' T, if it is in the pattern; W' is of (a, c), T' of (a, b).
 */
PHYS_INLINE void reduce_off_diagonal(const struct solve_block *block, uint32_t b, uint32_t c,
                                     const struct solve_columns *w, const struct solve_columns *t,
                                     struct solve_columns *all)
{
    uint32_t i = block->row[b];
    while (i < block->row[b + 1] && block->column[i] < c)
        i++;
    if (i == block->row[b + 1] || block->column[i] != c)
        return;
    reduce_column(w, t, 0, all[i].c);
    reduce_column(w, t, 1, all[i].c + 1);
    reduce_column(w, t, 2, all[i].c + 2);
}

/* Takes row a out of the rows behind it. */
PHYS_INLINE void eliminate(const struct solve_block *block, size_t a, struct local_factor *f)
{
    const uint32_t from = block->row[a], to = block->row[a + 1];
    for (uint32_t i = from; i < to; i++) {
        const struct solve_columns w = f->t[i];
        scale(f->inverse + a, f->t + i);
        reduce_diagonal(f->t + i, &w, f->inverse + block->column[i]);
        for (uint32_t j = from; j < i; j++)
            reduce_off_diagonal(block, block->column[j], block->column[i], &w, f->t + j, f->t);
    }
}

/* IC(0) with the diagonal entries of B times 1 + shift. Returns false if a pivot fails. */
PHYS_INLINE bool factorise(const struct solve_block *block, const struct solve_cut *cut,
                           const void *values, double shift, struct local_factor *f)
{
    gather(block, cut, values, f->inverse);
    spread(block, values, f->t);
    for (size_t a = 0; a < block->n; a++)
        f->inverse[a].diagonal *= 1 + shift;
    for (size_t a = 0; a < block->n; a++) {
        const struct solve_symmetric pivot = f->inverse[a];
        const double d = (1 + shift) * block->diagonal[a];
        const phys_vec whole = {d, d, d, 0};
        if (!solve_invert(&pivot, &whole, LEAST_OF_MASS, f->inverse + a))
            return false;
        eliminate(block, a, f);
    }
    return true;
}

/* (I + T') E (I + T) with E the diagonal of B, T = E^-1 (its upper part). */
PHYS_INLINE void over_relax(const struct solve_block *block, const struct solve_cut *cut,
                            const void *values, struct local_factor *f)
{
    gather(block, cut, values, f->inverse);
    spread(block, values, f->t);
    for (size_t a = 0; a < block->n; a++) {
        invert_surely(f->inverse + a);
        for (uint32_t i = block->row[a]; i < block->row[a + 1]; i++)
            scale(f->inverse + a, f->t + i);
    }
}

/* Works in place: each write is behind the reads. Numbers that a read of four takes with its three
 * are of the next three, or zero. */
PHYS_INLINE void round_off(const struct solve_block *block, struct local_factor *f)
{
    const size_t n = block->row[block->n];
    for (size_t i = 0; i < n; i++) {
        const struct solve_columns t = f->t[i];
        for (int k = 0; k < 3; k++) /* the fourth number is overwritten */
            solve_narrow(t.c + k, f->rounded[i].c + 3 * k);
    }
    if (n)
        f->rounded[n].c[0] = 0;
}

/* Signs that no pattern of the block follows: linear congruential numbers (Knuth & Lewis). */
PHYS_INLINE void mix_signs(const struct solve_block *block, phys_vec *q)
{
    uint32_t x = 1;
    for (size_t a = 0; a < block->n; a++) {
        for (int k = 0; k < 3; k++) {
            x = x * UINT32_C(1664525) + UINT32_C(1013904223);
            q[a][k] = x >> 31 ? -block->free[a] : block->free[a];
        }
        q[a][3] = 0;
        if (block->filter)
            solve_filter(block->filter + a, q + a);
    }
}

/* s' B s without what other blocks and ties add to it. */
PHYS_INLINE double square_in(const struct solve_block *block, const void *values, phys_vec *s)
{
    phys_vec sum = {0};
    for (size_t a = 0; a < block->n; a++)
        s[a][3] = 0;
    for (size_t a = 0; a < block->n; a++) {
        sum += block->diagonal[a] * s[a] * s[a];
        for (uint32_t i = block->row[a]; i < block->row[a + 1]; i++) {
            const phys_vec d = s[a] - s[block->column[i]];
            phys_vec of_a, of_b;
            solve_entry_times(block->format, values, i, &d, &of_a, &of_b);
            sum += s[a] * of_a - s[block->column[i]] * of_b;
        }
    }
    return phys_lanes(&sum);
}

/* A factor whose pivots have only just passed may take some motion for thousands of times softer
 * than it is, and a solve that has one such block takes ten times the iterations. Such a motion is
 * most of s = M^-1 q for any q, so the Rayleigh quotient of M^-1 B at s shows it: up to 1.1 for
 * good factors, 1.5 to 20,000 for others. Entries that push as well as pull make them, as those of
 * bending; springs have none. The two vectors are behind the rounded T; a block with no room for
 * them there has about one entry a row, and no fill. */
PHYS_INLINE bool is_close(const struct solve_block *block, const void *values,
                          const struct local_factor *f)
{
    static const double most = 1.2;
    const size_t n = block->n, entries = block->row[n];
    const size_t used =
        1 + (entries * sizeof(struct local_rounded) + sizeof(float)) / sizeof(phys_vec);
    phys_vec *q = (phys_vec *)(void *)f->t + used, *s = q + n;
    if (block->format == SOLVE_SPRINGS ||
        (used + 2 * n) * sizeof(phys_vec) > entries * sizeof(struct solve_columns))
        return true;
    mix_signs(block, q);
    memcpy(s, q, n * sizeof *s);
    local_forward(block, f, s);
    const double product = local_backward(block, f, q, s);
    return square_in(block, values, s) <= most * product;
}

PHYS_KERNEL_OF(int, solve_local_factor,
               (const struct solve_block *block, const struct solve_cut *cut, const void *values,
                enum solve_local kind, double *factor),
               (block, cut, values, kind, factor))
{
    static const double shift[SOLVE_SSOR] = {0, 0.01, 0.05, 0.2, 1};
    struct local_factor f = local_factor_of(block, factor);
    if (kind == SOLVE_JACOBI) {
        gather(block, cut, values, f.inverse);
        for (size_t a = 0; a < block->n; a++)
            invert_surely(f.inverse + a);
        return 0;
    }
    int tried = 0;
    for (bool made = false; tried < SOLVE_SSOR && !made; tried += !made) {
        made = factorise(block, cut, values, shift[tried], &f);
        if (made)
            round_off(block, &f);
        made = made && is_close(block, values, &f);
    }
    if (tried == SOLVE_SSOR) {
        over_relax(block, cut, values, &f);
        round_off(block, &f);
    }
    return tried;
}
