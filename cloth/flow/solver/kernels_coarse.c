/* The coarse part of a preconditioner (cloth/solve/patches.h): its space, once a run or, with
 * contact in the solve, in each step; and its matrix and factor, in each step. A block's task makes
 * what its patches add to the matrix; one task on every rank puts it together. */
#include "cloth/flow/bodies.h"
#include "cloth/flow/solver/patches.h"

#include <string.h>

#define ARGS sizeof(struct flow_args)

/* ---- What does not change during a run, but for contact ---- */

static int basis(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    phys_vec *rows = duite_out(call, 1, phys_vec);
    const struct solve_patches patches = solve_patches_of(t->n, flow_of(call)->patches);
    for (uint32_t k = 0; k < patches.n; k++) {
        const uint32_t from = patches.start[k], n = patches.start[k + 1] - from;
        solve_basis(n, t->free + from, t->position + from, rows + from);
    }
    if (call->n_params > 3)
        solve_basis_filter(t->n, duite_in(call, 3, phys_vec), rows);
    flow_write_rim(t, rows, duite_out(call, 2, phys_vec));
    return 0;
}
const duite_kernel flow_basis = {.name = "basis",
                                 .body = basis,
                                 .access = {DUITE_R, DUITE_W, DUITE_W},
                                 .variadic = DUITE_R,
                                 .args_size = ARGS};

static int basis_copies(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    phys_vec *copy = duite_out(call, 1, phys_vec);
    copy[0] = (phys_vec){0};
    for (uint32_t s = 0; s < t->n_slots; s++) {
        const phys_vec *rim = duite_in(call, 2 + s, phys_vec);
        for (uint32_t i = t->copies[s]; i < t->copies[s + 1]; i++)
            copy[i] = rim[t->copy[i]];
    }
    return 0;
}
const duite_kernel flow_basis_copies = {.name = "basis_copies",
                                        .body = basis_copies,
                                        .access = {DUITE_R, DUITE_W},
                                        .variadic = DUITE_R,
                                        .args_size = ARGS};

/* ---- Of each step's matrix ---- */

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

static int couple(const duite_call *call)
{
    const struct flow *flow = flow_of(call);
    struct flow_table table = flow_table_of(call), *t = &table;
    const phys_vec *values = flow_open_matrix(call, t, 1);
    const phys_vec *rows = duite_in(call, 2, phys_vec), *copies = duite_in(call, 3, phys_vec);
    double *coupling = duite_out(call, 4, double);
    const struct solve_patches patches = solve_patches_of(t->n, flow->patches);
    const uint32_t block = flow_args_of(call)->block, first = patches.n * block;
    struct solve_couplings own, beside;
    solve_couple_patches(&t->matrix, &patches, values, rows, &own);
    for (uint32_t s = 0; s < t->n_slots; s++) {
        const uint32_t from = t->cut_entry[s], n = t->cut_entry[s + 1] - from;
        const struct solve_patches others = patches_of_slot(flow, t, s);
        solve_couple_patches_cut(&t->matrix, &patches, values, t->matrix.row[t->n] + from, n,
                                 t->copy_end + from, rows, copies, &others, &own, &beside);
        for (uint32_t k = 0; k < patches.n && t->slot[s] > block; k++)
            for (uint32_t l = 0; l < patches.n; l++)
                put(flow, first + k, patches.n * t->slot[s] + l, beside.matrix[k][l], coupling);
    }
    for (uint32_t k = 0; k < patches.n; k++)
        for (uint32_t l = k; l < patches.n; l++)
            put(flow, first + k, first + l, own.matrix[k][l], coupling);
    return 0;
}
FLOW_TIMED(couple, FLOW_CG)
const duite_kernel flow_couple = {.name = "couple",
                                  .body = couple_timed,
                                  .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_R, DUITE_W},
                                  .args_size = ARGS};

static int factor_coarse(const duite_call *call)
{
    const struct flow *flow = flow_of(call);
    double *factor = duite_out(call, 0, double);
    solve_coarse_clear(&flow->pattern, factor);
    for (uint32_t p = 0; p < flow->pattern.n; p++)
        solve_coarse_fill(&flow->pattern, flow->first_beside, flow->beside, p,
                          duite_in(call, 1 + p / flow->patches, double) +
                              SOLVE_COUPLING * flow_coupling_at(flow, p, p),
                          factor);
    solve_coarse_factor(&flow->pattern, factor);
    return 0;
}
FLOW_TIMED(factor_coarse, FLOW_CG)
const duite_kernel flow_factor_coarse = {.name = "factor_coarse",
                                         .body = factor_coarse_timed,
                                         .access = {DUITE_W},
                                         .variadic = DUITE_R,
                                         .args_size = ARGS,
                                         .replicated = 1};
