/* Frame k shows the state after the step whose end is nearest to k / fps; a frame is forked when
 * that step is, and the one before it must have been written by then. */
#include "cloth/flow/tasks/tasks.h"

uint64_t flow_frame_step(const struct model *model, uint64_t frame)
{
    if (frame == 0)
        return 0;
    const double step = (double)frame / (model->fps * model->h) + 0.5;
    return step < 0x1p63 ? (uint64_t)step : UINT64_MAX;
}

static int fork_frame(struct flow_state *state, uint64_t steps)
{
    int64_t token;
    if (!flow_shows(state)) { /* only counted */
        state->next_frame++;
        return DUITE_OK;
    }
    if (state->next_frame > 0) {
        const int code = duite_get(state->rt, state->token, &token);
        if (code)
            return code;
    }
    const struct flow_args args = {.step = (uint32_t)steps, .frame = state->next_frame};
    const uint32_t n = state->flow->tables.n_blocks;
    state->refs[0] = state->token;
    for (uint32_t b = 0; b < n; b++)
        state->refs[1 + b] = state->block[b].x;
    state->next_frame++;
    return duite_fork_at(state->rt, 0, &flow_frame, &args, 1 + (size_t)n, state->refs);
}

int flow_frames(struct flow_state *state, uint64_t steps)
{
    int code = DUITE_OK;
    while (!code && flow_frame_step(state->flow->model, state->next_frame) <= steps)
        code = fork_frame(state, steps);
    return code;
}
