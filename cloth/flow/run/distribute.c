/* Rank 0 alone knows the model. It broadcasts to all ranks the little that all need, and
 * distributes the tables of the blocks to the ranks that keep them. Rank 0 makes each table when
 * its turn comes. A task where the block lives takes it over, and rank 0 frees it. A few are on
 * their way at any time, so that rank 0 never holds more than its own and those. */
#include "cloth/flow/checkpoint/checkpoint.h"
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/run/setup.h"
#include "cloth/flow/state/bodies.h"

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

/* ---- Broadcasts ---- */

/* Frictions of all sides; bytes of the marks of sides that do not meet. */
static size_t n_frictions(const struct model *model)
{
    return (size_t)model->n_cloths * ((size_t)model->n_cloths + model->n_obstacles);
}
static size_t apart_bytes(const struct model *model)
{
    return model->contact.apart.apart ? model->n_cloths * sizeof(uint32_t) + n_frictions(model) : 0;
}

FLOW_KERNEL(broadcast_head, FLOW_NO_PART, struct flow_block_args, (GIVEN_W(head)))
static int broadcast_head_body(const duite_call *call, const struct broadcast_head_fields *on)
{
    const struct flow *flow = flow_of(call);
    const struct flow_source *source = &flow->source;
    struct flow_head *head = on->head;
    memset(head, 0, sizeof *head);
    memcpy(&head->model, flow->model, sizeof head->model);
    head->n_steps = flow->n_steps;
    head->inertia = flow->inertia;
    head->release = flow->release;
    head->contact_stiffness = flow->contact_stiffness;
    head->vertex_mass = flow->vertex_mass;
    head->feels_contact = flow->feels_contact;
    head->partition_hash = flow->partition_hash;
    if (flow->from.bytes)
        head->resumed_bytes = ((const struct flow_saved *)flow->from.bytes)->main_bytes;
    head->n_vertices = flow->n_vertices;
    head->n_pieces = source->particles.n_pieces;
    head->n_ties = source->springs.n_timed;
    head->n_anchors = source->particles.n_anchors;
    head->n_triangles = flow->n_triangles;
    head->n_blocks = source->blocks.n_blocks;
    head->n_neighbours = source->neighbours.n_neighbours;
    head->n_ghosts = source->neighbours.n_ghosts;
    head->shared_bytes =
        flow->model->bodies.bytes + flow->model->n_obstacles * sizeof *flow->model->obstacles +
        flow->model->n_keys * sizeof *flow->model->keys +
        flow->model->n_motions * sizeof *flow->model->motions +
        n_frictions(flow->model) * sizeof *flow->friction + apart_bytes(flow->model) +
        head->n_anchors * sizeof *flow->anchor +
        flow->model->n_sliders * sizeof *flow->model->sliders +
        flow->model->n_curve_keys * sizeof *flow->model->curve_keys +
        flow->model->n_curves * sizeof *flow->model->curves +
        head->n_ties * sizeof(struct flow_tie) + head->n_blocks * (SHAPE + sizeof(uint32_t)) +
        (3 * (uint64_t)head->n_neighbours + head->n_ghosts) * sizeof(uint32_t);
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
    return 0;
}

static char *distribute_put_bytes(char *to, const void *from, size_t bytes)
{
    if (bytes)
        memcpy(to, from, bytes);
    return to + bytes;
}

static char *put_frictions(char *to, const struct model *model)
{
    for (uint32_t c = 0; c < model->n_cloths; c++)
        for (uint32_t i = 0; i < model->n_cloths + model->n_obstacles; i++) {
            const double friction =
                model_meets(model, c, i) ? model_friction(model, c, i) : FLOW_APART;
            to = distribute_put_bytes(to, &friction, sizeof friction);
        }
    return to;
}

static char *distribute_put_ties(char *to, const struct flow_source *source)
{
    for (uint32_t i = 0; i < source->springs.n_timed; i++) {
        const struct flow_tie tie = flow_joints_tie(source, source->springs.timed + i);
        to = distribute_put_bytes(to, &tie, sizeof tie);
    }
    return to;
}

/* Packs everything but blocks. */
static char *put_model(char *to, const struct flow *flow)
{
    const struct model *model = flow->model;
    const struct flow_source *source = &flow->source;
    to = distribute_put_bytes(to, model->bodies.memory,
                              model->bodies.bytes); /* first, as it is aligned */
    to = distribute_put_bytes(to, model->obstacles, model->n_obstacles * sizeof *model->obstacles);
    to = distribute_put_bytes(to, model->keys, model->n_keys * sizeof *model->keys);
    to = distribute_put_bytes(to, model->sliders, model->n_sliders * sizeof *model->sliders);
    to = distribute_put_bytes(to, model->curve_keys,
                              model->n_curve_keys * sizeof *model->curve_keys);
    to = distribute_put_bytes(to, model->curves, model->n_curves * sizeof *model->curves);
    to = distribute_put_bytes(to, model->motions, model->n_motions * sizeof *model->motions);
    to = put_frictions(to, model);
    to = distribute_put_bytes(to, source->particles.anchor,
                              source->particles.n_anchors * sizeof *source->particles.anchor);
    return distribute_put_ties(to, source);
}

static char *put_blocks(char *to, const struct flow_source *source)
{
    const uint32_t n_blocks = source->blocks.n_blocks;
    const struct flow_neighbours *all = &source->neighbours;
    for (uint32_t b = 0; b < n_blocks; b++)
        to = distribute_put_bytes(to, source->shape + b, SHAPE);
    to = distribute_put_bytes(to, all->neighbour, all->n_neighbours * sizeof *all->neighbour);
    to = distribute_put_bytes(to, all->ghost_start,
                              ((size_t)all->n_neighbours + n_blocks) * sizeof *all->ghost_start);
    to = distribute_put_bytes(to, all->ghost, all->n_ghosts * sizeof *all->ghost);
    return distribute_put_bytes(to, all->joins, all->n_neighbours * sizeof *all->joins);
}

FLOW_KERNEL(broadcast_shared, FLOW_NO_PART, struct flow_block_args, (GIVEN_W(shared)))
static int broadcast_shared_body(const duite_call *call, const struct broadcast_shared_fields *on)
{
    const struct flow *flow = flow_of(call);
    const struct contact_apart *apart = &flow->model->contact.apart;
    char *to = put_model(on->shared, flow);
    to = put_blocks(to, &flow->source);
    if (apart->apart) {
        to = distribute_put_bytes(to, apart->end, flow->model->n_cloths * sizeof *apart->end);
        distribute_put_bytes(to, apart->apart, n_frictions(flow->model));
    }
    return 0;
}

/* Gives all ranks an object of so many bytes, which a task on rank 0 writes. */
static int broadcast_all(struct flow_state *state, const struct flow_kernel *kernel, size_t bytes,
                         void *received)
{
    const struct flow_block_args all = {0};
    duite_object object;
    int code = duite_new(state->rt, DUITE_BYTE, bytes, &object);
    if (!code)
        code = flow_fork_given_at(state, 0, kernel, &all, &(struct flow_given){.one = &object});
    if (!code)
        code = duite_get(state->rt, object, received);
    const int freed = object.generation ? duite_free(state->rt, object) : DUITE_OK;
    return code ? code : freed;
}

int flow_share_head(struct flow_state *state)
{
    struct flow *flow = state->flow;
    const struct flow_head *head = &state->head;
    const int code = broadcast_all(state, &flow_kernel_broadcast_head, sizeof *head, &state->head);
    flow->n_ties = code ? 0 : head->n_ties;
    if (code || duite_rank(state->rt) == 0)
        return code;
    flow->received = head->model;
    flow->received.name = flow->received.h_place = flow->received.fps_place = NULL;
    flow->received.hdf5_place = NULL;
    flow->received.n_materials = flow->received.n_cloths = 0;
    flow->received.n_joints = flow->received.n_welds = 0;
    flow->received.materials = NULL;
    flow->received.cloths = NULL;
    flow->received.obstacles = NULL;
    flow->received.obstacle_names = NULL;
    flow->received.contact.n_pairs = 0;
    flow->received.contact.pairs = NULL;
    flow->received.contact.apart.joined = NULL;
    flow->received.contact.apart.end = NULL;
    flow->received.bodies.memory = NULL;
    flow->received.joints = NULL;
    flow->received.welds = NULL;
    flow->received.probes = NULL;
    flow->received.keys = NULL;
    flow->received.motions = NULL;
    flow->received.sliders = NULL;
    flow->received.curve_keys = NULL;
    flow->received.curves = NULL;
    flow->model = &flow->received;
    flow->n_steps = head->n_steps;
    flow->inertia = head->inertia;
    flow->release = head->release;
    flow->contact_stiffness = head->contact_stiffness;
    flow->vertex_mass = head->vertex_mass;
    flow->feels_contact = head->feels_contact;
    flow->partition_hash = head->partition_hash;
    flow->n_vertices = head->n_vertices;
    flow->n_triangles = head->n_triangles;
    return DUITE_OK;
}

/* Unpacks everything but blocks. Returns its end. */
static const void *unpack_model(struct flow_state *state)
{
    struct flow *flow = state->flow;
    flow->received.bodies.memory = flow->shared;
    flow->received.obstacles = (void *)((char *)flow->shared + flow->model->bodies.bytes);
    flow->received.keys = (void *)(flow->received.obstacles + flow->model->n_obstacles);
    flow->received.sliders = (void *)(flow->received.keys + flow->model->n_keys);
    flow->received.curve_keys = (void *)(flow->received.sliders + flow->model->n_sliders);
    flow->received.curves = (void *)(flow->received.curve_keys + flow->model->n_curve_keys);
    flow->received.motions = (void *)(flow->received.curves + flow->model->n_curves);
    flow->friction = (const void *)(flow->received.motions + flow->model->n_motions);
    flow->n_cloths = state->head.model.n_cloths;
    flow->n_anchors = state->head.n_anchors;
    flow->anchor = (const void *)(flow->friction + n_frictions(&state->head.model));
    flow->tie = (const void *)(flow->anchor + flow->n_anchors);
    return flow->tie + flow->n_ties;
}

static void unpack(struct flow_state *state)
{
    struct flow *flow = state->flow;
    struct flow_tables *tables = &flow->tables;
    const char *shape = unpack_model(state);
    const uint32_t *neighbour = (const void *)(shape + tables->n_blocks * SHAPE);
    const uint32_t *ghost_start = neighbour + state->head.n_neighbours;
    const uint32_t *ghost = ghost_start + state->head.n_neighbours + tables->n_blocks;
    const uint32_t *joins = ghost + state->head.n_ghosts;
    uint32_t first = 0;
    if (state->head.model.contact.apart.apart) {
        flow->received.contact.apart.end = (void *)(joins + state->head.n_neighbours);
        flow->received.contact.apart.apart =
            (void *)(joins + state->head.n_neighbours + flow->n_cloths);
    }
    tables->neighbour = neighbour;
    tables->ghost = ghost;
    for (uint32_t b = 0; b < tables->n_blocks; b++) {
        struct flow_table *table = tables->block + b;
        *table = (struct flow_table){
            .joins = joins, .neighbour = neighbour, .ghost_start = ghost_start, .ghost = ghost};
        memcpy(table, shape + b * SHAPE, SHAPE);
        table->first = first;
        table->format = flow->model->format;
        joins += table->n_neighbours;
        first += table->n;
        neighbour += table->n_neighbours;
        ghost_start += table->n_neighbours + 1;
        ghost += table->n_ghosts;
    }
}

int flow_share(struct flow_state *state)
{
    const int code = broadcast_all(state, &flow_kernel_broadcast_shared, state->head.shared_bytes,
                                   state->flow->shared);
    if (!code)
        unpack(state);
    return code;
}

/* ---- Dealing ---- */

FLOW_KERNEL(table_make, FLOW_NO_PART, struct flow_block_args, (W(table)))
static int table_make_body(const duite_call *call, const struct table_make_fields *on)
{
    const struct flow *flow = flow_of(call);
    if (!flow->source.side)
        return duite_fail(call, FLOW_NO_MEMORY, "rank %d: %s", call->rank, flow->trouble.text);
    flow_source_table(&flow->source, on->args->block, on->table);
    return 0;
}

/* Does nothing: the rank that writes an object last holds it. */
FLOW_KERNEL(table_keep, FLOW_NO_PART, struct flow_block_args, (RW(table)))
static int table_keep_body(const duite_call *call, const struct table_keep_fields *on)
{
    (void)call, (void)on;
    return 0;
}

FLOW_KERNEL(skin_make, FLOW_NO_PART, struct flow_block_args, (W(skin)))
static int skin_make_body(const duite_call *call, const struct skin_make_fields *on)
{
    struct cloth_error error = {0};
    if (flow_source_skin(&flow_of(call)->source, on->args->block, on->skin, &error))
        return duite_fail(call, FLOW_NO_MEMORY, "rank %d: %s", call->rank, error.text);
    return 0;
}

FLOW_KERNEL(skin_keep, FLOW_NO_PART, struct flow_block_args, (RW(skin)))
static int skin_keep_body(const duite_call *call, const struct skin_keep_fields *on)
{
    (void)call, (void)on;
    return 0;
}

static int distribute(struct flow_state *state, uint32_t from, uint32_t to)
{
    const bool skins = model_seeks(state->flow->model);
    struct flow_block_args args = {.block = from};
    int code = DUITE_OK;
    for (; args.block < to && !code; args.block++) {
        code = flow_fork_at(state, 0, &flow_kernel_table_make, &args, NULL);
        if (!code)
            code = flow_fork_one(state, &flow_kernel_table_keep, &args);
        if (!code && skins)
            code = flow_fork_at(state, 0, &flow_kernel_skin_make, &args, NULL);
        if (!code && skins)
            code = flow_fork_one(state, &flow_kernel_skin_keep, &args);
    }
    const int failed = duite_wait(state->rt);
    return code ? code : failed;
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
    int code = DUITE_OK;
    for (uint32_t from = 0; from < n && !code; from += group) {
        const uint32_t to = from + (uint32_t)cloth_smaller(group, n - from);
        if (makes) /* tasks report its failures */
            flow_source_gather(&flow->source, from, to, &flow->trouble);
        for (uint32_t b = from; b < to && !code; b += TRAVEL)
            code = distribute(state, b, b + (uint32_t)cloth_smaller(TRAVEL, to - b));
    }
    if (makes)
        forget_source(state);
    return code;
}
