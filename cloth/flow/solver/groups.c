/* The tasks of groups (levels.c). In each step one task makes the factor of a group's cover, and
 * the group's part of the matrix of all groups. After a pass another reads the parts of the group's
 * blocks and of the layer. It solves for the motion of the cover. It hands on, in the form of a
 * block's part, the dots of its own blocks with its share of q.s, and nine numbers. The same tasks
 * read the parts of groups on higher levels. */
#include "cloth/flow/solver/levels.h"
#include "cloth/flow/solver/solver.h"

#include <string.h>

/* ---- The group of a task ---- */

struct group_args {
    uint32_t level, group;
};

/* A group, as its task sees it. */
struct group {
    const struct flow *flow;
    const struct solve_level *level;
    const struct solve_cover *cover;
    const double (*lift)[FLOW_LIFT];
    uint32_t depth, number, among_all; /* which level; among the groups of the level; of all */
};

static struct group group_of(const duite_call *call, const double *lift)
{
    const struct group_args *args = call->args;
    const struct flow *flow = flow_of(call);
    const struct solve_level *level = flow->level + args->level;
    return (struct group){.flow = flow,
                          .level = level,
                          .cover = level->cover + args->group,
                          .lift = flow_lifts_of(flow, args->level, lift),
                          .depth = args->level,
                          .number = args->group,
                          .among_all = flow->first_group[args->level] + args->group};
}

/* The numbers of the node at a place. Parameters are in order of nodes, from `param` on. *at: the
 * parameter of the place before, then of this one; it begins at zero. */
static const double *numbers_at(const struct group *group, const duite_param *param, uint32_t place,
                                uint32_t *at)
{
    const uint32_t *node = group->cover->node + place;
    if (place && flow_levels_holder(group->flow, group->depth, node[0]) !=
                     flow_levels_holder(group->flow, group->depth, node[-1]))
        ++*at;
    return param[*at].data;
}

static bool is_own(const struct group *group, uint32_t place)
{
    return group->level->group[group->cover->node[place]] == group->number;
}

/* Appends the objects that a group covers to refs: parts of blocks or of groups below, or
 * couplings. Returns the new number of objects. */
static size_t add_covered(const struct flow_state *state, const struct group_args *args,
                          bool couplings, size_t n)
{
    const struct flow *flow = state->flow;
    const struct solve_cover *cover = flow->level[args->level].cover + args->group;
    for (uint32_t i = 0; i < cover->n; i++) {
        const uint32_t from = flow_levels_holder(flow, args->level, cover->node[i]);
        if (i && from == flow_levels_holder(flow, args->level, cover->node[i - 1]))
            continue;
        if (args->level) {
            const struct flow_group *below =
                state->groups.all + flow->first_group[args->level - 1] + from;
            state->refs[n++] = couplings ? below->coupling : below->part;
        } else {
            const struct flow_objects *block = state->block + from;
            state->refs[n++] = couplings ? block->coupling : block->part;
        }
    }
    return n;
}

/* Forks one of the kernels below on all groups of all levels. */
static int fork_groups(struct flow_state *state, const duite_kernel *kernel)
{
    const struct flow *flow = state->flow;
    const bool factor = kernel == &flow_group_factor;
    int code = DUITE_OK;
    for (uint32_t level = 0; level < flow->n_levels; level++)
        for (uint32_t g = 0; g < flow->level[level].n_groups && !code; g++) {
            const struct group_args args = {level, g};
            const struct flow_group *group = state->groups.all + flow->first_group[level] + g;
            size_t n = 0;
            state->refs[n++] = factor ? group->factor : group->motion;
            state->refs[n++] = factor ? group->coupling : group->part;
            state->refs[n++] = state->run.lift;
            if (!factor)
                state->refs[n++] = group->factor;
            if (kernel == &flow_group_solve)
                state->refs[n++] = flow_field_object(state, FLOW_FIELD_scalars, 0);
            n = add_covered(state, &args, factor, n);
            code = duite_fork(state->rt, kernel, &args, n, state->refs);
        }
    return code;
}

/* ---- Factors ---- */

static int factor_group(const duite_call *call)
{
    enum { FACTOR, COUPLING, LIFT, COVERED };
    const struct group group = group_of(call, duite_in(call, LIFT, double));
    const struct solve_cover *cover = group.cover;
    double *factor = duite_out(call, FACTOR, double), *to = duite_out(call, COUPLING, double);
    memset(to, 0, duite_count(call, COUPLING) * sizeof *to);
    solve_coarse_clear(&cover->pattern, factor);
    for (uint32_t i = 0, at = 0; i < cover->n; i++) {
        const double *coupling = numbers_at(&group, call->param + COVERED, i, &at) +
                                 flow_levels_coupling_at(group.flow, group.depth, cover->node[i]);
        solve_coarse_fill(&cover->pattern, cover->first, cover->neighbour, i, coupling, factor);
        if (is_own(&group, i))
            solve_level_couple(group.level, cover->node[i], coupling, group.lift, to);
    }
    solve_coarse_factor(&cover->pattern, factor);
    return 0;
}

static int factor_task(const duite_call *call)
{
    return flow_timed(call, factor_group, FLOW_CG);
}
const duite_kernel flow_group_factor = {.name = "group_factor",
                                        .body = factor_task,
                                        .access = {DUITE_W, DUITE_W, DUITE_R},
                                        .variadic = DUITE_R,
                                        .args_size = sizeof(struct group_args)};

int flow_levels_factor(struct flow_state *state)
{
    return fork_groups(state, &flow_group_factor);
}

/* ---- Between a pass and its scalars ---- */

/* The right side of the node at a place; at: as of numbers_at. */
static const double *right_at(const struct group *group, const duite_param *param, uint32_t place,
                              uint32_t *at)
{
    const double *part = numbers_at(group, param, place, at);
    return flow_levels_right(group->flow, group->depth, group->cover->node[place], part);
}

/* Adds the dots of the group's own blocks, or groups. */
static void add_dots(const struct group *group, const duite_param *param, double *dots)
{
    const double *last = NULL;
    for (uint32_t i = 0, at = 0; i < group->cover->n; i++) {
        const double *part = numbers_at(group, param, i, &at);
        for (int k = 0; k < SOLVE_DOTS && part != last && is_own(group, i); k++)
            dots[k] += part[k];
        last = part;
    }
}

/* Solves for the motion. Adds its share of q.s to the dots, and the group's right side on the next
 * level to the part. */
static void solve_group(const struct group *group, const double *factor, const duite_param *param,
                        double *motion, double *part)
{
    const struct solve_cover *cover = group->cover;
    memset(motion, 0, SOLVE_COARSE_STRIDE * (size_t)cover->n * sizeof *motion);
    for (uint32_t i = 0, at = 0; i < cover->n; i++) {
        const double *right = right_at(group, param, i, &at);
        memcpy(motion + solve_coarse_at(&cover->pattern, i), right, SOLVE_COARSE * sizeof *right);
        if (is_own(group, i))
            solve_level_restrict(group->lift[cover->node[i]], right, part + FLOW_PART_COARSE);
    }
    solve_level_solve(group->level, group->number, factor, motion);
    for (uint32_t i = 0, at = 0; i < cover->n; i++) {
        const double *right = right_at(group, param, i, &at);
        const double *x = motion + solve_coarse_at(&cover->pattern, i);
        for (int k = 0; k < SOLVE_COARSE; k++)
            part[SOLVE_QQ] += right[k] * x[k];
    }
}

enum { SOLVE_MOTION, SOLVE_PART, SOLVE_LIFT, SOLVE_FACTOR, SOLVE_COVERED };

/* param: the parts of the cover. */
static void solve_or_sum(const duite_call *call, bool moves, const duite_param *param)
{
    const struct group group = group_of(call, duite_in(call, SOLVE_LIFT, double));
    double *motion = duite_out(call, SOLVE_MOTION, double);
    double *part = duite_out(call, SOLVE_PART, double);
    memset(part, 0, duite_count(call, SOLVE_PART) * sizeof *part);
    memset(motion, 0, duite_count(call, SOLVE_MOTION) * sizeof *motion);
    motion[0] = group.among_all;
    add_dots(&group, param, part);
    if (moves)
        solve_group(&group, duite_in(call, SOLVE_FACTOR, double), param, motion + FLOW_MOTION,
                    part);
}

static int start_group(const duite_call *call)
{
    solve_or_sum(call, true, call->param + SOLVE_COVERED);
    return 0;
}

static int start_task(const duite_call *call)
{
    return flow_timed(call, start_group, FLOW_CG);
}
const duite_kernel flow_group_start = {.name = "group_start",
                                       .body = start_task,
                                       .access = {DUITE_W, DUITE_W, DUITE_R, DUITE_R},
                                       .variadic = DUITE_R,
                                       .args_size = sizeof(struct group_args)};

static int continue_group(const duite_call *call)
{
    const struct solve_scalars *scalars = call->param[SOLVE_COVERED].data;
    solve_or_sum(call, flow_coarse_moves(scalars), call->param + SOLVE_COVERED + 1);
    return 0;
}

static int solve_task(const duite_call *call)
{
    return flow_timed(call, continue_group, FLOW_CG);
}
const duite_kernel flow_group_solve = {.name = "group_solve",
                                       .body = solve_task,
                                       .access = {DUITE_W, DUITE_W, DUITE_R, DUITE_R, DUITE_R},
                                       .variadic = DUITE_R,
                                       .args_size = sizeof(struct group_args)};

int flow_levels_start(struct flow_state *state)
{
    return fork_groups(state, &flow_group_start);
}

int flow_levels_solve(struct flow_state *state)
{
    return fork_groups(state, &flow_group_solve);
}
