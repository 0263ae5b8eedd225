/* The state before a step is kept until the step is accepted; restoring it makes the step undone.
 */
#include "cloth/flow/bodies.h"

static int keep(const duite_call *call)
{
    for (size_t i = 0; i < 2; i++)
        memcpy(duite_out(call, 2 + i, phys_vec), duite_in(call, i, phys_vec),
               duite_count(call, i) * sizeof(double));
    return 0;
}
FLOW_TIMED(keep, FLOW_POSITION)
const duite_kernel flow_keep = {.name = "keep",
                                .body = keep_timed,
                                .access = {DUITE_R, DUITE_R, DUITE_W, DUITE_W},
                                .args_size = sizeof(struct flow_args)};

static int restore(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call);
    for (size_t i = 1; i < 3; i++) {
        const phys_vec *kept = duite_in(call, i, phys_vec);
        memcpy(duite_out(call, 2 + i, phys_vec), kept, duite_count(call, i) * sizeof(double));
        flow_write_rim(&table, kept, duite_out(call, 4 + i, phys_vec));
    }
    return 0;
}
FLOW_TIMED(restore, FLOW_POSITION)
const duite_kernel flow_restore = {
    .name = "restore",
    .body = restore_timed,
    .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_W, DUITE_W, DUITE_W, DUITE_W},
    .args_size = sizeof(struct flow_args)};
