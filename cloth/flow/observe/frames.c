/* Frame k shows the state after the step whose end is nearest to k / fps. Where steps may be
 * shorter than h it is known only when the step beyond k / fps is accepted: then either this step's
 * end or its begin, which is kept, is shown. The frame before must have been written by then. The
 * last frame of a run that is stopped shows the state that the run ends with, whenever that is. */
#include "cloth/flow/tasks.h"

#include <math.h>

double flow_frame_tick(const struct model *model, uint64_t frame)
{
    return (double)frame / (model->fps * model->h) * FLOW_TICKS;
}

/* Forks a frame of the state at a tick, kept or not. */
static int fork_frame(struct flow_state *state, double tick, bool kept)
{
    int64_t token;
    const struct flow_args args = {.frame = state->next_frame++,
                                   .time = tick * state->flow->model->h / FLOW_TICKS};
    state->shown = tick;
    if (!flow_shows(state)) /* only counted */
        return DUITE_OK;
    if (args.frame > 0) {
        const int code = duite_get(state->rt, state->run.token, &token);
        if (code)
            return code;
    }
    const uint32_t n = state->flow->tables.n_blocks;
    state->refs[0] = state->run.token;
    for (uint32_t b = 0; b < n; b++)
        state->refs[1 + b] = kept ? state->block[b].kept_x : state->block[b].x;
    return duite_fork_at(state->rt, 0, &flow_frame, &args, 1 + (size_t)n, state->refs);
}

int flow_frame_last(struct flow_state *state)
{
    const double now = (double)state->grid.now;
    return state->shown < now ? fork_frame(state, now, false) : DUITE_OK;
}

int flow_frames(struct flow_state *state, uint64_t from)
{
    const struct model *model = state->flow->model;
    const double now = (double)state->grid.now, begin = (double)from;
    /* What lies so far behind now is certainly shown now: no end of a step can be nearer. */
    const bool uniform = !model->halving || state->grid.now == state->grid.end;
    const double behind = uniform ? FLOW_TICKS / 2.0 : 0.5;
    const double middle = (begin + now) / 2;
    int code = DUITE_OK;
    while (!code) {
        const double tick = flow_frame_tick(model, state->next_frame);
        if (!(tick < now + behind))
            break;
        const bool before = tick < middle && begin < now;
        code = fork_frame(state, before ? begin : now, before);
    }
    return code;
}
