/* A factor is applied by one pass over its rows and one back (cloth/solve/local_rows.h). */
#include "cloth/solve/local.h"
#include "cloth/solve/local_rows.h"

PHYS_KERNEL_OF(double, solve_local_apply,
               (const struct solve_block *block, enum solve_local kind, const double *factor,
                const phys_vec *q, phys_vec *s),
               (block, kind, factor, q, s))
{
    const struct local_factor f = local_factor_of(block, (double *)(uintptr_t)factor);
    if (kind == SOLVE_IC0) {
        for (size_t a = 0; a < block->n; a++)
            s[a] = q[a];
        local_forward(block, &f, s);
        return local_backward(block, &f, q, s);
    }
    phys_vec dot = {0};
    for (size_t a = 0; a < block->n; a++) {
        solve_times(f.inverse + a, q + a, s + a);
        dot += q[a] * s[a];
    }
    return phys_lanes(&dot);
}
