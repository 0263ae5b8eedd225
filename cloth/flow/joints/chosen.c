/* The tick at which a step begins decides its timed joints. So every rank has the same joints, and
 * a repeated step has them again. In reading order: the joints of a step, the choice, the tables of
 * the blocks, the rows shown to others. */
#include "cloth/base/sets.h"
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/state/bodies.h"

/* ---- The joints of a step ---- */

static struct flow_tie_list joints_at(const struct flow *flow, uint64_t tick)
{
    return (struct flow_tie_list){.n_joints = flow->n_ties, .joint = flow->tie, .tick = tick};
}

/* Marks the blocks that have joints that act. */
static void mark_tied(const struct flow *flow, uint64_t tick, struct flow_tie_record *record)
{
    memset(record, 0, flow->tables.n_blocks * sizeof *record);
    for (const struct flow_tie *tie = flow->tie; tie < flow->tie + flow->n_ties; tie++)
        for (uint32_t k = 0; k < tie->at.n && flow_tie_acts(tie, tick); k++)
            record[tie->at.block[k]].n_ties = 1;
}

/* Makes the records of blocks for the joints that act. */
static void say_joints(const struct flow *flow, uint64_t tick, struct flow_tied *tied)
{
    const struct flow_tie_list list = joints_at(flow, tick);
    struct flow_tie_records *said = &tied->said;
    uint32_t n = 0;
    mark_tied(flow, tick, said->of);
    for (uint32_t b = 0; b < flow->tables.n_blocks; b++) {
        said->first[b] = n;
        if (said->of[b].n_ties) /* there is room for all links */
            flow_ties_count(&list, b, tied->scratch, said->max_links - n, said->of + b,
                            said->link + n);
        n += said->of[b].n_links;
    }
    said->first[flow->tables.n_blocks] = n;
}

/* ---- The choice ---- */

/* Finds the ticks between which the ties are those of this tick. */
static void find_interval(const struct flow *flow, uint64_t tick, struct flow_tied *tied)
{
    tied->from = 0;
    tied->to = UINT64_MAX;
    for (const struct flow_tie *tie = flow->tie; tie < flow->tie + flow->n_ties; tie++) {
        const uint64_t events[] = {tie->begin, tie->end};
        for (int i = 0; i < 2; i++) {
            if (events[i] <= tick && events[i] > tied->from)
                tied->from = events[i];
            if (events[i] > tick && events[i] < tied->to)
                tied->to = events[i];
        }
    }
}

/* ---- Ties between free pieces ---- */

/* Unites the pieces that ties join: piece k is number k of the parents, 0 is everything that a pin
 * holds. */
static void unite(const struct flow *flow, uint64_t tick, uint32_t *parent)
{
    for (const struct flow_tie *tie = flow->tie; tie < flow->tie + flow->n_ties; tie++)
        for (uint32_t k = 1; k < tie->at.n && flow_tie_acts(tie, tick); k++)
            cloth_sets_join(parent, tie->piece[0], tie->piece[k]);
}

/* True if blocks have other ties than the joints that act. */
static bool has_contacts(const struct flow_state *state)
{
    const struct flow *flow = state->flow;
    uint64_t ties = 0;
    for (uint32_t b = 0; b < flow->tables.n_blocks; b++)
        ties += state->tied.said.of[b].n_ties;
    for (const struct flow_tie *tie = flow->tie; tie < flow->tie + flow->n_ties; tie++)
        for (uint32_t k = 0; k < tie->at.n && flow_tie_acts(tie, state->attempt.begin); k++) {
            bool again = false;
            for (uint32_t l = 0; l < k; l++)
                again = again || tie->at.block[l] == tie->at.block[k];
            ties -= !again;
        }
    return ties > 0;
}

int flow_ties_group(struct flow_state *state)
{
    struct flow_tied *tied = &state->tied;
    const uint32_t n = state->head.n_pieces;
    if (!n)
        return DUITE_OK;
    const bool free = !has_contacts(state);
    cloth_sets_start(tied->parent, n + 1);
    unite(state->flow, state->attempt.begin, tied->parent);
    for (uint32_t piece = 0; piece < n; piece++)
        tied->group[piece] = free ? cloth_sets_root(tied->parent, piece + 1) : 0;
    return flow_set(state, FLOW_FIELD_groups, tied->group);
}

/* ---- The tables of the blocks ---- */

struct tie_args {
    uint32_t block;
    struct flow_tie_room room;
    uint64_t tick;
};

FLOW_KERNEL(tie, FLOW_NO_PART, struct tie_args, (R(table), R(tie_links), W(tie_table)))
{
    const struct flow_table table = flow_table_in(call, on->table);
    const struct flow_tie_list list = joints_at(flow_of(call), on->args->tick);
    const uint32_t(*links)[2] = (const uint32_t(*)[2])on->tie_links;
    const struct flow_ties_of of = {.block = on->args->block,
                                    .n_rows = table.n,
                                    .n_halo = table.n_halo,
                                    .n_others = links[0][0],
                                    .halo = table.halo,
                                    .others = links + 1,
                                    .list = &list,
                                    .room = on->args->room};
    return flow_ties_make(&of, on->tie_table)
               ? 0
               : duite_fail(call, FLOW_NO_MEMORY, "block %u has no room for its ties", of.block);
}

static bool is_empty(const struct flow_tie_room *room)
{
    return !room->ties && !room->others;
}

/* Forks those of all blocks at first, then those of blocks that have ties or had some. */
static int fork_tables(struct flow_state *state, bool all)
{
    const struct flow_tied *tied = &state->tied; /* next: the state before */
    struct tie_args args = {.tick = state->attempt.begin};
    for (; args.block < state->flow->tables.n_blocks; args.block++) {
        args.room = tied->now.room[args.block];
        if (all || !is_empty(&args.room) || !is_empty(tied->next.room + args.block))
            flow_fork_one(state, &flow_kernel_tie, &args);
    }
    return state->code;
}

bool flow_ties_stay(const struct flow_state *state, uint64_t tick)
{
    return !state->flow->n_ties || (state->tied.from <= tick && tick < state->tied.to);
}

int flow_ties_choose(struct flow_state *state)
{
    struct flow_tied *tied = &state->tied;
    const uint64_t tick = state->attempt.begin;
    const bool first = !tied->to;
    if (flow_ties_stay(state, tick))
        return DUITE_OK;
    find_interval(state->flow, tick, tied);
    if (model_seeks(state->flow->model)) /* they come with the contacts of the step */
        return DUITE_OK;
    say_joints(state->flow, tick, tied);
    flow_ties_adopt(state);
    flow_ties_group(state);
    return fork_tables(state, first);
}

bool flow_ties_changed(const struct flow_state *state)
{
    const struct flow *flow = state->flow;
    const uint64_t tick = state->attempt.begin;
    struct flow_tied then;
    if (!flow->n_ties)
        return false;
    find_interval(flow, tick, &then);
    return then.from > 0 && tick - then.from < FLOW_TICKS;
}

bool flow_ties_will_change(const struct flow_state *state)
{
    const uint64_t now = state->grid.now;
    bool will = false;
    for (uint32_t i = 0; i < state->flow->n_ties; i++) {
        const struct flow_tie *tie = state->flow->tie + i;
        will = will || (tie->begin > now && tie->begin < state->grid.end) ||
               (tie->end > now && tie->end < state->grid.end);
    }
    return will;
}

/* ---- Rows shown to others ---- */

FLOW_KERNEL(tie_show, FLOW_FORCE, struct flow_block_args, (R(tie_table), R(x), R(v), W(tie_halo)))
{
    const struct flow_ties ties = flow_ties_open(on->tie_table);
    (void)call;
    memset(on->tie_halo, 0, 2 * flow_ties_rows(&ties) * sizeof *on->tie_halo);
    for (uint32_t i = 0; i < ties.n_shown; i++) {
        on->tie_halo[i] = on->x[ties.shown[i]];
        on->tie_halo[ties.room.rows + i] = on->v[ties.shown[i]];
    }
    return 0;
}

int flow_ties_show(struct flow_state *state)
{
    const struct flow_tied_blocks *tied = &state->tied.now;
    struct flow_block_args args = {0};
    for (; tied->first && args.block < state->flow->tables.n_blocks; args.block++)
        if (tied->first[args.block] < tied->first[args.block + 1])
            flow_fork_one(state, &flow_kernel_tie_show, &args);
    return state->code;
}
