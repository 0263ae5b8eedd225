/* The main program once more: its words are read in order, and homes given by the same code that
 * gives them in a run. Slots of the trace stand for what was made in them last. */
#include "runtime/predict/program.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/map/map.h"

#include <stdlib.h>
#include <string.h>

/* ---- Words ---- */

static uint32_t word(struct predict_program *p)
{
    p->short_of |= p->at >= p->graph->run->n_words;
    return p->short_of ? 0 : p->graph->run->word[p->at++];
}

static uint64_t word2(struct predict_program *p)
{
    uint64_t low = word(p);
    return low | (uint64_t)word(p) << 32;
}

static double number(struct predict_program *p)
{
    uint64_t bits = word2(p);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static float small(struct predict_program *p)
{
    uint32_t bits = word(p);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* ---- Objects ---- */

enum { MOST_SLOTS = 1 << 28 };

static uint32_t *slot_of(struct predict_program *p, uint32_t slot)
{
    static uint32_t none;
    if (slot >= MOST_SLOTS) {
        p->damaged = true;
        return &none;
    }
    size_t before = p->slots_capacity;
    if (slot >= p->slots_capacity) {
        void *moved = base_grow(p->slot, &p->slots_capacity, (size_t)slot + 1, sizeof *p->slot);
        p->graph->failed |= !moved;
        if (!moved)
            return &none;
        p->slot = moved;
        memset(p->slot + before, 0xff, (p->slots_capacity - before) * sizeof *p->slot);
    }
    return &p->slot[slot];
}

/* The object that a slot names. */
static uint32_t object(struct predict_program *p, uint32_t slot)
{
    uint32_t found = *slot_of(p, slot);
    p->damaged |= found >= p->graph->n_objects;
    return found < p->graph->n_objects ? found : 0;
}

static void make(struct predict_program *p, bool view)
{
    struct predict_graph *graph = p->graph;
    uint32_t slot = word(p), parent = view ? object(p, word(p)) : PREDICT_NONE;
    uint64_t bytes = word2(p);
    void *moved = base_grow(graph->object, &graph->objects_capacity, graph->n_objects + 1,
                            sizeof *graph->object);
    duite_object *names =
        base_grow(p->name, &p->names_capacity, graph->n_objects + 1, sizeof *p->name);
    if (moved)
        graph->object = moved;
    if (names)
        p->name = names;
    if (!moved || !names) {
        graph->failed = true;
        return;
    }
    struct predict_object new = {.bytes = bytes,
                                 .writer = PREDICT_NONE,
                                 .readers = PREDICT_NONE,
                                 .copies = PREDICT_NONE,
                                 .leaves = PREDICT_NONE,
                                 .parent = parent,
                                 .gathered = PREDICT_NONE - 1};
    p->name[graph->n_objects] = DUITE_NO_OBJECT;
    if (view) {
        new.home = new.holder = graph->object[parent].home;
    } else if (p->maps && data_object_new(&p->table, DUITE_BYTE, 1, &p->name[graph->n_objects])) {
        graph->failed = true;
    }
    graph->object[graph->n_objects] = new;
    *slot_of(p, slot) = (uint32_t)graph->n_objects++;
}

static void drop(struct predict_program *p)
{
    uint32_t slot = word(p);
    duite_object name = p->name ? p->name[object(p, slot)] : DUITE_NO_OBJECT;
    if (name.slot)
        data_object_drop(&p->table, name);
    *slot_of(p, slot) = PREDICT_NONE;
}

static void hint(struct predict_program *p, size_t n)
{
    uint32_t slot = word(p);
    double weight = number(p);
    duite_object *names = malloc((n + 1) * sizeof *names);
    double *weights = malloc((n + 1) * sizeof *weights);
    p->graph->failed |= !names || !weights;
    for (size_t i = 0; i < n && !p->graph->failed && !p->short_of; i++) {
        uint32_t other = object(p, word(p));
        weights[i] = number(p);
        if (p->maps && !p->damaged)
            names[i] = p->name[other];
    }
    if (p->maps && !p->graph->failed && !p->damaged && !p->short_of)
        p->code = map_hint(&p->table, p->name[object(p, slot)], weight, n, names, weights);
    free(names);
    free(weights);
}

static void follow(struct predict_program *p)
{
    uint32_t own = object(p, word(p)), leader = object(p, word(p));
    if (p->maps && !p->damaged)
        p->code = map_follow(&p->table, p->name[own], p->name[leader]);
}

/* What was traced; or, of objects that had none, what the mapping says. */
static void homes(struct predict_program *p, size_t n)
{
    struct predict_graph *graph = p->graph;
    if (p->maps)
        p->code = map_settle(&p->table, graph->cluster->mapping, graph->cluster->seed);
    for (size_t i = 0; i < n && !p->code && !p->short_of; i++) {
        uint32_t own = object(p, word(p)), home = word(p);
        if (p->damaged)
            return;
        struct predict_object *o = &graph->object[own];
        const struct data_object *settled = p->maps ? &p->table.object[p->name[own].slot] : NULL;
        bool moves = o->writer != PREDICT_NONE; /* by migration: not foretold with a mapping */
        if (settled && moves)
            continue;
        p->damaged |= home >= graph->run->n_ranks;
        o->home = settled ? settled->home : (int)(home % graph->cluster->hosts);
        o->block = settled ? settled->block : (uint32_t)own;
        if (!moves)
            o->holder = o->home;
    }
}

/* ---- Tasks ---- */

static duite_mode mode_of(const struct trace_kernel *kernel, size_t i)
{
    static const duite_mode same[] = {DUITE_NONE, DUITE_R, DUITE_W,  DUITE_RW, DUITE_CW,
                                      DUITE_R,    DUITE_W, DUITE_RW, DUITE_CW};
    uint8_t mode = i < kernel->fixed ? kernel->mode[i] : kernel->rest;
    return mode < sizeof same / sizeof same[0] ? same[mode] : DUITE_R;
}

/* The owner rule; `at` or everywhere. */
static int place(struct predict_program *p, const struct predict_fork *fork, uint32_t *block)
{
    const struct predict_graph *graph = p->graph;
    const struct trace_kernel *kernel = &graph->run->kernel[fork->kernel];
    uint32_t own = PREDICT_NONE;
    for (size_t i = 0; i < fork->n; i++) {
        duite_mode mode = mode_of(kernel, i);
        bool writes = mode == DUITE_W || mode == DUITE_RW;
        if (writes || (mode == DUITE_R && own == PREDICT_NONE))
            own = fork->object[i];
        if (writes)
            break;
    }
    *block = own == PREDICT_NONE ? (uint32_t)fork->number : graph->object[own].block;
    if (kernel->replicated)
        return PREDICT_ALL;
    if (fork->at >= 0)
        return fork->at % (int)graph->cluster->hosts;
    return own == PREDICT_NONE ? 0 : graph->object[own].home;
}

void predict_fork(struct predict_program *p, const struct predict_fork *fork)
{
    struct predict_graph *graph = p->graph;
    const struct trace_kernel *kernel = &graph->run->kernel[fork->kernel];
    uint32_t block;
    int host = place(p, fork, &block);
    double seconds;
    if (!predict_times_find(p->times, fork->number, &seconds))
        seconds = predict_times_kernel(p->times, fork->kernel);
    for (size_t i = 0; i < fork->n; i++)
        p->prepared[i] = predict_prepare(graph, fork->object[i], mode_of(kernel, i), host);
    bool all = host == PREDICT_ALL;
    uint32_t node = predict_add(
        graph, &(struct predict_node){.number = fork->number,
                                      .kernel = fork->kernel,
                                      .host = all ? 0 : (uint32_t)host,
                                      .block = block,
                                      .priority = fork->priority,
                                      .cost = fork->cost,
                                      .seconds = (float)(seconds / graph->cluster->core_speed),
                                      .kind = all && graph->cluster->hosts > 1 ? PREDICT_EVERYWHERE
                                                                               : PREDICT_TASK});
    if (graph->failed)
        return;
    graph->linked = false;
    for (size_t i = 0; i < fork->n; i++)
        predict_use(graph, node, fork->object[i], mode_of(kernel, i), p->prepared[i]);
    predict_hold(graph, node);
    p->tasks++;
}

void predict_set(struct predict_program *p, uint32_t own)
{
    struct predict_graph *graph = p->graph;
    predict_prepare(graph, own, DUITE_W, graph->object[own].home);
    uint32_t node =
        predict_add(graph, &(struct predict_node){.host = (uint32_t)graph->object[own].home,
                                                  .kind = PREDICT_INSTANT});
    if (graph->failed)
        return;
    graph->linked = false;
    predict_use(graph, node, own, DUITE_W, PREDICT_NONE);
    predict_hold(graph, node);
}

bool predict_room(struct predict_program *p, size_t n)
{
    uint32_t *prepared = base_grow(p->prepared, &p->prepared_capacity, n + 1, sizeof *p->prepared);
    uint32_t *objects = base_grow(p->objects, &p->objects_capacity, n + 1, sizeof *p->objects);
    if (prepared)
        p->prepared = prepared;
    if (objects)
        p->objects = objects;
    p->graph->failed |= !prepared || !objects;
    return prepared && objects;
}

static void fork_one(struct predict_program *p, size_t n, bool told)
{
    struct predict_fork fork = {.kernel = word(p), .n = n, .at = -1};
    if (told) {
        fork.at = (int32_t)word(p);
        fork.priority = (int32_t)word(p);
        fork.cost = small(p);
    }
    p->damaged |= fork.kernel >= p->graph->run->n_kernels;
    if (!predict_room(p, n) || p->damaged)
        return;
    for (size_t i = 0; i < n; i++)
        p->objects[i] = object(p, word(p));
    fork.object = p->objects;
    fork.number = ++p->forks;
    if (!p->damaged && !p->short_of)
        predict_fork(p, &fork);
}

/* ---- The main program ---- */

/* What was brought into being since the last op. */
static struct predict_op *add_op(struct predict_program *p, bool forked)
{
    struct predict_graph *graph = p->graph;
    void *moved = base_grow(graph->op, &graph->ops_capacity, graph->n_ops + 1, sizeof *graph->op);
    graph->failed |= !moved;
    if (!moved)
        return NULL;
    graph->op = moved;
    size_t begin = graph->n_ops ? graph->op[graph->n_ops - 1].end : 0;
    struct predict_op *op = &graph->op[graph->n_ops++];
    *op = (struct predict_op){.end = (uint32_t)graph->n_nodes, .node = PREDICT_NONE};
    op->each = forked ? 1 : 0;
    p->forked += forked ? graph->n_nodes - begin : 0;
    return op;
}

void predict_op_replays(struct predict_program *p, bool begins)
{
    add_op(p, begins);
}

/* It forked until `from`, and waits until `to`: each fork takes its share of the time. */
static void op(struct predict_program *p, uint64_t from, uint64_t to, uint32_t node, bool waits)
{
    struct predict_graph *graph = p->graph;
    struct predict_op *last = add_op(p, true);
    if (!last)
        return;
    last->node = node;
    last->waits = waits;
    double tick = graph->run->rank[0].header->tick / graph->cluster->core_speed;
    double seconds = from > p->since ? tick * (double)(from - p->since) : 0;
    for (size_t i = p->first_op; i < graph->n_ops; i++)
        graph->op[i].each *= p->forked ? seconds / (double)p->forked : 0;
    p->first_op = graph->n_ops;
    p->forked = 0;
    p->since = to;
}

static void get(struct predict_program *p)
{
    uint32_t own = object(p, word(p));
    int rank = (int32_t)word(p);
    uint64_t from = word2(p), to = word2(p);
    if (p->damaged || p->short_of)
        return;
    int host = rank < 0 ? PREDICT_ALL : rank % (int)p->graph->cluster->hosts;
    uint32_t node = predict_prepare(p->graph, own, DUITE_R, host);
    op(p, from, to, node, host <= 0 && node != PREDICT_NONE);
}

static void wait(struct predict_program *p)
{
    uint64_t from = word2(p), to = word2(p);
    op(p, from, to, PREDICT_NONE, true);
}

static void turn(struct predict_program *p, bool on)
{
    p->forks = word2(p);
    word2(p);
    uint64_t now = word2(p);
    if (!on)
        op(p, now, now, PREDICT_NONE, true);
    p->since = now;
}

static void entry(struct predict_program *p)
{
    uint32_t first = word(p);
    size_t n = first >> 8;
    switch (first & 0xff) {
    case TRACE_OBJECT:
    case TRACE_VIEW:
        make(p, (first & 0xff) == TRACE_VIEW);
        break;
    case TRACE_FREE:
        drop(p);
        break;
    case TRACE_HINT:
        hint(p, n);
        break;
    case TRACE_FOLLOW:
        follow(p);
        break;
    case TRACE_HOMES:
        homes(p, n);
        break;
    case TRACE_ON:
    case TRACE_OFF:
        turn(p, (first & 0xff) == TRACE_ON);
        break;
    case TRACE_FORK:
    case TRACE_FORKED:
        fork_one(p, n, (first & 0xff) == TRACE_FORKED);
        break;
    case TRACE_SET: {
        uint32_t own = object(p, word(p));
        if (!p->damaged)
            predict_set(p, own);
        break;
    }
    case TRACE_GET:
        get(p);
        break;
    case TRACE_WAIT:
        wait(p);
        break;
    case TRACE_GRAPH:
        predict_take_graph(p, n);
        break;
    case TRACE_REPLAY:
        predict_replay(p, n);
        break;
    default:
        p->damaged = true;
    }
}

uint32_t predict_word(struct predict_program *p)
{
    return word(p);
}

float predict_float(struct predict_program *p)
{
    return small(p);
}

uint64_t predict_word2(struct predict_program *p)
{
    return word2(p);
}

uint32_t predict_object_at(struct predict_program *p, uint32_t slot)
{
    return object(p, slot);
}

/* ---- All of it ---- */

static int walk(struct predict_program *p)
{
    struct predict_graph *graph = p->graph;
    while (p->at < graph->run->n_words && !p->damaged && !graph->failed && !p->code)
        entry(p);
    if (graph->failed)
        return base_no_memory("the graph of a trace");
    if (p->code)
        return p->code;
    if (p->damaged || p->short_of)
        return base_error(DUITE_E_ARGUMENT,
                          "the trace is damaged: word %zu of its program cannot be", p->at);
    if (!p->tasks)
        return base_error(DUITE_E_ARGUMENT, "the trace has no tasks of the main program");
    op(p, p->since, p->since, PREDICT_NONE, true);
    return graph->failed ? base_no_memory("the graph of a trace") : DUITE_OK;
}

static bool prepare(struct predict_program *p)
{
    struct predict_graph *graph = p->graph;
    const uint32_t hosts = graph->cluster->hosts;
    p->maps = graph->cluster->mapping != NULL;
    p->times = predict_times_new(graph->run);
    graph->piece = base_alloc(hosts * sizeof *graph->piece);
    graph->began = base_alloc(hosts * sizeof *graph->began);
    graph->round = PREDICT_NONE;
    graph->flag = PREDICT_NONE;
    if (!p->times || !graph->piece || !graph->began ||
        (p->maps && data_table_start(&p->table, (int)hosts)))
        return false;
    for (uint32_t kind = 0; kind < sizeof graph->own / sizeof graph->own[0]; kind++)
        graph->own[kind] = predict_times_own(p->times, kind) / graph->cluster->core_speed;
    graph->overhead = graph->cluster->overhead < 0
                          ? predict_times_gap(p->times) / graph->cluster->core_speed
                          : graph->cluster->overhead;
    return true;
}

int predict_build(struct predict_graph *graph)
{
    struct predict_program p = {.graph = graph};
    int code = prepare(&p) ? walk(&p) : base_no_memory("the graph of a trace");
    graph->n_tasks = p.tasks;
    if (p.maps)
        data_table_stop(&p.table);
    predict_times_free(p.times);
    predict_graphs_free(&p);
    free(p.slot);
    free(p.name);
    free(p.prepared);
    free(p.objects);
    return code;
}
