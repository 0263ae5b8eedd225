/* Conjugate gradients with a preconditioner (cloth/solve/cg.h, local.h, coarse.h), a body a block
 * and pass. It is like the plain one with z in place of r and s in place of q: neighbours read the
 * rim of s. What a pass sums it leaves in its block's part, with the coarse right side P' q behind
 * it; the task of the scalars adds up parts in the order of blocks and solves the coarse system, so
 * that a pass finds P's part of s in `motion` and adds it to its own rows and to its copies alike.
 */
#include "cloth/flow/bodies.h"
#include "cloth/flow/solver/patches.h"

#include "cloth/solve/local.h"

#include <string.h>

#define ARGS sizeof(struct flow_args)

static bool is_coarse(const duite_call *call)
{
    return flow_is_coarse(flow_of(call));
}

static enum solve_local local_of(const duite_call *call)
{
    return flow_local(flow_of(call));
}

/* ---- Of each step's matrix ---- */

static int factor(const duite_call *call)
{
    struct flow_table table = flow_table_of(call), *t = &table;
    const phys_vec *values = flow_open_matrix(call, t, 1);
    const struct solve_cut cut = flow_table_cut_entries(t);
    double *factor = duite_out(call, 2, double);
    const int tried = solve_local_factor(&t->matrix, &cut, values, local_of(call), factor);
    /* The object has room for entries that are there twice, too (flow_table): zeros. */
    const size_t used = solve_local_doubles(t->n, t->matrix.row[t->n], local_of(call));
    memset(factor + used, 0,
           (solve_local_doubles(t->n, t->n_entries, local_of(call)) - used) * sizeof *factor);
    duite_out(call, 3, double)[FLOW_SHIFTED] = tried > 0;
    return 0;
}
FLOW_TIMED(factor, FLOW_CG)
const duite_kernel flow_factor = {.name = "factor",
                                  .body = factor_timed,
                                  .access = {DUITE_R, DUITE_R, DUITE_W, DUITE_CW},
                                  .args_size = ARGS};

/* ---- The solve ---- */

/* P' q of each patch. */
static void restrict_all(const duite_call *call, const struct flow_table *t, const phys_vec *rows,
                         const phys_vec *q, double *right)
{
    const struct solve_patches patches = solve_patches_of(t->n, flow_of(call)->patches);
    for (uint32_t k = 0; k < patches.n; k++) {
        const uint32_t from = patches.start[k], n = patches.start[k + 1] - from;
        solve_restrict(n, rows + from, q + from, right + SOLVE_COARSE * k);
    }
}

/* s = M^-1 q but for the coarse part, of which the part has the right side. */
static void turn(const duite_call *call, const struct flow_table *t, const double *factor,
                 const phys_vec *rows, const phys_vec *q, phys_vec *s, double *part)
{
    part[SOLVE_QQ] = solve_local_apply(&t->matrix, local_of(call), factor, q, s);
    if (rows)
        restrict_all(call, t, rows, q, part + FLOW_PART_COARSE);
}

static int start(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    phys_vec *q = duite_out(call, 6, phys_vec), *z = duite_out(call, 7, phys_vec);
    phys_vec *s = duite_out(call, 8, phys_vec);
    double *part = duite_out(call, 11, double);
    solve_start(t->n, t->free, duite_in(call, 1, phys_vec), duite_out(call, 3, phys_vec),
                duite_out(call, 4, phys_vec), duite_out(call, 5, phys_vec), q);
    memset(z, 0, t->n * sizeof *z);
    memset(duite_out(call, 9, phys_vec), 0, duite_count(call, 9) * sizeof(double));
    memset(part, 0, flow_part_doubles(flow_of(call)) * sizeof *part);
    turn(call, t, duite_in(call, 2, double), is_coarse(call) ? duite_in(call, 12, phys_vec) : NULL,
         q, s, part);
    flow_pack_rim(t, s, duite_out(call, 10, double));
    return 0;
}
FLOW_TIMED(start, FLOW_CG)
const duite_kernel flow_start_turned = {.name = "cg_start_turned",
                                        .body = start_timed,
                                        .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_W, DUITE_W,
                                                   DUITE_W, DUITE_W, DUITE_W, DUITE_W, DUITE_W,
                                                   DUITE_W, DUITE_W},
                                        .variadic = DUITE_R,
                                        .args_size = ARGS};

/* Parameters of a pass; behind the neighbours, with a coarse part, basis, that of the copies, and
 * motion. */
enum { SCALARS = 1, A, B, DV, R, P, Q, Z, S, COPIES, RIM, PART, FACTOR, NEIGHBOURS };
enum { BASIS, BASIS_COPIES, MOTION };

static const void *coarse_in(const duite_call *call, const struct flow_table *t, uint32_t which)
{
    return duite_in(call, NEIGHBOURS + t->n_slots + which, double);
}

/* P's part of s, of patch k of a block. */
static const double *motion_of(const duite_call *call, const struct flow_table *t, uint32_t block,
                               uint32_t k)
{
    const struct flow *flow = flow_of(call);
    const double *motion = coarse_in(call, t, MOTION);
    return motion + solve_coarse_at(&flow->pattern, flow->patches * block + k);
}

static void prolong_all(const duite_call *call, const struct flow_table *t, phys_vec *s)
{
    const struct solve_patches patches = solve_patches_of(t->n, flow_of(call)->patches);
    const phys_vec *rows = coarse_in(call, t, BASIS);
    for (uint32_t k = 0; k < patches.n; k++) {
        const uint32_t from = patches.start[k], n = patches.start[k + 1] - from;
        solve_prolong(n, rows + from, motion_of(call, t, flow_args_of(call)->block, k), s + from);
    }
}

/* Copies of one neighbour, whose patches they are of one after the other. rim: of its s. */
static void advance_patches(const duite_call *call, const struct flow_table *t, uint32_t slot,
                            const struct solve_scalars *scalars, const double *rim)
{
    const struct flow *flow = flow_of(call);
    const struct flow_table *other = flow->tables.block + t->slot[slot];
    const uint32_t *at = flow->at + (t->copy - flow->tables.copy);
    const phys_vec *rows = coarse_in(call, t, BASIS_COPIES);
    phys_vec *z = duite_out(call, COPIES, phys_vec), *p = z + t->n_copies;
    uint32_t i = t->copies[slot];
    for (uint32_t k = 0; k < flow->patches; k++) {
        const uint32_t from = i;
        while (i < t->copies[slot + 1] && t->copy[i] < other->rim_start[k + 1])
            i++;
        solve_advance_copies_coarse(i - from, scalars->alpha, scalars->beta, rim, at + from,
                                    rows + from, motion_of(call, t, t->slot[slot], k), z + from,
                                    p + from);
    }
}

static void advance_copies(const duite_call *call, const struct flow_table *t,
                           const struct solve_scalars *scalars)
{
    const struct flow *flow = flow_of(call);
    const double alpha = scalars->alpha, beta = scalars->beta;
    phys_vec *z = duite_out(call, COPIES, phys_vec), *p = z + t->n_copies;
    const uint32_t *at = flow->at + (t->copy - flow->tables.copy);
    for (uint32_t s = 0; s < t->n_slots; s++) {
        const uint32_t from = t->copies[s], n = t->copies[s + 1] - from;
        const double *rim = duite_in(call, NEIGHBOURS + s, double);
        if (is_coarse(call))
            advance_patches(call, t, s, scalars, rim);
        else
            solve_advance_copies(n, alpha, beta, rim, at + from, z + from, p + from);
    }
}

/* s of the new q, as neighbours see it. */
static void turn_and_show(const duite_call *call, const struct flow_pass *pass)
{
    const struct flow_table *t = pass->table;
    phys_vec *s = duite_out(call, S, phys_vec);
    turn(call, t, duite_in(call, FACTOR, double),
         is_coarse(call) ? coarse_in(call, t, BASIS) : NULL, pass->rows.q, s,
         duite_out(call, PART, double));
    flow_pack_rim(t, s, pass->rim);
}

static void advance(const duite_call *call, const struct solve_scalars *scalars,
                    const struct flow_pass *pass)
{
    const struct flow_table *t = pass->table;
    const struct solve_cut cut = flow_table_cut_entries(t);
    phys_vec *s = duite_out(call, S, phys_vec);
    double *part = duite_out(call, PART, double);
    const struct solve_turned turned = {duite_out(call, Z, phys_vec), s};
    if (is_coarse(call))
        prolong_all(call, t, s);
    advance_copies(call, t, scalars);
    solve_pass_turned(&t->matrix, &cut, pass->value, pass->copies + t->n_copies, scalars->alpha,
                      scalars->beta, &pass->rows, &turned, part);
    turn_and_show(call, pass);
    flow_add_norms(call, &t->matrix, &pass->rows, part);
}

/* r is the right side of a solve that begins. */
static void again(const duite_call *call, const struct flow_pass *pass)
{
    memset(duite_out(call, Z, phys_vec), 0, pass->table->n * sizeof(phys_vec));
    turn_and_show(call, pass);
}

static int pass(const duite_call *call)
{
    struct flow_table table = flow_table_of(call), *t = &table;
    const struct solve_scalars *scalars = duite_in(call, SCALARS, struct solve_scalars);
    struct flow_pass pass;
    flow_pass_open(call, t, COPIES, NEIGHBOURS, &pass);
    double *part = duite_out(call, PART, double);
    if (scalars->phase == SOLVE_LAST)
        part[SOLVE_RR] =
            solve_finish(t->n, scalars->alpha, pass.rows.q, pass.rows.p, pass.rows.dv, pass.rows.r);
    else if (scalars->phase == SOLVE_ON)
        advance(call, scalars, &pass);
    else
        flow_pass_beside(call, scalars, &pass, part);
    if (scalars->phase == SOLVE_AGAIN)
        again(call, &pass);
    return 0;
}
FLOW_TIMED(pass, FLOW_CG)
const duite_kernel flow_pass_turned = {.name = "cg_pass_turned",
                                       .body = pass_timed,
                                       .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_R, DUITE_RW,
                                                  DUITE_RW, DUITE_RW, DUITE_RW, DUITE_RW, DUITE_RW,
                                                  DUITE_RW, DUITE_RW, DUITE_RW, DUITE_R},
                                       .variadic = DUITE_R,
                                       .args_size = ARGS};

/* ---- Scalars, on every rank ---- */

/* The right side of a patch, of the parts that begin at parameter `from`. */
static const double *right_of(const duite_call *call, size_t from, uint32_t patch)
{
    const uint32_t patches = flow_of(call)->patches;
    const double *part = duite_in(call, from + patch / patches, double);
    return part + FLOW_PART_COARSE + SOLVE_COARSE * (patch % patches);
}

/* Solves for the coarse part of s, of the parts that begin at parameter `from`. Returns its share
 * in q.s, of a q that these right sides are of. */
static double solve_motion(const duite_call *call, const double *factor, size_t from,
                           double *motion)
{
    const struct flow *flow = flow_of(call);
    double sum = 0;
    memset(motion, 0, flow_motion_doubles(flow) * sizeof *motion);
    for (uint32_t p = 0; p < flow->pattern.n; p++)
        memcpy(motion + solve_coarse_at(&flow->pattern, p), right_of(call, from, p),
               SOLVE_COARSE * sizeof *motion);
    solve_coarse_solve(&flow->pattern, factor, motion);
    for (uint32_t p = 0; p < flow->pattern.n; p++) {
        const double *right = right_of(call, from, p);
        const double *x = motion + solve_coarse_at(&flow->pattern, p);
        for (int i = 0; i < SOLVE_COARSE; i++)
            sum += right[i] * x[i];
    }
    return sum;
}

static void sum_parts(const duite_call *call, size_t from, double dots[SOLVE_DOTS])
{
    for (uint32_t b = 0; b < flow_of(call)->tables.n_blocks; b++) {
        const double *part = duite_in(call, from + b, double);
        for (int i = 0; i < SOLVE_DOTS; i++)
            dots[i] += part[i];
    }
}

static int scalars_turned(const duite_call *call)
{
    double dots[SOLVE_DOTS] = {0};
    sum_parts(call, 2, dots);
    return flow_next_scalars(call, dots, duite_in(call, 1, struct solve_scalars),
                             duite_out(call, 0, struct solve_scalars));
}
const duite_kernel flow_scalars_turned = {.name = "cg_scalars_turned",
                                          .body = scalars_turned,
                                          .access = {DUITE_W, DUITE_R},
                                          .variadic = DUITE_R,
                                          .args_size = ARGS,
                                          .replicated = 1};

/* Whether the pass made a right side for the coarse part. */
static bool turns(double phase)
{
    return phase == SOLVE_ON || phase == SOLVE_AGAIN;
}

static int scalars_coarse(const duite_call *call)
{
    const struct solve_scalars *before = duite_in(call, 2, struct solve_scalars);
    double dots[SOLVE_DOTS] = {0}, *motion = duite_out(call, 1, double);
    sum_parts(call, 4, dots);
    if (turns(before->phase))
        dots[SOLVE_QQ] += solve_motion(call, duite_in(call, 3, double), 4, motion);
    else
        memset(motion, 0, flow_motion_doubles(flow_of(call)) * sizeof *motion);
    return flow_next_scalars(call, dots, before, duite_out(call, 0, struct solve_scalars));
}
FLOW_TIMED(scalars_coarse, FLOW_CG)
const duite_kernel flow_scalars_coarse = {.name = "cg_scalars_coarse",
                                          .body = scalars_coarse_timed,
                                          .access = {DUITE_W, DUITE_W, DUITE_R, DUITE_R},
                                          .variadic = DUITE_R,
                                          .args_size = ARGS,
                                          .replicated = 1};

static int begin_coarse(const duite_call *call)
{
    *duite_out(call, 0, struct solve_scalars) = flow_begin_scalars(call);
    solve_motion(call, duite_in(call, 2, double), 3, duite_out(call, 1, double));
    return 0;
}
FLOW_TIMED(begin_coarse, FLOW_CG)
const duite_kernel flow_begin_coarse = {.name = "cg_begin_coarse",
                                        .body = begin_coarse_timed,
                                        .access = {DUITE_W, DUITE_W, DUITE_R},
                                        .variadic = DUITE_R,
                                        .args_size = ARGS,
                                        .replicated = 1};
