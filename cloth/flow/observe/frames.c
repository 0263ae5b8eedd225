/* Frame k shows the state after the step whose end is nearest to k / fps, by the time of all
 * phases. If steps may be shorter than h, the end is known only when the step beyond k / fps is
 * accepted: then the frame shows this step's end or its begin, which is kept. The frame before must
 * be written by then: rank 0 writes frames one after the other, and each frame's task holds the
 * token. The last frame of a stopped run shows its final state. */
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/state/bodies.h"

/* The tick that a frame shows; rounding errors of whole ticks are removed. */
static double frame_tick(const struct flow_state *state, uint64_t frame)
{
    const double ROUNDED = 1e-3; /* of a tick: a millionth of h, more than rounding comes to */
    const struct model *model = state->flow->model;
    const double before = flow_before(state).time / model->h;
    const double tick = ((double)frame / (model->fps * model->h) - before) * FLOW_TICKS;
    return fabs(tick - nearbyint(tick)) < ROUNDED ? nearbyint(tick) : tick;
}

/* A vector of the vertices of all blocks, by all their names. */
static void observe_frames_put_all(struct flow *flow, const duite_param *vector)
{
    struct flow_name name;
    for (uint32_t b = 0; b < flow->tables.n_blocks; b++) {
        const phys_vec *x = flow_rows_of(vector, b);
        const struct flow_table *t = flow->tables.block + b;
        for (uint32_t k = 0; flow_name_of(&flow->names, flow->vertex, t, k, &name); k++)
            for (size_t c = 0; c < 3; c++)
                flow->room[3 * (size_t)name.vertex + c] = x[name.row][c];
    }
}

/* The block of each vertex, and the rank that keeps it. */
static void put_places(const struct flow *flow)
{
    struct flow_name name;
    for (uint32_t b = 0; b < flow->tables.n_blocks; b++) {
        const struct flow_table *t = flow->tables.block + b;
        for (uint32_t k = 0; flow_name_of(&flow->names, flow->vertex, t, k, &name); k++) {
            flow->block_of[name.vertex] = (int32_t)b;
            flow->rank_of[name.vertex] = flow->home[b];
        }
    }
    for (uint32_t i = 0; i < flow->unused.n; i++)
        flow->block_of[flow->unused.vertex[i]] = flow->rank_of[flow->unused.vertex[i]] = -1;
}

/* Hands the places of the next frame to the program. */
static int show_places(struct flow *flow, uint64_t frame)
{
    const struct flow_places places = {flow->block_of, flow->tables.n_blocks, flow->home};
    if (!flow->output->places)
        return 0;
    put_places(flow);
    return flow->output->places(flow->output->context, frame, &places, &flow->trouble);
}

/* Fills in vertices that no block has: zeros, or their places. */
static void put_unused(const struct flow *flow, bool zeros)
{
    for (uint32_t i = 0; i < flow->unused.n; i++)
        for (size_t c = 0; c < 3; c++)
            flow->room[3 * (size_t)flow->unused.vertex[i] + c] =
                zeros ? 0 : flow->unused.position[i][c];
}

/* The vector that a task shows: the positions of a frame; of one that is written, the velocities
 * with its other fields, or the forces. */
enum frame_shows { POSITIONS, BESIDE, FORCES };
struct frame_args {
    uint32_t block; /* none */
    enum frame_shows shows;
    uint64_t frame;
    double time; /* s */
};

/* Hands the vector in the room to the program. */
static int show_vector(struct flow *flow, const struct frame_args *args)
{
    const struct flow_output *to = flow->output;
    const struct flow_beside beside = {flow->room, flow->block_of, flow->rank_of};
    if (args->shows == FORCES)
        return to->force(to->context, args->frame, flow->room, &flow->trouble);
    if (args->shows == BESIDE) {
        put_places(flow);
        return to->beside(to->context, &beside, &flow->trouble);
    }
    const int failed = show_places(flow, args->frame);
    return failed ? failed
                  : to->frame(to->context, args->frame, args->time, flow->room, &flow->trouble);
}

FLOW_KERNEL_WITH(frame, FLOW_OUTPUT, struct frame_args, (RW(token), ALL(x)), .side_effects = 1)
{
    struct flow *flow = flow_of(call);
    const bool places = on->args->shows == POSITIONS;
    if (!places)
        put_unused(flow, true);
    observe_frames_put_all(flow, on->x);
    const int failed = show_vector(flow, on->args);
    if (!places)
        put_unused(flow, false);
    if (failed && flow->output->written)
        flow->frames = flow->output->first_frame + flow->output->written(flow->output->context);
    if (failed)
        return duite_fail(call, FLOW_NOT_WRITTEN, "%s", flow->trouble.text);
    flow->frames = flow->output->first_frame + on->args->frame + 1;
    return 0;
}

/* Called while no frame is under way. */
static void find_homes(struct flow_state *state)
{
    for (uint32_t b = 0; b < state->flow->tables.n_blocks; b++) {
        const int home = duite_home(state->rt, state->block[b].x);
        if (state->flow->home)
            state->flow->home[b] = home;
    }
}

static void fork_vector(struct flow_state *state, struct frame_args args, enum frame_shows shows,
                        enum flow_field_id field)
{
    args.shows = shows;
    flow_fork_at(state, 0, &flow_kernel_frame, &args, FLOW_AS({FLOW_FIELD_x, field}));
}

/* Forks a frame of the state at a tick, kept or not. */
static int fork_frame(struct flow_state *state, double tick, bool kept)
{
    int64_t token;
    const struct flow_before before = flow_before(state);
    const uint64_t number = state->next_frame++, first = flow_first_frame(state);
    const struct frame_args args = {
        .frame = number - first, .time = before.time + tick * state->flow->model->h / FLOW_TICKS};
    state->shown = tick;
    if (!flow_shows(state) || number < first) /* only counted */
        return DUITE_OK;
    if (number > before.frames && flow_get(state, FLOW_FIELD_token, &token))
        return state->code;
    if (flow_shows_places(state))
        find_homes(state);
    fork_vector(state, args, POSITIONS, kept ? FLOW_FIELD_kept_x : FLOW_FIELD_x);
    if (flow_shows_beside(state, args.frame))
        fork_vector(state, args, BESIDE, kept ? FLOW_FIELD_kept_v : FLOW_FIELD_v);
    if (flow_shows_contact(state))
        fork_vector(state, args, FORCES,
                    kept ? FLOW_FIELD_kept_contact_force : FLOW_FIELD_contact_force);
    return state->code;
}

static bool are_over(const struct flow_state *state)
{
    const uint64_t end = state->output ? state->output->end_frame : 0;
    return end && state->next_frame >= end;
}

int flow_frame_last(struct flow_state *state)
{
    const double now = (double)state->grid.now;
    return state->shown < now && !are_over(state) ? fork_frame(state, now, false) : DUITE_OK;
}

/* Forks the frames that the step shows. Its end shows frames up to `behind` ticks after it. */
static int fork_frames(struct flow_state *state, double begin, double behind)
{
    const double now = (double)state->grid.now, middle = (begin + now) / 2;
    while (!state->code && !are_over(state)) {
        const double tick = frame_tick(state, state->next_frame);
        if (!(tick < now + behind))
            break;
        const bool before = tick < middle && begin < now;
        fork_frame(state, before ? begin : now, before);
    }
    return state->code;
}

/* Frames within half the shortest step after now are certain: no other end can be nearer. A resumed
 * run takes back the frames that only the end of the earlier run made certain. */
int flow_frames(struct flow_state *state, uint64_t from)
{
    const double most = FLOW_TICKS / 2.0, begin = (double)from;
    fork_frames(state, begin, state->flow->model->halving ? 0.5 : most);
    state->certain = (struct flow_frames_so_far){state->next_frame, state->shown};
    if (state->grid.now == state->grid.end)
        fork_frames(state, begin, most);
    return state->code;
}
