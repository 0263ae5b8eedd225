#ifndef CLOTH_FLOW_INTEGRATORS_EXPLICIT_H
#define CLOTH_FLOW_INTEGRATORS_EXPLICIT_H

#include "cloth/flow/integrators/integrator.h"
#include "cloth/flow/step/guides.h"
#include "cloth/flow/step/step.h"
#include "cloth/physics/particle.h"
#include "cloth/physics/stage.h"

/* What explicit integrators share: they solve nothing (cloth/physics/stage.h). Each step begins and
 * ends with x, v and their rims; what else an integrator keeps from step to step is said with it. A
 * task that finds forces reads its neighbours' rims and moves its own rows at once: what the
 * neighbours are to read next goes to spare rims, which are the rims when all such tasks are
 * forked. So no block waits for its neighbours to have seen it, and forces do not leave the
 * caches. */

/* What a task wrote to the spare rims is what neighbours read next: when all tasks are forked. */
static inline void flow_swap_rims_v(struct flow_state *state)
{
    flow_fields_swap(state, FLOW_FIELD_rim_v, FLOW_FIELD_spare_rim_v);
}

static inline void flow_swap_rims(struct flow_state *state)
{
    flow_fields_swap(state, FLOW_FIELD_rim_x, FLOW_FIELD_spare_rim_x);
    flow_swap_rims_v(state);
}

/* Arguments of a task that finds forces when so much of the step is over. */
static inline struct flow_args flow_explicit_args(const struct flow_state *state, double part)
{
    struct flow_args args = flow_attempt_args(state);
    args.now = (args.begin + part * state->attempt.length) * state->flow->model->h / FLOW_TICKS;
    return args;
}

/* Asks memory for what a task comes to when its long loops, which ask for themselves, are done:
 * a rim of its own that it writes, and rows of the neighbours' rims. */
static inline void flow_fetch_own(const struct flow_table *t, const phys_vec *rim)
{
    enum { ROWS = 2 }; /* a cache line */
    for (uint32_t i = 0; i < t->n_rim; i += ROWS)
        phys_fetch(rim + i, 0, 1);
}

static inline void flow_fetch_rims(const struct flow_table *t, const struct flow_view *view)
{
    for (uint32_t s = 0; s < t->n_slots; s++) {
        const phys_vec *x = flow_rows_of(view->rim_x, s), *v = flow_rows_of(view->rim_v, s);
        for (uint32_t i = t->copies[s]; i < t->copies[s + 1]; i++) {
            phys_fetch(x + t->copy[i], 0, 0);
            phys_fetch(v + t->copy[i], 0, 0);
        }
    }
}

#endif
