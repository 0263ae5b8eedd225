/* Restores the momentum that a solve loses to free pieces. A solve ends with a residual r = b - A
 * dv. The sum of r over the rows of a free piece is momentum that the step lost. The entries of A
 * cancel in that sum. It has only terms of rows: b - D dv, D the diagonal besides entries. On a
 * uniform motion c a row of A gives D c. So the c that removes the sum is exact, and needs no
 * iteration. */
#include "cloth/flow/run/step.h"
#include "cloth/flow/solver/solver.h"

/* Sums over a piece: the lost momentum, D, kg, and the number of rows that a slider holds. */
enum { LOST, MASS = 3, HELD };

static bool solver_pieces_is_held(const struct flow_table *t, uint32_t row)
{
    if (!t->matrix.filter)
        return false;
    const phys_vec filter = t->matrix.filter[row]; /* free: 0 0 0 1 */
    return filter[0] != 0 || filter[1] != 0 || filter[2] != 0 || filter[3] != 1;
}

FLOW_KERNEL(piece_sums, FLOW_CG, struct flow_block_args,
            (R(table), R(f), R(a), R(dv), SUM(pieces), IF_MADE(groups)));

/* The number of a piece's sums, from 1; pieces joined by ties share them. 0: none, as a pin holds
 * the piece. */
static uint64_t solver_pieces_group_of(const uint64_t *groups, uint32_t piece)
{
    return groups ? groups[piece - 1] : piece;
}

static int piece_sums_body(const duite_call *call, const struct piece_sums_fields *on)
{
    struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const phys_vec *b = on->f, *dv = on->dv;
    flow_matrix_in(call, t, on->a); /* its diagonal */
    for (uint32_t i = 0; i < t->n_loose; i++) {
        const uint32_t row = t->loose[i][0];
        const uint64_t group = solver_pieces_group_of(on->groups, t->loose[i][1]);
        if (!group)
            continue;
        double *sums = on->pieces + FLOW_PIECE_SUMS * (group - 1);
        const phys_vec lost = b[row] - t->matrix.diagonal[row] * dv[row];
        for (int c = 0; c < 3; c++)
            sums[LOST + c] += lost[c];
        sums[MASS] += t->matrix.diagonal[row];
        sums[HELD] += solver_pieces_is_held(t, row);
    }
    return 0;
}

/* c of m c = l; zero if a row of the piece is held. */
static void shift_of(const double *sums, phys_vec *shift)
{
    *shift = (phys_vec){0};
    if (sums[HELD] > 0)
        return;
    for (int c = 0; c < 3; c++)
        (*shift)[c] = sums[LOST + c] / sums[MASS];
}

FLOW_KERNEL(piece_shift, FLOW_CG, struct flow_block_args,
            (R(table), R(a), R(pieces), RW(dv), RW(r), IF_MADE(groups)))
{
    struct flow_table table = flow_table_in(call, on->table), *t = &table;
    flow_matrix_in(call, t, on->a); /* its diagonal */
    phys_vec shift = {0};
    uint64_t last = 0;
    for (uint32_t i = 0; i < t->n_loose; i++) {
        const uint32_t row = t->loose[i][0];
        const uint64_t group = solver_pieces_group_of(on->groups, t->loose[i][1]);
        if (!group)
            continue;
        if (group != last)
            shift_of(on->pieces + FLOW_PIECE_SUMS * (group - 1), &shift);
        last = group;
        on->dv[row] += shift;
        on->r[row] -= t->matrix.diagonal[row] * shift;
    }
    return 0;
}

int flow_pieces_fork(struct flow_state *state)
{
    if (!state->head.n_pieces)
        return DUITE_OK;
    const struct flow_kernel *const kernel[] = {&flow_kernel_piece_sums, &flow_kernel_piece_shift};
    struct flow_block_args here;
    flow_set(state, FLOW_FIELD_pieces, NULL);
    for (int k = 0; k < 2; k++)
        for (here.block = 0; here.block < state->flow->tables.n_blocks; here.block++)
            if (state->flow->tables.block[here.block].n_loose)
                flow_fork_one(state, kernel[k], &here);
    return state->code;
}
