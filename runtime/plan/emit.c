/* Emitting: from a round in its intermediate form to the flat arrays of a plan. A plan is written
 * once, here; afterwards only bindings, arguments and replays change it. It lives as long as its
 * record or a replay of it. */
#include "runtime/plan/plan.h"
#include "runtime/task/event.h"
#include "runtime/task/ready.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/data/object.h"

#include <string.h>

/* The mode of a whole replay on one rank. */
static duite_mode emit_mode(const struct plan_recorded_object *object)
{
    if (!object->written && !object->sums)
        return DUITE_R;
    return object->reads_old ? DUITE_RW : DUITE_W;
}

/* The inputs of a plan. */
struct emit {
    const struct plan_record *record;
    const duite_object *flag;
    const struct plan_round *round; /* with several ranks: this rank's part */
    const float *path;              /* by fork, or NULL: not wanted */
};

static void emit_places(struct plan *plan, const struct emit *from)
{
    const struct plan_record *record = from->record;
    const struct plan_round *round = from->round;
    for (size_t i = 0; i < record->n_objects; i++) {
        const struct plan_recorded_object *object = &record->object[i];
        plan->place[i] = (struct plan_place){
            .type = object->type, .mode = emit_mode(object), .count = object->count};
    }
    if (plan->n_objects > record->n_objects) {
        const struct data_object *object = &record->graph->table.object[from->flag->slot];
        plan->place[record->n_objects] =
            (struct plan_place){.type = object->type, .mode = DUITE_R, .count = object->count};
    }
    for (size_t i = 0; i < plan->n_objects && plan->words; i++)
        plan->place[i].mode = plan_mode(plan, i);
    for (size_t i = plan->n_objects; i < plan->n_places; i++) {
        const struct plan_place *whole = &plan->place[round->place[i].object];
        plan->place[i] = (struct plan_place){
            .type = whole->type, .count = whole->count, .law = round->place[i].law};
    }
    for (size_t i = 0; i < plan->n_places; i++)
        plan->place[i].bytes = plan->place[i].count * data_type_size(plan->place[i].type);
}

/* Buffers for all places in use, except objects with values from outside. */
static bool emit_buffers(struct plan *plan)
{
    for (size_t i = 0; i < plan->n_uses; i++)
        plan->place[plan->use[i].place].n_params++;
    for (int fill = 0; fill < 2; fill++) {
        size_t bytes = 0;
        for (size_t i = 0; i < plan->n_places; i++) {
            struct plan_place *place = &plan->place[i];
            if (place->mode != DUITE_NONE || !place->n_params)
                continue;
            if (fill)
                place->data = plan->buffers + bytes;
            bytes += (place->bytes + BASE_LINE - 1) / BASE_LINE * BASE_LINE;
        }
        if (!fill && !(plan->buffers = base_alloc(bytes)))
            return false;
    }
    return true;
}

static void emit_params(struct plan *plan)
{
    size_t at = 0;
    for (size_t i = 0; i < plan->n_places; i++) {
        plan->place[i].first_param = at;
        at += plan->place[i].n_params;
        plan->place[i].n_params = 0;
    }
    for (size_t i = 0; i < plan->n_uses; i++) {
        struct plan_place *place = &plan->place[plan->use[i].place];
        plan->param[i] = (duite_param){
            .data = place->data, .count = place->count, .type = place->type, .max = place->count};
        plan->param_of[place->first_param + place->n_params++] = (uint32_t)i;
    }
}

/* Kernel, arguments and options of a task or set; at_home: it runs for an object. */
static void emit_call(struct plan *plan, const struct plan_record *record,
                      const struct plan_round_node *from, struct task *task, bool at_home)
{
    struct plan_node *node = task->node;
    const struct plan_recorded_fork *fork = &record->fork[from->fork];
    node->args = fork->zeros ? NULL : plan->args + fork->args;
    if (from->kind == PLAN_SET)
        return;
    const duite_kernel *kernel = record->graph->kernels[fork->kernel];
    task->kernel = fork->kernel;
    task->state = kernel->events ? TASK_HELD : TASK_LOCAL;
    task->placed = at_home && !kernel->replicated && fork->options.at == TASK_ANYWHERE;
    task->priority = fork->options.priority;
    task->cost = (float)fork->options.cost;
    node->args = kernel->args_size ? plan->args + fork->args : NULL;
    uint32_t stamp = task_new_stamp();
    for (uint32_t k = 0; k < fork->n; k++) {
        node->param[k].object = (duite_object){TASK_LOCAL_NAME | k, stamp};
        node->n_leaves += plan->place[plan->use[node->first_use + k].place].law != NULL;
    }
}

static enum task_type emit_type(enum plan_kind kind)
{
    static const enum task_type type[] = {
        [PLAN_TASK] = TASK_NODE,      [PLAN_SET] = TASK_NODE_SET,
        [PLAN_SUM] = TASK_NODE_SUM,   [PLAN_FLAG] = TASK_NODE_FLAG,
        [PLAN_COPY] = TASK_NODE_COPY, [PLAN_PARTIAL] = TASK_NODE_PARTIAL,
        [PLAN_SEND] = TASK_NODE_SEND, [PLAN_RECEIVE] = TASK_NODE_RECEIVE};
    return type[kind];
}

static bool emit_adds(const struct plan_round_node *node)
{
    return node->kind == PLAN_SUM || node->kind == PLAN_PARTIAL;
}

/* The fields that all nodes have. */
static struct task *emit_task(struct plan *plan, const struct emit *emit, size_t i)
{
    const struct plan_round_node *from = &emit->round->node[i];
    struct task *task = plan_task(plan, i);
    struct plan_node *node = (void *)(plan->nodes + i * PLAN_NODE_BYTES + PLAN_NODE_AT);
    *task = (struct task){.n = (uint32_t)from->n_uses,
                          .type = emit_type(from->kind),
                          .kernel = UINT32_MAX,
                          .priority = INT32_MAX,
                          .scope = &emit->record->graph->root,
                          .node = node};
    *node = (struct plan_node){.plan = plan,
                               .param = plan->param + from->first_use,
                               .n_next = from->n_next,
                               .n_cyclic = from->n_next_cyclic,
                               .steady = from->within + from->cyclic,
                               .first_use = (uint32_t)from->first_use,
                               .sink = from->n_next == from->n_next_cyclic};
    return task;
}

static void emit_node(struct plan *plan, const struct emit *emit, size_t i)
{
    const struct plan_record *record = emit->record;
    const struct plan_round_node *from = &emit->round->node[i];
    struct task *task = emit_task(plan, emit, i);
    struct plan_node *node = task->node;
    plan->first[i] = from->within;
    plan->call[i] = record->n_forks ? record->fork[from->fork].call : 0;
    plan->owner[i] = from->owner;
    if (!from->within)
        plan->root[plan->n_roots++] = task;
    plan->n_sinks += node->sink;
    if (emit_adds(from)) {
        node->tree = &plan->tree[plan->n_trees++];
        plan->tree[plan->n_trees - 1] =
            (struct plan_tree){from->law, plan->merge + from->first_merge, from->n_merges};
    }
    if (from->kind == PLAN_TASK || from->kind == PLAN_SET)
        emit_call(plan, record, from, task, from->owner != PLAN_NONE);
    if (from->kind == PLAN_TASK && emit->path)
        task->path = emit->path[from->fork];
}

/* Returns whether the node has no body and no message, which the communication runs. */
static bool emit_is_own(enum plan_kind kind)
{
    return kind != PLAN_TASK && kind != PLAN_SEND && kind != PLAN_RECEIVE;
}

/* Successors in one row, the next round's before this round's. */
static void emit_next(struct plan *plan, const struct plan_round *round)
{
    struct task **at = plan->next;
    for (size_t i = 0; i < plan->n_nodes; i++) {
        struct plan_node *node = plan_task(plan, i)->node;
        node->next = at;
        at += node->n_next;
        node->n_next = 0;
    }
    for (int within = 0; within < 2; within++)
        for (size_t i = 0; i < round->n_edges; i++) {
            const struct plan_round_edge *edge = &round->edge[i];
            struct plan_node *node = plan_task(plan, edge->from)->node;
            bool sends = round->node[edge->to].kind == PLAN_SEND;
            if (sends && !edge->cyclic)
                node->runs_inline = emit_is_own(round->node[edge->from].kind);
            if (edge->cyclic != within)
                node->next[node->n_next++] = plan_task(plan, edge->to);
        }
}

static size_t emit_count_trees(const struct plan_round *round)
{
    size_t n = 0;
    for (size_t i = 0; i < round->n_nodes; i++)
        n += emit_adds(&round->node[i]);
    return n;
}

static bool emit_has_events(const struct emit *emit)
{
    const struct plan_record *record = emit->record;
    bool has = false;
    for (size_t i = 0; i < emit->round->n_nodes && !has; i++) {
        const struct plan_round_node *node = &emit->round->node[i];
        has = node->kind == PLAN_TASK &&
              record->graph->kernels[record->fork[node->fork].kernel]->events;
    }
    return has;
}

static bool emit_room(struct plan *plan, const struct emit *emit)
{
    const struct plan_round *round = emit->round;
    const size_t nodes = plan->n_nodes + 1, uses = plan->n_uses + 1;
    const struct base_array arrays[] = {{&plan->nodes, nodes * PLAN_NODE_BYTES, false},
                                        BASE_ARRAY(plan->root, nodes),
                                        BASE_ARRAY(plan->next, round->n_edges + 1),
                                        BASE_ARRAY(plan->first, nodes),
                                        BASE_ARRAY(plan->call, nodes),
                                        BASE_ARRAY(plan->owner, nodes),
                                        BASE_ARRAY(plan->held, emit_has_events(emit) ? nodes : 0),
                                        BASE_ARRAY(plan->use, uses),
                                        BASE_ARRAY(plan->param, uses),
                                        BASE_ARRAY(plan->param_of, uses),
                                        BASE_ARRAY(plan->place, plan->n_places + 1),
                                        BASE_ARRAY(plan->merge, round->n_merges),
                                        BASE_ARRAY(plan->tree, emit_count_trees(round)),
                                        {0}};
    plan->memory = base_arrays(arrays);
    plan->args = base_alloc(emit->record->args_bytes + 1); /* apart: see plan_ring */
    return plan->memory && plan->args;
}

static bool emit_all(struct plan *plan, const struct emit *emit)
{
    const struct plan_record *record = emit->record;
    const struct plan_round *round = emit->round;
    plan->n_nodes = round->n_nodes;
    plan->n_uses = round->n_uses;
    plan->n_places = round->n_places;
    plan->n_calls = record->n_calls;
    if (!emit_room(plan, emit))
        return false;
    memcpy(plan->use, round->use, plan->n_uses * sizeof *plan->use);
    memcpy(plan->merge, round->merge, round->n_merges * sizeof *plan->merge);
    emit_places(plan, emit);
    if (!emit_buffers(plan))
        return false;
    emit_params(plan);
    if (record->args_bytes)
        memcpy(plan->args, record->args, record->args_bytes);
    for (size_t i = 0; i < plan->n_nodes; i++)
        emit_node(plan, emit, i);
    emit_next(plan, round);
    return true;
}

bool plan_fits(struct plan *plan, const struct plan_record *record, const duite_object *flag)
{
    if (plan->decides != (flag != NULL) || !plan_at_home(plan, record))
        return false;
    if (!flag)
        return true;
    const struct plan_place *place = &plan->place[plan->flag_place];
    const struct data_object *object = &record->graph->table.object[flag->slot];
    return plan->flag_place == plan_record_flag(record, *flag) && place->type == object->type &&
           place->count == object->count;
}

/* All passes in order. With several ranks, those between lowering and edges make this rank's part.
 * The nodes of all ranks are freed once the paths are known, since the plan takes their memory. */
static int plan_compile(struct plan *plan, const struct plan_record *record,
                        const duite_object *flag)
{
    const bool several = record->graph->n_ranks > 1, paths = plan->graph->paths;
    struct plan_source source;
    struct plan_round all = {0}, part = {0}, *own = several ? &part : &all;
    float *path = NULL;
    bool fine = plan_record_source(record, flag, &source) && plan_lower(&all, &source);
    plan->n_objects = source.n_objects;
    plan->flag_place = flag ? source.flag : 0;
    if (fine && several)
        fine = plan_of_ranks(plan, &all, &part, record, flag);
    if (fine && (paths || !several))
        fine = plan_edges(&all);
    if (fine && paths)
        fine = (path = plan_paths_find(&all)) != NULL;
    if (several)
        plan_round_free(&all);
    if (fine && several)
        fine = plan_edges(&part);
    fine = fine && emit_all(plan, &(struct emit){record, flag, own, path});
    int code = fine ? DUITE_OK : base_no_memory("a recorded graph");
    if (fine && several)
        code = plan_open(plan, &part);
    base_free(path);
    plan_round_free(own);
    plan_source_free(&source);
    return code;
}

int plan_new(struct plan **out, const struct plan_record *record, const duite_object *flag)
{
    struct plan *plan = *out = base_alloc_zero(sizeof *plan);
    if (!plan)
        return base_no_memory("a recorded graph");
    atomic_init(&plan->refs, 1);
    plan->graph = record->graph;
    plan->decides = flag != NULL;
    const int code = plan_compile(plan, record, flag);
    if (code) {
        plan_drop(plan, NULL);
        *out = NULL;
    }
    return code;
}

void plan_release(struct plan *plan)
{
    if (atomic_fetch_sub_explicit(&plan->refs, 1, memory_order_acq_rel) != 1)
        return;
    if (plan->channels.close)
        plan->channels.close(&plan->channels);
    base_free(plan->memory);
    base_free(plan->args);
    base_free(plan->buffers);
    base_free(plan->channels.channel);
    base_free(plan->sets);
    base_free(plan);
}

void plan_drop(struct plan *plan, struct worker *worker)
{
    if (!plan)
        return;
    if (plan->turn.current)
        ready_release(plan->graph, worker, plan->turn.current);
    plan->turn.current = NULL;
    if (plan->channels.drop)
        plan->channels.drop(&plan->channels);
    plan_release(plan);
}
