/* The order of every sum is given by the block: rows ascending, dots in four interleaved partial
 * sums. The fourth lane of q carries rubbish between solve_matvec_cut and the end of its row in
 * solve_matvec, and is zero in every result. */
#include "cloth/solve/block.h"

#include <string.h>

/* alpha d + w (w . d); lane 3 becomes rubbish. */
PHYS_INLINE void spring(const phys_vec *value, const phys_vec *d, phys_vec *y)
{
    const phys_vec product = *value * *d; /* lane 3: d is zero there */
    *y = (*value)[3] * *d + phys_lanes(&product) * *value;
}

PHYS_CLONES
void solve_matvec_cut(const struct solve_cut *cut, const phys_vec *value, const phys_vec *p,
                      const phys_vec *p_other, phys_vec *q)
{
    for (size_t i = 0; i < cut->n; i++) {
        const uint32_t a = cut->end[i][0];
        const phys_vec d = p[a] - p_other[cut->end[i][1]];
        phys_vec y;
        spring(value + i, &d, &y);
        q[a] += y;
    }
}

/* Springs of row a: takes each from its other row and returns the sum for this one. */
PHYS_INLINE void row(const struct solve_block *block, size_t a, const phys_vec *value,
                     const phys_vec *p, phys_vec *q, phys_vec *sum)
{
    const phys_vec own = p[a];
    phys_vec total = q[a];
    for (uint32_t i = block->row[a]; i < block->row[a + 1]; i++) {
        const uint32_t b = block->column[i];
        const phys_vec d = own - p[b];
        phys_vec y;
        spring(value + i, &d, &y);
        total += y;
        q[b] -= y;
    }
    *sum = total;
}

PHYS_CLONES
double solve_matvec(const struct solve_block *block, const phys_vec *restrict value,
                    const phys_vec *restrict p, phys_vec *restrict q)
{
    const phys_vec three = {1, 1, 1, 0};
    phys_vec dot = {0};
    for (size_t a = 0; a < block->n; a++) {
        phys_vec sum;
        row(block, a, value, p, q, &sum);
        q[a] = (sum + block->diagonal[a] * p[a]) * (block->free[a] * three);
        dot += p[a] * q[a];
    }
    return phys_lanes(&dot);
}

PHYS_CLONES
double solve_start(size_t n, const double *restrict free, const phys_vec *restrict b,
                   phys_vec *restrict dv, phys_vec *restrict r, phys_vec *restrict p)
{
    phys_vec dot = {0};
    for (size_t a = 0; a < n; a++) {
        const phys_vec start = free[a] * b[a];
        r[a] = start;
        p[a] = start;
        dot += start * start;
    }
    memset(dv, 0, n * sizeof *dv);
    return phys_lanes(&dot);
}

/* One row of the update: returns its r * r through dot. */
PHYS_INLINE void update(size_t a, double alpha, const phys_vec *p, const phys_vec *q, phys_vec *dv,
                        phys_vec *r, phys_vec *dot)
{
    const phys_vec left = r[a] - alpha * q[a];
    dv[a] += alpha * p[a];
    r[a] = left;
    *dot += left * left;
}

PHYS_CLONES
double solve_update(size_t n, double alpha, const phys_vec *restrict p, const phys_vec *restrict q,
                    phys_vec *restrict dv, phys_vec *restrict r)
{
    phys_vec dot[4] = {{0}};
    size_t a = 0;
    for (; a + 4 <= n; a += 4) {
        update(a, alpha, p, q, dv, r, dot);
        update(a + 1, alpha, p, q, dv, r, dot + 1);
        update(a + 2, alpha, p, q, dv, r, dot + 2);
        update(a + 3, alpha, p, q, dv, r, dot + 3);
    }
    for (; a < n; a++)
        update(a, alpha, p, q, dv, r, dot + (a & 3));
    const phys_vec all = (dot[0] + dot[2]) + (dot[1] + dot[3]);
    return phys_lanes(&all);
}

PHYS_CLONES
void solve_direction(size_t n, double beta, const phys_vec *restrict r, phys_vec *restrict p)
{
    for (size_t a = 0; a < n; a++)
        p[a] = r[a] + beta * p[a];
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
