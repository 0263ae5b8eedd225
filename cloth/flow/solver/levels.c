/* The coarse part by groups (cloth/solve/levels.h), for more patches than one factor can take: the
 * groups, and the work before and after their tasks (groups.c). A group's objects live with its
 * first block.
 *
 * In reading order: objects; the lifts of nodes into their groups, once a run; the places of a
 * node's numbers; the top, which the task of the scalars solves like few patches; the motions that
 * a pass reads and sums over all levels for each patch. */
#include "cloth/flow/solver/levels.h"
#include "cloth/flow/solver/solver.h"

#include <string.h>

/* ---- Objects ---- */

static uint32_t count_groups(const struct flow *flow)
{
    return flow->first_group[flow->n_levels];
}

void flow_levels_take(struct flow_state *state)
{
    const uint32_t n = count_groups(state->flow);
    struct flow_groups *groups = &state->groups;
    groups->all = flow_take(state->flow, n, sizeof *groups->all);
    groups->mark = flow_take(state->flow, n, sizeof *groups->mark);
    groups->n = groups->all ? n : 0;
}

static uint32_t first_block(const struct flow *flow, uint32_t level, uint32_t group)
{
    uint32_t node = flow->level[level].start[group];
    for (uint32_t l = level; l-- > 0;)
        node = flow->level[l].start[node];
    return node / flow->patches;
}

static void make_group(struct flow_state *state, uint32_t level, uint32_t g)
{
    const struct flow *flow = state->flow;
    const struct solve_level *l = flow->level + level;
    const struct solve_cover *cover = l->cover + g;
    struct flow_group *group = state->groups.all + flow->first_group[level] + g;
    const struct {
        duite_object *object;
        size_t numbers;
    } made[] = {
        {&group->factor, solve_coarse_doubles(&cover->pattern)},
        {&group->coupling, SOLVE_COUPLING * (size_t)solve_level_couplings(l, g)},
        {&group->part, FLOW_PART_COARSE + SOLVE_COARSE},
        {&group->motion, FLOW_MOTION + SOLVE_COARSE_STRIDE * (size_t)cover->n},
    };
    for (size_t i = 0; i < sizeof made / sizeof *made; i++) {
        duite_new(state->rt, DUITE_F64, made[i].numbers, made[i].object);
        duite_colocate(state->rt, *made[i].object, state->block[first_block(flow, level, g)].x);
    }
}

void flow_levels_make(struct flow_state *state)
{
    for (uint32_t level = 0; level < state->flow->n_levels; level++)
        for (uint32_t g = 0; g < state->flow->level[level].n_groups; g++)
            make_group(state, level, g);
}

/* ---- The lifts of nodes into their groups ---- */

FLOW_KERNEL(patch_frame, FLOW_NO_PART, struct flow_block_args, (R(table), W(patch_frame)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct solve_patches patches = solve_patches_of(t->n, flow_of(call)->patches);
    for (uint32_t k = 0; k < patches.n; k++)
        on->patch_frame[k] =
            solve_frame_of(patches.start[k + 1] - patches.start[k], t->position + patches.start[k]);
    return 0;
}

/* The frame of a node of a level, from the frames of all patches. */
static struct solve_frame solver_levels_frame_of(const struct flow *flow, const duite_param *patch,
                                                 uint32_t level, uint32_t node)
{
    struct solve_frame part[FLOW_MAX_NODES];
    uint32_t n = 0;
    if (level == 0)
        return ((const struct solve_frame *)patch[node / flow->patches].data)[node % flow->patches];
    const struct solve_level *below = flow->level + level - 1;
    for (uint32_t p = below->start[node]; p < below->start[node + 1]; p++)
        part[n++] = solver_levels_frame_of(flow, patch, level - 1, p);
    return solve_frame_of_group(n, part);
}

FLOW_KERNEL_WITH(lift, FLOW_NO_PART, struct flow_block_args, (W(lift), ALL(patch_frame)),
                 .replicated = 1)
{
    const struct flow *flow = flow_of(call);
    double *to = on->lift;
    for (uint32_t level = 0; level < flow->n_levels; level++)
        for (uint32_t g = 0; g < flow->level[level].n_groups; g++) {
            const struct solve_frame group =
                solver_levels_frame_of(flow, on->patch_frame, level + 1, g);
            const uint32_t *start = flow->level[level].start + g;
            for (uint32_t p = start[0]; p < start[1]; p++, to += FLOW_LIFT) {
                const struct solve_frame part =
                    solver_levels_frame_of(flow, on->patch_frame, level, p);
                solve_lift(&part, &group, to);
            }
        }
    return 0;
}

int flow_levels_initialise(struct flow_state *state)
{
    struct flow_block_args args;
    if (!state->flow->n_levels)
        return DUITE_OK;
    flow_fork_each(state, &flow_kernel_patch_frame, &args);
    args.block = 0;
    return flow_fork_one(state, &flow_kernel_lift, &args);
}

/* ---- The places of a node's numbers ---- */

uint32_t flow_levels_holder(const struct flow *flow, uint32_t level, uint32_t node)
{
    return level ? node : node / flow->patches;
}

size_t flow_levels_coupling_at(const struct flow *flow, uint32_t level, uint32_t node)
{
    return level ? 0 : SOLVE_COUPLING * flow_coupling_at(flow, node, node);
}

const double *flow_levels_right(const struct flow *flow, uint32_t level, uint32_t node,
                                const double *part)
{
    const uint32_t place = level ? 0 : node % flow->patches;
    return part + FLOW_PART_COARSE + SOLVE_COARSE * place;
}

/* ---- The top ---- */

int flow_levels_fork_top(struct flow_state *state, const struct flow_kernel *kernel,
                         const void *args, bool couplings)
{
    const struct flow *flow = state->flow;
    const struct flow_group *top = NULL;
    size_t n = flow_kernel_objects(state, kernel, 0, NULL);
    if (flow->n_levels) {
        n -= flow->tables.n_blocks;
        top = state->groups.all + flow->first_group[flow->n_levels - 1];
    }
    for (uint32_t g = 0; top && g < flow_parts(flow); g++)
        state->refs[n++] = couplings ? top[g].coupling : top[g].part;
    return flow_fork_listed(state, kernel, args, n);
}

/* ---- The motions that a pass reads ---- */

/* Marks the groups that cover the patches of a block, on all levels. */
static void mark_block(struct flow_state *state, uint32_t block)
{
    const struct flow *flow = state->flow;
    for (uint32_t k = 0; k < flow->patches; k++) {
        uint32_t node = flow->patches * block + k;
        for (uint32_t l = 0; l < flow->n_levels; l++) {
            const struct solve_level *level = flow->level + l;
            for (uint32_t i = level->covering_first[node]; i < level->covering_first[node + 1]; i++)
                state->groups.mark[flow->first_group[l] + level->covering[i].group] = 1;
            node = level->group[node];
        }
    }
}

size_t flow_levels_seen(struct flow_state *state, uint32_t block, size_t n)
{
    const struct flow_table *t = state->flow->tables.block + block;
    const struct flow_tied_blocks *tied = &state->tied.now;
    const struct flow_groups *groups = &state->groups;
    if (!groups->n)
        return n;
    memset(groups->mark, 0, groups->n);
    mark_block(state, block);
    for (uint32_t s = 0; s < t->n_neighbours; s++)
        mark_block(state, t->neighbour[s]);
    for (uint32_t i = tied->first ? tied->first[block] : 0;
         tied->first && i < tied->first[block + 1]; i++)
        mark_block(state, tied->other[i]);
    for (uint32_t g = 0; g < groups->n; g++)
        if (groups->mark[g])
            state->refs[n++] = groups->all[g].motion;
    return n;
}

/* The motion of a group among those that a pass reads, which ascend. */
static const double *find_motion(const struct flow_preconditioner *m, uint32_t group)
{
    size_t from = 0, to = m->n_seen;
    while (to - from > 1) {
        const size_t middle = from + (to - from) / 2;
        if (flow_numbers_of(m->seen, middle)[0] > group)
            to = middle;
        else
            from = middle;
    }
    return flow_numbers_of(m->seen, from) + FLOW_MOTION;
}

void flow_levels_motion(const struct flow_preconditioner *m, uint32_t patch, double x[SOLVE_COARSE])
{
    const struct flow *flow = m->flow;
    uint32_t node[FLOW_MAX_LEVELS + 1] = {patch};
    for (uint32_t l = 0; l < flow->n_levels; l++)
        node[l + 1] = flow->level[l].group[node[l]];
    memcpy(x, m->motion + solve_coarse_at(&flow->pattern, node[flow->n_levels]),
           SOLVE_COARSE * sizeof *x);
    for (uint32_t l = flow->n_levels; l-- > 0;) {
        const struct solve_level *level = flow->level + l;
        const uint32_t *first = level->covering_first + node[l];
        solve_level_prolong(flow_lifts_of(flow, l, m->lift)[node[l]], x);
        for (const struct solve_covering *c = level->covering + first[0];
             c < level->covering + first[1]; c++) {
            const double *y = find_motion(m, flow->first_group[l] + c->group) +
                              solve_coarse_at(&level->cover[c->group].pattern, c->place);
            for (int i = 0; i < SOLVE_COARSE; i++)
                x[i] += y[i];
        }
    }
}
