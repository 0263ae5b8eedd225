/* A step whose contacts push apart. Its begin finds the pairs that are too near then. They are ties
 * of the step, as in certified contact, and their lists live as long as it does. They leave no
 * state, so a step that is given up leaves no trace. */
#include "cloth/flow/contact/repel.h"
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/run/step.h"

#include <math.h>

static const double EXPLICIT = 0.1; /* k H^2 / m */
static const double LIGHT = 0.25;   /* of the mean mass: that of a grid's corners */

static double stiffness_of(const struct flow *flow)
{
    const struct model *model = flow->model;
    if (model->contact.stiffness > 0)
        return model->contact.stiffness;
    return model_is_implicit(model) ? flow_contact_stiffness(flow, model->h)
                                    : EXPLICIT * flow->vertex_mass / (model->h * model->h);
}

struct contact_spring flow_repulsion_of(const struct flow *flow, double h)
{
    const double stiffness = stiffness_of(flow);
    const double band = flow_contact_reach(flow->model) - flow->model->contact.thickness;
    return (struct contact_spring){.stiffness = stiffness,
                                   .damping = 2 * flow->model->contact.damping *
                                              sqrt(stiffness * flow->vertex_mass),
                                   .hold = stiffness * h,
                                   .spare = h > 0 ? LIGHT * flow->vertex_mass / h : 0,
                                   .band = band};
}

int flow_repulsion_start(struct flow_state *state)
{
    return flow_contact_none(state);
}

/* A step with contacts uses only the state of its begin: BDF2 would take the jump of a force for
 * motion. */
static void note(struct flow_state *state, const struct flow_seen *seen)
{
    state->contact.pushed = seen->contacts;
    if (seen->contacts)
        state->smooth = 0;
    if (seen->contacts > state->report->contacts)
        state->report->contacts = seen->contacts;
}

/* Bodies with frames move here: tasks of the step before are done, since it has been settled. */
int flow_repulsion_begin(struct flow_state *state)
{
    const struct flow_step_args step = flow_attempt_args(state);
    struct flow_seen seen;
    contact_bodies_move(&state->flow->model->bodies, step.time - step.h, step.time);
    int code = flow_contact_look(state, &seen);
    if (code)
        return code;
    note(state, &seen);
    state->contact.begin = state->contact.now;
    code = flow_contact_accept(state);
    return code ? code : flow_contact_tie(state);
}
