/* Bodies of implicit steps that have bases (cloth/physics/implicit.h): those of more than one
 * Newton step, and those by BDF2. args.h is the t of the step. */
#include "cloth/flow/step/guides.h"

#include "cloth/physics/implicit.h"
#include "cloth/physics/particle.h"

#define ARGS sizeof(struct flow_args)

/* Along what a guide holds a row goes where its v says, as one that is held whole does. */
static void hold_bases(const duite_call *call, const struct flow_table *t,
                       const struct phys_states *s)
{
    struct flow_pins pins;
    struct flow_guide guide;
    flow_pins_begin(call, t, &pins);
    for (uint32_t i = 0; i < t->n_guided; i++) {
        const uint32_t row = t->guided[i][0];
        const phys_vec held = s->x[row] + flow_args_of(call)->h / 2 * s->v[row];
        flow_pins_guide(&pins, i, &guide);
        flow_guide_keep(&guide, &held, s->base_x + row);
    }
}

/* The bases of BDF2, and x where v would lead. */
static int predict(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const double h = flow_args_of(call)->h;
    phys_vec *x = duite_out(call, 1, phys_vec);
    const struct phys_states states = {.x = x,
                                       .v = duite_in(call, 2, phys_vec),
                                       .last_x = duite_out(call, 3, phys_vec),
                                       .last_v = duite_out(call, 4, phys_vec),
                                       .base_x = duite_out(call, 5, phys_vec),
                                       .base_v = duite_out(call, 6, phys_vec)};
    phys_bdf2_bases(t->n, h, t->free, &states);
    hold_bases(call, t, &states);
    phys_place(t->n, h, states.base_x, states.v, x);
    flow_write_rim(t, x, duite_out(call, 7, phys_vec));
    return 0;
}
FLOW_TIMED(predict, FLOW_POSITION)
const duite_kernel flow_predict = {
    .name = "predict",
    .body = predict_timed,
    .access = {DUITE_R, DUITE_RW, DUITE_R, DUITE_RW, DUITE_RW, DUITE_W, DUITE_W, DUITE_W},
    .args_size = ARGS};

/* Moves the block by a part of dv; v, x, and their rims are parameters i to i + 3. */
static void move(const duite_call *call, const struct flow_table *t, double part,
                 const phys_vec *dv, const phys_vec *base_x, size_t i)
{
    phys_vec *v = duite_out(call, i, phys_vec), *x = duite_out(call, i + 1, phys_vec);
    phys_advance(t->n, part, dv, v);
    phys_place(t->n, flow_args_of(call)->h, base_x, v, x);
    flow_write_rim(t, v, duite_out(call, i + 2, phys_vec));
    flow_write_rim(t, x, duite_out(call, i + 3, phys_vec));
}

enum { B = 1, A, DV, R, BASE_X, BASE_V, V, X, RIM_V, RIM_X, SCALARS, STATUS }; /* of correct */

/* The whole of dv. */
static int correct(const duite_call *call)
{
    struct flow_table table = flow_table_of(call), *t = &table;
    const phys_vec *dv = duite_in(call, DV, phys_vec), *v = duite_in(call, V, phys_vec);
    double *status = duite_out(call, STATUS, double);
    const struct flow_solved solved = {.value = flow_open_matrix(call, t, A),
                                       .b = duite_in(call, B, phys_vec),
                                       .dv = dv,
                                       .r = duite_in(call, R, phys_vec),
                                       .scalars = duite_in(call, SCALARS, struct solve_scalars)};
    flow_note_solve(call, t, &solved, status);
    status[FLOW_SLOPE] = phys_slope(t->n, t->free, dv, solved.b);
    move(call, t, 1, dv, duite_in(call, BASE_X, phys_vec), V);
    status[FLOW_CHANGE] = phys_distance(t->n, t->mass, dv, NULL);
    status[FLOW_WHOLE] = phys_distance(t->n, t->mass, v, duite_in(call, BASE_V, phys_vec));
    const int code = flow_check(call, t, v, "velocity", STATUS);
    return code ? code : flow_check(call, t, duite_in(call, X, phys_vec), "position", STATUS);
}
FLOW_TIMED(correct, FLOW_VELOCITY)
const duite_kernel flow_correct = {.name = "correct",
                                   .body = correct_timed,
                                   .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_R, DUITE_R, DUITE_R,
                                              DUITE_R, DUITE_RW, DUITE_W, DUITE_W, DUITE_W, DUITE_R,
                                              DUITE_CW},
                                   .args_size = ARGS};

/* args.part of dv more. */
static int shift(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call);
    move(call, &table, flow_args_of(call)->part, duite_in(call, 1, phys_vec),
         duite_in(call, 2, phys_vec), 3);
    return 0;
}
FLOW_TIMED(shift, FLOW_VELOCITY)
const duite_kernel flow_shift = {
    .name = "shift",
    .body = shift_timed,
    .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_RW, DUITE_W, DUITE_W, DUITE_W},
    .args_size = ARGS};

/* f becomes the right side of the next Newton step. */
static int residual(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    phys_vec *f = duite_out(call, 4, phys_vec);
    phys_residual(t->n, flow_args_of(call)->h, t->mass, duite_in(call, 1, phys_vec),
                  duite_in(call, 2, phys_vec), f);
    *duite_out(call, 5, double) = phys_slope(t->n, t->free, duite_in(call, 3, phys_vec), f);
    return 0;
}
FLOW_TIMED(residual, FLOW_ACCELERATION)
const duite_kernel flow_residual = {
    .name = "residual",
    .body = residual_timed,
    .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_R, DUITE_RW, DUITE_CW},
    .args_size = ARGS};
