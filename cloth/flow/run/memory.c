/* Everything that can fail on one rank alone is taken before the first task of a run. A rank that
 * lacks it does not leave: it says so in a task, and all ranks leave together. */
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/state/bodies.h"
#include "cloth/flow/state/room.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"

#include <stdint.h>
#include <stdlib.h>

/* Room on rank 0 to gather a frame, and a part of the state to be hashed. */
static void run_memory_take_room(struct flow_state *state)
{
    struct flow *flow = state->flow;
    const struct flow_watched *watched = &flow->source.watched; /* tables are not distributed yet */
    if (flow_shows(state))
        flow->room = flow_take(flow, flow->n_vertices, 3 * sizeof *flow->room);
    if (flow_shows_places(state)) {
        flow->block_of = flow_take(flow, flow->n_vertices, sizeof *flow->block_of);
        flow->rank_of = flow_take(flow, flow->n_vertices, sizeof *flow->rank_of);
        flow->home = flow_take(flow, state->head.n_blocks, sizeof *flow->home);
    }
    if (state->output && state->output->row && watched->n_columns) {
        flow->row = flow_take(flow, watched->n_columns, sizeof *flow->row);
        flow->probe_values =
            flow_take(flow, watched->n, FLOW_PROBE_VALUES * sizeof *flow->probe_values);
    }
    state->bytes = flow_take(flow, flow_hash_part(flow), FLOW_VERTEX_BYTES);
    state->hash = XXH64_createState();
    if (!state->hash)
        cloth_fail(&flow->trouble, CLOTH_E_MEMORY, "out of memory for a hash");
}

/* Room of each worker; one that a run does not need is NULL. */
static void take_workers(struct flow *flow, const struct flow_head *head)
{
    const size_t n = flow->n_clocks;
    flow->clock = flow_take(flow, n, sizeof *flow->clock);
    flow->n_sums = head->max_entries;
    if (flow->model->format != SOLVE_SPRINGS && head->max_entries)
        flow->sums = flow_take(flow, n * flow->n_sums, sizeof *flow->sums);
    flow->n_ghosts = 2 * ((size_t)head->max_ghosts + 1);
    if (head->n_elements)
        flow->ghost_room = flow_take(flow, n * flow->n_ghosts, sizeof *flow->ghost_room);
    flow->n_forces = 2 * ((size_t)head->max_rows / 2 + 1); /* whole cache lines */
    if (!model_is_implicit(flow->model))
        flow->forces = flow_take(flow, n * flow->n_forces, sizeof *flow->forces);
}

static void take_all(struct flow_state *state)
{
    struct flow *flow = state->flow;
    const struct flow_head *head = &state->head;
    const size_t tied = model_seeks(flow->model) /* others of a block, at most */
                            ? head->n_blocks
                            : cloth_smaller(head->n_blocks, 2 * (size_t)head->n_ties);
    const size_t groups = head->n_blocks; /* fewer than that, on all levels */
    flow->n_clocks = duite_threads(state->rt);
    take_workers(flow, head);
    flow->shared = flow_take(flow, head->shared_bytes, 1);
    flow->tables.block = flow_take(flow, head->n_blocks, sizeof *flow->tables.block);
    flow->tables.n_blocks = head->n_blocks;
    state->block = flow_take(flow, head->n_blocks, sizeof *state->block);
    state->max_refs = cloth_larger(head->n_blocks, 2 * (size_t)head->max_neighbours) + 4 * tied +
                      groups + DUITE_MAX_ACCESS;
    state->refs = flow_take(flow, FLOW_FORKS_AHEAD * state->max_refs, sizeof *state->refs);
    state->rows = flow_take(flow, cloth_larger(4 * (size_t)head->max_rows, head->max_neighbours),
                            sizeof *state->rows);
    state->seam_squares = flow_take(flow, flow->model->n_pulled, sizeof *state->seam_squares);
    flow_halo_take(state);
    flow_ties_take(state);
    flow_contact_take(state);
    if (duite_rank(state->rt) == 0)
        run_memory_take_room(state);
}

FLOW_KERNEL(ready, FLOW_NO_PART, struct flow_block_args, (GIVEN_SUM(lacks)))
{
    const struct cloth_error *trouble = &flow_of(call)->trouble;
    (void)on;
    return trouble->code
               ? duite_fail(call, FLOW_NO_MEMORY, "rank %d: %s", call->rank, trouble->text)
               : 0;
}

int flow_memory_agree(struct flow_state *state)
{
    const struct flow_block_args none = {0};
    duite_object lacks;
    int32_t nothing;
    flow_noted(state, duite_new(state->rt, DUITE_I32, 1, &lacks));
    for (int rank = 0; rank < duite_ranks(state->rt); rank++)
        flow_fork_with_at(state, rank, &flow_kernel_ready, &none,
                          &(struct flow_with){.lacks = lacks});
    if (!state->code)
        flow_noted(state, duite_get(state->rt, lacks, &nothing));
    return flow_noted(state, duite_free(state->rt, lacks));
}

int flow_memory_take(struct flow_state *state)
{
    take_all(state);
    return flow_memory_agree(state);
}

void flow_memory_free(struct flow_state *state)
{
    struct flow *flow = state->flow;
    flow_preconditioner_free(flow);
    flow_contact_free(state);
    XXH64_freeState(state->hash);
    cloth_pool_free(&flow->taken);
}
