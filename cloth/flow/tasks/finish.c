/* What a report needs of the whole state, gathered when the last step is done. The hash is made on
 * rank 0 and told to all. */
#include "cloth/flow/tasks/tasks.h"

#include <stddef.h>
#include <string.h>
#include <xxhash.h>

static int largest_stretch(struct flow_state *state)
{
    struct flow_args args = {0};
    const uint32_t n = state->flow->tables.n_blocks;
    int code = DUITE_OK;
    for (; args.block < n && !code; args.block++) {
        const struct flow_objects *o = state->block + args.block;
        code = flow_fork(state, &flow_stretch, &args, 2, (duite_object[]){o->x, o->stretch},
                         offsetof(struct flow_objects, rim_x), FLOW_NO_RIM);
    }
    args.block = 0;
    state->refs[0] = state->most;
    for (uint32_t b = 0; b < n; b++)
        state->refs[1 + b] = state->block[b].stretch;
    if (!code)
        code = duite_fork(state->rt, &flow_most, &args, 1 + (size_t)n, state->refs);
    return code ? code : duite_get(state->rt, state->most, &state->report->max_stretch);
}

/* Seconds in bodies, of all ranks in rank order. No other task runs meanwhile. */
static int sum_seconds(struct flow_state *state)
{
    const struct flow_args args = {0};
    int code = duite_wait(state->rt);
    for (int rank = 0; rank < duite_ranks(state->rt) && !code; rank++)
        code = duite_fork_at(state->rt, rank, &flow_seconds, &args, 1, &state->seconds);
    double sum[FLOW_PARTS];
    if (!code)
        code = duite_get(state->rt, state->seconds, sum);
    if (code)
        return code;
    state->report->seconds_force = sum[FLOW_FORCE];
    state->report->seconds_acceleration = sum[FLOW_ACCELERATION];
    state->report->seconds_matrix = sum[FLOW_MATRIX];
    state->report->seconds_cg = sum[FLOW_CG];
    state->report->seconds_velocity = sum[FLOW_VELOCITY];
    state->report->seconds_position = sum[FLOW_POSITION];
    state->report->seconds_collide = sum[FLOW_COLLIDE];
    state->report->seconds_output = sum[FLOW_OUTPUT];
    return DUITE_OK;
}

/* A double as eight bytes, the lowest first. */
static void put(unsigned char *bytes, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 8; i++)
        bytes[i] = (unsigned char)(bits >> (8 * i));
}

/* Gathers a vector of all blocks on rank 0 into bytes, 24 a vertex of the input; bytes: NULL on the
 * other ranks. */
static int gather(struct flow_state *state, size_t offset, unsigned char *bytes)
{
    const struct flow *flow = state->flow;
    for (uint32_t b = 0; b < flow->tables.n_blocks; b++) {
        const struct flow_table *t = flow->tables.block + b;
        const duite_object *object = (const void *)((const char *)(state->block + b) + offset);
        const int code = duite_get_at(state->rt, *object, 0, state->rows);
        if (code)
            return code;
        for (uint32_t i = 0; bytes && i < t->n; i++)
            for (size_t c = 0; c < 3; c++)
                put(bytes + 24 * (size_t)flow->blocks.vertex[t->first + i] + 8 * c,
                    state->rows[4 * (size_t)i + c]);
    }
    return DUITE_OK;
}

/* No frame is written any more. Vertices that no face or edge uses are at their start, at rest. */
static int hash_state(struct flow_state *state)
{
    struct flow *flow = state->flow;
    unsigned char *bytes = duite_rank(state->rt) == 0 ? (unsigned char *)flow->room : NULL;
    const size_t half = 24 * (size_t)flow->n_vertices;
    for (size_t v = 0; bytes && v < flow->n_vertices; v++)
        for (size_t c = 0; c < 3; c++) {
            put(bytes + 24 * v + 8 * c, flow->start[v][c]);
            put(bytes + half + 24 * v + 8 * c, 0);
        }
    int code = gather(state, offsetof(struct flow_objects, x), bytes);
    if (!code)
        code = gather(state, offsetof(struct flow_objects, v), bytes ? bytes + half : NULL);
    if (!code && bytes)
        flow->hash = XXH64(bytes, 2 * half, 0);
    return code;
}

static int tell(struct flow_state *state, uint64_t told[FLOW_TELL])
{
    const struct flow_args args = {0};
    int code = duite_fork_at(state->rt, 0, &flow_tell, &args, 1, &state->told);
    if (!code)
        code = duite_get(state->rt, state->told, told);
    return code;
}

static int hash_all(struct flow_state *state)
{
    uint64_t told[FLOW_TELL];
    int code = hash_state(state);
    if (!code)
        code = tell(state, told);
    if (!code)
        state->report->state_hash = told[FLOW_TELL_HASH];
    return code;
}

int flow_last_frame(struct flow_state *state)
{
    uint64_t told[FLOW_TELL];
    const int code = tell(state, told);
    if (code)
        return code;
    state->report->frames = told[FLOW_TELL_FRAMES];
    state->report->last_frame = told[FLOW_TELL_FRAMES] ? told[FLOW_TELL_FRAMES] - 1 : 0;
    return DUITE_OK;
}

int flow_finish(struct flow_state *state)
{
    int code = largest_stretch(state);
    if (!code)
        code = hash_all(state);
    if (!code)
        code = sum_seconds(state);
    if (!code)
        code = flow_last_frame(state);
    if (!code)
        code = duite_count_all(state->rt, &state->report->counters);
    return code;
}
