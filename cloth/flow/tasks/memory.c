/* What can fail on one rank alone is had before the first task of a run. A rank that lacks it does
 * not leave: it says so in a task, and all ranks leave together. */
#include "cloth/flow/tasks/bodies.h"

#include "cloth/base/memory.h"

#include <stdlib.h>
#include <string.h>

static size_t larger(size_t a, size_t b)
{
    return a > b ? a : b;
}

static void take(struct flow_state *state)
{
    struct flow *flow = state->flow;
    const struct flow_tables *tables = &flow->tables;
    size_t rows = 0, slots = 0;
    for (uint32_t b = 0; b < tables->n_blocks; b++) {
        rows = larger(rows, tables->block[b].n);
        slots = larger(slots, tables->block[b].n_slots);
    }
    const size_t refs = larger(tables->n_blocks, 2 * slots) + DUITE_MAX_ACCESS;
    flow->n_clocks = duite_threads(state->rt);
    flow->clock = aligned_alloc(sizeof *flow->clock, flow->n_clocks * sizeof *flow->clock);
    if (flow->clock)
        memset(flow->clock, 0, flow->n_clocks * sizeof *flow->clock);
    else
        cloth_fail(&flow->trouble, CLOTH_E_MEMORY, "out of memory for %u clocks", flow->n_clocks);
    state->block = cloth_alloc(tables->n_blocks, sizeof *state->block, &flow->trouble);
    state->refs = cloth_alloc(refs, sizeof *state->refs, &flow->trouble);
    state->rows = cloth_alloc(larger(4 * rows, slots), sizeof *state->rows, &flow->trouble);
    flow_far_take(state);
    if (duite_rank(state->rt) == 0)
        flow->room = cloth_alloc(flow->n_vertices, 6 * sizeof *flow->room, &flow->trouble);
}

static int ready(const duite_call *call)
{
    const struct cloth_error *trouble = &flow_of(call)->trouble;
    return trouble->code
               ? duite_fail(call, FLOW_NO_MEMORY, "rank %d: %s", call->rank, trouble->text)
               : 0;
}
const duite_kernel flow_ready = {
    .name = "ready", .body = ready, .access = {DUITE_CW}, .args_size = sizeof(struct flow_args)};

int flow_memory_take(struct flow_state *state)
{
    const struct flow_args args = {0};
    duite_object all;
    int32_t nothing;
    take(state);
    int code = duite_new(state->rt, DUITE_I32, 1, &all);
    for (int rank = 0; rank < duite_ranks(state->rt) && !code; rank++)
        code = duite_fork_at(state->rt, rank, &flow_ready, &args, 1, &all);
    if (!code)
        code = duite_get(state->rt, all, &nothing);
    const int freed = duite_free(state->rt, all);
    return code ? code : freed;
}

void flow_memory_free(struct flow_state *state)
{
    struct flow *flow = state->flow;
    free(flow->clock);
    free(flow->room);
    free(state->block);
    free(state->refs);
    free(state->rows);
    flow_far_free(state);
    flow->clock = NULL;
    flow->room = NULL;
    state->block = NULL;
    state->refs = NULL;
    state->rows = NULL;
}
