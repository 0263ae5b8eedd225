/* Rank 0 alone knows the model. It tells all ranks the little that all need, and deals the tables
 * of the blocks to the ranks that keep them: each is made when its turn comes, and is gone from
 * rank 0 when a task where its block lives has taken it over. A few are on their way at any time,
 * so that rank 0 never holds more than its own and those. */
#include "cloth/flow/bodies.h"
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/setup/setup.h"

#include <string.h>

enum {
    GROUPS = 4,  /* times that rank 0 goes through all springs, with the sides of as many blocks */
    GROUP = 32,  /* blocks that a group has at least */
    TRAVEL = 16, /* tables on their way */
    KEYS = sizeof(struct flow_args)
};

/* What is told of a block; the neighbours of all blocks follow. */
struct shape {
    uint32_t n, n_inner, n_cut, n_entries, n_cut_entries, n_rim, n_held, lowest, highest;
    uint32_t joined, rim_start[SOLVE_MOST_PATCHES + 1];
    uint32_t n_watched, n_moved, n_guided, n_loose, n_varying, n_slots, n_copies, n_stiff,
        n_elements[ELEMENT_KINDS], n_materials;
};

/* ---- Telling ---- */

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

static int tell_head(const duite_call *call)
{
    const struct flow *flow = flow_of(call);
    const struct flow_source *source = &flow->source;
    struct flow_head *head = duite_out(call, 0, struct flow_head);
    memset(head, 0, sizeof *head);
    memcpy(&head->model, flow->model, sizeof head->model);
    head->n_steps = flow->n_steps;
    head->inertia = flow->inertia;
    head->release = flow->release;
    head->partition_hash = flow->partition_hash;
    head->n_vertices = flow->n_vertices;
    head->n_pieces = source->particles.n_pieces;
    head->n_triangles = flow->n_triangles;
    head->n_blocks = source->blocks.n_blocks;
    head->n_slots = source->neighbours.n_slots;
    head->n_copies = source->neighbours.n_copies;
    head->shared_bytes = flow->model->n_obstacles * sizeof *flow->model->obstacles +
                         flow->model->n_keys * sizeof *flow->model->keys +
                         flow->model->n_motions * sizeof *flow->model->motions +
                         flow->model->n_guides * sizeof *flow->model->guides +
                         flow->model->n_beats * sizeof *flow->model->beats +
                         flow->model->n_courses * sizeof *flow->model->courses +
                         head->n_blocks * (sizeof(struct shape) + sizeof(uint32_t)) +
                         (3 * (uint64_t)head->n_slots + head->n_copies) * sizeof(uint32_t);
    for (uint32_t b = 0; b < head->n_blocks; b++) {
        const struct flow_table *t = source->shape + b;
        head->most_rows = larger(t->n, head->most_rows);
        head->most_slots = larger(t->n_slots, head->most_slots);
        head->most_rim = larger(t->n_rim, head->most_rim);
        head->most_copies = larger(t->n_copies, head->most_copies);
        for (int kind = 0; kind < ELEMENT_KINDS; kind++)
            head->n_elements += t->n_elements[kind];
        head->most_entries = larger(t->n_entries + t->n_cut_entries, head->most_entries);
    }
    return 0;
}
const duite_kernel flow_tell_head = {
    .name = "tell_head", .body = tell_head, .access = {DUITE_W}, .args_size = KEYS};

static char *put(char *to, const void *from, size_t bytes)
{
    if (bytes)
        memcpy(to, from, bytes);
    return to + bytes;
}

static int tell_shared(const duite_call *call)
{
    const struct flow *flow = flow_of(call);
    const struct flow_source *source = &flow->source;
    char *to = duite_out(call, 0, char);
    const struct model *model = flow->model;
    to = put(to, model->obstacles, model->n_obstacles * sizeof *model->obstacles);
    to = put(to, model->keys, model->n_keys * sizeof *model->keys);
    to = put(to, model->guides, model->n_guides * sizeof *model->guides);
    to = put(to, model->beats, model->n_beats * sizeof *model->beats);
    to = put(to, model->courses, model->n_courses * sizeof *model->courses);
    to = put(to, model->motions, model->n_motions * sizeof *model->motions);
    for (uint32_t b = 0; b < source->blocks.n_blocks; b++) {
        const struct flow_table *t = source->shape + b;
        struct shape shape = {.n = t->n,
                              .n_inner = t->n_inner,
                              .n_cut = t->n_cut,
                              .n_entries = t->n_entries,
                              .n_cut_entries = t->n_cut_entries,
                              .n_rim = t->n_rim,
                              .n_held = t->n_held,
                              .n_watched = t->n_watched,
                              .n_moved = t->n_moved,
                              .n_guided = t->n_guided,
                              .n_loose = t->n_loose,
                              .n_varying = t->n_varying,
                              .lowest = t->lowest,
                              .highest = t->highest,
                              .n_slots = t->n_slots,
                              .n_copies = t->n_copies,
                              .n_stiff = t->n_stiff,
                              .n_materials = t->n_materials,
                              .joined = t->joined};
        memcpy(shape.n_elements, t->n_elements, sizeof shape.n_elements);
        memcpy(shape.rim_start, t->rim_start, sizeof shape.rim_start);
        to = put(to, &shape, sizeof shape);
    }
    const struct flow_neighbours *all = &source->neighbours;
    to = put(to, all->slot, all->n_slots * sizeof *all->slot);
    to = put(to, all->copies,
             ((size_t)all->n_slots + source->blocks.n_blocks) * sizeof *all->copies);
    to = put(to, all->copy, all->n_copies * sizeof *all->copy);
    put(to, all->joins, all->n_slots * sizeof *all->joins);
    return 0;
}
const duite_kernel flow_tell_shared = {
    .name = "tell_shared", .body = tell_shared, .access = {DUITE_W}, .args_size = KEYS};

/* What a task on rank 0 writes into an object of so many bytes, to all ranks. */
static int tell_all(struct flow_state *state, const duite_kernel *kernel, size_t bytes, void *told)
{
    const struct flow_args args = {0};
    duite_object object;
    int code = duite_new(state->rt, DUITE_BYTE, bytes, &object);
    if (!code)
        code = duite_fork_at(state->rt, 0, kernel, &args, 1, &object);
    if (!code)
        code = duite_get(state->rt, object, told);
    const int freed = object.generation ? duite_free(state->rt, object) : DUITE_OK;
    return code ? code : freed;
}

int flow_share_head(struct flow_state *state)
{
    struct flow *flow = state->flow;
    const struct flow_head *head = &state->head;
    const int code = tell_all(state, &flow_tell_head, sizeof *head, &state->head);
    if (code || duite_rank(state->rt) == 0)
        return code;
    flow->told = head->model;
    flow->told.name = flow->told.h_place = flow->told.fps_place = NULL;
    flow->told.n_materials = flow->told.n_cloths = 0;
    flow->told.n_joints = flow->told.n_welds = 0;
    flow->told.materials = NULL;
    flow->told.cloths = NULL;
    flow->told.obstacles = NULL;
    flow->told.joints = NULL;
    flow->told.welds = NULL;
    flow->told.probes = NULL;
    flow->told.keys = NULL;
    flow->told.motions = NULL;
    flow->told.guides = NULL;
    flow->told.beats = NULL;
    flow->told.courses = NULL;
    flow->model = &flow->told;
    flow->n_steps = head->n_steps;
    flow->inertia = head->inertia;
    flow->release = head->release;
    flow->partition_hash = head->partition_hash;
    flow->n_vertices = head->n_vertices;
    flow->n_triangles = head->n_triangles;
    return DUITE_OK;
}

static void unpack(struct flow_state *state)
{
    struct flow *flow = state->flow;
    struct flow_tables *tables = &flow->tables;
    flow->told.obstacles = flow->shared;
    flow->told.keys = (void *)(flow->told.obstacles + flow->model->n_obstacles);
    flow->told.guides = (void *)(flow->told.keys + flow->model->n_keys);
    flow->told.beats = (void *)(flow->told.guides + flow->model->n_guides);
    flow->told.courses = (void *)(flow->told.beats + flow->model->n_beats);
    flow->told.motions = (void *)(flow->told.courses + flow->model->n_courses);
    const struct shape *shape = (const void *)(flow->told.motions + flow->model->n_motions);
    const uint32_t *slot = (const void *)(shape + tables->n_blocks);
    const uint32_t *copies = slot + state->head.n_slots;
    const uint32_t *copy = copies + state->head.n_slots + tables->n_blocks;
    const uint32_t *joins = copy + state->head.n_copies;
    uint32_t first = 0;
    tables->slot = slot;
    tables->copy = copy;
    for (uint32_t b = 0; b < tables->n_blocks; b++, shape++) {
        tables->block[b] = (struct flow_table){.n = shape->n,
                                               .first = first,
                                               .n_inner = shape->n_inner,
                                               .n_cut = shape->n_cut,
                                               .n_entries = shape->n_entries,
                                               .n_cut_entries = shape->n_cut_entries,
                                               .format = flow->model->format,
                                               .n_rim = shape->n_rim,
                                               .n_held = shape->n_held,
                                               .n_watched = shape->n_watched,
                                               .n_moved = shape->n_moved,
                                               .n_guided = shape->n_guided,
                                               .n_loose = shape->n_loose,
                                               .n_varying = shape->n_varying,
                                               .lowest = shape->lowest,
                                               .highest = shape->highest,
                                               .n_slots = shape->n_slots,
                                               .n_copies = shape->n_copies,
                                               .n_stiff = shape->n_stiff,
                                               .n_materials = shape->n_materials,
                                               .joined = shape->joined,
                                               .joins = joins,
                                               .slot = slot,
                                               .copies = copies,
                                               .copy = copy};
        memcpy(tables->block[b].n_elements, shape->n_elements, sizeof shape->n_elements);
        memcpy(tables->block[b].rim_start, shape->rim_start, sizeof shape->rim_start);
        joins += shape->n_slots;
        first += shape->n;
        slot += shape->n_slots;
        copies += shape->n_slots + 1;
        copy += shape->n_copies;
    }
}

int flow_share(struct flow_state *state)
{
    const int code =
        tell_all(state, &flow_tell_shared, state->head.shared_bytes, state->flow->shared);
    if (!code)
        unpack(state);
    return code;
}

/* ---- Dealing ---- */

FLOW_KERNEL(table_make, FLOW_NO_PART, struct flow_args, (W(table)))
static int table_make_body(const duite_call *call, const struct table_make_fields *on)
{
    const struct flow *flow = flow_of(call);
    if (!flow->source.side)
        return duite_fail(call, FLOW_NO_MEMORY, "rank %d: %s", call->rank, flow->trouble.text);
    flow_source_table(&flow->source, on->args->block, on->table);
    return 0;
}

/* Nothing is to be done but to have it: who writes an object last holds it. */
FLOW_KERNEL(table_keep, FLOW_NO_PART, struct flow_args, (RW(table)))
static int table_keep_body(const duite_call *call, const struct table_keep_fields *on)
{
    (void)call, (void)on;
    return 0;
}

static int deal(struct flow_state *state, uint32_t from, uint32_t to)
{
    struct flow_args args = {.block = from};
    int code = DUITE_OK;
    for (; args.block < to && !code; args.block++) {
        code = flow_fork_at(state, 0, &flow_kernel_table_make, &args, NULL);
        if (!code)
            code = flow_fork_one(state, &flow_kernel_table_keep, &args);
    }
    const int failed = duite_wait(state->rt);
    return code ? code : failed;
}

static uint32_t smaller(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static void forget_source(struct flow_state *state)
{
    struct flow *flow = state->flow;
    flow->vertex = flow->source.blocks.vertex;
    flow->source.blocks.vertex = NULL;
    flow->names = flow->source.names;
    flow->source.names = (struct flow_names){0};
    flow->watched = flow->source.watched;
    flow->source.watched = (struct flow_watched){0};
    flow_source_free(&flow->source);
    const struct flow_progress *progress = state->flow->progress;
    if (progress && progress->dealt)
        progress->dealt(progress->context);
}

int flow_deal(struct flow_state *state)
{
    struct flow *flow = state->flow;
    const uint32_t n = flow->tables.n_blocks, part = n / GROUPS + 1;
    const uint32_t group = part > GROUP ? part : GROUP;
    const bool makes = duite_rank(state->rt) == 0;
    int code = DUITE_OK;
    for (uint32_t from = 0; from < n && !code; from += group) {
        const uint32_t to = from + smaller(group, n - from);
        if (makes) /* what fails here, the tasks say */
            flow_source_gather(&flow->source, from, to, &flow->trouble);
        for (uint32_t b = from; b < to && !code; b += TRAVEL)
            code = deal(state, b, b + smaller(TRAVEL, to - b));
    }
    if (makes)
        forget_source(state);
    return code;
}
