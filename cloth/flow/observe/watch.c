/* The state after a step is watched when the step has been forked whole; when it is accepted,
 * probes tell of it, and the main program may find that the run rests. What is watched of a state
 * waits where the next but one is watched, as the status of a step does. Nothing here is forked for
 * a run that has neither. */
#include "cloth/flow/tasks.h"

#include <math.h>
#include <stddef.h>

static bool may_rest(const struct flow_state *state)
{
    return state->flow->model->rest.speed > 0;
}

int flow_watch(struct flow_state *state)
{
    if (!flow_tells(state) && !may_rest(state))
        return DUITE_OK;
    const double none[FLOW_PEAKS] = {0, -INFINITY, -INFINITY};
    const unsigned at = state->attempt.parity;
    struct flow_args args = flow_attempt_args(state);
    int code = duite_set(state->rt, state->run.peaks[at], none);
    for (; args.block < state->flow->tables.n_blocks && !code; args.block++) {
        const struct flow_objects *o = state->block + args.block;
        const duite_object objects[] = {o->x, o->v, state->run.peaks[at]};
        code = flow_fork(state, &flow_watch_block, &args, 3, objects, FLOW_RIM(rim_x), FLOW_NO_RIM);
    }
    if (!code && flow_tells(state))
        code = flow_energies(state, flow_attempt_args(state), state->run.energy);
    return code;
}

static int fork_probe(struct flow_state *state, struct flow_args args)
{
    const struct flow_objects *o = state->block + args.block;
    int code = flow_fork_one_as(state, &flow_kernel_force, &args, FLOW_AS(FLOW_FOR(f, felt)));
    if (!code)
        code = flow_fork(state, &flow_probe, &args, 4,
                         (duite_object[]){o->x, o->v, o->felt, o->seen}, FLOW_NO_RIM, FLOW_NO_RIM);
    return code;
}

/* The row before must have been written by then. */
static int fork_row(struct flow_state *state)
{
    int64_t token;
    const uint64_t steps = state->report->steps;
    const unsigned at = state->attempt.parity;
    const double tick = state->flow->model->h / FLOW_TICKS;
    const uint32_t length = state->length ? state->length : FLOW_TICKS;
    struct flow_args args = {.frame = steps,
                             .time = flow_time(state),
                             .now = flow_time(state),
                             .h = length * tick,
                             .before =
                                 (state->length_before ? state->length_before : length) * tick};
    int code = steps ? duite_get(state->rt, state->run.token, &token) : DUITE_OK;
    for (; args.block < state->flow->tables.n_blocks && !code; args.block++)
        if (state->flow->tables.block[args.block].n_watched)
            code = fork_probe(state, args);
    if (code)
        return code;
    size_t n = 0;
    args.block = 0;
    state->refs[n++] = state->run.token;
    state->refs[n++] = state->run.status[at];
    state->refs[n++] = state->run.peaks[at];
    state->refs[n++] = state->run.energy;
    for (uint32_t b = 0; b < state->flow->tables.n_blocks; b++)
        if (state->flow->tables.block[b].n_watched)
            state->refs[n++] = state->block[b].seen;
    return duite_fork_at(state->rt, 0, &flow_row, &args, n, state->refs);
}

/* Whether the run rests, by the speeds at the end of a step. */
static int find_rest(struct flow_state *state)
{
    const struct model *model = state->flow->model;
    double peaks[FLOW_PEAKS];
    if (!may_rest(state) || state->resting)
        return DUITE_OK;
    const int code = duite_get(state->rt, state->run.peaks[state->attempt.parity], peaks);
    if (code)
        return code;
    const double time = flow_time(state);
    for (uint32_t i = 0; i < model->n_keys; i++)
        if (model->keys[i].time > time)
            state->moved = time; /* a pin or an obstacle will move yet */
    for (uint32_t course = 1; course <= model->n_courses; course++)
        if (model_course_end(model, course) > time)
            state->moved = time; /* a load will vary yet */
    if (!(sqrt(peaks[FLOW_PEAK_SPEED]) <= model->rest.speed))
        state->moved = time;
    state->resting = state->grid.now > 0 && time - state->moved >= model->rest.hold;
    if (state->resting)
        state->report->rest_seconds = time;
    return DUITE_OK;
}

int flow_watched(struct flow_state *state)
{
    const int code = flow_tells(state) ? fork_row(state) : DUITE_OK;
    return code ? code : find_rest(state);
}
