#ifndef CLOTH_FLOW_INTEGRATORS_INTEGRATOR_H
#define CLOTH_FLOW_INTEGRATORS_INTEGRATOR_H

#include "cloth/flow/state/state.h"

/* An integrator: its part of a step, and its fields. explicit.c and implicit.c have one of each of
 * the model's list (cloth/model/model.h). */
struct flow_integrator {
    /* Forks the part of a step that leaves x and v as they are; NULL: no such part. */
    int (*begin)(struct flow_state *state);
    /* Forks the rest, which ends with the new x and v and their halos; contact comes after it. */
    int (*end)(struct flow_state *state);
    /* keeps: true if its steps leave the state before them as the kept one; NULL: it is copied
     * before a step. restore: makes that the state again; NULL: a copy back. */
    bool (*keeps)(const struct model *model);
    void (*restore)(struct flow_state *state);
    /* Its fields: */
    bool ends_forces; /* v0, of the half step; f may be that of the end of the step before */
    bool in_stages;   /* x0, v0, where the step began; sum_x, sum_v */
    bool two_steps;   /* last_x, last_v: the state a step before */
};

#define FLOW_INTEGRATOR_EXTERN(number, name, ...)                                                  \
    extern const struct flow_integrator flow_integrator_##name;
MODEL_ALL_INTEGRATORS(FLOW_INTEGRATOR_EXTERN)

const struct flow_integrator *flow_integrator(const struct model *model);
/* True if steps of a model keep the state before them (keeps). Local. */
bool flow_integrator_keeps(const struct model *model);
/* The rows that a task of a block moves, from x and v in place or beside the state; status notes
 * rows that went too far. */
struct flow_move {
    const phys_vec *from_x, *from_v;
    phys_vec *x, *v, *halo_x, *halo_v;
    double *status;
};
/* FLOW_MOVE(on, kept_x, kept_v, halo_x, halo_v): to these fields of the kernel. */
#define FLOW_MOVE(on, to_x, to_v, to_halo_x, to_halo_v)                                            \
    ((struct flow_move){(on)->x, (on)->v, (on)->to_x, (on)->to_v, (on)->to_halo_x,                 \
                        (on)->to_halo_v, (on)->status})

/* Swaps the state and the rows written beside it: the old state is then the kept one. Called when
 * all tasks of such a step are forked; a second call swaps back. */
static inline void flow_swap_kept(struct flow_state *state)
{
    flow_fields_swap(state, FLOW_FIELD_x, FLOW_FIELD_kept_x);
    flow_fields_swap(state, FLOW_FIELD_v, FLOW_FIELD_kept_v);
}

/* ---- Implicit steps ---- */

/* True if the step under way is by BDF2, not by implicit Euler as the first one. */
bool flow_implicit_is_second(const struct flow_state *state);
/* The first adds the notes of Newton steps to a step's status, when that is known. The second, when
 * the step is accepted or not, updates the report and the state that the next step builds on. */
void flow_implicit_status(const struct flow_state *state, double status[FLOW_STATUS]);
void flow_implicit_settle(struct flow_state *state, bool accepted,
                          const double status[FLOW_STATUS]);

/* Warns, before a run, of steps that are too long: for the fastest vibration (explicit), for the
 * solve (implicit), or for the push of the air. To flow->warning, on rank 0, when the source is
 * made. Error: CLOTH_E_MEMORY. Local. (long_steps.c) */
int flow_warn_of_steps(struct flow *flow, struct cloth_error *error);

#endif
