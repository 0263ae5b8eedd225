/* Gathers the whole state's part of the report when the last step is done. The hash is made on rank
 * 0 and broadcast to all. */
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/state/bodies.h"

#include <endian.h>
#include <math.h>
#include <string.h>

static int largest_stretch(struct flow_state *state)
{
    flow_stretch_fork(state);
    return flow_stretch_get(state, &state->report->max_stretch);
}

/* Runs alone. */
FLOW_KERNEL(seconds, FLOW_NO_PART, struct flow_block_args, (SUM(seconds)))
{
    const struct flow *flow = flow_of(call);
    for (unsigned w = 0; w < flow->n_clocks; w++)
        for (int part = 0; part < FLOW_PARTS; part++)
            on->seconds[part] += flow->clock[w].seconds[part];
    return 0;
}

static double some(double seconds)
{
    return seconds > 0 ? seconds : NAN;
}

/* Seconds in bodies, of all ranks in rank order. No other task runs meanwhile. */
static int sum_seconds(struct flow_state *state)
{
    const struct flow_block_args args = {0};
    double sum[FLOW_PARTS];
    flow_noted(state, duite_wait(state->rt));
    for (int rank = 0; rank < duite_ranks(state->rt); rank++)
        flow_fork_at(state, rank, &flow_kernel_seconds, &args, NULL);
    if (flow_get(state, FLOW_FIELD_seconds, sum))
        return state->code;
    state->report->seconds_force = some(sum[FLOW_FORCE]);
    state->report->seconds_acceleration = some(sum[FLOW_ACCELERATION]);
    state->report->seconds_matrix = some(sum[FLOW_MATRIX]);
    state->report->seconds_cg = some(sum[FLOW_CG]);
    state->report->seconds_velocity = some(sum[FLOW_VELOCITY]);
    state->report->seconds_position = some(sum[FLOW_POSITION]);
    state->report->seconds_collide = some(sum[FLOW_COLLIDE]);
    state->report->seconds_correction = some(sum[FLOW_CORRECTION]);
    state->report->seconds_output = some(sum[FLOW_OUTPUT]);
    return DUITE_OK;
}

/* ---- The hash ----
 *
 * Positions, then velocities, of the vertices by number, a part of the vertices at a time. Blocks
 * with vertices in the part send theirs, some blocks at a time. */

enum { AT_ONCE = 32 };

uint32_t flow_hash_part(const struct flow *flow)
{
    const uint32_t least = 1 << 16, part = flow->n_vertices / 16 + 1;
    const uint32_t size = part > least ? part : least;
    return size < flow->n_vertices ? size : flow->n_vertices;
}

/* Vertices of the input, from .. to - 1. */
struct part {
    uint32_t from, to;
};

/* A double with its lowest byte first, or back. */
static void turn_double(void *to, const void *from)
{
    uint64_t bits;
    memcpy(&bits, from, sizeof bits);
    bits = htole64(bits);
    memcpy(to, &bits, sizeof bits);
}

/* On rank 0: copies the rows of a block whose vertices, by all their names, are in the part. */
static void place_rows(const struct flow_state *state, uint32_t block, const struct part *part)
{
    const struct flow *flow = state->flow;
    const unsigned char *packed = (const unsigned char *)state->rows;
    const struct flow_table *t = flow->tables.block + block;
    struct flow_name name;
    for (uint32_t k = 0; flow_name_of(&flow->names, flow->vertex, t, k, &name); k++)
        if (name.vertex >= part->from && name.vertex < part->to)
            memcpy(state->bytes + FLOW_VERTEX_BYTES * (size_t)(name.vertex - part->from),
                   packed + FLOW_VERTEX_BYTES * (size_t)name.row, FLOW_VERTEX_BYTES);
}

/* A vector of a block without its fourth lane. */
FLOW_KERNEL(collect, FLOW_NO_PART, struct flow_block_args, (R(x), W(gathered)))
{
    const struct flow_table *t = flow_shape_of(call);
    unsigned char *to = on->gathered;
    const int code =
        duite_resize(call, FLOW_INDEX_OF(collect, gathered), FLOW_VERTEX_BYTES * (size_t)t->n);
    for (uint32_t i = 0; i < t->n && !code; i++)
        for (int c = 0; c < 3; c++, to += 8)
            turn_double(to, (const double *)(on->x + i) + c);
    return code;
}

/* Sends a vector of some blocks to rank 0, which holds each only for a moment. */
static void collect_vector(struct flow_state *state, uint32_t n, const uint32_t *block,
                           enum flow_field_id vector, const struct part *part)
{
    for (uint32_t k = 0; k < n; k++) {
        const struct flow_block_args args = {.block = block[k]};
        flow_fork_one_as(state, &flow_kernel_collect, &args, FLOW_AS({FLOW_FIELD_x, vector}));
    }
    for (uint32_t k = 0; k < n && !state->code; k++) {
        const duite_object gathered = state->block[block[k]].gathered;
        if (flow_noted(state, duite_get_at(state->rt, gathered, 0, state->rows)))
            return;
        if (state->bytes)
            place_rows(state, block[k], part);
        flow_noted(state, duite_set_sized(state->rt, gathered, NULL, 0));
    }
}

static int collect_part(struct flow_state *state, enum flow_field_id vector,
                        const struct part *part)
{
    const struct flow_tables *tables = &state->flow->tables;
    uint32_t some[AT_ONCE], n = 0;
    for (uint32_t b = 0; b < tables->n_blocks; b++) {
        if (tables->block[b].highest >= part->from && tables->block[b].lowest < part->to)
            some[n++] = b;
        if (n < AT_ONCE && b + 1 < tables->n_blocks)
            continue;
        collect_vector(state, n, some, vector, part);
        n = 0;
    }
    /* No rank runs ahead of rank 0 with its messages. */
    return flow_noted(state, duite_wait(state->rt));
}

/* Vertices that no face or edge uses are at their start, at rest. */
static void place_unused(struct flow_state *state, bool at_rest, const struct part *part)
{
    static const double rest = 0;
    const struct flow_unused *unused = &state->flow->unused;
    for (uint32_t i = 0; i < unused->n; i++) {
        const uint32_t v = unused->vertex[i];
        unsigned char *to = state->bytes + FLOW_VERTEX_BYTES * (size_t)(v - part->from);
        for (size_t c = 0; v >= part->from && v < part->to && c < 3; c++)
            turn_double(to + 8 * c, at_rest ? &rest : unused->position[i] + c);
    }
}

/* Hands a part of the positions, or of the velocities, to the program. */
static void keep_end(const struct flow_state *state, enum flow_field_id vector,
                     const struct part *part)
{
    double(*end)[6] = state->output ? state->output->end : NULL;
    const unsigned char *from = state->bytes;
    const int first = vector == FLOW_FIELD_v ? 3 : 0;
    for (uint32_t v = part->from; end && v < part->to; v++)
        for (int c = 0; c < 3; c++, from += 8)
            turn_double(end[v] + first + c, from);
}

static void hash_vectors(struct flow_state *state, enum flow_field_id vector, bool at_rest,
                         XXH64_state_t *hash)
{
    const uint32_t n = state->flow->n_vertices, step = flow_hash_part(state->flow);
    for (struct part part = {0}; part.from < n && !state->code; part.from = part.to) {
        part.to = n - part.from > step ? part.from + step : n;
        if (hash)
            place_unused(state, at_rest, &part);
        if (collect_part(state, vector, &part) || !hash)
            continue;
        XXH64_update(hash, state->bytes, FLOW_VERTEX_BYTES * (size_t)(part.to - part.from));
        keep_end(state, vector, &part);
    }
}

static void hash_state(struct flow_state *state)
{
    XXH64_state_t *hash = state->hash;
    if (hash)
        XXH64_reset(hash, 0);
    hash_vectors(state, FLOW_FIELD_x, false, hash);
    hash_vectors(state, FLOW_FIELD_v, true, hash);
    if (hash)
        state->flow->hash = XXH64_digest(hash);
}

FLOW_KERNEL(broadcast, FLOW_NO_PART, struct flow_block_args, (W(broadcast)))
{
    on->broadcast[FLOW_BROADCAST_FRAMES] = flow_of(call)->frames;
    on->broadcast[FLOW_BROADCAST_HASH] = flow_of(call)->hash;
    return 0;
}

static int broadcast_result(struct flow_state *state, uint64_t broadcast[FLOW_BROADCAST])
{
    const struct flow_block_args args = {0};
    flow_fork_at(state, 0, &flow_kernel_broadcast, &args, NULL);
    return flow_get(state, FLOW_FIELD_broadcast, broadcast);
}

static int hash_all(struct flow_state *state)
{
    uint64_t broadcast[FLOW_BROADCAST];
    hash_state(state);
    if (!broadcast_result(state, broadcast))
        state->report->state_hash = broadcast[FLOW_BROADCAST_HASH];
    return state->code;
}

int flow_last_frame(struct flow_state *state)
{
    uint64_t broadcast[FLOW_BROADCAST] = {[FLOW_BROADCAST_FRAMES] = state->next_frame};
    if (flow_shows(state) && broadcast_result(state, broadcast))
        return state->code;
    const uint64_t first = flow_first_frame(state), frames = broadcast[FLOW_BROADCAST_FRAMES];
    const uint64_t before = first < state->next_frame ? first : state->next_frame;
    state->report->frames = frames > before ? frames : before;
    state->report->last_frame = frames > first ? frames - first - 1 : 0;
    return DUITE_OK;
}

void flow_counters_add(duite_counters *to, const duite_counters *of, int sign)
{
    const uint64_t times = (uint64_t)sign; /* counts wrap around: -1 takes them away */
    to->tasks += times * of->tasks;
    to->placed += times * of->placed;
    to->stolen += times * of->stolen;
    to->chained += times * of->chained;
    to->messages += times * of->messages;
    to->bytes += times * of->bytes;
    to->graphs_recorded += times * of->graphs_recorded;
    to->delegated += times * of->delegated;
    to->migrated += times * of->migrated;
    to->stolen_far += times * of->stolen_far;
    to->recognised += times * of->recognised;
    to->recognised_rounds += times * of->recognised_rounds;
    to->busy += sign * of->busy;
    to->idle += sign * of->idle;
    to->awaited += sign * of->awaited;
    to->exposed += sign * of->exposed;
}

/* The counters of the run itself, without its preparations. */
static int observe_finish_count(struct flow_state *state)
{
    duite_counters *now = &state->report->counters;
    flow_noted(state, duite_count_all(state->rt, now));
    flow_counters_add(now, &state->before, -1);
    return state->code;
}

int flow_finish(struct flow_state *state)
{
    if (!state->complete) { /* else its report was whole */
        largest_stretch(state);
        flow_energy_get(state, &state->report->end);
    }
    hash_all(state);
    if (!state->complete) {
        sum_seconds(state);
        flow_last_frame(state);
    }
    return observe_finish_count(state);
}
