/* Everything that can fail on one rank alone is taken before the first task of a run. A rank that
 * lacks it does not leave: it says so in a task, and all ranks leave together. */
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/solver/levels.h"
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/state/bodies.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"

#include <stdlib.h>
#include <string.h>

/* Takes room on rank 0 to gather a frame, and a part of the state to be hashed. */
static void run_memory_take_room(struct flow_state *state)
{
    struct flow *flow = state->flow;
    if (flow_shows(state))
        flow->room = cloth_alloc(flow->n_vertices, 3 * sizeof *flow->room, &flow->trouble);
    if (flow_shows_places(state)) {
        flow->block_of = cloth_alloc(flow->n_vertices, sizeof *flow->block_of, &flow->trouble);
        flow->rank_of = cloth_alloc(flow->n_vertices, sizeof *flow->rank_of, &flow->trouble);
        flow->home = cloth_alloc(state->head.n_blocks, sizeof *flow->home, &flow->trouble);
    }
    const struct flow_watched *watched =
        &flow->source.watched; /* the tables are not distributed yet */
    if (state->output && state->output->row && watched->n_columns) {
        flow->row = cloth_alloc(watched->n_columns, sizeof *flow->row, &flow->trouble);
        flow->probe_values =
            cloth_alloc(watched->n, FLOW_PROBE_VALUES * sizeof *flow->probe_values, &flow->trouble);
    }
    state->bytes = cloth_alloc(flow_hash_part(flow), FLOW_VERTEX_BYTES, &flow->trouble);
    state->hash = XXH64_createState();
    if (!state->hash)
        cloth_fail(&flow->trouble, CLOTH_E_MEMORY, "out of memory for a hash");
}

static void take_sums(struct flow *flow)
{
    flow->sums =
        aligned_alloc(sizeof(phys_vec), flow->n_clocks * flow->n_sums * sizeof *flow->sums);
    if (!flow->sums)
        cloth_fail(&flow->trouble, CLOTH_E_MEMORY, "out of memory for the entries of a matrix");
}

static void take_forces(struct flow *flow)
{
    flow->forces = aligned_alloc(64, flow->n_clocks * flow->n_forces * sizeof *flow->forces);
    if (!flow->forces)
        cloth_fail(&flow->trouble, CLOTH_E_MEMORY, "out of memory for the forces of a block");
}

static void take_all(struct flow_state *state)
{
    struct flow *flow = state->flow;
    const struct flow_head *head = &state->head;
    const size_t tied = model_seeks(flow->model) /* others of a block, at most */
                            ? head->n_blocks
                            : cloth_smaller(head->n_blocks, 2 * (size_t)head->n_ties);
    const size_t groups = head->n_blocks; /* fewer than that, on all levels */
    const size_t refs = cloth_larger(head->n_blocks, 2 * (size_t)head->max_neighbours) + 4 * tied +
                        groups + DUITE_MAX_ACCESS;
    flow->n_clocks = duite_threads(state->rt);
    flow->clock = aligned_alloc(sizeof *flow->clock, flow->n_clocks * sizeof *flow->clock);
    if (flow->clock)
        memset(flow->clock, 0, flow->n_clocks * sizeof *flow->clock);
    else
        cloth_fail(&flow->trouble, CLOTH_E_MEMORY, "out of memory for %u clocks", flow->n_clocks);
    flow->n_sums = head->max_entries;
    if (flow->model->format != SOLVE_SPRINGS && head->max_entries)
        take_sums(flow);
    flow->n_ghosts = 2 * ((size_t)head->max_ghosts + 1);
    if (head->n_elements) {
        flow->ghost_room = aligned_alloc(sizeof *flow->ghost_room, flow->n_clocks * flow->n_ghosts *
                                                                       sizeof *flow->ghost_room);
        if (!flow->ghost_room)
            cloth_fail(&flow->trouble, CLOTH_E_MEMORY, "out of memory for ghosts");
    }
    flow->n_forces = 2 * ((size_t)head->max_rows / 2 + 1); /* whole cache lines */
    if (!model_is_implicit(flow->model))
        take_forces(flow);
    flow->shared =
        aligned_alloc(CONTACT_ALIGN, (head->shared_bytes / CONTACT_ALIGN + 1) * CONTACT_ALIGN);
    if (!flow->shared)
        cloth_fail(&flow->trouble, CLOTH_E_MEMORY, "out of memory for what all ranks share");
    flow->tables.block = cloth_alloc(head->n_blocks, sizeof *flow->tables.block, &flow->trouble);
    flow->tables.n_blocks = head->n_blocks;
    state->block = cloth_alloc(head->n_blocks, sizeof *state->block, &flow->trouble);
    state->max_refs = refs;
    state->refs = cloth_alloc(FLOW_FORKS_AHEAD * refs, sizeof *state->refs, &flow->trouble);
    state->rows = cloth_alloc(cloth_larger(4 * (size_t)head->max_rows, head->max_neighbours),
                              sizeof *state->rows, &flow->trouble);
    state->seam_peaks =
        cloth_alloc(flow->model->n_pulled, sizeof *state->seam_peaks, &flow->trouble);
    state->seam_squares =
        cloth_alloc(flow->model->n_pulled, sizeof *state->seam_squares, &flow->trouble);
    flow_halo_take(state);
    flow_ties_take(state);
    flow_contact_take(state);
    if (duite_rank(state->rt) == 0)
        run_memory_take_room(state);
}

FLOW_KERNEL(ready, FLOW_NO_PART, struct flow_block_args, (GIVEN_SUM(lacks)))
static int ready_body(const duite_call *call, const struct ready_fields *on)
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
    int code = duite_new(state->rt, DUITE_I32, 1, &lacks);
    for (int rank = 0; rank < duite_ranks(state->rt) && !code; rank++)
        code = flow_fork_given_at(state, rank, &flow_kernel_ready, &none,
                                  &(struct flow_given){.one = &lacks});
    if (!code)
        code = duite_get(state->rt, lacks, &nothing);
    const int freed = duite_free(state->rt, lacks);
    return code ? code : freed;
}

int flow_memory_take(struct flow_state *state)
{
    take_all(state);
    return flow_memory_agree(state);
}

void flow_memory_free(struct flow_state *state)
{
    struct flow *flow = state->flow;
    flow_levels_free(state);
    flow_preconditioner_free(flow);
    free(flow->clock);
    free(flow->sums);
    free(flow->ghost_room);
    free(flow->forces);
    free(flow->room);
    free(flow->block_of);
    free(flow->rank_of);
    free(flow->home);
    free(flow->row);
    free(flow->probe_values);
    free(state->block);
    free(state->refs);
    free(state->rows);
    free(state->seam_peaks);
    free(state->seam_squares);
    flow_halo_free(state);
    flow_ties_free(state);
    flow_contact_free(state);
    free(state->bytes);
    XXH64_freeState(state->hash);
}
