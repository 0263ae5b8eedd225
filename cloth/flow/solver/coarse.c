/* The coarse part of a preconditioner, P C^-1 P' (cloth/solve/coarse.h): motions of patches of
 * blocks (cloth/solve/patches.h). A block's task makes its patches' part of C; one task on every
 * rank assembles C. A pass leaves the right side P' q of its patches; the task of the scalars
 * solves for the motion of all patches. The next pass adds P times that motion to its own rows and
 * its ghosts.
 *
 * In reading order: the space P, made once a run or, for filtered solves, in each step; C and its
 * factor, made in each step; their use in a pass and in its scalars. Its pattern is made once a run
 * (pattern.c). */
#include "cloth/flow/solver/levels.h"
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/solver/solver.h"

#include <string.h>

/* ---- The space P ---- */

FLOW_KERNEL(basis, FLOW_NO_PART, struct flow_block_args,
            (R(table), W(basis), W(halo_basis), IF_MADE(filter)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct solve_patches patches = solve_patches_of(t->n, flow_of(call)->patches);
    for (uint32_t k = 0; k < patches.n; k++) {
        const uint32_t from = patches.start[k], n = patches.start[k + 1] - from;
        solve_basis(n, t->free + from, t->position + from, on->basis + from);
    }
    if (on->filter)
        solve_basis_filter(t->n, on->filter, on->basis);
    flow_write_halo(t, on->basis, on->halo_basis);
    return 0;
}

FLOW_KERNEL(basis_ghosts, FLOW_NO_PART, struct flow_block_args,
            (R(table), W(basis_ghosts), NEIGHBOURS(halo_basis)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    on->basis_ghosts[0] = (phys_vec){0};
    for (uint32_t s = 0; s < t->n_neighbours; s++) {
        const phys_vec *halo = flow_rows_of(on->halo_basis, s);
        for (uint32_t i = t->ghost_start[s]; i < t->ghost_start[s + 1]; i++)
            on->basis_ghosts[i] = halo[t->ghost[i]];
    }
    return 0;
}

int flow_coarse_initialise(struct flow_state *state)
{
    if (!state->flow->conditioner.coarse)
        return DUITE_OK;
    flow_fork_each(state, &flow_kernel_basis, NULL);
    return flow_fork_each(state, &flow_kernel_basis_ghosts, NULL);
}

/* ---- The matrix C and its factor ---- */

/* Copies the block of patches p <= q to its place in the coupling of p's block, if they are joined.
 */
static void put_coupling(const struct flow *flow, uint32_t p, uint32_t q, const double *matrix,
                         double *coupling)
{
    if (flow_patches_joined(flow, p, q))
        memcpy(coupling + SOLVE_COUPLING * flow_coupling_at(flow, p, q), matrix,
               SOLVE_COUPLING * sizeof *matrix);
}

/* The patches of a neighbour by its ghosts here. */
static struct solve_patches patches_of_neighbour(const struct flow *flow,
                                                 const struct flow_table *t, uint32_t neighbour)
{
    const struct flow_table *other = flow->tables.block + t->neighbour[neighbour];
    struct solve_patches patches = {.n = flow->patches};
    uint32_t i = t->ghost_start[neighbour];
    for (uint32_t k = 0; k <= SOLVE_MAX_PATCHES; k++) {
        while (i < t->ghost_start[neighbour + 1] && t->ghost[i] < other->halo_start[k])
            i++;
        patches.start[k] = i;
    }
    return patches;
}

FLOW_KERNEL(couple, FLOW_CG, struct flow_block_args,
            (R(table), R(a), R(basis), R(basis_ghosts), W(coupling), IF_MADE(tie_table),
             TIED(tie_basis)));

/* A tie as the coarse space sees it: P' of its weights, for each patch that it has corners in. */
struct coupled_tie {
    uint32_t n, patch[SOLVE_TIE_CORNERS];
    struct solve_lifted lifted[SOLVE_TIE_CORNERS];
};

/* Data that ties in a row share, looked up once. */
struct coupled_ties {
    const struct flow *flow;
    const struct couple_fields *on;
    struct flow_ties ties;
    struct solve_patches own, there; /* there: of the other block with this number */
    uint32_t other;
    uint32_t n, patch[SOLVE_TIE_CORNERS];             /* between patches of one tie: */
    double *to[SOLVE_TIE_CORNERS][SOLVE_TIE_CORNERS]; /* NULL: another block adds it, or none */
};

static uint32_t patch_of_corner(struct coupled_ties *m, uint32_t corner)
{
    const uint32_t own = m->on->args->block;
    if (corner < m->ties.n_rows)
        return m->own.n * own + solve_patch_of(&m->own, corner);
    const uint32_t ghost = corner - m->ties.n_rows, other = m->ties.ghost_other[ghost];
    const uint32_t block = m->ties.other[other];
    if (other != m->other)
        m->there = solve_patches_of(m->flow->tables.block[block].n, m->flow->patches);
    m->other = other;
    return m->there.n * block + solve_patch_of(&m->there, m->ties.ghost_row[ghost]);
}

static void see_tie(struct coupled_ties *m, uint32_t i, struct coupled_tie *tie)
{
    const struct flow_ties *ties = &m->ties;
    tie->n = 0;
    for (int k = 0; k < SOLVE_TIE_CORNERS; k++) {
        const uint32_t corner = ties->corner[i][k];
        uint32_t at = 0;
        if (ties->weight[i][k] == 0)
            continue;
        const uint32_t patch = patch_of_corner(m, corner);
        while (at < tie->n && tie->patch[at] != patch)
            at++;
        if (at == tie->n) {
            tie->patch[tie->n++] = patch;
            tie->lifted[at] = (struct solve_lifted){{0}};
        }
        solve_lift_corner(ties->weight[i][k],
                          flow_tie_row(ties, corner, m->on->basis, m->on->tied_tie_basis, 0),
                          tie->lifted + at);
    }
}

/* Finds the targets of a tie between these patches: each block has its own patches as rows. A tie
 * to patches beyond the pattern adds only its diagonal part, so that C stays definite. */
static void find_targets(struct coupled_ties *m, const struct coupled_tie *tie)
{
    const uint32_t first = m->flow->patches * m->on->args->block;
    bool whole = true;
    if (tie->n == m->n && !memcmp(tie->patch, m->patch, tie->n * sizeof *tie->patch))
        return;
    m->n = tie->n;
    memcpy(m->patch, tie->patch, tie->n * sizeof *tie->patch);
    for (uint32_t k = 0; k < tie->n; k++)
        for (uint32_t l = 0; l < k; l++)
            whole = whole && flow_patches_joined(m->flow, tie->patch[k], tie->patch[l]);
    for (uint32_t k = 0; k < tie->n; k++)
        for (uint32_t l = 0; l < tie->n; l++) {
            const uint32_t p = tie->patch[k], q = tie->patch[l];
            const bool own = p >= first && p < first + m->flow->patches;
            m->to[k][l] = NULL;
            if (own && (p == q || (whole && q > p)))
                m->to[k][l] = m->on->coupling + SOLVE_COUPLING * flow_coupling_at(m->flow, p, q);
        }
}

/* Adds the ties' part of C. */
static void couple_ties(const struct flow *flow, const phys_vec *value,
                        const struct couple_fields *on)
{
    struct coupled_ties m = {
        .flow = flow, .on = on, .ties = flow_ties_open(on->tie_table), .other = UINT32_MAX};
    m.own = solve_patches_of(m.ties.n_rows, flow->patches);
    for (uint32_t i = 0; i < m.ties.n; i++) {
        struct coupled_tie tie;
        if (solve_is_nothing(value + i))
            continue;
        see_tie(&m, i, &tie);
        find_targets(&m, &tie);
        for (uint32_t k = 0; k < tie.n; k++)
            for (uint32_t l = 0; l < tie.n; l++)
                if (m.to[k][l])
                    solve_couple_lifted(value + i, tie.lifted + k, tie.lifted + l, m.to[k][l]);
    }
}

static int couple_body(const duite_call *call, const struct couple_fields *on)
{
    const struct flow *flow = flow_of(call);
    struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const phys_vec *values = flow_matrix_in(call, t, on->a);
    const struct solve_patches patches = solve_patches_of(t->n, flow->patches);
    const uint32_t block = on->args->block, first = patches.n * block;
    struct solve_couplings own, cut;
    if (on->tie_table)
        memset(on->coupling, 0,
               duite_count(call, FLOW_INDEX_OF(couple, coupling)) * sizeof *on->coupling);
    solve_couple_patches(&t->matrix, &patches, values, on->basis, &own);
    for (uint32_t s = 0; s < t->n_neighbours; s++) {
        const uint32_t from = t->cut_entry[s], n = t->cut_entry[s + 1] - from;
        const struct solve_patches others = patches_of_neighbour(flow, t, s);
        solve_couple_patches_cut(&t->matrix, &patches, values, t->matrix.row[t->n] + from, n,
                                 t->ghost_end + from, on->basis, on->basis_ghosts, &others, &own,
                                 &cut);
        for (uint32_t k = 0; k < patches.n && t->neighbour[s] > block; k++)
            for (uint32_t l = 0; l < patches.n; l++)
                put_coupling(flow, first + k, patches.n * t->neighbour[s] + l, cut.matrix[k][l],
                             on->coupling);
    }
    for (uint32_t k = 0; k < patches.n; k++)
        for (uint32_t l = k; l < patches.n; l++)
            put_coupling(flow, first + k, first + l, own.matrix[k][l], on->coupling);
    couple_ties(flow, flow_tie_values(t, values), on);
    return 0;
}

FLOW_KERNEL_WITH(factor_coarse, FLOW_CG, struct flow_block_args, (W(coarse), ALL(coupling)),
                 .replicated = 1)
{
    const struct flow *flow = flow_of(call);
    const struct flow_graph graph = flow_levels_graph(flow);
    solve_coarse_clear(&flow->pattern, on->coarse);
    for (uint32_t p = 0; p < flow->pattern.n; p++)
        solve_coarse_fill(
            &flow->pattern, graph.first, graph.neighbour, p,
            flow_numbers_of(on->coupling, flow_levels_holder(flow, flow->n_levels, p)) +
                flow_levels_coupling_at(flow, flow->n_levels, p),
            on->coarse);
    solve_coarse_factor(&flow->pattern, on->coarse);
    return 0;
}

/* The coarse factor is made while blocks factorise theirs. */
int flow_coarse_start(struct flow_state *state)
{
    struct flow_block_args args;
    if (!state->flow->conditioner.coarse)
        return DUITE_OK;
    if (model_is_filtered(state->flow->model))
        flow_coarse_initialise(state);
    flow_ties_show_basis(state);
    flow_fork_each(state, &flow_kernel_couple, &args);
    args.block = 0;
    flow_levels_factor(state);
    return flow_levels_fork_top(state, &flow_kernel_factor_coarse, &args, true);
}

/* ---- In a pass ---- */

void flow_coarse_restrict(const struct flow_preconditioner *m, const phys_vec *q, double *right)
{
    const struct solve_patches patches = solve_patches_of(m->table->n, m->flow->patches);
    for (uint32_t k = 0; k < patches.n; k++) {
        const uint32_t from = patches.start[k], n = patches.start[k + 1] - from;
        solve_restrict(n, m->basis + from, q + from, right + SOLVE_COARSE * k);
    }
}

/* The motion of patch k of a block. room: for the sum over levels. */
static const double *motion_of(const struct flow_preconditioner *m, uint32_t block, uint32_t k,
                               double room[SOLVE_COARSE])
{
    const uint32_t patch = m->flow->patches * block + k;
    if (!m->flow->n_levels)
        return m->motion + solve_coarse_at(&m->flow->pattern, patch);
    flow_levels_motion(m, patch, room);
    return room;
}

void flow_coarse_prolong(const struct flow_preconditioner *m, phys_vec *s)
{
    const struct solve_patches patches = solve_patches_of(m->table->n, m->flow->patches);
    double x[SOLVE_COARSE];
    for (uint32_t k = 0; k < patches.n; k++) {
        const uint32_t from = patches.start[k], n = patches.start[k + 1] - from;
        solve_prolong(n, m->basis + from, motion_of(m, m->block, k, x), s + from);
    }
}

/* Ghosts of a neighbour are those of its patches one after the other. */
void flow_coarse_advance_ghosts(const struct flow_preconditioner *m, uint32_t neighbour,
                                const struct solve_scalars *scalars, const double *halo,
                                const uint32_t *at, phys_vec *z, phys_vec *p)
{
    const struct flow_table *t = m->table, *other = m->flow->tables.block + t->neighbour[neighbour];
    const uint32_t first = t->ghost_start[neighbour], end = t->ghost_start[neighbour + 1];
    double x[SOLVE_COARSE];
    for (uint32_t k = 0, i = first; k < m->flow->patches; k++) {
        const uint32_t from = i;
        while (i < end && t->ghost[i] < other->halo_start[k + 1])
            i++;
        solve_advance_ghosts_coarse(i - from, scalars->alpha, scalars->beta, halo,
                                    at + (from - first), m->basis_ghosts + from,
                                    motion_of(m, t->neighbour[neighbour], k, x), z + (from - first),
                                    p + (from - first));
    }
}

void flow_coarse_advance_ties(const struct flow_preconditioner *m, const struct flow_ties *ties,
                              uint32_t k, const struct solve_scalars *scalars, const double *s,
                              const phys_vec *basis, phys_vec *z, phys_vec *p)
{
    const uint32_t block = ties->other[k], n = ties->start[k + 1] - ties->start[k];
    const uint32_t *row = ties->ghost_row + ties->start[k];
    const struct solve_patches patches =
        solve_patches_of(m->flow->tables.block[block].n, m->flow->patches);
    double x[SOLVE_COARSE];
    for (uint32_t patch = 0, i = 0; patch < patches.n; patch++) {
        const uint32_t from = i;
        while (i < n && row[i] < patches.start[patch + 1])
            i++;
        solve_advance_ghosts_coarse(i - from, scalars->alpha, scalars->beta, s, ties->at + from,
                                    basis + from, motion_of(m, block, patch, x), z + from,
                                    p + from);
    }
}

/* ---- In the task of the scalars ---- */

/* The right side of a node on top. */
static const double *right_of(const struct flow *flow, const duite_param *part, uint32_t node)
{
    const uint32_t holder = flow_levels_holder(flow, flow->n_levels, node);
    return flow_levels_right(flow, flow->n_levels, node, flow_numbers_of(part, holder));
}

double flow_coarse_motion(const struct flow *flow, const double *factor, const duite_param *part,
                          double *motion)
{
    double sum = 0;
    memset(motion, 0, flow_motion_doubles(flow) * sizeof *motion);
    for (uint32_t p = 0; p < flow->pattern.n; p++)
        memcpy(motion + solve_coarse_at(&flow->pattern, p), right_of(flow, part, p),
               SOLVE_COARSE * sizeof *motion);
    if (flow->n_levels)
        solve_level_solve_top(&flow->pattern, factor, motion);
    else
        solve_coarse_solve(&flow->pattern, factor, motion);
    for (uint32_t p = 0; p < flow->pattern.n; p++) {
        const double *right = right_of(flow, part, p);
        const double *x = motion + solve_coarse_at(&flow->pattern, p);
        for (int i = 0; i < SOLVE_COARSE; i++)
            sum += right[i] * x[i];
    }
    return sum;
}
