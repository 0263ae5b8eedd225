#ifndef CLOTH_FLOW_INTEGRATORS_EXPLICIT_H
#define CLOTH_FLOW_INTEGRATORS_EXPLICIT_H

#include "cloth/flow/integrators/integrator.h"
#include "cloth/flow/pins/sliders.h"
#include "cloth/flow/run/step.h"
#include "cloth/physics/particle.h"
#include "cloth/physics/stage.h"

/* Shared by explicit integrators: they have no solve (cloth/physics/stage.h). Each step begins and
 * ends with x, v and their halos; each integrator's file names its other state. A task that finds
 * forces reads its neighbours' halos and moves its own rows at once. It writes its next rows to
 * spare halos. These become the halos when all such tasks are forked. So blocks do not wait until
 * neighbours have read them, and forces stay in the caches. */

/* Spare halos become the halos that neighbours read next. Called when all tasks are forked. */
static inline void flow_swap_halos_v(struct flow_state *state)
{
    flow_fields_swap(state, FLOW_FIELD_halo_v, FLOW_FIELD_spare_halo_v);
}

static inline void flow_swap_halos(struct flow_state *state)
{
    flow_fields_swap(state, FLOW_FIELD_halo_x, FLOW_FIELD_spare_halo_x);
    flow_swap_halos_v(state);
}

/* Arguments of a step that a block makes in stages, by a task each. */
struct flow_stage_args {
    union {
        uint32_t block;
        struct flow_step_args step;
    };
    uint32_t stage; /* from 0 */
};

/* Arguments of a task that finds forces when so much of the step is over. */
static inline struct flow_step_args flow_explicit_args(const struct flow_state *state, double part)
{
    struct flow_step_args args = flow_attempt_args(state);
    args.now = (args.begin + part * state->attempt.length) * state->flow->model->h / FLOW_TICKS;
    return args;
}

/* Prefetch the data that a task uses after its long loops, which prefetch their own: its own halo,
 * which it writes, and rows of the neighbours' halos. */
static inline void flow_fetch_own(const struct flow_table *t, const phys_vec *halo)
{
    enum { ROWS = 2 }; /* a cache line */
    for (uint32_t i = 0; i < t->n_halo; i += ROWS)
        phys_fetch(halo + i, 0, 1);
}

static inline void flow_fetch_halos(const struct flow_table *t, const struct flow_view *view)
{
    for (uint32_t s = 0; s < t->n_neighbours; s++) {
        const phys_vec *x = flow_rows_of(view->halo_x, s), *v = flow_rows_of(view->halo_v, s);
        for (uint32_t i = t->ghost_start[s]; i < t->ghost_start[s + 1]; i++) {
            phys_fetch(x + t->ghost[i], 0, 0);
            phys_fetch(v + t->ghost[i], 0, 0);
        }
    }
}

/* Output of a stage: the block's rows, and their halo beside the one that neighbours still read;
 * status notes rows that went too far. */
struct flow_moved {
    phys_vec *x, *v, *halo_x, *halo_v;
    double *status;
};
#define FLOW_MOVED(on)                                                                             \
    ((struct flow_moved){(on)->x, (on)->v, (on)->spare_halo_x, (on)->spare_halo_v, (on)->status})

/* A stage begins: the accelerations of the block's rows where they are, in room of the worker's;
 * sliding rows keep to their way. */
static inline phys_vec *flow_stage_slopes(const duite_call *call, const struct flow_table *t,
                                          const struct flow_step_args *step,
                                          const struct flow_view *view, const phys_vec *halo_x,
                                          const phys_vec *halo_v)
{
    phys_vec *a = flow_force_room(call);
    flow_fetch_own(t, halo_x);
    flow_fetch_own(t, halo_v);
    flow_fetch_halos(t, view);
    flow_forces(call, t, step, view, a);
    flow_part_ends(call, FLOW_FORCE);
    phys_accelerate(t->n, t->mass, t->free, a);
    flow_sliders_filter(call, t, step->time, a);
    flow_part_ends(call, FLOW_ACCELERATION);
    return a;
}

/* A stage ends: writes the halos of the moved rows and checks the rows. Returns the body's code. */
static inline int flow_stage_end(const duite_call *call, const struct flow_table *t,
                                 const struct flow_step_args *step, struct flow_moved moved)
{
    flow_write_halo(t, moved.x, moved.halo_x);
    flow_write_halo(t, moved.v, moved.halo_v);
    const int code = flow_check(call, t, step, moved.x, "position", moved.status);
    return code ? code : flow_check(call, t, step, moved.v, "velocity", moved.status);
}

#endif
