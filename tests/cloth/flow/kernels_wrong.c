/* Kernels as they must not be declared: test_kernels.sh compiles this with each number of WRONG.
 * 0: right. */
#include "cloth/flow/state/bodies.h"

#if WRONG == 1 /* a misspelt field */
FLOW_KERNEL(implicit, FLOW_POSITION, struct flow_step_args, (R(table), R(v), RW(x), W(halo_y)))
#elif WRONG == 2                 /* a field twice */
FLOW_KERNEL(implicit, FLOW_POSITION, struct flow_step_args,
            (R(table), R(v), RW(x), W(halo_x), R(x)))
#elif WRONG == 3                 /* a kernel that is in no list */
FLOW_KERNEL(somewhere, FLOW_POSITION, struct flow_step_args, (R(table), R(v), RW(x), W(halo_x)))
#elif WRONG == 4                 /* a word that is no mode */
FLOW_KERNEL(implicit, FLOW_POSITION, struct flow_step_args, (R(table), R(v), WR(x), W(halo_x)))
#elif WRONG == 5                 /* arguments that do not begin with the block */
struct other {
    double h;
    uint32_t block;
};
FLOW_KERNEL(implicit, FLOW_POSITION, struct other, (R(table), R(v), RW(x), W(halo_x)))
#elif WRONG == 9                 /* their block is not the number of one */
struct other {
    uint64_t block;
};
FLOW_KERNEL(implicit, FLOW_POSITION, struct other, (R(table), R(v), RW(x), W(halo_x)))
#elif WRONG == 12                /* an object that is no field, and that no list has */
FLOW_KERNEL(implicit, FLOW_POSITION, struct flow_step_args,
            (R(table), R(v), RW(x), W(halo_x), GIVEN_R(surprise)))
#elif WRONG == 10 || WRONG == 11 /* the block alone */
FLOW_KERNEL(implicit, FLOW_POSITION, struct flow_block_args, (R(table), R(v), RW(x), W(halo_x)))
#else
FLOW_KERNEL(implicit, FLOW_POSITION, struct flow_step_args, (R(table), R(v), RW(x), W(halo_x)))
#endif
{
    (void)call;
#if WRONG == 6 /* it is read only */
    on->v[0] = on->x[0];
#elif WRONG == 7  /* not declared */
    on->x[0] = on->dv[0];
#elif WRONG == 8  /* of another type */
    double *halo = on->halo_x;
    halo[0] = 0;
#elif WRONG == 10 /* arguments of a step, which the kernel lacks */
    const struct flow_table table = flow_table_in(call, on->table);
    return flow_check(call, &table, on->args, on->x, "position", NULL);
#elif WRONG == 11 /* a time of them */
    const struct flow_table table = flow_table_in(call, on->table);
    flow_varying_add(call, &table, on->args->now, on->x);
#endif
    on->x[0] += on->v[0];
    on->halo_x[0] = on->x[0];
    return 0;
}
