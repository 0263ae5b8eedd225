/* The coarse part of a preconditioner, P C^-1 P' (cloth/solve/coarse.h): motions of patches of
 * blocks (cloth/solve/patches.h). A block's task makes what its patches add to C; one task on every
 * rank puts it together. A pass leaves the right side P' q of its patches; the task of the scalars
 * solves for the motion of all patches. The next pass adds P times it to its own rows and to its
 * copies alike.
 *
 * In reading order: the pattern of C, once a run; the space P, once a run or, with
 * contact in the solve, in each step; C and its factor, in each step; what a pass and its scalars
 * do with them. */
#include "cloth/flow/setup/setup.h"
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/solver/solver.h"

#include "cloth/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* ---- The pattern ---- */

/* Appends to `to` the patches of block `other` that patch k is joined with. */
static uint32_t *add_joined(const struct flow *flow, uint32_t joins, uint32_t k, uint32_t other,
                            uint32_t *to)
{
    for (uint32_t l = 0; l < flow->patches; l++)
        if (joins & solve_patch_bit(k, l))
            *to++ = flow->patches * other + l;
    return to;
}

/* Those of patch k of block b, ascending. Returns the end. */
static uint32_t *add_neighbours(const struct flow *flow, uint32_t b, uint32_t k, uint32_t *to)
{
    const struct flow_table *t = flow->tables.block + b;
    const uint32_t itself = solve_patch_bit(k, k);
    uint32_t s = 0;
    for (; s < t->n_slots && t->slot[s] < b; s++)
        to = add_joined(flow, t->joins[s], k, t->slot[s], to);
    to = add_joined(flow, t->joined & ~itself, k, b, to);
    for (; s < t->n_slots; s++)
        to = add_joined(flow, t->joins[s], k, t->slot[s], to);
    return to;
}

/* How many neighbours all patches can have. */
static size_t most_beside(const struct flow *flow)
{
    size_t slots = 0;
    for (uint32_t b = 0; b < flow->tables.n_blocks; b++)
        slots += 1 + (size_t)flow->tables.block[b].n_slots;
    return slots * flow->patches * flow->patches;
}

static void make_pattern(struct flow *flow)
{
    const uint32_t n_blocks = flow->tables.n_blocks, n = flow->patches * n_blocks;
    struct cloth_error *trouble = &flow->trouble;
    flow->first_beside = cloth_alloc((size_t)n + 1, sizeof *flow->first_beside, trouble);
    flow->beside = cloth_alloc(most_beside(flow), sizeof *flow->beside, trouble);
    if (!flow->first_beside || !flow->beside)
        return;
    for (uint32_t b = 0; b < n_blocks; b++)
        for (uint32_t k = 0; k < flow->patches; k++) {
            uint32_t *first = flow->first_beside + flow->patches * b + k;
            first[1] = (uint32_t)(add_neighbours(flow, b, k, flow->beside + *first) - flow->beside);
        }
    solve_pattern_make(&flow->pattern, n, flow->first_beside, flow->beside, trouble);
}

/* How many neighbours of patch p are behind it and before `end`. */
static size_t count_later(const struct flow *flow, uint32_t p, uint32_t end)
{
    size_t count = 0;
    for (uint32_t i = flow->first_beside[p]; i < flow->first_beside[p + 1]; i++)
        count += flow->beside[i] > p && flow->beside[i] < end;
    return count;
}

size_t flow_coupling_at(const struct flow *flow, uint32_t p, uint32_t q)
{
    size_t at = q > p ? 1 + count_later(flow, p, q) : 0;
    for (uint32_t before = p - p % flow->patches; before < p; before++)
        at += 1 + count_later(flow, before, UINT32_MAX);
    return at;
}

int flow_coarse_prepare(struct flow_state *state)
{
    make_pattern(state->flow);
    return flow_memory_agree(state);
}

void flow_coarse_free(struct flow *flow)
{
    solve_pattern_free(&flow->pattern);
    free(flow->first_beside);
    free(flow->beside);
    flow->first_beside = flow->beside = NULL;
}

/* ---- The space P ---- */

FLOW_KERNEL(basis, FLOW_NO_PART, struct flow_args,
            (R(table), W(basis), W(rim_basis), IF_MADE(filter)))
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
    flow_write_rim(t, on->basis, on->rim_basis);
    return 0;
}

FLOW_KERNEL(basis_copies, FLOW_NO_PART, struct flow_args,
            (R(table), W(basis_copies), NEIGHBOURS(rim_basis)))
static int basis_copies_body(const duite_call *call, const struct basis_copies_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    on->basis_copies[0] = (phys_vec){0};
    for (uint32_t s = 0; s < t->n_slots; s++) {
        const phys_vec *rim = flow_rows_of(on->rim_basis, s);
        for (uint32_t i = t->copies[s]; i < t->copies[s + 1]; i++)
            on->basis_copies[i] = rim[t->copy[i]];
    }
    return 0;
}

int flow_coarse_initialise(struct flow_state *state)
{
    struct flow_args args = {0};
    if (!flow_is_coarse(state->flow))
        return DUITE_OK;
    const int code = flow_fork_each(state, &flow_kernel_basis, &args);
    return code ? code : flow_fork_each(state, &flow_kernel_basis_copies, &args);
}

/* ---- The matrix C and its factor ---- */

/* Copies the block of patches p <= q to its place in the coupling of p's block, if they are joined.
 */
static void put(const struct flow *flow, uint32_t p, uint32_t q, const double *matrix,
                double *coupling)
{
    bool joined = p == q;
    for (uint32_t i = flow->first_beside[p]; i < flow->first_beside[p + 1]; i++)
        joined = joined || flow->beside[i] == q;
    if (joined)
        memcpy(coupling + SOLVE_COUPLING * flow_coupling_at(flow, p, q), matrix,
               SOLVE_COUPLING * sizeof *matrix);
}

/* The patches of a neighbour by its copies here. */
static struct solve_patches patches_of_slot(const struct flow *flow, const struct flow_table *t,
                                            uint32_t slot)
{
    const struct flow_table *other = flow->tables.block + t->slot[slot];
    struct solve_patches patches = {.n = flow->patches};
    uint32_t i = t->copies[slot];
    for (uint32_t k = 0; k <= SOLVE_MOST_PATCHES; k++) {
        while (i < t->copies[slot + 1] && t->copy[i] < other->rim_start[k])
            i++;
        patches.start[k] = i;
    }
    return patches;
}

FLOW_KERNEL(couple, FLOW_CG, struct flow_args,
            (R(table), R(a), R(basis), R(basis_copies), W(coupling)))
static int couple_body(const duite_call *call, const struct couple_fields *on)
{
    const struct flow *flow = flow_of(call);
    struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const phys_vec *values = flow_matrix_in(call, t, on->a);
    const struct solve_patches patches = solve_patches_of(t->n, flow->patches);
    const uint32_t block = on->args->block, first = patches.n * block;
    struct solve_couplings own, beside;
    solve_couple_patches(&t->matrix, &patches, values, on->basis, &own);
    for (uint32_t s = 0; s < t->n_slots; s++) {
        const uint32_t from = t->cut_entry[s], n = t->cut_entry[s + 1] - from;
        const struct solve_patches others = patches_of_slot(flow, t, s);
        solve_couple_patches_cut(&t->matrix, &patches, values, t->matrix.row[t->n] + from, n,
                                 t->copy_end + from, on->basis, on->basis_copies, &others, &own,
                                 &beside);
        for (uint32_t k = 0; k < patches.n && t->slot[s] > block; k++)
            for (uint32_t l = 0; l < patches.n; l++)
                put(flow, first + k, patches.n * t->slot[s] + l, beside.matrix[k][l], on->coupling);
    }
    for (uint32_t k = 0; k < patches.n; k++)
        for (uint32_t l = k; l < patches.n; l++)
            put(flow, first + k, first + l, own.matrix[k][l], on->coupling);
    return 0;
}

FLOW_KERNEL_WITH(factor_coarse, FLOW_CG, struct flow_args, (W(coarse), ALL(coupling)),
                 .replicated = 1)
static int factor_coarse_body(const duite_call *call, const struct factor_coarse_fields *on)
{
    const struct flow *flow = flow_of(call);
    solve_coarse_clear(&flow->pattern, on->coarse);
    for (uint32_t p = 0; p < flow->pattern.n; p++)
        solve_coarse_fill(&flow->pattern, flow->first_beside, flow->beside, p,
                          flow_numbers_of(on->coupling, p / flow->patches) +
                              SOLVE_COUPLING * flow_coupling_at(flow, p, p),
                          on->coarse);
    solve_coarse_factor(&flow->pattern, on->coarse);
    return 0;
}

/* The factor is on its way while blocks factorise theirs. */
static int fork_factor(struct flow_state *state, struct flow_args args)
{
    const int code = flow_fork_each(state, &flow_kernel_couple, &args);
    args.block = 0;
    return code ? code : flow_fork_one(state, &flow_kernel_factor_coarse, &args);
}

int flow_coarse_start(struct flow_state *state, struct flow_args args)
{
    if (!flow_is_coarse(state->flow))
        return DUITE_OK;
    const int code =
        model_is_filtered(state->flow->model) ? flow_coarse_initialise(state) : DUITE_OK;
    return code ? code : fork_factor(state, args);
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

/* Copies of a neighbour are those of its patches one after the other. */
void flow_coarse_advance_copies(const struct flow_preconditioner *m, uint32_t slot,
                                const struct solve_scalars *scalars, const double *rim,
                                const uint32_t *at, phys_vec *z, phys_vec *p)
{
    const struct flow_table *t = m->table, *other = m->flow->tables.block + t->slot[slot];
    const uint32_t first = t->copies[slot], end = t->copies[slot + 1];
    for (uint32_t k = 0, i = first; k < m->flow->patches; k++) {
        const uint32_t from = i;
        while (i < end && t->copy[i] < other->rim_start[k + 1])
            i++;
        solve_advance_copies_coarse(i - from, scalars->alpha, scalars->beta, rim,
                                    at + (from - first), m->basis_copies + from,
                                    motion_of(m, t->slot[slot], k), z + (from - first),
                                    p + (from - first));
    }
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
