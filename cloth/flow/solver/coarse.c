/* The coarse part of a preconditioner, P C^-1 P' (cloth/solve/coarse.h): motions of patches of
 * blocks (cloth/solve/patches.h). A block's task makes what its patches add to C; one task on every
 * rank puts it together. A pass leaves the right side P' q of its patches; the task of the scalars
 * solves for the motion of all patches. The next pass adds P times it to its own rows and to its
 * ghosts alike.
 *
 * In reading order: the space P, once a run or, with contact in the solve, in each step; C and its
 * factor, in each step; what a pass and its scalars do with them. Its pattern is made once a run
 * (pattern.c). */
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/solver/solver.h"

#include <string.h>

/* ---- The space P ---- */

FLOW_KERNEL(basis, FLOW_NO_PART, struct flow_block_args,
            (R(table), W(basis), W(halo_basis), IF_MADE(filter)))
static int basis_body(const duite_call *call, const struct basis_fields *on)
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
static int basis_ghosts_body(const duite_call *call, const struct basis_ghosts_fields *on)
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
    struct flow_block_args args;
    if (!flow_is_coarse(state->flow))
        return DUITE_OK;
    const int code = flow_fork_each(state, &flow_kernel_basis, &args);
    return code ? code : flow_fork_each(state, &flow_kernel_basis_ghosts, &args);
}

/* ---- The matrix C and its factor ---- */

/* Copies the block of patches p <= q to its place in the coupling of p's block, if they are joined.
 */
static void put(const struct flow *flow, uint32_t p, uint32_t q, const double *matrix,
                double *coupling)
{
    bool joined = p == q;
    for (uint32_t i = flow->patch_first[p]; i < flow->patch_first[p + 1]; i++)
        joined = joined || flow->patch_neighbour[i] == q;
    if (joined)
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
             TIED(tie_basis)))

/* What is made of ties. */
struct coupled_ties {
    const struct flow *flow;
    struct solve_block springs; /* the block, in the format of ties */
    const phys_vec *value;
    double *coupling;
};

static void add_to(const struct coupled_ties *m, uint32_t p, uint32_t q, const double *matrix)
{
    double *to = m->coupling + SOLVE_COUPLING * flow_coupling_at(m->flow, p, q);
    for (int i = 0; i < SOLVE_COUPLING; i++)
        to[i] += matrix[i];
}

/* Adds tie i as its row `row` of patch p sees it: on the diagonal, and beside it where the other
 * end's patch q is the same or a later one. other: the basis there. */
static void couple_tie(const struct coupled_ties *m, uint32_t i, uint32_t row, uint32_t p,
                       uint32_t q, const phys_vec *basis, const phys_vec *other)
{
    const uint32_t end[1][2] = {{row, 0}};
    double own[SOLVE_COUPLING] = {0}, off_diagonal[SOLVE_COUPLING] = {0};
    solve_couple_cut(&m->springs, m->value, 1, &i, end, basis, other, own, off_diagonal);
    add_to(m, p, p, own);
    if (q >= p)
        add_to(m, p, q, off_diagonal);
}

static void couple_ties(const struct coupled_ties *m, uint32_t block,
                        const struct couple_fields *on)
{
    const struct flow_ties ties = flow_ties_open(on->tie_table);
    const phys_vec *basis = on->basis;
    for (uint32_t i = 0; i < ties.n_inner; i++) {
        const uint32_t a = ties.end[i][0], b = ties.end[i][1];
        const uint32_t p = flow_patch_of(m->flow, block, a), q = flow_patch_of(m->flow, block, b);
        couple_tie(m, i, a, p, q, basis, basis + b);
        couple_tie(m, i, b, q, p, basis, basis + a);
    }
    for (uint32_t k = 0; k < ties.n_others; k++)
        for (uint32_t j = ties.start[k]; j < ties.start[k + 1]; j++) {
            const uint32_t i = ties.n_inner + j, row = ties.end[i][0];
            couple_tie(m, i, row, flow_patch_of(m->flow, block, row),
                       flow_patch_of(m->flow, ties.other[k], ties.far[j]), basis,
                       flow_rows_of(on->tied_tie_basis, k) + ties.place[k] + (j - ties.start[k]));
        }
}

static int couple_body(const duite_call *call, const struct couple_fields *on)
{
    const struct flow *flow = flow_of(call);
    struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const phys_vec *values = flow_matrix_in(call, t, on->a);
    const struct solve_patches patches = solve_patches_of(t->n, flow->patches);
    const uint32_t block = on->args->block, first = patches.n * block;
    struct coupled_ties tied = {flow, t->matrix, flow_tie_values(t, values), on->coupling};
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
                put(flow, first + k, patches.n * t->neighbour[s] + l, cut.matrix[k][l],
                    on->coupling);
    }
    for (uint32_t k = 0; k < patches.n; k++)
        for (uint32_t l = k; l < patches.n; l++)
            put(flow, first + k, first + l, own.matrix[k][l], on->coupling);
    tied.springs.format = SOLVE_SPRINGS;
    couple_ties(&tied, block, on);
    return 0;
}

FLOW_KERNEL_WITH(factor_coarse, FLOW_CG, struct flow_block_args, (W(coarse), ALL(coupling)),
                 .replicated = 1)
static int factor_coarse_body(const duite_call *call, const struct factor_coarse_fields *on)
{
    const struct flow *flow = flow_of(call);
    solve_coarse_clear(&flow->pattern, on->coarse);
    for (uint32_t p = 0; p < flow->pattern.n; p++)
        solve_coarse_fill(&flow->pattern, flow->patch_first, flow->patch_neighbour, p,
                          flow_numbers_of(on->coupling, p / flow->patches) +
                              SOLVE_COUPLING * flow_coupling_at(flow, p, p),
                          on->coarse);
    solve_coarse_factor(&flow->pattern, on->coarse);
    return 0;
}

/* The factor is on its way while blocks factorise theirs. */
static int fork_factor(struct flow_state *state)
{
    struct flow_block_args args;
    const int code = flow_fork_each(state, &flow_kernel_couple, &args);
    args.block = 0;
    return code ? code : flow_fork_one(state, &flow_kernel_factor_coarse, &args);
}

int flow_coarse_start(struct flow_state *state)
{
    if (!flow_is_coarse(state->flow))
        return DUITE_OK;
    int code = model_is_filtered(state->flow->model) ? flow_coarse_initialise(state) : DUITE_OK;
    if (!code)
        code = flow_ties_show_basis(state);
    return code ? code : fork_factor(state);
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

/* Of patch k of a block. */
static const double *motion_of(const struct flow_preconditioner *m, uint32_t block, uint32_t k)
{
    return m->motion + solve_coarse_at(&m->flow->pattern, m->flow->patches * block + k);
}

void flow_coarse_prolong(const struct flow_preconditioner *m, phys_vec *s)
{
    const struct solve_patches patches = solve_patches_of(m->table->n, m->flow->patches);
    for (uint32_t k = 0; k < patches.n; k++) {
        const uint32_t from = patches.start[k], n = patches.start[k + 1] - from;
        solve_prolong(n, m->basis + from, motion_of(m, m->block, k), s + from);
    }
}

/* Ghosts of a neighbour are those of its patches one after the other. */
void flow_coarse_advance_ghosts(const struct flow_preconditioner *m, uint32_t neighbour,
                                const struct solve_scalars *scalars, const double *halo,
                                const uint32_t *at, phys_vec *z, phys_vec *p)
{
    const struct flow_table *t = m->table, *other = m->flow->tables.block + t->neighbour[neighbour];
    const uint32_t first = t->ghost_start[neighbour], end = t->ghost_start[neighbour + 1];
    for (uint32_t k = 0, i = first; k < m->flow->patches; k++) {
        const uint32_t from = i;
        while (i < end && t->ghost[i] < other->halo_start[k + 1])
            i++;
        solve_advance_ghosts_coarse(i - from, scalars->alpha, scalars->beta, halo,
                                    at + (from - first), m->basis_ghosts + from,
                                    motion_of(m, t->neighbour[neighbour], k), z + (from - first),
                                    p + (from - first));
    }
}

void flow_coarse_advance_row(const struct flow_preconditioner *m, uint32_t block, uint32_t row,
                             const phys_vec *basis, const struct solve_scalars *scalars,
                             const double *s, phys_vec *z, phys_vec *p)
{
    const uint32_t here = 0, patch = flow_patch_of(m->flow, block, row);
    solve_advance_ghosts_coarse(1, scalars->alpha, scalars->beta, s, &here, basis,
                                m->motion + solve_coarse_at(&m->flow->pattern, patch), z, p);
}

/* ---- In the task of the scalars ---- */

/* The right side of a patch. */
static const double *right_of(const struct flow *flow, const duite_param *part, uint32_t patch)
{
    const double *all = flow_numbers_of(part, patch / flow->patches) + FLOW_PART_COARSE;
    return all + SOLVE_COARSE * (patch % flow->patches);
}

double flow_coarse_motion(const struct flow *flow, const double *factor, const duite_param *part,
                          double *motion)
{
    double sum = 0;
    memset(motion, 0, flow_motion_doubles(flow) * sizeof *motion);
    for (uint32_t p = 0; p < flow->pattern.n; p++)
        memcpy(motion + solve_coarse_at(&flow->pattern, p), right_of(flow, part, p),
               SOLVE_COARSE * sizeof *motion);
    solve_coarse_solve(&flow->pattern, factor, motion);
    for (uint32_t p = 0; p < flow->pattern.n; p++) {
        const double *right = right_of(flow, part, p);
        const double *x = motion + solve_coarse_at(&flow->pattern, p);
        for (int i = 0; i < SOLVE_COARSE; i++)
            sum += right[i] * x[i];
    }
    return sum;
}
