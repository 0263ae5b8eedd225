/* The order of every sum is given by the block: rows ascending. The fourth lane of q carries
 * rubbish between solve_matvec_cut and the end of its row in solve_matvec, and is zero in every
 * result. */
#include "cloth/solve/block.h"

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
void solve_matvec(const struct solve_block *block, const phys_vec *restrict value,
                  const phys_vec *restrict p, const phys_vec *restrict r, phys_vec *restrict q,
                  double dots[SOLVE_DOTS])
{
    const phys_vec three = {1, 1, 1, 0};
    phys_vec pq = {0}, rq = {0}, qq = {0};
    for (size_t a = 0; a < block->n; a++) {
        phys_vec sum;
        row(block, a, value, p, q, &sum);
        const phys_vec product = (sum + block->diagonal[a] * p[a]) * (block->free[a] * three);
        q[a] = product;
        pq += p[a] * product;
        rq += r[a] * product;
        qq += product * product;
    }
    dots[SOLVE_PQ] = phys_lanes(&pq);
    dots[SOLVE_RQ] = phys_lanes(&rq);
    dots[SOLVE_QQ] = phys_lanes(&qq);
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
