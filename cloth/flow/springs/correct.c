/* Velocity correction (cloth/solve/correction.h): rounds of tasks, one a block, until no edge is
 * over its limit by more than the tolerance. A round corrects the edges between blocks first, all
 * at once from the ends that both blocks showed, so that both find the same bits. Each correction
 * is the share that lets all of a vertex be made together. Then come the edges inside the block,
 * one after the other in the order of the table. Two rounds are recorded once a run and replayed
 * until their scalars, which every rank makes alike, say that they are done. The main thread waits
 * for none of them. x moves in the rounds; v and the halos follow when they are over. */
#include "cloth/flow/pins/sliders.h"
#include "cloth/flow/run/step.h"

#include "cloth/flow/integrators/integrator.h"

/* ---- The begin of the rounds ---- */

struct edge_args {
    union {
        uint32_t block;
        struct flow_step_args step;
    };
    double t; /* s: x = X + t v */
};

/* S of a row. */
static void find_filter(struct flow_pins *pins, uint32_t row, phys_vec *filter)
{
    const phys_vec *slider = flow_pins_filter(pins, row);
    *filter = slider ? *slider : (phys_vec){0, 0, 0, 1};
}

/* Writes the data of halo rows that other blocks need. */
static void show_ends(const duite_call *call, const struct flow_table *t, double time,
                      const phys_vec *base, const phys_vec *begin, phys_vec *ends)
{
    struct flow_pins pins;
    flow_pins_begin(call, t, time, &pins);
    for (uint32_t i = 0; i < t->n_halo; i++, ends += 3) {
        ends[0] = base[t->halo[i]];
        ends[1] = begin[t->halo[i]];
        find_filter(&pins, t->halo[i], ends + 2);
    }
    if (!t->n_halo)
        memset(ends, 0, 3 * sizeof *ends);
}

FLOW_KERNEL(edge_start, FLOW_CORRECTION, struct edge_args,
            (R(table), R(x), R(v), R(kept_x), W(edge_base), W(edge_moved), W(edge_ends), W(edge_x),
             W(edge_calm)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    for (uint32_t i = 0; i < t->n; i++) {
        on->edge_base[i] = on->x[i] - on->args->t * on->v[i];
        on->edge_base[i][3] = t->free[i] / t->mass[i];
    }
    memset(on->edge_moved, 0, t->n * sizeof *on->edge_moved);
    show_ends(call, t, on->args->step.time, on->edge_base, on->kept_x, on->edge_ends);
    flow_write_halo(t, on->x, on->edge_x);
    on->edge_calm[0] = on->edge_calm[1] = 0;
    return 0;
}

FLOW_KERNEL_WITH(edge_begin, FLOW_NO_PART, struct edge_args, (W(edge_rounds)), .replicated = 1)
{
    const struct edge_args *args = on->args;
    (void)call;
    *on->edge_rounds = solve_rounds_start(args->step.h, args->t, args->step.time);
    return 0;
}

/* ---- A round ---- */

/* A block in a round. */
struct block {
    const struct flow_table *t;
    struct solve_correction correction;
    struct flow_pins pins;
    const phys_vec *base, *begin;
    phys_vec *x, *moved;
    struct solve_excess excess;
    bool moves;
};

static void split_base(const phys_vec *base, struct solve_end *end)
{
    end->base = *base;
    end->w = (*base)[3];
    end->base[3] = 0;
}

static void open_row(struct block *block, uint32_t row, struct solve_end *end)
{
    end->x = block->x[row];
    end->begin = block->begin[row];
    split_base(block->base + row, end);
    find_filter(&block->pins, row, &end->filter);
}

static void open_shown(const phys_vec *x, const phys_vec *ends, uint32_t place,
                       struct solve_end *end)
{
    const phys_vec *shown = ends + 3 * (size_t)place;
    end->x = x[place];
    split_base(shown, end);
    end->begin = shown[1];
    end->filter = shown[2];
}

static void move_row(struct block *block, uint32_t row, const phys_vec *by)
{
    block->x[row] += *by;
    block->moved[row] += *by;
    block->moves = true;
}

static void correct_inner(struct block *block)
{
    const struct flow_table *t = block->t;
    for (uint32_t e = 0; e < t->n_corrected; e++) {
        const struct solve_edge *edge = t->corrected + e;
        struct solve_end end[2];
        phys_vec move[2];
        if (!solve_is_over(edge, block->x + edge->end[0], block->x + edge->end[1]))
            continue;
        for (int i = 0; i < 2; i++)
            open_row(block, edge->end[i], end + i);
        if (!solve_correct(&block->correction, edge, end, 1, move, &block->excess))
            continue;
        for (int i = 0; i < 2; i++)
            move_row(block, edge->end[i], move + i);
    }
}

/* Halos as all blocks showed them: x of the block itself, and of its neighbours. */
struct shown {
    const phys_vec *x;
    const duite_param *other_x, *other_ends;
};

static void correct_cut(struct block *block, const struct shown *shown)
{
    const struct flow_table *t = block->t;
    for (uint32_t e = 0; e < t->n_corrected_cut; e++) {
        const struct flow_cut_edge *cut = t->corrected_cut + e;
        const struct solve_edge *edge = &cut->edge;
        const phys_vec *other = flow_rows_of(shown->other_x, cut->neighbour);
        struct solve_end end[2];
        phys_vec move[2];
        if (!solve_is_over(edge, shown->x + edge->end[0], other + edge->end[1]))
            continue;
        open_row(block, cut->row, end);
        end[0].x = shown->x[edge->end[0]];
        open_shown(other, flow_rows_of(shown->other_ends, cut->neighbour), edge->end[1], end + 1);
        if (solve_correct(&block->correction, edge, end, cut->share, move, &block->excess))
            move_row(block, cut->row, move);
    }
}

/* Edges inside a block that were all within the tolerance still are, unless a row moved. calm: 1 if
 * they were, and their largest excess. */
static void correct_rest(struct block *block, double calm[2])
{
    const struct solve_excess cut = block->excess;
    if (!(calm[0] > 0) || block->moves) {
        block->excess = (struct solve_excess){0, 0};
        correct_inner(block);
        calm[0] = !(block->excess.corrected > 0);
        calm[1] = block->excess.most;
    }
    block->excess.most = cut.most > calm[1] ? cut.most : calm[1];
    block->excess.corrected = cut.corrected > 0 || !(calm[0] > 0);
}

/* Until the edges between blocks are corrected, the written halo has the old x. */
FLOW_KERNEL(edge_round, FLOW_CORRECTION, struct flow_block_args,
            (R(table), RW(x), R(kept_x), R(edge_base), RW(edge_moved), W(edge_x_next),
             RW(edge_calm), R(edge_rounds), MAX(edge_excess), NEIGHBOURS(edge_x),
             NEIGHBOURS(edge_ends)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct shown shown = {on->edge_x_next, on->edge_x, on->edge_ends};
    struct block block = {.t = t,
                          .correction = solve_rounds_correction(on->edge_rounds),
                          .base = on->edge_base,
                          .begin = on->kept_x,
                          .x = on->x,
                          .moved = on->edge_moved};
    flow_write_halo(t, on->x, on->edge_x_next);
    if (!(on->edge_rounds->phase > 0))
        return 0;
    flow_pins_begin(call, t, on->edge_rounds->time, &block.pins);
    correct_cut(&block, &shown);
    correct_rest(&block, on->edge_calm);
    on->edge_excess[0] = block.excess.most;
    on->edge_excess[1] = block.excess.corrected;
    if (block.moves)
        flow_write_halo(t, on->x, on->edge_x_next);
    return 0;
}

FLOW_KERNEL_WITH(edge_next, FLOW_NO_PART, struct flow_block_args,
                 (R(edge_rounds), W(edge_rounds_next), R(edge_excess)), .replicated = 1)
{
    const struct solve_excess found = {on->edge_excess[0], on->edge_excess[1]};
    *on->edge_rounds_next =
        solve_rounds_next(on->edge_rounds, &found, flow_of(call)->model->correction_rounds);
    return 0;
}

/* Two rounds. */
static int build_rounds(duite *rt, void *context)
{
    const struct flow_block_args first = {0};
    struct flow_state *state = context;
    (void)rt;
    for (state->pass = 0; state->pass < 2; state->pass++) {
        flow_set(state, FLOW_FIELD_edge_excess, NULL);
        flow_fork_each(state, &flow_kernel_edge_round, NULL);
        flow_fork_one(state, &flow_kernel_edge_next, &first);
    }
    state->pass = 0;
    return state->code;
}

/* ---- The end of the rounds ---- */

static void note_rounds(const struct solve_rounds *rounds, double *status)
{
    status[FLOW_CORRECTED] = rounds->rounds;
    status[FLOW_CORRECTION_UNMET] = rounds->unmet;
    status[FLOW_CORRECTION_EXCESS] = rounds->excess;
}

FLOW_KERNEL(edge_end, FLOW_CORRECTION, struct flow_block_args,
            (R(table), R(x), RW(v), W(halo_x), W(halo_v), R(edge_moved), R(edge_rounds),
             SUM(status)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct solve_rounds *rounds = on->edge_rounds;
    if (rounds->rounds > 0)
        on->status[FLOW_CORRECTION_ENERGY] =
            solve_correct_velocity(t->n, rounds->t, t->mass, on->edge_moved, on->v);
    if (flow_block_of(call) == 0)
        note_rounds(rounds, on->status);
    flow_write_halo(t, on->x, on->halo_x);
    flow_write_halo(t, on->v, on->halo_v);
    return 0;
}

/* ---- The correction of a step ---- */

int flow_correct(struct flow_state *state)
{
    struct edge_args args = {.step = flow_attempt_args(state)};
    struct flow_block_args block;
    const uint64_t passes = (uint64_t)state->flow->model->correction_rounds + 1;
    args.t = flow_implicit_is_second(state) ? args.step.h * (2.0 / 3) : args.step.h;
    if (!state->correct.generation)
        flow_noted(state, duite_graph_new(state->rt, build_rounds, state, &state->correct));
    flow_fork_each(state, &flow_kernel_edge_start, &args);
    args.block = 0;
    flow_fork_one(state, &flow_kernel_edge_begin, &args);
    if (!state->code)
        flow_noted(state, duite_replay_while(state->rt, state->correct, state->run.edge_rounds[0],
                                             (passes + 1) / 2));
    return flow_fork_each(state, &flow_kernel_edge_end, &block);
}
