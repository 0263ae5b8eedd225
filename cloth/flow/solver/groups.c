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
    uint32_t block; /* 0: it has none */
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

static struct group solver_groups_group_of(const duite_call *call, const struct group_args *args,
                                           const double *lift)
{
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

/* Puts the objects that a group covers into `to`: parts of blocks or of groups below, or couplings.
 * Returns how many. */
static size_t list_covered(const struct flow_state *state, const struct group_args *args,
                           bool couplings, duite_object *to)
{
    const struct flow *flow = state->flow;
    const struct solve_cover *cover = flow->level[args->level].cover + args->group;
    size_t n = 0;
    for (uint32_t i = 0; i < cover->n; i++) {
        const uint32_t from = flow_levels_holder(flow, args->level, cover->node[i]);
        if (i && from == flow_levels_holder(flow, args->level, cover->node[i - 1]))
            continue;
        if (args->level) {
            const struct flow_group *below =
                state->groups.all + flow->first_group[args->level - 1] + from;
            to[n++] = couplings ? below->coupling : below->part;
        } else {
            const struct flow_objects *block = state->block + from;
            to[n++] = couplings ? block->coupling : block->part;
        }
    }
    return n;
}

/* Forks one of the kernels below on all groups of all levels. makes: it makes factors, of
 * couplings; else it solves with them, for parts. */
static int fork_groups(struct flow_state *state, const struct flow_kernel *kernel, bool makes)
{
    const struct flow *flow = state->flow;
    duite_object *rest = state->refs + FLOW_MAX_PARAMETERS;
    for (uint32_t level = 0; level < flow->n_levels; level++)
        for (uint32_t g = 0; g < flow->level[level].n_groups; g++) {
            const struct group_args args = {.level = level, .group = g};
            const struct flow_group *group = state->groups.all + flow->first_group[level] + g;
            const struct flow_with with = {.group_factor = group->factor,
                                           .group_coupling = group->coupling,
                                           .group_motion = group->motion,
                                           .group_part = group->part,
                                           .n = list_covered(state, &args, makes, rest),
                                           .rest = rest};
            flow_fork_with(state, kernel, &args, &with);
        }
    return state->code;
}

/* ---- Factors ---- */

FLOW_KERNEL(group_factor, FLOW_CG, struct group_args,
            (GIVEN_W(group_factor), GIVEN_W(group_coupling), R(lift), REST_R(covered)))
{
    const struct group group = solver_groups_group_of(call, on->args, on->lift);
    const struct solve_cover *cover = group.cover;
    double *factor = on->group_factor, *to = on->group_coupling;
    memset(to, 0, duite_count(call, FLOW_INDEX_OF(group_factor, group_coupling)) * sizeof *to);
    solve_coarse_clear(&cover->pattern, factor);
    for (uint32_t i = 0, at = 0; i < cover->n; i++) {
        const double *coupling = numbers_at(&group, on->covered, i, &at) +
                                 flow_levels_coupling_at(group.flow, group.depth, cover->node[i]);
        solve_coarse_fill(&cover->pattern, cover->first, cover->neighbour, i, coupling, factor);
        if (is_own(&group, i))
            solve_level_couple(group.level, cover->node[i], coupling, group.lift, to);
    }
    solve_coarse_factor(&cover->pattern, factor);
    return 0;
}

int flow_levels_factor(struct flow_state *state)
{
    return fork_groups(state, &flow_kernel_group_factor, true);
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

/* Before the first pass of a solve, too, whose scalars say that it makes a new q. */
FLOW_KERNEL(group_solve, FLOW_CG, struct group_args,
            (GIVEN_W(group_motion), GIVEN_W(group_part), GIVEN_R(group_factor), R(lift), R(scalars),
             REST_R(covered)))
{
    const struct group group = solver_groups_group_of(call, on->args, on->lift);
    double *motion = on->group_motion, *part = on->group_part;
    memset(part, 0, duite_count(call, FLOW_INDEX_OF(group_solve, group_part)) * sizeof *part);
    memset(motion, 0, duite_count(call, FLOW_INDEX_OF(group_solve, group_motion)) * sizeof *motion);
    motion[0] = group.among_all;
    add_dots(&group, on->covered, part);
    if (flow_coarse_moves(on->scalars))
        solve_group(&group, on->group_factor, on->covered, motion + FLOW_MOTION, part);
    return 0;
}

int flow_levels_solve(struct flow_state *state)
{
    return fork_groups(state, &flow_kernel_group_solve, false);
}
