/* A step whose contacts push apart. Its begin finds the pairs that are too near then. They are ties
 * of the step, as in certified contact, and their lists live as long as it does. They leave no
 * state, so a step that is given up leaves no trace. */
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/run/step.h"

#include <math.h>

/* k H^2 / m of explicit steps, by default: two layers reach 4 times that (FLOW_SPRINGS_MOST),
 * well below the 4 where what they push bounces ever harder. */
static const double EXPLICIT = 0.1;
/* Thicknesses: in implicit steps the matrix has the band of springs (repulse.h), too. */
static const double BAND = 1.3;
static const double LIGHT = 0.25; /* of the mean mass: that of a grid's corners */

static double reach_of_springs(const struct model *model)
{
    return model_is_implicit(model) ? BAND : 1;
}

static double stiffness_of(const struct flow *flow)
{
    const struct model *model = flow->model;
    if (model->contact.stiffness > 0)
        return model->contact.stiffness;
    return model_is_implicit(model) ? flow_contact_stiffness(flow, model->h)
                                    : EXPLICIT * flow->vertex_mass / (model->h * model->h);
}

/* The scene gives k. Its default is 0.1 m / H^2 in explicit steps, m the mean mass of a vertex and
 * H the scene's step; in implicit ones flow_contact_stiffness of H. */
static struct contact_spring spring_of(const struct flow *flow, double h)
{
    const double stiffness = stiffness_of(flow);
    return (struct contact_spring){.stiffness = stiffness,
                                   .damping = 2 * flow->model->contact.damping *
                                              sqrt(stiffness * flow->vertex_mass),
                                   .hold = stiffness * h,
                                   .spare = h > 0 ? LIGHT * flow->vertex_mass / h : 0,
                                   .reach = reach_of_springs(flow->model)};
}

/* A step with contacts uses only the state of its begin: BDF2 would take the jump of a force for
 * motion. */
static void note_pushed(struct flow_state *state, const struct flow_seen *seen)
{
    state->contact.pushed = seen->contacts;
    if (seen->contacts)
        state->smooth = 0;
    if (seen->contacts > state->report->contacts)
        state->report->contacts = seen->contacts;
}

/* Bodies with frames move here: tasks of the step before are done, since it has been settled. */
static int begin_repulsion(struct flow_state *state)
{
    const struct flow_step_args step = flow_attempt_args(state);
    struct flow_seen seen;
    contact_bodies_move(&state->flow->model->bodies, step.time - step.h, step.time);
    int code = flow_contact_look(state, false, false, &seen);
    if (code)
        return code;
    note_pushed(state, &seen);
    code = flow_contact_accept(state);
    return code ? code : flow_contact_tie(state);
}

static void add_pushed(const struct flow_state *state, double status[FLOW_STATUS])
{
    status[FLOW_TOUCHED] += (double)state->contact.pushed;
}

/* ---- In tasks ---- */

static bool is_repulsion(const struct model *model)
{
    return model_promise(model).springs;
}

/* Moves a point to its place beside a second side that still has the part `left` of its way through
 * the step. */
static void shift_point(const struct contact_row *row, double left, phys_vec *point)
{
    *point -= left * row->slip;
}

/* The second side's motion is part of the slip, and so of the speed. Without velocities the speed
 * is the way from the row's origin, over h. */
static void press_spring(const struct contact_spring *spring, const struct flow_ties *ties,
                         const struct flow_view *view, double h, double left, uint32_t i,
                         const phys_vec *point, struct flow_pressed *to)
{
    const struct contact_row *row = view->contact_rows + i;
    struct contact_repelled repelled;
    const double rate = h > 0 ? 1 / h : 0;
    phys_vec at = *point;
    shift_point(row, left, &at);
    phys_vec speed = rate * (at - row->origin);
    if (view->v)
        flow_contact_speed(ties, view, i, &speed);
    speed += rate * row->slip;
    contact_repel(spring, row, &at, &speed, &repelled);
    to->force = repelled.force;
    to->against = sqrt(repelled.stiffness) * row->normal;
    contact_repelled_value(&repelled, &row->normal, h, &to->value);
}

const struct flow_contact_mode flow_contact_repulsion = {.is = is_repulsion,
                                                         .start = flow_contact_none,
                                                         .resume = flow_contact_none,
                                                         .begin = begin_repulsion,
                                                         .reach = reach_of_springs,
                                                         .status = add_pushed,
                                                         .press = press_spring,
                                                         .spring = spring_of};
