/* A pass of conjugate gradients over a block (cloth/solve/cg.h): one body, with a preconditioner or
 * without, where z is r and s is q. A block keeps copies of z and p of the rows that its cut
 * entries end at, and changes them as their owner does: of a neighbour it reads rows of s only.
 * What a pass sums is its part: without a preconditioner a contribution to the sums of all blocks;
 * with one the block's own, with the coarse right side P' q behind the dots.
 *
 * In reading order: what a solve begins with, a pass by its phases, the forks of both. */
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/solver/solver.h"

#include <string.h>

/* Parameters of a pass. A preconditioner has three more; then come the neighbours' rims of s, and
 * behind them, with a coarse part, its basis, that of the copies, and motion. */
enum { SCALARS = 1, A, B, DV, R, P, Q, COPIES, RIM, PART, PLAIN, Z = PLAIN, S, FACTOR, ALL };
enum { BASIS, BASIS_COPIES, MOTION };

struct pass {
    const duite_call *call;
    struct flow_table table; /* with the matrix of the step */
    const struct solve_scalars *scalars;
    const void *values; /* of the matrix */
    const phys_vec *b;
    struct solve_rows rows;
    phys_vec *z_copies, *p_copies;
    double *rim, *part;
    size_t neighbours; /* parameters from here on */
    struct flow_preconditioner m;
};

/* The block of a pass, with no preconditioner so far. */
static void open_block(const duite_call *call, struct pass *pass)
{
    pass->call = call;
    pass->table = *flow_shape_of(call);
    flow_table_open(&pass->table, call->param[0].data);
    pass->m = (struct flow_preconditioner){
        .flow = flow_of(call), .table = &pass->table, .block = flow_args_of(call)->block};
}

/* Shows the neighbours s of the new q, and sums what a preconditioner leaves of that. */
static void show_product(struct pass *pass, double dots[SOLVE_DOTS])
{
    const struct solve_rows *rows = &pass->rows;
    if (pass->m.factor)
        dots[SOLVE_QQ] =
            flow_precondition(&pass->m, rows->q, rows->s, pass->part + FLOW_PART_COARSE);
    flow_pack_rim(&pass->table, rows->s, pass->rim);
}

/* ---- What a solve begins with ---- */

/* Parameters; a preconditioner has four more, a coarse part its basis. */
enum { START_B = 1, START_DV, START_COPIES = START_DV + 4, START_RIM, START_PART };
enum { START_Z = START_PART + 1, START_S, START_FACTOR, START_BASIS };

static void open_start(const duite_call *call, struct pass *pass)
{
    phys_vec *vector[4];
    for (size_t i = 0; i < 4; i++)
        vector[i] = duite_out(call, START_DV + i, phys_vec);
    open_block(call, pass);
    pass->rows = solve_rows_plain(vector[0], vector[1], vector[2], vector[3]);
    pass->b = duite_in(call, START_B, phys_vec);
    pass->z_copies = duite_out(call, START_COPIES, phys_vec);
    pass->rim = duite_out(call, START_RIM, double);
    if (!flow_is_preconditioned(flow_of(call)))
        return;
    pass->part = duite_out(call, START_PART, double);
    pass->rows.z = duite_out(call, START_Z, phys_vec);
    pass->rows.s = duite_out(call, START_S, phys_vec);
    pass->m.factor = duite_in(call, START_FACTOR, double);
    if (flow_is_coarse(flow_of(call)))
        pass->m.basis = duite_in(call, START_BASIS, phys_vec);
}

static int start(const duite_call *call)
{
    struct pass pass;
    open_start(call, &pass);
    const struct flow_table *t = &pass.table;
    const struct solve_rows *rows = &pass.rows;
    double dots[SOLVE_DOTS] = {0};
    solve_start(t->n, t->free, pass.b, rows->dv, rows->r, rows->p, rows->q);
    memset(pass.z_copies, 0, duite_count(call, START_COPIES) * sizeof(double));
    if (pass.m.factor) {
        memset(rows->z, 0, t->n * sizeof *rows->z);
        memset(pass.part, 0, flow_part_doubles(flow_of(call)) * sizeof *pass.part);
    }
    show_product(&pass, dots);
    if (pass.m.factor)
        memcpy(pass.part, dots, sizeof dots);
    return 0;
}
FLOW_TIMED(start, FLOW_CG)
const duite_kernel flow_start = {
    .name = "cg_start",
    .body = start_timed,
    .access = {DUITE_R, DUITE_R, DUITE_W, DUITE_W, DUITE_W, DUITE_W, DUITE_W, DUITE_W},
    .args_size = sizeof(struct flow_args)};
const duite_kernel flow_start_preconditioned = {.name = "cg_start_preconditioned",
                                                .body = start_timed,
                                                .access = {DUITE_R, DUITE_R, DUITE_W, DUITE_W,
                                                           DUITE_W, DUITE_W, DUITE_W, DUITE_W,
                                                           DUITE_W, DUITE_W, DUITE_W, DUITE_R},
                                                .variadic = DUITE_R,
                                                .args_size = sizeof(struct flow_args)};

/* With a guess: the first pass multiplies by it, and a later one begins again. */
static int guess(const duite_call *call)
{
    struct flow_table table = flow_table_of(call), *t = &table;
    phys_vec *dv = duite_out(call, 3, phys_vec);
    flow_open_matrix(call, t, 2);
    solve_start_guess(t->n, t->free, t->matrix.filter, duite_in(call, 1, phys_vec),
                      flow_args_of(call)->guess, dv, duite_out(call, 4, phys_vec),
                      duite_out(call, 5, phys_vec), duite_out(call, 6, phys_vec));
    flow_pack_rim(t, dv, duite_out(call, 7, double));
    return 0;
}
FLOW_TIMED(guess, FLOW_CG)
const duite_kernel flow_guess = {
    .name = "cg_guess",
    .body = guess_timed,
    .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_RW, DUITE_W, DUITE_W, DUITE_W, DUITE_W},
    .args_size = sizeof(struct flow_args)};

/* ---- A pass, by its phases ---- */

static void open_preconditioner(const duite_call *call, struct pass *pass)
{
    pass->neighbours = ALL;
    pass->rows.z = duite_out(call, Z, phys_vec);
    pass->rows.s = duite_out(call, S, phys_vec);
    pass->m.factor = duite_in(call, FACTOR, double);
    if (!flow_is_coarse(flow_of(call)))
        return;
    const size_t coarse = ALL + pass->table.n_slots;
    pass->m.basis = duite_in(call, coarse + BASIS, phys_vec);
    pass->m.basis_copies = duite_in(call, coarse + BASIS_COPIES, phys_vec);
    pass->m.motion = duite_in(call, coarse + MOTION, double);
}

static void open_pass(const duite_call *call, struct pass *pass)
{
    open_block(call, pass);
    pass->scalars = duite_in(call, SCALARS, struct solve_scalars);
    pass->values = flow_open_matrix(call, &pass->table, A);
    pass->b = duite_in(call, B, phys_vec);
    pass->rows = solve_rows_plain(duite_out(call, DV, phys_vec), duite_out(call, R, phys_vec),
                                  duite_out(call, P, phys_vec), duite_out(call, Q, phys_vec));
    pass->z_copies = duite_out(call, COPIES, phys_vec);
    pass->p_copies = pass->z_copies + pass->table.n_copies;
    pass->rim = duite_out(call, RIM, double);
    pass->part = duite_out(call, PART, double);
    pass->neighbours = PLAIN;
    if (flow_is_preconditioned(flow_of(call)))
        open_preconditioner(call, pass);
}

/* Where copies of slot s are in what this block reads of the neighbour. */
static const uint32_t *places_of(const struct pass *pass, uint32_t s)
{
    const struct flow *flow = flow_of(pass->call);
    const struct flow_table *t = &pass->table;
    return flow->at + (t->copy - flow->tables.copy) + t->copies[s];
}

static const double *rim_of(const struct pass *pass, uint32_t s)
{
    return duite_in(pass->call, pass->neighbours + s, double);
}

/* The first half of a pass for the copies: they change as the rows of their owners do. */
static void advance_copies(const struct pass *pass)
{
    const struct flow_table *t = &pass->table;
    const struct solve_scalars *now = pass->scalars;
    for (uint32_t s = 0; s < t->n_slots; s++) {
        const uint32_t from = t->copies[s], n = t->copies[s + 1] - from;
        phys_vec *z = pass->z_copies + from, *p = pass->p_copies + from;
        if (pass->m.motion)
            flow_coarse_advance_copies(&pass->m, s, now, rim_of(pass, s), places_of(pass, s), z, p);
        else
            solve_advance_copies(n, now->alpha, now->beta, rim_of(pass, s), places_of(pass, s), z,
                                 p);
    }
}

/* Adds what stops by norms ask for to the dots of a pass. */
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
static void iterate(struct pass *pass, double dots[SOLVE_DOTS])
{
    const struct flow_table *t = &pass->table;
    const struct solve_cut cut = flow_table_cut_entries(t);
    if (pass->m.motion)
        flow_coarse_prolong(&pass->m, pass->rows.s);
    advance_copies(pass);
    solve_pass(&t->matrix, &cut, pass->values, pass->p_copies, pass->scalars->alpha,
               pass->scalars->beta, &pass->rows, dots);
    show_product(pass, dots);
    add_norms(pass, dots);
}

/* SOLVE_LAST, and the first half of SOLVE_AGAIN. Returns r.r. */
static double finish(const struct pass *pass)
{
    const struct solve_rows *rows = &pass->rows;
    return solve_finish(pass->table.n, pass->scalars->alpha, rows->q, rows->p, rows->dv, rows->r);
}

/* SOLVE_OPEN and SOLVE_CHECK: the product with the guess, or with dv, which neighbours were shown
 * in place of s. */
static void multiply(struct pass *pass, double dots[SOLVE_DOTS])
{
    const struct flow_table *t = &pass->table;
    const struct solve_cut cut = flow_table_cut_entries(t);
    phys_vec *shown = pass->p_copies;
    for (uint32_t s = 0; s < t->n_slots; s++)
        solve_unpack(t->copies[s + 1] - t->copies[s], rim_of(pass, s), places_of(pass, s),
                     shown + t->copies[s]);
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
    finish(pass);
    solve_again(pass->table.n, rows->r, rows->p, rows->q);
    memset(pass->z_copies, 0, 2 * (size_t)pass->table.n_copies * sizeof *pass->z_copies);
    if (pass->m.factor)
        memset(rows->z, 0, pass->table.n * sizeof *rows->z);
    show_product(pass, dots);
}

static int pass(const duite_call *call)
{
    struct pass pass;
    open_pass(call, &pass);
    const double phase = pass.scalars->phase;
    double dots[SOLVE_DOTS] = {0};
    if (phase == SOLVE_ON)
        iterate(&pass, dots);
    else if (phase == SOLVE_LAST)
        dots[SOLVE_RR] = finish(&pass);
    else if (phase == SOLVE_SHOW)
        flow_pack_rim(&pass.table, pass.rows.dv, pass.rim);
    else if (phase == SOLVE_CHECK || phase == SOLVE_OPEN)
        multiply(&pass, dots);
    else if (phase == SOLVE_AGAIN)
        begin_again(&pass, dots);
    memcpy(pass.part, dots, flow_dots(flow_of(call)) * sizeof *dots);
    return 0;
}
FLOW_TIMED(pass, FLOW_CG)
const duite_kernel flow_pass = {.name = "cg_pass",
                                .body = pass_timed,
                                .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_R, DUITE_RW, DUITE_RW,
                                           DUITE_RW, DUITE_RW, DUITE_RW, DUITE_RW, DUITE_CW},
                                .variadic = DUITE_R,
                                .args_size = sizeof(struct flow_args)};
const duite_kernel flow_pass_preconditioned = {
    .name = "cg_pass_preconditioned",
    .body = pass_timed,
    .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_R, DUITE_RW, DUITE_RW, DUITE_RW, DUITE_RW, DUITE_RW,
               DUITE_RW, DUITE_RW, DUITE_RW, DUITE_RW, DUITE_R},
    .variadic = DUITE_R,
    .args_size = sizeof(struct flow_args)};

/* ---- Forks ---- */

static int fork_guess(struct flow_state *state, const struct flow_args *args)
{
    const struct flow_objects *o = state->block + args->block;
    return DUITE_FORK(state->rt, &flow_guess, args, o->table, o->f, o->a, o->dv, o->r, o->p, o->q,
                      o->rim_q[0]);
}

static int fork_start(struct flow_state *state, const struct flow_args *args)
{
    const struct flow_objects *o = state->block + args->block;
    const duite_object all[] = {o->f,        o->dv,   o->r, o->p, o->q,      o->copies,
                                o->rim_q[0], o->part, o->z, o->s, o->factor, o->basis};
    enum { WITH_BASIS = sizeof all / sizeof *all, WITHOUT = WITH_BASIS - 1, NONE = WITHOUT - 4 };
    if (!flow_is_preconditioned(state->flow))
        return flow_fork(state, &flow_start, args, NONE, all, FLOW_NO_RIM, FLOW_NO_RIM);
    return flow_fork(state, &flow_start_preconditioned, args,
                     flow_is_coarse(state->flow) ? WITH_BASIS : WITHOUT, all, FLOW_NO_RIM,
                     FLOW_NO_RIM);
}

int flow_pass_start(struct flow_state *state, const struct flow_args *args)
{
    const int code = args->guess != 0 ? fork_guess(state, args) : fork_start(state, args);
    return code ? code : flow_halo_pack(state, args->block, 0);
}

static int fork_block(struct flow_state *state, const struct flow_args *args, int from)
{
    const struct flow_table *t = state->flow->tables.block + args->block;
    const struct flow_objects *o = state->block + args->block;
    const duite_object *s = state->far.read[from] + (t->slot - state->flow->tables.slot);
    const bool preconditioned = flow_is_preconditioned(state->flow);
    const duite_object own[ALL] = {o->table,
                                   state->run.scalars[from],
                                   o->a,
                                   o->f,
                                   o->dv,
                                   o->r,
                                   o->p,
                                   o->q,
                                   o->copies,
                                   o->rim_q[1 - from],
                                   preconditioned ? o->part : state->run.sums[from],
                                   o->z,
                                   o->s,
                                   o->factor};
    const duite_object coarse[] = {o->basis, o->basis_copies, state->run.motion[from]};
    size_t n = 0;
    for (; n < (preconditioned ? ALL : PLAIN); n++)
        state->refs[n] = own[n];
    for (uint32_t i = 0; i < t->n_slots; i++)
        state->refs[n++] = s[i];
    for (size_t i = 0; i < 3 && flow_is_coarse(state->flow); i++)
        state->refs[n++] = coarse[i];
    return duite_fork(state->rt, preconditioned ? &flow_pass_preconditioned : &flow_pass, args, n,
                      state->refs);
}

/* Passes go to and fro over the blocks: those that come last in one, whose rows the caches still
 * have, come first in the next. */
int flow_pass_fork(struct flow_state *state, int from)
{
    const uint32_t n = state->flow->tables.n_blocks;
    struct flow_args args = {0};
    int code = DUITE_OK;
    for (uint32_t i = 0; i < n && !code; i++) {
        args.block = from ? n - 1 - i : i;
        code = fork_block(state, &args, from);
        if (!code)
            code = flow_halo_pack(state, args.block, 1 - from);
    }
    return code;
}
