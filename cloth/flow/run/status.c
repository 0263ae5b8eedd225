/* Tasks note in a step's status: rows beyond all bounds, a requested stop, a checkpoint due. */
#include "cloth/flow/run/step.h"
#include "cloth/flow/state/bodies.h"

#include "cloth/physics/particle.h"

bool flow_stop_is_asked(const struct flow *flow)
{
    const struct flow_progress *progress = flow->progress;
    return progress && progress->stop && progress->stop(progress->context);
}

static void status_note_stop(const duite_call *call, double *status)
{
    if (flow_stop_is_asked(flow_of(call)))
        status[FLOW_STOP] = 1;
}

int flow_check(const duite_call *call, const struct flow_table *t,
               const struct flow_step_args *step, const phys_vec *y, const char *what,
               double *status)
{
    const size_t bad = phys_diverged(t->n, FLOW_BOUND, y);
    status_note_stop(call, status);
    if (bad < t->n)
        status[FLOW_BEYOND] = 1;
    if (bad == t->n || !step->last)
        return 0;
    return duite_fail(call, FLOW_DIVERGED,
                      "step %.0f: the %s of vertex %u, counted from 1, in block %u is (%g, %g, "
                      "%g): the run diverged",
                      flow_step_number(step->begin), what, t->vertex[bad] + 1, step->block,
                      y[bad][0], y[bad][1], y[bad][2]);
}

/* Rank 0 alone has the clock by which checkpoints are due. */
static void note_due(const duite_call *call, double *status)
{
    const struct flow_progress *progress = flow_of(call)->progress;
    if (call->rank == 0 && progress && progress->due && progress->due(progress->context))
        status[FLOW_DUE] = 1;
}

FLOW_KERNEL(status, FLOW_NO_PART, struct flow_block_args, (SUM(status)))
{
    status_note_stop(call, on->status);
    note_due(call, on->status);
    return 0;
}

/* Runs on every rank, with or without blocks. */
int flow_status_fork(struct flow_state *state)
{
    const struct flow_block_args args = {0};
    for (int rank = 0; rank < duite_ranks(state->rt); rank++)
        flow_fork_at(state, rank, &flow_kernel_status, &args, NULL);
    return state->code;
}
