#ifndef CLOTH_FLOW_OBSERVE_ENERGY_H
#define CLOTH_FLOW_OBSERVE_ENERGY_H

#include "cloth/flow/run.h"
#include "cloth/flow/state/fields.h"

#include <stdbool.h>

/* Energies of the state, and the guard that refuses steps which gain of them. All are collective,
 * alike on every rank, and return 0 or what duite returned. */

struct flow_state;
struct flow_step_args;

/* The energies that a guarded run (model_is_guarded) keeps, J. */
struct flow_guard {
    bool off;           /* the last step touched something: energies are not checked */
    double lowest;      /* of their sum less all loans to contacts, since the start, a touch, or a
                         * gain that was accepted */
    double max;         /* of motion and strain together, since the start; at least the energy that
                         * weights and loads can set free (flow_source_release) */
    uint64_t calm;      /* tick: steps grow back from there on */
    double sum, moving; /* of the step under way: their sum; motion and strain; */
    double lent;        /* lent to contacts to lift cloth that rests on them too deep; */
    double loans;       /* in all accepted steps while the guard was on */
};

/* Forks the sum of the present state's energies into a field: `energies` or `energy`. args: of the
 * step that ends there. */
int flow_energies(struct flow_state *state, struct flow_step_args args, enum flow_field_id sums);

/* The energies of the present state. Waits for it. */
int flow_energy_get(struct flow_state *state, struct flow_energy *energy);
/* Takes the energies before the first step into the report and the guard. Waits. */
int flow_energy_begin(struct flow_state *state);

/* If a run checks energies after each step, the first function forks those of the step under way.
 * The second waits for them when the step's status is known. The third notes them when it is
 * accepted. touched: contact or a changed tie did work in that step. */
int flow_energy_fork(struct flow_state *state);
int flow_energy_wait(struct flow_state *state);
void flow_energy_note(struct flow_state *state, bool touched);

/* After flow_energy_wait: true if the step under way ends too far above the lowest sum. */
bool flow_energy_gained(const struct flow_state *state, bool touched);

#endif
