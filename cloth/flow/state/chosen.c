/* The tick at which a step begins decides which ties it has. So every rank has the same ties, and a
 * repeated step has them again.
 *
 * In reading order: memory, what ties ask of the blocks, the choice, the tables of the blocks, what
 * others see of them. */
#include "cloth/flow/bodies.h"
#include "cloth/flow/solver/solve.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"

#include <stdlib.h>

/* ---- Memory ---- */

static void take(struct flow_tied_blocks *blocks, size_t n_blocks, size_t n_ties,
                 struct cloth_error *trouble)
{
    blocks->room = cloth_alloc(n_blocks, sizeof *blocks->room, trouble);
    blocks->first = cloth_alloc(n_blocks + 1, sizeof *blocks->first, trouble);
    blocks->other = cloth_alloc(2 * n_ties, sizeof *blocks->other, trouble);
}

void flow_ties_take(struct flow_state *state)
{
    const struct flow_head *head = &state->head;
    if (!head->n_ties)
        return;
    state->tied.parent =
        cloth_alloc((size_t)head->n_pieces + 1, sizeof *state->tied.parent, &state->flow->trouble);
    state->tied.group =
        cloth_alloc(head->n_pieces, sizeof *state->tied.group, &state->flow->trouble);
    take(&state->tied.now, head->n_blocks, head->n_ties, &state->flow->trouble);
    take(&state->tied.next, head->n_blocks, head->n_ties, &state->flow->trouble);
}

static void drop(struct flow_tied_blocks *blocks)
{
    free(blocks->room);
    free(blocks->first);
    free(blocks->other);
}

void flow_ties_free(struct flow_state *state)
{
    free(state->tied.parent);
    free(state->tied.group);
    drop(&state->tied.now);
    drop(&state->tied.next);
    state->tied = (struct flow_tied){0};
}

/* ---- What ties ask of the blocks ---- */

static bool is_shared(const struct flow_tie *tie, uint64_t tick)
{
    return flow_tie_acts(tie, tick) && tie->block[0] != tie->block[1];
}

/* How many ties each block has, in whole classes. */
static void find_room(const struct flow *flow, uint64_t tick, uint32_t *room)
{
    const uint32_t n_blocks = flow->tables.n_blocks;
    memset(room, 0, n_blocks * sizeof *room);
    for (const struct flow_tie *tie = flow->tie; tie < flow->tie + flow->n_ties; tie++) {
        room[tie->block[0]] += flow_tie_acts(tie, tick);
        room[tie->block[1]] += is_shared(tie, tick);
    }
    for (uint32_t b = 0; b < n_blocks; b++)
        room[b] = (room[b] + FLOW_TIE_CLASS - 1) / FLOW_TIE_CLASS * FLOW_TIE_CLASS;
}

/* Sorts the others of each block and keeps each once. first: where those of each block end; then,
 * where they begin. */
static void keep_once(uint32_t n_blocks, struct flow_tied_blocks *to)
{
    uint32_t from = 0, kept = 0;
    for (uint32_t b = 0; b < n_blocks; b++) {
        const uint32_t end = to->first[b], first = kept;
        qsort(to->other + from, end - from, sizeof *to->other, cloth_compare_items_u32);
        for (; from < end; from++)
            if (kept == first || to->other[kept - 1] != to->other[from])
                to->other[kept++] = to->other[from];
        to->first[b] = first;
    }
    to->first[n_blocks] = kept;
}

/* Who shares ties with whom. */
static void find_others(const struct flow *flow, uint64_t tick, struct flow_tied_blocks *to)
{
    const uint32_t n_blocks = flow->tables.n_blocks;
    uint32_t sum = 0;
    memset(to->first, 0, ((size_t)n_blocks + 1) * sizeof *to->first);
    for (uint32_t i = 0; i < flow->n_ties; i++)
        for (int end = 0; end < 2; end++)
            to->first[flow->tie[i].block[end]] += is_shared(flow->tie + i, tick);
    for (uint32_t b = 0; b < n_blocks; b++) {
        const uint32_t n = to->first[b];
        to->first[b] = sum;
        sum += n;
    }
    for (uint32_t i = 0; i < flow->n_ties; i++)
        for (int end = 0; end < 2 && is_shared(flow->tie + i, tick); end++)
            to->other[to->first[flow->tie[i].block[end]]++] = flow->tie[i].block[1 - end];
    keep_once(n_blocks, to);
}

/* ---- The choice ---- */

/* From which tick until which one the ties are those of this tick. */
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

/* Makes the next ones those that count. *recorded: the recorded round still serves. */
static void fit(struct flow_state *state, bool *recorded)
{
    struct flow_tied *tied = &state->tied;
    struct flow_tied_blocks *now = &tied->now, *next = &tied->next;
    const size_t n_blocks = state->flow->tables.n_blocks;
    *recorded = !memcmp(now->room, next->room, n_blocks * sizeof *now->room) &&
                !memcmp(now->first, next->first, (n_blocks + 1) * sizeof *now->first) &&
                !memcmp(now->other, next->other, now->first[n_blocks] * sizeof *now->other);
    if (!*recorded && state->solve.generation) {
        duite_graph_free(state->rt, state->solve); /* a failure is returned by the next fork */
        state->solve = (duite_graph){0};
    }
    for (uint32_t b = 0; b < n_blocks; b++)
        if (now->room[b] != next->room[b])
            flow_objects_fit(state, b, next->room[b]);
    const struct flow_tied_blocks before = *now;
    *now = *next;
    *next = before;
}

/* ---- What ties make of free pieces ---- */

static uint32_t root_of(const uint32_t *parent, uint32_t piece)
{
    while (parent[piece] != piece)
        piece = parent[piece];
    return piece;
}

/* Unites what ties join: piece k is number k of the parents, 0 is what a pin holds. The lowest
 * number of each group is its root. */
static void unite(const struct flow *flow, uint64_t tick, uint32_t *parent)
{
    for (const struct flow_tie *tie = flow->tie; tie < flow->tie + flow->n_ties; tie++) {
        const uint32_t a = root_of(parent, tie->piece[0]), b = root_of(parent, tie->piece[1]);
        if (flow_tie_acts(tie, tick))
            parent[a > b ? a : b] = a > b ? b : a;
    }
}

static int set_groups(struct flow_state *state)
{
    struct flow_tied *tied = &state->tied;
    const uint32_t n = state->head.n_pieces;
    if (!n)
        return DUITE_OK;
    for (uint32_t piece = 0; piece <= n; piece++)
        tied->parent[piece] = piece;
    unite(state->flow, state->attempt.begin, tied->parent);
    for (uint32_t piece = 0; piece < n; piece++)
        tied->group[piece] = root_of(tied->parent, piece + 1);
    return duite_set(state->rt, state->run.groups, tied->group);
}

/* ---- The tables of the blocks ---- */

struct tie_args {
    uint32_t block, room;
    uint64_t tick;
};

FLOW_KERNEL(tie, FLOW_NO_PART, struct tie_args, (R(table), W(tie_table)))
static int tie_body(const duite_call *call, const struct tie_fields *on)
{
    const struct flow *flow = flow_of(call);
    const struct flow_table table = flow_table_in(call, on->table);
    const struct flow_ties_of of = {.block = on->args->block,
                                    .room = on->args->room,
                                    .tick = on->args->tick,
                                    .n = flow->n_ties,
                                    .n_halo = table.n_halo,
                                    .tie = flow->tie,
                                    .halo = table.halo};
    flow_ties_make(&of, on->tie_table);
    return 0;
}

/* Of all blocks at first, then of those that have ties or had some. */
static int fork_tables(struct flow_state *state, bool all)
{
    const struct flow_tied *tied = &state->tied; /* next: what was before */
    struct tie_args args = {.tick = state->attempt.begin};
    int code = DUITE_OK;
    for (; args.block < state->flow->tables.n_blocks && !code; args.block++) {
        args.room = tied->now.room[args.block];
        if (all || args.room || tied->next.room[args.block])
            code = flow_fork_one(state, &flow_kernel_tie, &args);
    }
    return code;
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
    bool recorded;
    if (flow_ties_stay(state, tick))
        return DUITE_OK;
    find_interval(state->flow, tick, tied);
    find_room(state->flow, tick, tied->next.room);
    find_others(state->flow, tick, &tied->next);
    fit(state, &recorded);
    int code = set_groups(state);
    if (!code)
        code = fork_tables(state, first);
    if (code || recorded || !model_is_implicit(state->flow->model))
        return code;
    return flow_cg_record(state);
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

/* ---- What others see of them ---- */

FLOW_KERNEL(tie_show, FLOW_FORCE, struct flow_block_args, (R(tie_table), R(x), R(v), W(tie_halo)))
static int tie_show_body(const duite_call *call, const struct tie_show_fields *on)
{
    const struct flow_ties ties = flow_ties_open(on->tie_table);
    (void)call;
    memset(on->tie_halo, 0, 2 * (size_t)ties.room * sizeof *on->tie_halo);
    for (uint32_t i = ties.n_inner; i < ties.n; i++) {
        on->tie_halo[i - ties.n_inner] = on->x[ties.end[i][0]];
        on->tie_halo[ties.room + i - ties.n_inner] = on->v[ties.end[i][0]];
    }
    return 0;
}

int flow_ties_show(struct flow_state *state)
{
    const struct flow_tied_blocks *tied = &state->tied.now;
    struct flow_block_args args = {0};
    int code = DUITE_OK;
    for (; tied->first && args.block < state->flow->tables.n_blocks && !code; args.block++)
        if (tied->first[args.block] < tied->first[args.block + 1])
            code = flow_fork_one(state, &flow_kernel_tie_show, &args);
    return code;
}
