/* The order of every sum is given by the block: rows ascending, in the dots with q those of the
 * halo last. The fourth lane of q carries undefined values between a row's first entry and its end,
 * and is zero in every result.
 *
 * A pass is one sweep: its first half is as far before the product as the product's entries reach,
 * so that both work in the nearest cache. Rows and entries farther on are fetched meanwhile. */
#include "cloth/solve/block.h"

enum {
    STRETCH = 64, /* rows: they and their entries take a cache of 32 KiB or half of it */
    ROWS_AHEAD = 96 * sizeof(phys_vec), /* bytes of each vector that are fetched beforehand, */
    ENTRIES_AHEAD = 256 * 32,           /* and of the entries: enough for memory to answer */
    LINE = 64
};

/* The first half of a pass for rows from .. to - 1; leaves q zero. Adds r * r to sum, and r * z
 * with a preconditioner. */
PHYS_INLINE void begin_rows(bool preconditioned, size_t from, size_t to, double alpha, double beta,
                            const struct solve_rows *rows, phys_vec sum[SOLVE_DOTS])
{
    phys_vec *restrict dv = rows->dv, *restrict r = rows->r;
    phys_vec *restrict p = rows->p, *restrict q = rows->q;
    phys_vec square = sum[SOLVE_RR], product = sum[SOLVE_RZ];
    for (size_t a = from; a < to; a++) {
        phys_fetch(dv + a, ROWS_AHEAD, 1);
        phys_fetch(r + a, ROWS_AHEAD, 1);
        phys_fetch(p + a, ROWS_AHEAD, 1);
        phys_fetch(q + a, ROWS_AHEAD, 1);
        const phys_vec before = q[a]; /* in registers: compilers read again what they stored */
        phys_vec left = r[a], next = p[a];
        dv[a] += alpha * next;
        if (preconditioned) {
            phys_vec z = rows->z[a];
            left -= alpha * before;
            solve_advance(alpha, beta, rows->s + a, &z, &next);
            rows->z[a] = z;
            product += left * z;
        } else {
            solve_advance(alpha, beta, &before, &left, &next);
        }
        r[a] = left;
        p[a] = next;
        square += left * left;
        q[a] = (phys_vec){0};
    }
    sum[SOLVE_RR] = square;
    sum[SOLVE_RZ] = product;
}

/* Prefetches three entries, beyond entry i. */
PHYS_INLINE void fetch_entries(enum solve_format format, const void *values, size_t i)
{
    static const size_t bytes[] = {[SOLVE_SPRINGS] = 32, [SOLVE_HALF] = 72}; /* an entry */
    for (size_t line = 0; line < 3 * bytes[format]; line += LINE)
        phys_fetch((const char *)values + bytes[format] * i, ENTRIES_AHEAD + line, 0);
}

/* Entries from .. to - 1 of row a: takes each from its other row and returns the sum for this one.
 */
PHYS_INLINE void row(enum solve_format format, size_t from, size_t to, const void *values,
                     const uint32_t *column, size_t a, const phys_vec *restrict p,
                     phys_vec *restrict q, phys_vec *sum)
{
    const phys_vec own = p[a];
    phys_vec total = q[a];
    for (size_t i = from; i < to; i++) {
        const uint32_t b = column[i];
        const phys_vec d = own - p[b];
        phys_vec y, turned;
        solve_entry_times(format, values, i, &d, &y, &turned);
        total += y;
        q[b] -= turned;
    }
    *sum = total;
}

/* q = S A p of row a, of which total is the sum over the entries. Adds p * q, r * q, q * q to the
 * sums; with a preconditioner p * q and z * q. */
PHYS_INLINE void end_row(const struct solve_block *block, bool preconditioned, size_t a,
                         const phys_vec *total, const struct solve_rows *rows,
                         phys_vec sum[SOLVE_DOTS])
{
    const phys_vec three = {1, 1, 1, 0};
    const phys_vec p = rows->p[a];
    phys_vec q = *total + block->diagonal[a] * p;
    q *= block->free[a] * three;
    if (block->filter)
        solve_filter(block->filter + a, &q);
    rows->q[a] = q;
    sum[SOLVE_PQ] += p * q;
    sum[SOLVE_RQ] += (preconditioned ? rows->z : rows->r)[a] * q;
    if (!preconditioned)
        sum[SOLVE_QQ] += q * q;
}

/* The inner entries of rows from .. to - 1. Ends the rows but those of the halo, of which *met were
 * met before. */
PHYS_INLINE void multiply(const struct solve_block *block, enum solve_format format,
                          bool preconditioned, const struct solve_cut *cut, size_t *met,
                          size_t from, size_t to, const void *values, const struct solve_rows *rows,
                          phys_vec sum[SOLVE_DOTS])
{
    size_t i = block->row[from], halo = *met < cut->n_halo ? cut->halo[*met] : block->n;
    for (size_t a = from; a < to; a++) {
        const size_t end = block->row[a + 1];
        phys_vec total;
        fetch_entries(format, values, i);
        row(format, i, end, values, block->column, a, rows->p, rows->q, &total);
        i = end;
        if (a != halo) {
            end_row(block, preconditioned, a, &total, rows, sum);
            continue;
        }
        rows->q[a] = total;
        halo = ++*met < cut->n_halo ? cut->halo[*met] : block->n;
    }
}

/* Adds the products of ties from .. to - 1 with p to q. A tie has so many corners, of which `own`
 * are rows. */
PHYS_INLINE void add_ties(const struct solve_ties *ties, size_t from, size_t to, int own,
                          int corners, size_t n_rows, const phys_vec *restrict p,
                          phys_vec *restrict q)
{
    for (size_t i = from; i < to; i++) {
        const uint32_t *corner = ties->corner[i];
        const double *weight = ties->weight[i];
        phys_vec u = weight[0] * p[corner[0]], y;
        PHYS_UNROLL
        for (int k = 1; k < corners; k++)
            u += weight[k] * (k < own ? p[corner[k]] : ties->p_other[corner[k] - n_rows]);
        solve_spring_times(ties->value + i, &u, &y);
        PHYS_UNROLL
        for (int k = 0; k < own; k++)
            q[corner[k]] += weight[k] * y;
    }
}

/* Inlining makes the numbers of corners constants, too. */
PHYS_KERNEL(solve_add_ties,
            (size_t n_rows, const struct solve_ties *ties, const phys_vec *restrict p,
             phys_vec *restrict q),
            (n_rows, ties, p, q))
{
    const struct solve_ties here = *ties; /* stays in registers */
    const uint32_t *start = ties->start;
    add_ties(&here, start[0], start[1], 1, 1, n_rows, p, q);
    add_ties(&here, start[1], start[2], 1, SOLVE_TIE_CORNERS, n_rows, p, q);
    add_ties(&here, start[2], start[3], 2, SOLVE_TIE_CORNERS, n_rows, p, q);
    add_ties(&here, start[3], start[4], 3, SOLVE_TIE_CORNERS, n_rows, p, q);
    add_ties(&here, start[4], start[5], 4, SOLVE_TIE_CORNERS, n_rows, p, q);
}

/* The entries into other blocks, ties, and the rows that waited for them. */
PHYS_INLINE void end_halo(const struct solve_block *block, enum solve_format format,
                          bool preconditioned, const struct solve_cut *cut, const void *values,
                          const phys_vec *p_other, const struct solve_rows *rows,
                          phys_vec sum[SOLVE_DOTS])
{
    const size_t inner = block->row[block->n];
    for (size_t i = 0; i < cut->n; i++) {
        const uint32_t a = cut->end[i][0];
        const phys_vec d = rows->p[a] - p_other[cut->end[i][1]];
        phys_vec y, other;
        solve_entry_times(format, values, inner + i, &d, &y, &other);
        rows->q[a] += y;
    }
    if (cut->ties)
        solve_add_ties(block->n, cut->ties, rows->p, rows->q);
    for (size_t i = 0; i < cut->n_halo; i++) {
        const phys_vec total = rows->q[cut->halo[i]];
        end_row(block, preconditioned, cut->halo[i], &total, rows, sum);
    }
}

/* Inlining makes format and preconditioned constants: four passes are made, none of which tests
 * them in a loop. */
PHYS_INLINE void pass(const struct solve_block *block, enum solve_format format,
                      bool preconditioned, const struct solve_cut *cut, const void *values,
                      const phys_vec *p_other, double alpha, double beta,
                      const struct solve_rows *rows, double dots[SOLVE_DOTS])
{
    phys_vec sum[SOLVE_DOTS] = {{0}}; /* no loop over it: it lives in registers */
    size_t met = 0, begun = 0;
    for (size_t from = 0; from < block->n; from += STRETCH) {
        const size_t to = block->n - from > STRETCH ? from + STRETCH : block->n;
        const size_t reach = block->n - to > block->span ? to + block->span : block->n;
        begin_rows(preconditioned, begun, reach, alpha, beta, rows, sum);
        begun = reach;
        multiply(block, format, preconditioned, cut, &met, from, to, values, rows, sum);
    }
    end_halo(block, format, preconditioned, cut, values, p_other, rows, sum);
    dots[SOLVE_RR] = phys_lanes(sum + SOLVE_RR);
    dots[SOLVE_PQ] = phys_lanes(sum + SOLVE_PQ);
    dots[SOLVE_RQ] = phys_lanes(sum + SOLVE_RQ);
    dots[SOLVE_QQ] = phys_lanes(sum + SOLVE_QQ);
    dots[SOLVE_RZ] = preconditioned ? phys_lanes(sum + SOLVE_RZ) : dots[SOLVE_RR];
}

/* preconditioned: a constant where this is inlined, too. */
PHYS_INLINE void pass_of(const struct solve_block *block, bool preconditioned,
                         const struct solve_cut *cut, const void *values, const phys_vec *p_other,
                         double alpha, double beta, const struct solve_rows *rows,
                         double dots[SOLVE_DOTS])
{
    if (block->format == SOLVE_SPRINGS)
        pass(block, SOLVE_SPRINGS, preconditioned, cut, values, p_other, alpha, beta, rows, dots);
    else
        pass(block, SOLVE_HALF, preconditioned, cut, values, p_other, alpha, beta, rows, dots);
}

/* The two halves of solve_pass are kernels of their own: compilers make fewer instructions of each
 * than of one function with both passes. */
PHYS_KERNEL(solve_pass_plain,
            (const struct solve_block *block, const struct solve_cut *cut, const void *values,
             const phys_vec *p_other, double alpha, double beta, const struct solve_rows *rows,
             double dots[SOLVE_DOTS]),
            (block, cut, values, p_other, alpha, beta, rows, dots))
{
    pass_of(block, false, cut, values, p_other, alpha, beta, rows, dots);
}

PHYS_KERNEL(solve_pass_preconditioned,
            (const struct solve_block *block, const struct solve_cut *cut, const void *values,
             const phys_vec *p_other, double alpha, double beta, const struct solve_rows *rows,
             double dots[SOLVE_DOTS]),
            (block, cut, values, p_other, alpha, beta, rows, dots))
{
    const struct solve_rows here = *rows; /* z and s stay in registers */
    pass_of(block, true, cut, values, p_other, alpha, beta, &here, dots);
}

void solve_pass(const struct solve_block *block, const struct solve_cut *cut, const void *values,
                const phys_vec *p_other, double alpha, double beta, const struct solve_rows *rows,
                double dots[SOLVE_DOTS])
{
    if (rows->z == rows->r)
        solve_pass_plain(block, cut, values, p_other, alpha, beta, rows, dots);
    else
        solve_pass_preconditioned(block, cut, values, p_other, alpha, beta, rows, dots);
}

/* A pass with dv for r and without factors: p = dv, q = S A dv, and nothing else changes. */
void solve_residual(const struct solve_block *block, const struct solve_cut *cut,
                    const void *values, const phys_vec *b, const phys_vec *dv_other,
                    const struct solve_rows *rows, double dots[SOLVE_DOTS])
{
    const struct solve_rows of_dv = solve_rows_plain(rows->r, rows->dv, rows->p, rows->q);
    solve_pass(block, cut, values, dv_other, 0, 0, &of_dv, dots);
    solve_renew(block->n, block->free, block->diagonal, b, rows->q, rows->r, dots);
    const struct solve_norms norms = solve_norms(block->n, block->diagonal, rows->dv, rows->r);
    dots[SOLVE_SIZE] = norms.size;
    dots[SOLVE_BOUND] = norms.bound;
}

void solve_open(const struct solve_block *block, const struct solve_cut *cut, const void *values,
                const phys_vec *guess_other, const struct solve_rows *rows, double dots[SOLVE_DOTS])
{
    const struct solve_rows of_dv = solve_rows_plain(rows->r, rows->dv, rows->p, rows->q);
    phys_vec square = {0}, along = {0};
    solve_pass(block, cut, values, guess_other, 0, 0, &of_dv, dots);
    for (size_t a = 0; a < block->n; a++) {
        square += rows->r[a] * rows->r[a];
        along += rows->r[a] * rows->p[a];
        rows->dv[a] = (phys_vec){0};
    }
    dots[SOLVE_RR] = phys_lanes(&square);
    dots[SOLVE_RQ] = phys_lanes(&along);
}

/* In the sum over the free rows of A, column b is the diagonal of row b and N' of its entries to
 * held rows. */
void solve_lost(const struct solve_block *block, const struct solve_held *held, const void *values,
                const phys_vec *b, const phys_vec *dv, double lost[3])
{
    const size_t inner = block->row[block->n];
    phys_vec sum = {0};
    for (size_t a = 0; a < block->n; a++)
        sum += block->free[a] * (b[a] - block->diagonal[a] * dv[a]);
    for (size_t k = 0; k < held->n; k++) {
        const uint32_t a = held->at[k][0], i = held->at[k][1];
        phys_vec y, turned;
        solve_entry_times(block->format, values, i, dv + a, &y, &turned);
        sum -= i < inner && block->column[i] == a ? y : turned;
    }
    for (int c = 0; c < 3; c++)
        lost[c] += sum[c];
}
