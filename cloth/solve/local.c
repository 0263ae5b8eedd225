/* A factor is, for each row, the inverse of a 3 x 3 block (struct solve_symmetric), and behind them
 * for IC(0), for each inner entry, its block of T. The same T stands on both sides of E, so M is
 * exactly symmetric and as definite as E. T in float takes half the bytes and is slower: what is
 * converted is in the cache of the core anyway. */
#include "cloth/solve/local.h"
#include "cloth/solve/matrix3.h"

#include <stdbool.h>

/* A pivot below this part of its row's diagonal is rounding. */
#define LEAST 1e-9

/* Those of B are not below its masses; what IC(0) leaves so far below is as good as nothing. */
#define LEAST_OF_MASS 1e-3

struct factor {
    struct solve_symmetric *inverse; /* n */
    struct solve_columns *t;         /* row[n] */
};

static struct factor factor_of(const struct solve_block *block, double *memory)
{
    struct solve_symmetric *inverse = (struct solve_symmetric *)(void *)memory;
    return (struct factor){inverse, (struct solve_columns *)(void *)(inverse + block->n)};
}

size_t solve_local_doubles(size_t n, size_t entries, enum solve_local kind)
{
    const size_t blocks = kind == SOLVE_IC0 ? entries : 0;
    return (n * sizeof(struct solve_symmetric) + blocks * sizeof(struct solve_columns)) /
           sizeof(double);
}

PHYS_INLINE void add(struct solve_symmetric *to, const struct solve_symmetric *m)
{
    to->diagonal += m->diagonal;
    to->beside += m->beside;
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
    m->beside =
        (phys_vec){columns.c[1][0], columns.c[2][1], columns.c[0][2], 0} - along * d * SOLVE_YZX(d);
}

/* The blocks on the diagonal of B. */
PHYS_INLINE void gather(const struct solve_block *block, const struct solve_cut *cut,
                        const void *values, struct solve_symmetric *sum)
{
    const enum solve_format format = block->format;
    const void *entry = solve_values_of(format, block->n, values).entry;
    struct solve_symmetric m = {{0}, {0}};
    phys_vec turn; /* of a row they come to nothing */
    for (size_t a = 0; a < block->n; a++) {
        const double d = block->diagonal[a];
        sum[a] = (struct solve_symmetric){{d, d, d, 0}, {0}};
    }
    for (size_t a = 0; a < block->n; a++)
        for (uint32_t i = block->row[a]; i < block->row[a + 1]; i++) {
            solve_entry_of(format, entry, i, &m, &turn);
            add(sum + a, &m);
            add(sum + block->column[i], &m);
        }
    for (size_t i = 0; i < cut->n; i++) {
        solve_entry_of(format, entry, block->row[block->n] + i, &m, &turn);
        add(sum + cut->end[i][0], &m);
    }
    for (size_t a = 0; a < block->n; a++)
        if (block->free[a] == 0)
            sum[a] = (struct solve_symmetric){{1, 1, 1, 0}, {0}};
        else if (block->filter)
            filter_diagonal(block->filter + a, sum + a);
}

/* A row's block may be singular in what rounding leaves of a stiff spring: then a larger diagonal
 * is taken, which is not. */
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

/* The inner entries of B: zero where an end is held. */
PHYS_INLINE void spread(const struct solve_block *block, const void *values,
                        struct solve_columns *t)
{
    const void *entry = solve_values_of(block->format, block->n, values).entry;
    for (size_t a = 0; a < block->n; a++)
        for (uint32_t i = block->row[a]; i < block->row[a + 1]; i++) {
            struct solve_symmetric m = {{0}, {0}};
            phys_vec turn;
            solve_entry_of(block->format, entry, i, &m, &turn);
            solve_entry_columns(&m, &turn, t + i);
            const double sign = -block->free[a] * block->free[block->column[i]];
            for (int k = 0; k < 3; k++)
                t[i].c[k] *= sign;
            if (block->filter) {
                filter_left(block->filter + a, t + i);
                filter_right(block->filter + block->column[i], t + i);
            }
        }
}

/* t = inverse t. */
PHYS_INLINE void scale(const struct solve_symmetric *inverse, struct solve_columns *t)
{
    for (int k = 0; k < 3; k++) {
        const phys_vec column = t->c[k];
        solve_times(inverse, &column, t->c + k);
    }
}

/* b -= t' w, where that is symmetric. */
PHYS_INLINE void reduce_diagonal(const struct solve_columns *t, const struct solve_columns *w,
                                 struct solve_symmetric *b)
{
    struct solve_columns m;
    for (int k = 0; k < 3; k++)
        solve_columns_turned(t, w->c + k, m.c + k);
    b->diagonal -= (phys_vec){m.c[0][0], m.c[1][1], m.c[2][2], 0};
    b->beside -= (phys_vec){m.c[1][0], m.c[2][1], m.c[2][0], 0};
}

/* The entry of (b, c) -= t' w, if it is in the pattern. */
PHYS_INLINE void reduce_beside(const struct solve_block *block, uint32_t b, uint32_t c,
                               const struct solve_columns *w, const struct solve_columns *t,
                               struct solve_columns *all)
{
    uint32_t i = block->row[b];
    while (i < block->row[b + 1] && block->column[i] < c)
        i++;
    if (i == block->row[b + 1] || block->column[i] != c)
        return;
    for (int k = 0; k < 3; k++) {
        phys_vec product;
        solve_columns_turned(t, w->c + k, &product);
        all[i].c[k] -= product;
    }
}

/* Takes row a out of the rows behind it. pivot: its block of E. */
PHYS_INLINE void eliminate(const struct solve_block *block, size_t a,
                           const struct solve_symmetric *pivot, struct factor *f)
{
    const uint32_t from = block->row[a], to = block->row[a + 1];
    for (uint32_t i = from; i < to; i++)
        scale(f->inverse + a, f->t + i);
    for (uint32_t i = from; i < to; i++) {
        struct solve_columns w;
        for (int k = 0; k < 3; k++)
            solve_times(pivot, f->t[i].c + k, w.c + k);
        reduce_diagonal(f->t + i, &w, f->inverse + block->column[i]);
        for (uint32_t j = from; j < i; j++)
            reduce_beside(block, block->column[j], block->column[i], &w, f->t + j, f->t);
    }
}

/* IC(0) with the diagonal entries of B times 1 + shift. Returns false if a pivot fails. */
PHYS_INLINE bool factorise(const struct solve_block *block, const struct solve_cut *cut,
                           const void *values, double shift, struct factor *f)
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
        eliminate(block, a, &pivot, f);
    }
    return true;
}

/* (I + T') E (I + T) with E the diagonal of B, T = E^-1 (its upper part). */
PHYS_INLINE void over_relax(const struct solve_block *block, const struct solve_cut *cut,
                            const void *values, struct factor *f)
{
    gather(block, cut, values, f->inverse);
    spread(block, values, f->t);
    for (size_t a = 0; a < block->n; a++) {
        invert_surely(f->inverse + a);
        for (uint32_t i = block->row[a]; i < block->row[a + 1]; i++)
            scale(f->inverse + a, f->t + i);
    }
}

PHYS_KERNEL_OF(int, solve_local_factor,
               (const struct solve_block *block, const struct solve_cut *cut, const void *values,
                enum solve_local kind, double *factor),
               (block, cut, values, kind, factor))
{
    static const double shift[SOLVE_SSOR] = {0, 0.01, 0.05, 0.2, 1};
    struct factor f = factor_of(block, factor);
    if (kind == SOLVE_JACOBI) {
        gather(block, cut, values, f.inverse);
        for (size_t a = 0; a < block->n; a++)
            invert_surely(f.inverse + a);
        return 0;
    }
    for (int i = 0; i < SOLVE_SSOR; i++)
        if (factorise(block, cut, values, shift[i], &f))
            return i;
    over_relax(block, cut, values, &f);
    return SOLVE_SSOR;
}

/* s = (I + T')^-1 q, then E^-1 of it; a row is final when all before it are. */
PHYS_INLINE void forward(const struct solve_block *block, const struct factor *f, phys_vec *s)
{
    for (size_t a = 0; a < block->n; a++) {
        const phys_vec own = s[a];
        for (uint32_t i = block->row[a]; i < block->row[a + 1]; i++) {
            phys_vec y;
            solve_columns_turned(f->t + i, &own, &y);
            s[block->column[i]] -= y;
        }
        solve_times(f->inverse + a, &own, s + a);
    }
}

/* s = (I + T)^-1 s. Returns q.s. */
PHYS_INLINE double backward(const struct solve_block *block, const struct factor *f,
                            const phys_vec *q, phys_vec *s)
{
    phys_vec dot = {0};
    for (size_t a = block->n; a-- > 0;) {
        phys_vec sum = s[a];
        for (uint32_t i = block->row[a + 1]; i-- > block->row[a];) { /* the latest last */
            phys_vec y;
            solve_columns_times(f->t + i, s + block->column[i], &y);
            sum -= y;
        }
        s[a] = sum;
        dot += q[a] * sum;
    }
    return phys_lanes(&dot);
}

PHYS_KERNEL_OF(double, solve_local_apply,
               (const struct solve_block *block, enum solve_local kind, const double *factor,
                const phys_vec *q, phys_vec *s),
               (block, kind, factor, q, s))
{
    const struct solve_symmetric *inverse = (const struct solve_symmetric *)(const void *)factor;
    const struct factor f = {(struct solve_symmetric *)(uintptr_t)inverse,
                             (struct solve_columns *)(uintptr_t)(inverse + block->n)};
    if (kind == SOLVE_IC0) {
        for (size_t a = 0; a < block->n; a++)
            s[a] = q[a];
        forward(block, &f, s);
        return backward(block, &f, q, s);
    }
    phys_vec dot = {0};
    for (size_t a = 0; a < block->n; a++) {
        solve_times(f.inverse + a, q + a, s + a);
        dot += q[a] * s[a];
    }
    return phys_lanes(&dot);
}
