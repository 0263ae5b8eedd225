/* The order of every sum is given by the block: rows ascending, in the dots with q those of the rim
 * last. The fourth lane of q carries rubbish between a row's first spring and its end, and is zero
 * in every result.
 *
 * A pass is one sweep: its first half is as far before the product as the product's springs reach,
 * so that both work in the nearest cache. While the product computes, the rows and springs of the
 * next stretch are fetched. */
#include "cloth/solve/block.h"

enum {
    STRETCH = 64,       /* rows: they and their springs take half of a cache of 32 KiB */
    AHEAD = 96,         /* rows, */
    SPRINGS_AHEAD = 256 /* and about as many springs: enough for memory to answer */
};

/* alpha d + w (w . d); lane 3 becomes rubbish. */
PHYS_INLINE void spring(const phys_vec *value, const phys_vec *d, phys_vec *y)
{
    const phys_vec product = *value * *d; /* lane 3: d is zero there */
    phys_vec dot;
    phys_lanes_each(&product, &dot);
    *y = (*value)[3] * *d + dot * *value;
}

/* What lies so many rows further on: an address alone, which may be behind the end. */
PHYS_INLINE void fetch(const phys_vec *from, size_t rows, int to_write)
{
    const uintptr_t address = (uintptr_t)from + rows * sizeof *from;
    if (to_write)
        __builtin_prefetch((const void *)address, 1);
    else
        __builtin_prefetch((const void *)address, 0);
}

/* The first half of a pass for rows from .. to - 1; leaves q zero. Adds r * r to sum, and r * z if
 * there is a z. */
PHYS_INLINE void begin_rows(size_t from, size_t to, double alpha, double beta,
                            const struct solve_rows *rows, const struct solve_turned *turned,
                            phys_vec sum[SOLVE_DOTS])
{
    phys_vec *restrict dv = rows->dv, *restrict r = rows->r;
    phys_vec *restrict p = rows->p, *restrict q = rows->q;
    phys_vec square = sum[SOLVE_RR], product = sum[SOLVE_RZ];
    for (size_t a = from; a < to; a++) {
        dv[a] += alpha * p[a];
        if (turned) {
            r[a] -= alpha * q[a];
            solve_turn(alpha, beta, turned->s + a, turned->z + a, p + a);
            product += r[a] * turned->z[a];
        } else {
            solve_turn(alpha, beta, q + a, r + a, p + a);
        }
        square += r[a] * r[a];
        q[a] = (phys_vec){0};
    }
    sum[SOLVE_RR] = square;
    sum[SOLVE_RZ] = product;
}

/* How many rows have begun when those that the springs of rows from .. to - 1 end at have. */
PHYS_INLINE size_t reach(const struct solve_block *block, size_t from, size_t to, size_t begun)
{
    size_t last = begun > to ? begun : to;
    for (size_t a = from; a < to; a++) {
        const uint32_t end = block->row[a + 1];
        if (end > block->row[a] && block->column[end - 1] >= last)
            last = block->column[end - 1] + (size_t)1;
    }
    return last;
}

/* Springs of row a, from `value` and `column` on: takes each from its other row and returns the sum
 * for this one. */
PHYS_INLINE void row(size_t n, const phys_vec *restrict value, const uint32_t *column, size_t a,
                     const phys_vec *restrict p, phys_vec *restrict q, phys_vec *sum)
{
    const phys_vec own = p[a];
    phys_vec total = q[a];
    for (size_t i = 0; i < n; i++) {
        const uint32_t b = column[i];
        const phys_vec d = own - p[b];
        phys_vec y;
        spring(value + i, &d, &y);
        total += y;
        q[b] -= y;
    }
    *sum = total;
}

/* q = S A p of row a, of which total is the sum over the springs. Adds p * q, r * q, q * q to the
 * sums; with a preconditioner p * q and z * q. */
PHYS_INLINE void end_row(const struct solve_block *block, size_t a, const phys_vec *total,
                         const struct solve_rows *rows, const struct solve_turned *turned,
                         phys_vec sum[SOLVE_DOTS])
{
    const phys_vec three = {1, 1, 1, 0};
    const phys_vec p = rows->p[a];
    const phys_vec q = (*total + block->diagonal[a] * p) * (block->free[a] * three);
    rows->q[a] = q;
    sum[SOLVE_PQ] += p * q;
    sum[SOLVE_RQ] += (turned ? turned->z : rows->r)[a] * q;
    if (!turned)
        sum[SOLVE_QQ] += q * q;
}

/* The inner springs of rows from .. to - 1. Ends the rows but those of the rim, of which *met were
 * met before. */
PHYS_INLINE void multiply(const struct solve_block *block, const struct solve_cut *cut, size_t *met,
                          size_t from, size_t to, const phys_vec *value,
                          const struct solve_rows *rows, const struct solve_turned *turned,
                          phys_vec sum[SOLVE_DOTS])
{
    size_t i = block->row[from], rim = *met < cut->n_rim ? cut->rim[*met] : block->n;
    for (size_t a = from; a < to; a++) {
        const size_t n = block->row[a + 1] - i;
        phys_vec total;
        fetch(rows->dv + a, AHEAD, 1);
        fetch(rows->r + a, AHEAD, 1);
        fetch(rows->p + a, AHEAD, 1);
        fetch(rows->q + a, AHEAD, 1);
        fetch(value + i, SPRINGS_AHEAD, 0);
        fetch(value + i + 2, SPRINGS_AHEAD, 0);
        row(n, value + i, block->column + i, a, rows->p, rows->q, &total);
        i += n;
        if (a != rim) {
            end_row(block, a, &total, rows, turned, sum);
            continue;
        }
        rows->q[a] = total;
        rim = ++*met < cut->n_rim ? cut->rim[*met] : block->n;
    }
}

/* The springs into other blocks, and the rows that waited for them. */
PHYS_INLINE void end_rim(const struct solve_block *block, const struct solve_cut *cut,
                         const phys_vec *value, const phys_vec *p_other,
                         const struct solve_rows *rows, const struct solve_turned *turned,
                         phys_vec sum[SOLVE_DOTS])
{
    for (size_t i = 0; i < cut->n; i++) {
        const uint32_t a = cut->end[i][0];
        const phys_vec d = rows->p[a] - p_other[cut->end[i][1]];
        phys_vec y;
        spring(value + i, &d, &y);
        rows->q[a] += y;
    }
    for (size_t i = 0; i < cut->n_rim; i++) {
        const phys_vec total = rows->q[cut->rim[i]];
        end_row(block, cut->rim[i], &total, rows, turned, sum);
    }
}

/* turned is NULL or not where this is inlined: two passes are made of it, neither with a look at it
 * in a loop. */
PHYS_INLINE void pass(const struct solve_block *block, const struct solve_cut *cut,
                      const phys_vec *value, const phys_vec *p_other, double alpha, double beta,
                      const struct solve_rows *rows, const struct solve_turned *turned,
                      double dots[SOLVE_DOTS])
{
    phys_vec sum[SOLVE_DOTS] = {{0}}; /* no loop over it: it lives in registers */
    size_t met = 0, begun = 0;
    for (size_t from = 0; from < block->n; from += STRETCH) {
        const size_t to = block->n - from > STRETCH ? from + STRETCH : block->n;
        const size_t next = reach(block, from, to, begun);
        begin_rows(begun, next, alpha, beta, rows, turned, sum);
        begun = next;
        multiply(block, cut, &met, from, to, value, rows, turned, sum);
    }
    end_rim(block, cut, value + block->row[block->n], p_other, rows, turned, sum);
    dots[SOLVE_RR] = phys_lanes(sum + SOLVE_RR);
    dots[SOLVE_PQ] = phys_lanes(sum + SOLVE_PQ);
    dots[SOLVE_RQ] = phys_lanes(sum + SOLVE_RQ);
    dots[SOLVE_QQ] = phys_lanes(sum + SOLVE_QQ);
    dots[SOLVE_RZ] = turned ? phys_lanes(sum + SOLVE_RZ) : dots[SOLVE_RR];
}

PHYS_CLONES
void solve_pass(const struct solve_block *block, const struct solve_cut *cut, const phys_vec *value,
                const phys_vec *p_other, double alpha, double beta, const struct solve_rows *rows,
                double dots[SOLVE_DOTS])
{
    pass(block, cut, value, p_other, alpha, beta, rows, NULL, dots);
}

PHYS_CLONES
void solve_pass_turned(const struct solve_block *block, const struct solve_cut *cut,
                       const phys_vec *value, const phys_vec *p_other, double alpha, double beta,
                       const struct solve_rows *rows, const struct solve_turned *turned,
                       double dots[SOLVE_DOTS])
{
    const struct solve_turned here = *turned;
    pass(block, cut, value, p_other, alpha, beta, rows, &here, dots);
}

void solve_lost(const struct solve_block *block, const struct solve_held *held,
                const phys_vec *value, const phys_vec *b, const phys_vec *dv, double lost[3])
{
    phys_vec sum = {0};
    for (size_t a = 0; a < block->n; a++)
        sum += block->free[a] * (b[a] - block->diagonal[a] * dv[a]);
    for (size_t i = 0; i < held->n; i++) {
        phys_vec y;
        spring(value + held->at[i][1], dv + held->at[i][0], &y);
        sum -= y;
    }
    for (int c = 0; c < 3; c++)
        lost[c] += sum[c];
}
