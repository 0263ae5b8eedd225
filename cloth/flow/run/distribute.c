/* Rank 0 alone knows the model. It broadcasts to all ranks the little that all need, and
 * distributes the tables of the blocks to the ranks that keep them. Rank 0 makes each table when
 * its turn comes. A task where the block lives takes it over, and rank 0 frees it. A few are on
 * their way at any time, so that rank 0 never holds more than its own and those. */
#include "cloth/flow/checkpoint/checkpoint.h"
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/state/bodies.h"
#include "cloth/flow/state/room.h"

#include "cloth/base/order.h"

#include <stddef.h>
#include <string.h>

enum {
    GROUPS = 4, /* times that rank 0 goes through all springs, with the sides of as many blocks */
    GROUP = 32, /* blocks that a group has at least */
    TRAVEL = 16 /* tables on their way */
};

/* Bytes of a block's table that are broadcast: its shape; the neighbours of all blocks follow. */
static const size_t SHAPE = offsetof(struct flow_table, neighbour);

/* ---- The arrays that all ranks share ---- */

/* Pairs of all sides. */
static size_t n_sides(const struct model *model)
{
    return (size_t)model->n_cloths * ((size_t)model->n_cloths + model->n_obstacles);
}

/* In the order of their memory: type, name, how many, and where rank 0 has them; NULL: they are
 * made on the way. head, m: their head and its model; flow, source: of rank 0. */
#define SHARED(X)                                                                                  \
    X(unsigned char, bodies, m->bodies.bytes, flow->model->bodies.memory)                          \
    X(struct contact_shape, obstacles, m->n_obstacles, flow->model->obstacles)                     \
    X(struct phys_key, keys, m->n_keys, flow->model->keys)                                         \
    X(struct model_slider, sliders, m->n_sliders, flow->model->sliders)                            \
    X(struct phys_curve_key, curve_keys, m->n_curve_keys, flow->model->curve_keys)                 \
    X(struct model_curve, curves, m->n_curves, flow->model->curves)                                \
    X(struct model_motion, motions, m->n_motions, flow->model->motions)                            \
    X(uint32_t, apart_end, m->contact.apart.apart ? m->n_cloths : 0,                               \
      flow->model->contact.apart.end)                                                              \
    X(unsigned char, apart, m->contact.apart.apart ? n_sides(m) : 0,                               \
      flow->model->contact.apart.apart)                                                            \
    X(struct model_sides, sides, n_sides(m), NULL)                                                 \
    X(struct flow_anchor, anchor, head->n_anchors, source->particles.anchor)                       \
    X(struct flow_tie, tie, head->n_ties, NULL)                                                    \
    X(unsigned char, shape, head->n_blocks *SHAPE, NULL)                                           \
    X(uint32_t, neighbour, head->n_neighbours, source->neighbours.neighbour)                       \
    X(uint32_t, ghost_start, (size_t)head->n_neighbours + head->n_blocks,                          \
      source->neighbours.ghost_start)                                                              \
    X(uint32_t, ghost, head->n_ghosts, source->neighbours.ghost)                                   \
    X(uint32_t, joins, head->n_neighbours, source->neighbours.joins)

struct shared_arrays {
#define SHARED_MEMBER(type, name, n, from) type *name;
    SHARED(SHARED_MEMBER)
};

/* Finds them in memory; NULL: none. Returns how many bytes they have. */
static size_t lay_shared(const struct flow_head *head, void *memory, struct shared_arrays *to)
{
    const struct model *m = &head->model;
    struct flow_room room = {.base = memory};
#define SHARED_LAY(type, name, n, from) to->name = flow_room_next(&room, (n) * sizeof *to->name);
    SHARED(SHARED_LAY)
    return room.used;
}

static void put_sides(const struct model *model, struct model_sides *to)
{
    for (uint32_t c = 0; c < model->n_cloths; c++)
        for (uint32_t i = 0; i < model->n_cloths + model->n_obstacles; i++, to++) {
            *to = model_sides(model, c, i);
            to->friction = model_meets(model, c, i) ? to->friction : FLOW_APART;
        }
}

static void put_bytes(void *to, const void *from, size_t bytes)
{
    if (from && bytes)
        memcpy(to, from, bytes);
}

/* ---- Broadcasts ---- */

/* The sizes of all blocks, and the largest of any. */
static void measure_blocks(const struct flow_source *source, struct flow_head *head)
{
    head->n_blocks = source->blocks.n_blocks;
    head->n_neighbours = source->neighbours.n_neighbours;
    head->n_ghosts = source->neighbours.n_ghosts;
    for (uint32_t b = 0; b < head->n_blocks; b++) {
        const struct flow_table *t = source->shape + b;
        head->max_rows = (uint32_t)cloth_larger(t->n, head->max_rows);
        head->max_neighbours = (uint32_t)cloth_larger(t->n_neighbours, head->max_neighbours);
        head->max_halo = (uint32_t)cloth_larger(t->n_halo, head->max_halo);
        head->max_ghosts = (uint32_t)cloth_larger(t->n_ghosts, head->max_ghosts);
        for (int kind = 0; kind < ELEMENT_KINDS; kind++)
            head->n_elements += t->n_elements[kind];
        head->max_entries =
            (uint32_t)cloth_larger(t->n_entries + t->n_cut_entries, head->max_entries);
    }
}

/* On rank 0, which alone has a source. */
static void make_head(const struct flow *flow, struct flow_head *head)
{
    const struct flow_source *source = &flow->source;
    struct shared_arrays nowhere;
    memset(head, 0, sizeof *head);
    memcpy(&head->model, flow->model, sizeof head->model);
    memcpy(&head->numbers, &flow->numbers, sizeof head->numbers);
    if (flow->from.bytes)
        head->resumed_bytes = ((const struct flow_saved *)flow->from.bytes)->main_bytes;
    head->n_pieces = source->particles.n_pieces;
    head->n_ties = source->springs.n_timed;
    head->n_anchors = source->particles.n_anchors;
    measure_blocks(source, head);
    head->shared_bytes = lay_shared(head, NULL, &nowhere);
}

FLOW_KERNEL(broadcast_head, FLOW_NO_PART, struct flow_block_args, (GIVEN_W(sent)))
{
    make_head(flow_of(call), (struct flow_head *)(void *)on->sent);
    return 0;
}

FLOW_KERNEL(broadcast_shared, FLOW_NO_PART, struct flow_block_args, (GIVEN_W(sent)))
{
    const struct flow *flow = flow_of(call);
    const struct flow_source *source = &flow->source;
    struct flow_head made, *head = &made;
    const struct model *m = &head->model;
    struct shared_arrays to;
    make_head(flow, head);
    memset(on->sent, 0, head->shared_bytes);
    lay_shared(head, on->sent, &to);
#define SHARED_PUT(type, name, n, from) put_bytes(to.name, from, (n) * sizeof *to.name);
    SHARED(SHARED_PUT)
    put_sides(flow->model, to.sides);
    for (uint32_t i = 0; i < head->n_ties; i++)
        to.tie[i] = flow_joints_tie(source, source->springs.timed + i);
    for (uint32_t b = 0; b < head->n_blocks; b++)
        memcpy(to.shape + b * SHAPE, source->shape + b, SHAPE);
    return 0;
}

int flow_broadcast(struct flow_state *state, const struct flow_kernel *kernel, size_t bytes,
                   void *received)
{
    const struct flow_block_args all = {0};
    duite_object object;
    flow_noted(state, duite_new(state->rt, DUITE_BYTE, bytes, &object));
    flow_fork_with_at(state, 0, kernel, &all, &(struct flow_with){.sent = object});
    if (!state->code)
        flow_noted(state, duite_get(state->rt, object, received));
    if (object.generation)
        flow_noted(state, duite_free(state->rt, object));
    return state->code;
}

/* A model without what rank 0 alone has. */
static struct model received_model(const struct flow_head *head)
{
    struct model model = head->model;
    model.n_materials = model.n_cloths = model.n_joints = model.n_welds = 0;
    model.contact.n_pairs = 0;
    model.name = model.h_place = model.fps_place = model.hdf5_place = NULL;
    model.materials = NULL;
    model.cloths = NULL;
    model.obstacle_names = NULL;
    model.contact.pairs = NULL;
    model.contact.apart.joined = NULL;
    model.joints = NULL;
    model.welds = NULL;
    model.probes = NULL;
    return model;
}

int flow_share_head(struct flow_state *state)
{
    struct flow *flow = state->flow;
    const struct flow_head *head = &state->head;
    const int code = flow_broadcast(state, &flow_kernel_broadcast_head, sizeof *head, &state->head);
    flow->n_ties = code ? 0 : head->n_ties;
    if (code || duite_rank(state->rt) == 0)
        return code;
    flow->received = received_model(head);
    flow->model = &flow->received;
    flow->numbers = head->numbers;
    return DUITE_OK;
}

/* Points the members of the flow into the arrays. */
static void open_shared(struct flow *flow, const struct flow_head *head,
                        const struct shared_arrays *arrays)
{
    struct model *model = &flow->received;
    model->bodies.memory = arrays->bodies;
    model->obstacles = arrays->obstacles;
    model->keys = arrays->keys;
    model->sliders = arrays->sliders;
    model->curve_keys = arrays->curve_keys;
    model->curves = arrays->curves;
    model->motions = arrays->motions;
    model->contact.apart.end = arrays->apart_end;
    model->contact.apart.apart = head->model.contact.apart.apart ? arrays->apart : NULL;
    flow->sides = arrays->sides;
    flow->n_cloths = head->model.n_cloths;
    flow->n_anchors = head->n_anchors;
    flow->anchor = arrays->anchor;
    flow->tie = arrays->tie;
    flow->tables.neighbour = arrays->neighbour;
    flow->tables.ghost = arrays->ghost;
}

/* Points the shapes into them. */
static void open_shapes(struct flow *flow, struct shared_arrays at)
{
    struct flow_tables *tables = &flow->tables;
    uint32_t first = 0;
    for (uint32_t b = 0; b < tables->n_blocks; b++) {
        struct flow_table *table = tables->block + b;
        *table = (struct flow_table){.joins = at.joins,
                                     .neighbour = at.neighbour,
                                     .ghost_start = at.ghost_start,
                                     .ghost = at.ghost};
        memcpy(table, at.shape + b * SHAPE, SHAPE);
        table->first = first;
        table->format = flow->model->format;
        first += table->n;
        at.joins += table->n_neighbours;
        at.neighbour += table->n_neighbours;
        at.ghost_start += table->n_neighbours + 1;
        at.ghost += table->n_ghosts;
    }
}

int flow_share(struct flow_state *state)
{
    struct shared_arrays arrays;
    const int code = flow_broadcast(state, &flow_kernel_broadcast_shared, state->head.shared_bytes,
                                    state->flow->shared);
    if (code)
        return code;
    lay_shared(&state->head, state->flow->shared, &arrays);
    open_shared(state->flow, &state->head, &arrays);
    open_shapes(state->flow, arrays);
    return DUITE_OK;
}

/* ---- Dealing ---- */

FLOW_KERNEL_IF(table_make, skin, FLOW_NO_PART, struct flow_block_args, (W(table), W_IF(skin)),
               .side_effects = 0)
{
    const struct flow *flow = flow_of(call);
    struct cloth_error error = {0};
    if (!flow->source.side)
        return duite_fail(call, FLOW_NO_MEMORY, "rank %d: %s", call->rank, flow->trouble.text);
    flow_source_table(&flow->source, on->args->block, on->table);
    if (on->skin && flow_source_skin(&flow->source, on->args->block, on->skin, &error))
        return duite_fail(call, FLOW_NO_MEMORY, "rank %d: %s", call->rank, error.text);
    return 0;
}

/* Does nothing: the rank that writes an object last holds it. */
FLOW_KERNEL_IF(table_keep, skin, FLOW_NO_PART, struct flow_block_args, (RW(table), RW_IF(skin)),
               .side_effects = 0)
{
    (void)call, (void)on;
    return 0;
}

static void distribute(struct flow_state *state, uint32_t from, uint32_t to)
{
    struct flow_block_args args = {.block = from};
    for (; args.block < to; args.block++) {
        flow_fork_at(state, 0, &flow_kernel_table_make, &args, NULL);
        flow_fork_one(state, &flow_kernel_table_keep, &args);
    }
    flow_noted(state, duite_wait(state->rt));
}

static void forget_source(struct flow_state *state)
{
    struct flow *flow = state->flow;
    flow->vertex = flow->source.blocks.vertex;
    flow->source.blocks.vertex = NULL;
    flow->names = flow->source.names;
    flow->source.names = (struct flow_names){0};
    flow->attached = flow->source.particles.attached;
    flow->source.particles.attached = NULL;
    flow->watched = flow->source.watched;
    flow->source.watched = (struct flow_watched){0};
    flow_source_free(&flow->source);
    const struct flow_progress *progress = state->flow->progress;
    if (progress && progress->distributed)
        progress->distributed(progress->context);
}

int flow_distribute(struct flow_state *state)
{
    struct flow *flow = state->flow;
    const uint32_t n = flow->tables.n_blocks, part = n / GROUPS + 1;
    const uint32_t group = part > GROUP ? part : GROUP;
    const bool makes = duite_rank(state->rt) == 0;
    for (uint32_t from = 0; from < n && !state->code; from += group) {
        const uint32_t to = from + (uint32_t)cloth_smaller(group, n - from);
        if (makes) /* tasks report its failures */
            flow_source_gather(&flow->source, from, to, &flow->trouble);
        for (uint32_t b = from; b < to && !state->code; b += TRAVEL)
            distribute(state, b, b + (uint32_t)cloth_smaller(TRAVEL, to - b));
    }
    if (makes)
        forget_source(state);
    return state->code;
}
