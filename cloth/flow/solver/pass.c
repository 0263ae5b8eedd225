/* A pass of conjugate gradients over a block (cloth/solve/cg.h). Without a preconditioner, that is
 * with the identity, z is r and s is q. A block keeps z and p of its ghosts, the other
 * ends of its cut entries. It changes them as their owner does, so it reads only rows of s of a
 * neighbour. The sums of a pass are its part. Without a preconditioner they go to the sums of all
 * blocks. With one they are the block's own, with the coarse right side P' q behind the dots.
 *
 * In reading order: the factor of a step's matrix (cloth/solve/local.h), the begin of a solve, a
 * pass by its phases, its kernel, the forks. */
#include "cloth/flow/solver/levels.h"
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/solver/solver.h"

#include <string.h>

/* ---- The factor of a block ---- */

FLOW_KERNEL(factor, FLOW_CG, struct flow_block_args,
            (R(table), R(a), W(factor), IF_MADE(tie_table)))
{
    const enum solve_local local = flow_of(call)->conditioner.local;
    struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const phys_vec *values = flow_matrix_in(call, t, on->a);
    const struct flow_ties ties = flow_ties_open(on->tie_table);
    const struct solve_ties solved = flow_ties_solved(&ties, flow_tie_values(t, values), NULL);
    struct solve_cut cut = flow_table_cut_entries(t);
    cut.ties = &solved;
    const int tried = solve_local_factor(&t->matrix, &cut, values, local, on->factor);
    /* The object also has room for double entries (flow_table): zeros. */
    const size_t used = solve_local_doubles(t->n, t->matrix.row[t->n], local);
    const size_t shifted = flow_factor_shifted(t, local);
    memset(on->factor + used, 0, (shifted - used) * sizeof *on->factor);
    on->factor[shifted] = tried > 0;
    return 0;
}

int flow_pass_factor(struct flow_state *state, uint32_t first, uint32_t end)
{
    return flow_is_preconditioned(state->flow)
               ? flow_fork_range_as(state, &flow_kernel_factor, first, end, NULL, NULL)
               : DUITE_OK;
}

/* ---- A pass ---- */

/* A pass as its phases see it, of fields of the kernels below. */
struct pass {
    const duite_call *call;
    struct flow_table table; /* with the matrix of the step */
    const struct solve_scalars *scalars;
    const void *values; /* of the matrix */
    const phys_vec *b;
    struct solve_rows rows;
    phys_vec *z_ghosts, *p_ghosts;
    double *halo, *part;
    const duite_param *halos; /* of the neighbours */
    struct flow_preconditioner m;
    struct flow_ties ties;
    struct solve_ties joined;               /* that they make of the matrix */
    phys_vec *z_ties, *p_ties;              /* of their ghosts */
    const duite_param *tied_q, *tied_basis; /* of the blocks of these; tied_basis: if coarse */
};

/* Shows the neighbours s of the new q, and sums the preconditioner's dot. */
static void show_product(struct pass *pass, double dots[SOLVE_DOTS])
{
    const struct solve_rows *rows = &pass->rows;
    const struct flow_preconditioner *m = &pass->m;
    if (m->factor)
        dots[SOLVE_QQ] = solve_local_apply(&pass->table.matrix, m->flow->conditioner.local,
                                           m->factor, rows->q, rows->s);
    if (m->basis)
        flow_coarse_restrict(m, rows->q, pass->part + FLOW_PART_COARSE);
    flow_pack_halo(&pass->table, rows->s, pass->halo);
}

/* Without a preconditioner z is r and s is q. */
static struct solve_rows rows_of(phys_vec *dv, phys_vec *r, phys_vec *p, phys_vec *q, phys_vec *z,
                                 phys_vec *s)
{
    return (struct solve_rows){dv, r, p, q, z ? z : r, s ? s : q};
}

/* ---- The begin of a solve ---- */

/* Makes the vectors, and the halo that neighbours read. */
static void begin_solve(struct pass *pass, double *ghosts, size_t n_ghosts)
{
    const struct flow_table *t = &pass->table;
    const struct solve_rows *rows = &pass->rows;
    double dots[SOLVE_DOTS] = {0};
    solve_start(t->n, t->free, pass->b, rows->dv, rows->r, rows->p, rows->q);
    memset(ghosts, 0, n_ghosts * sizeof *ghosts);
    if (pass->m.factor) {
        memset(rows->z, 0, t->n * sizeof *rows->z);
        memset(pass->part, 0, flow_part_doubles(flow_of(pass->call)) * sizeof *pass->part);
    }
    show_product(pass, dots);
    if (pass->m.factor)
        memcpy(pass->part, dots, sizeof dots);
}

FLOW_KERNEL_IF(cg_start, part, FLOW_CG, struct flow_block_args,
               (R(table), R(f), W(dv), W(r), W(p), W(q), W(ghosts), W(halo_q), W_IF(part), W_IF(z),
                W_IF(s), IF_MADE(factor), IF_MADE(basis)),
               .side_effects = 0)
{
    struct pass pass = {.call = call,
                        .table = flow_table_in(call, on->table),
                        .b = on->f,
                        .rows = rows_of(on->dv, on->r, on->p, on->q, on->z, on->s),
                        .halo = on->halo_q,
                        .part = on->part,
                        .m = {.flow = flow_of(call),
                              .block = on->args->block,
                              .factor = on->factor,
                              .basis = on->basis}};
    pass.m.table = &pass.table;
    begin_solve(&pass, (double *)on->ghosts, duite_count(call, FLOW_INDEX_OF(cg_start, ghosts)));
    return 0;
}

struct guess_args {
    uint32_t block;
    double guess; /* times dv */
};

/* With a guess: the first pass multiplies by it, and a later one begins again. */
FLOW_KERNEL(cg_guess, FLOW_CG, struct guess_args,
            (R(table), R(f), R(a), RW(dv), W(r), W(p), W(q), W(halo_q)))
{
    struct flow_table table = flow_table_in(call, on->table), *t = &table;
    flow_matrix_in(call, t, on->a);
    solve_start_guess(t->n, t->free, t->matrix.filter, on->f, on->args->guess, on->dv, on->r, on->p,
                      on->q);
    flow_pack_halo(t, on->dv, on->halo_q);
    return 0;
}

/* ---- A pass, by its phases ---- */

/* The places of neighbour s's ghosts in the halo that this block reads. */
static const uint32_t *places_of(const struct pass *pass, uint32_t s)
{
    const struct flow *flow = flow_of(pass->call);
    const struct flow_table *t = &pass->table;
    return flow->at + (t->ghost - flow->tables.ghost) + t->ghost_start[s];
}

static const double *halo_of(const struct pass *pass, uint32_t s)
{
    return flow_numbers_of(pass->halos, s);
}

/* The first half of a pass for the ghosts: they change as the rows of their owners do. */
static void advance_ghosts(const struct pass *pass)
{
    const struct flow_table *t = &pass->table;
    const struct solve_scalars *now = pass->scalars;
    for (uint32_t s = 0; s < t->n_neighbours; s++) {
        const uint32_t from = t->ghost_start[s], n = t->ghost_start[s + 1] - from;
        phys_vec *z = pass->z_ghosts + from, *p = pass->p_ghosts + from;
        if (pass->m.motion)
            flow_coarse_advance_ghosts(&pass->m, s, now, halo_of(pass, s), places_of(pass, s), z,
                                       p);
        else
            solve_advance_ghosts(n, now->alpha, now->beta, halo_of(pass, s), places_of(pass, s), z,
                                 p);
    }
}

/* The first half of a pass for the ghosts of ties. */
static void advance_ties(const struct pass *pass)
{
    const struct flow_ties *ties = &pass->ties;
    const struct solve_scalars *now = pass->scalars;
    for (uint32_t k = 0; k < ties->n_others; k++) {
        const uint32_t from = ties->start[k], n = ties->start[k + 1] - from;
        const double *s = flow_numbers_of(pass->tied_q, k) + 3 * (size_t)ties->place[k];
        phys_vec *z = pass->z_ties + from, *p = pass->p_ties + from;
        if (pass->m.motion)
            flow_coarse_advance_ties(&pass->m, ties, k, now, s,
                                     flow_rows_of(pass->tied_basis, k) + ties->place[k], z, p);
        else
            solve_advance_ghosts(n, now->alpha, now->beta, s, ties->at, z, p);
    }
}

/* The entries into other blocks, with the ties. */
static struct solve_cut cut_of(const struct pass *pass)
{
    struct solve_cut cut = flow_table_cut_entries(&pass->table);
    if (pass->ties.n) {
        cut.n_halo = pass->ties.n_halo;
        cut.halo = pass->ties.halo;
        cut.ties = &pass->joined;
    }
    return cut;
}

/* Adds the norms that some stops need to the dots of a pass. */
static void add_norms(const struct pass *pass, double dots[SOLVE_DOTS])
{
    const struct flow_table *t = &pass->table;
    if (!model_stops_by_norms(flow_of(pass->call)->model))
        return;
    const struct solve_norms norms =
        solve_norms(t->n, t->matrix.diagonal, pass->rows.dv, pass->rows.r);
    dots[SOLVE_SIZE] = norms.size;
    dots[SOLVE_BOUND] = norms.bound;
}

/* SOLVE_ON: ends an iteration and begins the next one. */
static void pass_iterate(struct pass *pass, double dots[SOLVE_DOTS])
{
    const struct flow_table *t = &pass->table;
    const struct solve_cut cut = cut_of(pass);
    if (pass->m.motion)
        flow_coarse_prolong(&pass->m, pass->rows.s);
    advance_ghosts(pass);
    advance_ties(pass);
    solve_pass(&t->matrix, &cut, pass->values, pass->p_ghosts, pass->scalars->alpha,
               pass->scalars->beta, &pass->rows, dots);
    show_product(pass, dots);
    add_norms(pass, dots);
}

/* SOLVE_LAST, and the first half of SOLVE_AGAIN. Returns r.r. */
static double finish_solve(const struct pass *pass)
{
    const struct solve_rows *rows = &pass->rows;
    return solve_finish(pass->table.n, pass->scalars->alpha, rows->q, rows->p, rows->dv, rows->r);
}

/* SOLVE_OPEN and SOLVE_CHECK: the product with the guess, or with dv, which neighbours were shown
 * in place of s. */
static void pass_multiply(struct pass *pass, double dots[SOLVE_DOTS])
{
    const struct flow_table *t = &pass->table;
    const struct flow_ties *ties = &pass->ties;
    const struct solve_cut cut = cut_of(pass);
    phys_vec *shown = pass->p_ghosts;
    for (uint32_t s = 0; s < t->n_neighbours; s++)
        solve_unpack(t->ghost_start[s + 1] - t->ghost_start[s], halo_of(pass, s),
                     places_of(pass, s), shown + t->ghost_start[s]);
    for (uint32_t k = 0; k < ties->n_others; k++)
        solve_unpack(ties->start[k + 1] - ties->start[k],
                     flow_numbers_of(pass->tied_q, k) + 3 * (size_t)ties->place[k], ties->at,
                     pass->p_ties + ties->start[k]);
    if (pass->scalars->phase == SOLVE_OPEN)
        solve_open(&t->matrix, &cut, pass->values, shown, &pass->rows, dots);
    else
        solve_residual(&t->matrix, &cut, pass->values, pass->b, shown, &pass->rows, dots);
}

/* SOLVE_AGAIN: all vectors are as before the first pass, with the true residual for the right side.
 */
static void begin_again(struct pass *pass, double dots[SOLVE_DOTS])
{
    const struct solve_rows *rows = &pass->rows;
    finish_solve(pass);
    solve_again(pass->table.n, rows->r, rows->p, rows->q);
    const size_t ghosts = (size_t)pass->table.n_ghosts + pass->ties.room.rows;
    memset(pass->z_ghosts, 0, 2 * ghosts * sizeof *pass->z_ghosts);
    if (pass->m.factor)
        memset(rows->z, 0, pass->table.n * sizeof *rows->z);
    show_product(pass, dots);
}

static void run_phase(struct pass *pass)
{
    const double phase = pass->scalars->phase;
    double dots[SOLVE_DOTS] = {0};
    if (phase == SOLVE_ON)
        pass_iterate(pass, dots);
    else if (phase == SOLVE_LAST)
        dots[SOLVE_RR] = finish_solve(pass);
    else if (phase == SOLVE_SHOW)
        flow_pack_halo(&pass->table, pass->rows.dv, pass->halo);
    else if (phase == SOLVE_CHECK || phase == SOLVE_OPEN)
        pass_multiply(pass, dots);
    else if (phase == SOLVE_AGAIN)
        begin_again(pass, dots);
    memcpy(pass->part, dots, flow_dots(flow_of(pass->call)) * sizeof *dots);
}

/* ---- Its kernel ---- */

FLOW_KERNEL_IF(cg_pass, part, FLOW_CG, struct flow_block_args,
               (R(table), R(scalars), R(a), R(f), RW(dv), RW(r), RW(p), RW(q), RW(ghosts),
                RW(halo_q_next), RW_IF(part), RW_IF(z), RW_IF(s), SUM_ELSE(sums),
                NEIGHBOURS(halo_q), IF_MADE(factor), IF_MADE(basis), IF_MADE(basis_ghosts),
                IF_MADE(motion), IF_MADE(lift), IF_MADE(tie_table), TIED(tie_q), TIED(tie_basis),
                REST_R(group_motion)),
               .side_effects = 0);

/* The preconditioner as the pass sees it. */
static struct flow_preconditioner conditioning(const duite_call *call,
                                               const struct cg_pass_fields *on,
                                               const struct flow_table *table)
{
    return (struct flow_preconditioner){.flow = flow_of(call),
                                        .table = table,
                                        .block = on->args->block,
                                        .factor = on->factor,
                                        .basis = on->basis,
                                        .basis_ghosts = on->basis_ghosts,
                                        .motion = on->motion,
                                        .lift = on->lift,
                                        .seen = on->group_motion,
                                        .n_seen = on->n_group_motion};
}

static int cg_pass_body(const duite_call *call, const struct cg_pass_fields *on)
{
    struct pass pass;
    pass.call = call;
    pass.table = *flow_shape_of(call);
    flow_table_open(&pass.table, on->table);
    pass.ties = flow_ties_open(on->tie_table);
    pass.scalars = on->scalars;
    pass.values = flow_matrix_in(call, &pass.table, on->a);
    pass.b = on->f;
    pass.rows = rows_of(on->dv, on->r, on->p, on->q, on->z, on->s);
    pass.z_ghosts = on->ghosts;
    pass.p_ghosts = on->ghosts + pass.table.n_ghosts;
    pass.halo = on->halo_q_next;
    pass.part = on->part ? on->part : on->sums;
    pass.halos = on->halo_q;
    pass.m = conditioning(call, on, &pass.table);
    pass.tied_q = on->tied_tie_q;
    pass.tied_basis = on->tied_tie_basis;
    pass.z_ties = pass.p_ghosts + pass.table.n_ghosts;
    pass.p_ties = pass.z_ties + pass.ties.room.rows;
    pass.joined =
        flow_ties_solved(&pass.ties, flow_tie_values(&pass.table, pass.values), pass.p_ties);
    run_phase(&pass);
    return 0;
}

/* ---- Forks ---- */

int flow_pass_start(struct flow_state *state, uint32_t first, uint32_t end, double guess)
{
    struct guess_args args = {.guess = guess};
    flow_fork_range_as(state, guess != 0 ? &flow_kernel_cg_guess : &flow_kernel_cg_start, first,
                       end, &args, NULL);
    for (uint32_t b = first; b < end; b++) {
        flow_ties_pack_start(state, b, guess != 0);
        flow_halo_pack(state, b, 0);
    }
    return state->code;
}

/* Reads the neighbours' halos or packed ones (halo.c). Motions of groups, if any, come last. */
static int fork_block(struct flow_state *state, const struct flow_block_args *args)
{
    const struct flow_table *t = state->flow->tables.block + args->block;
    const duite_kernel *task = flow_task_of(state, &flow_kernel_cg_pass);
    size_t n = flow_kernel_objects(state, &flow_kernel_cg_pass, args->block, NULL), halos = 0;
    const duite_object *read =
        state->packed.read[state->pass] + (t->neighbour - state->flow->tables.neighbour);
    while (task->access[halos] != DUITE_NONE)
        halos++;
    memcpy(state->refs + halos, read, t->n_neighbours * sizeof *read);
    n = flow_levels_seen(state, args->block, n);
    return flow_fork_listed(state, &flow_kernel_cg_pass, args, n);
}

/* Passes go to and fro over the blocks: the last blocks of one, still in caches, come first in the
 * next. */
int flow_pass_fork(struct flow_state *state)
{
    const uint32_t n = state->flow->tables.n_blocks;
    struct flow_block_args args;
    for (uint32_t i = 0; i < n; i++) {
        args.block = state->pass ? n - 1 - i : i;
        fork_block(state, &args);
        flow_halo_pack(state, args.block, 1 - (int)state->pass);
        flow_ties_pack(state, args.block);
    }
    return state->code;
}
