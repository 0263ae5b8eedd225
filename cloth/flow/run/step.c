/* A step is a list of stages, which are forked in order. It is forked whole while the last may
 * still run. First come stages that only read the state (its begin). Then the main program looks at
 * the status of the last step (settle.c). Then come stages that change the state. */
#include "cloth/flow/run/step.h"
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/integrators/integrator.h"
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/state/state.h"

struct flow_step_args flow_attempt_args(const struct flow_state *state)
{
    const struct model *model = state->flow->model;
    const struct flow_attempt *attempt = &state->attempt;
    const double end = (double)(attempt->begin + attempt->length) * model->h / FLOW_TICKS;
    return (struct flow_step_args){.last = !model->halving || attempt->length == 1,
                                   .h = model->h * attempt->length / FLOW_TICKS,
                                   .begin = (double)attempt->begin,
                                   .time = end,
                                   .now = end};
}

/* ---- Conditions of stages ---- */

static bool always(const struct model *model)
{
    (void)model;
    return true;
}

static bool resizes(const struct model *model)
{
    return model->sizes;
}

static bool is_driven(const struct model *model)
{
    return model_is_driven(model);
}

static bool corrects(const struct model *model)
{
    return model->correction_rounds > 0;
}

/* The copy comes first if velocities change before the forces. */
static bool keeps_first(const struct model *model)
{
    return model_keeps(model) && flow_step_is_driven(model);
}

static bool keeps_late(const struct model *model)
{
    return model_keeps(model) && !flow_step_is_driven(model) && !flow_integrator_keeps(model);
}

bool flow_step_is_driven(const struct model *model)
{
    return model_is_driven(model) || model_is_filtered(model) || model_seeks(model);
}

/* ---- Stages ---- */

static int step_fork_begin(struct flow_state *state)
{
    const struct flow_integrator *is = flow_integrator(state->flow->model);
    return is->begin ? is->begin(state) : DUITE_OK;
}

/* Comes after the status of the step before was got. Tasks of a begin add nothing to it. */
static int empty_status(struct flow_state *state)
{
    return flow_set(state, FLOW_FIELD_status, NULL);
}

static int fork_end(struct flow_state *state)
{
    return flow_integrator(state->flow->model)->end(state);
}

/* The part of a step. Up to SOLVE: its begin, which leaves x and v as they are, unless velocities
 * change first (flow_step_is_driven). A step that is solved again goes from PREDICT to CORRECT. */
enum stage_part { TIE, PREDICT, SOLVE, CORRECT, SETTLE, OBSERVE };

struct stage {
    const char *name;
    enum stage_part part;
    bool (*enabled)(const struct model *model);
    int (*fork)(struct flow_state *state);
};

/* In order, also of their parts; docs/design/cloth.md lists them by name. A new stage is a row. */
static const struct stage stages[] = {
    {"resize", TIE, resizes, flow_resize},
    {"choose ties", TIE, always, flow_ties_choose},
    {"begin contact", TIE, always, flow_contact_begin},
    {"keep", PREDICT, keeps_first, flow_keep},
    {"prescribe velocities", PREDICT, is_driven, flow_pins_prescribe_velocity},
    {"begin", SOLVE, always, step_fork_begin},
    {"empty status", CORRECT, always, empty_status},
    {"keep", CORRECT, keeps_late, flow_keep},
    {"integrate", CORRECT, always, fork_end},
    {"prescribe positions", CORRECT, is_driven, flow_pins_prescribe_position},
    {"correct", CORRECT, corrects, flow_correct},
    {"settle contact", SETTLE, always, flow_contact_settle},
    {"stretch", OBSERVE, flow_is_judged, flow_stretch_fork},
    {"watch", OBSERVE, always, flow_watch},
    {"energy", OBSERVE, always, flow_energy_fork},
    {"status", OBSERVE, always, flow_status_fork},
};

/* Forks the stages of the parts from .. to. */
static int fork_stages(struct flow_state *state, enum stage_part from, enum stage_part to)
{
    for (size_t i = 0; i < sizeof stages / sizeof *stages && !state->code; i++) {
        const struct stage *stage = stages + i;
        if (stage->part >= from && stage->part <= to && stage->enabled(state->flow->model))
            flow_noted(state, stage->fork(state));
    }
    return state->code;
}

int flow_step_begin(struct flow_state *state)
{
    flow_noted(state, duite_trace_step(state->rt, state->attempt.begin / FLOW_TICKS));
    return fork_stages(state, TIE, SOLVE);
}

int flow_step_again(struct flow_state *state)
{
    return fork_stages(state, PREDICT, CORRECT);
}

int flow_step_end(struct flow_state *state)
{
    const int code = fork_stages(state, CORRECT, OBSERVE);
    state->attempt.forked = !code;
    return code;
}

int flow_step(struct flow_state *state)
{
    state->attempt.length = FLOW_TICKS;
    state->guessed = 0;
    flow_step_begin(state);
    return flow_step_end(state);
}
