/* The main program's recorded graphs: a slot's generation is odd while a graph lives in it. Before
 * a replay the graph is recorded again if it names objects that are gone. Then its rounds run by
 * the plan or, where that cannot be, through the forks of the dynamic path. */
#include "runtime/api/instance.h"

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <stdio.h>

struct recorded_graph {
    duite_build *build;
    void *context;
    struct plan_record *record; /* NULL: the slot is free */
    uint32_t generation;
    uint64_t replays; /* since api_graphs_each was called last */
    uint64_t begun;   /* all of them */
    uint64_t map_at;  /* of these: see api_migrate */
};

int api_graphs_failed(duite *rt, int code)
{
    struct plan_record *record = rt->building;
    if (record->failed)
        return code;
    record->failed = code;
    snprintf(record->message, sizeof record->message, "%s", duite_message());
    return code;
}

int api_graphs_left(const duite *rt)
{
    for (size_t i = 0; i < rt->n_recorded; i++)
        if (rt->recorded[i].record)
            return base_error(DUITE_E_NOT_FREED, "recorded graph %zu was not freed", i + 1);
    return DUITE_OK;
}

void api_graphs_stop(duite *rt)
{
    for (size_t i = 0; i < rt->n_recorded; i++)
        if (rt->recorded[i].record)
            plan_record_free(rt->recorded[i].record, NULL);
    base_free(rt->recorded);
}

static struct recorded_graph *graph_find(duite *rt, duite_graph name)
{
    struct recorded_graph *found =
        name.slot && name.slot <= rt->n_recorded ? &rt->recorded[name.slot - 1] : NULL;
    if (found && found->generation == name.generation && name.generation % 2)
        return found;
    base_error(DUITE_E_OBJECT, "recorded graph %u.%u %s", name.slot, name.generation,
               found && name.generation < found->generation ? "was freed" : "was never made");
    return NULL;
}

/* A call on a graph begins: *found is the graph. A missing graph is remembered as an error. */
static int graph_enter(duite *rt, const char *call, duite_graph name, struct recorded_graph **found)
{
    const int code = api_enter(rt, call);
    if (code)
        return code;
    *found = graph_find(rt, name);
    return *found ? DUITE_OK : api_remember(rt, DUITE_E_OBJECT);
}

/* Takes a slot with an empty record; 0 without memory. */
static uint32_t graph_take_slot(duite *rt)
{
    size_t slot = 0;
    while (slot < rt->n_recorded && rt->recorded[slot].record)
        slot++;
    struct plan_record *record = BASE_GROW(rt->recorded, rt->recorded_capacity, slot + 1)
                                     ? plan_record_new(&rt->graph)
                                     : NULL;
    if (!record)
        return 0;
    if (slot == rt->n_recorded)
        rt->recorded[rt->n_recorded++].generation = 0;
    rt->recorded[slot].record = record;
    rt->recorded[slot].replays = rt->recorded[slot].begun = rt->recorded[slot].map_at = 0;
    rt->recorded[slot].generation++;
    return (uint32_t)slot + 1;
}

static void graph_free_slot(duite *rt, struct recorded_graph *slot)
{
    plan_record_free(slot->record, rt->worker);
    slot->record = NULL;
    slot->generation++;
}

/* Calls build, whose forks become the record. */
static int graph_record(duite *rt, struct recorded_graph *slot)
{
    struct plan_record *record = slot->record;
    plan_record_clear(record, rt->worker);
    rt->building = record;
    rt->graphs_recorded++;
    int code = slot->build(rt, slot->context);
    rt->building = NULL;
    if (record->failed)
        code = base_error(record->failed, "%s", record->message);
    else if (code)
        base_error(code, "the build function of a graph returned %d", code);
    if (code)
        plan_record_clear(record, rt->worker);
    else
        plan_record_end(record);
    if (!code)
        trace_graph(rt->trace, (uint32_t)(slot - rt->recorded), record);
    return code;
}

int duite_graph_new(duite *rt, duite_build *build, void *context, duite_graph *graph)
{
    if (graph)
        *graph = DUITE_NO_GRAPH;
    int code = api_enter(rt, "duite_graph_new");
    if (code)
        return code;
    if (!build || !graph)
        return api_remember(rt, base_error(DUITE_E_ARGUMENT, "duite_graph_new: no %s",
                                           build ? "place for the graph" : "build function"));
    code = api_settle(rt);
    uint32_t slot = code ? 0 : graph_take_slot(rt);
    if (!slot)
        return api_remember(rt, code ? code : base_no_memory("a recorded graph"));
    struct recorded_graph *made = &rt->recorded[slot - 1];
    made->build = build;
    made->context = context;
    code = graph_record(rt, made);
    if (code)
        graph_free_slot(rt, made);
    else
        *graph = (duite_graph){slot, made->generation};
    return api_remember(rt, code);
}

int duite_graph_free(duite *rt, duite_graph graph)
{
    struct recorded_graph *found;
    const int code = graph_enter(rt, "duite_graph_free", graph, &found);
    if (code)
        return code;
    task_mix(&rt->graph, graph.slot);
    task_mixed(&rt->graph, COMM_CALLED, COMM_CALLED_GRAPH_FREE);
    graph_free_slot(rt, found);
    return DUITE_OK;
}

int duite_graph_args(duite *rt, duite_graph graph, size_t k, const void *args)
{
    struct recorded_graph *found;
    const int code = graph_enter(rt, "duite_graph_args", graph, &found);
    return code ? code : api_remember(rt, plan_record_args(found->record, k, args));
}

int duite_graph_bind(duite *rt, duite_graph graph, duite_object recorded, duite_object object)
{
    struct recorded_graph *found;
    const int code = graph_enter(rt, "duite_graph_bind", graph, &found);
    return code ? code : api_remember(rt, plan_record_bind(found->record, recorded, object));
}

/* ---- Replays ---- */

static int graph_check_rounds(const struct plan_record *record, uint64_t rounds)
{
    uint64_t max = UINT64_C(1) << PLAN_MAX_TASKS_BITS;
    if (rounds <= max / (record->n_forks + 1))
        return DUITE_OK;
    return base_error(DUITE_E_ARGUMENT, "%llu rounds of %zu tasks are more than 2^%d",
                      (unsigned long long)rounds, record->n_forks, PLAN_MAX_TASKS_BITS);
}

int api_graphs_each(duite *rt, int (*visit)(void *context, const struct plan_record *, double),
                    void *context)
{
    int code = DUITE_OK;
    for (size_t i = 0; i < rt->n_recorded && !code; i++) {
        struct recorded_graph *graph = &rt->recorded[i];
        const double replays = (double)graph->replays;
        graph->replays = 0;
        if (replays > 0 && graph->record && plan_record_fits(graph->record))
            code =
                visit(context, graph->record, replays * (double)plan_replay_rounds(graph->record));
    }
    return code;
}

/* Makes the graph fit the objects it is bound to, and gives objects their homes. */
static int graph_prepare(duite *rt, struct recorded_graph *slot, uint64_t rounds)
{
    int code = api_settle(rt);
    if (!code && !plan_record_fits(slot->record))
        code = graph_record(rt, slot);
    if (!code)
        code = plan_record_distinct(slot->record);
    if (!code)
        code = graph_check_rounds(slot->record, rounds);
    if (!code)
        code = api_migrate(rt, slot->record, slot->begun, &slot->map_at);
    slot->replays += !code;
    slot->begun += !code;
    return code;
}

static int replay_fork_rounds(duite *rt, struct plan_record *record, uint64_t first,
                              uint64_t rounds)
{
    int code = DUITE_OK;
    for (uint64_t i = 0; i < rounds && !code; i++) {
        code = plan_replay_fork(record, rt->worker, first + i);
        record->rounds += !code;
        work_tick(rt->pool);
        if (!code)
            api_throttle(rt);
    }
    return code;
}

/* All tags are handed out to plans: reuses those of plans that are over on all ranks. */
static int replay_make_tags(duite *rt)
{
    int code = api_meet(rt, "duite_replay", NULL);
    if (!code)
        code = comm_channels_settle(rt->comm);
    if (!code)
        code = api_meet(rt, "duite_replay", NULL);
    if (!code)
        comm_channels_met(rt->comm);
    return code;
}

static int replay_by_plan(duite *rt, struct plan_record *record, const duite_object *flag,
                          uint64_t rounds)
{
    int code = plan_replay_plan(record, rt->worker, flag, rounds);
    if (code == COMM_NEEDS_TAGS) {
        code = replay_make_tags(rt);
        if (!code)
            code = plan_replay_plan(record, rt->worker, flag, rounds);
        if (code == COMM_NEEDS_TAGS)
            code = base_error(DUITE_E_MPI, "MPI has too few tags for the messages of all recorded "
                                           "graphs: free some, or fork their tasks");
    }
    record->by_plan = !code;
    if (!code)
        api_throttle(rt);
    return code;
}

static int replay_all_rounds(duite *rt, struct plan_record *record, uint64_t rounds)
{
    uint64_t before, after;
    plan_replay_split(record, NULL, rounds, &before, &after);
    record->rounds = 0;
    record->by_plan = false;
    int code = replay_fork_rounds(rt, record, 0, before);
    if (!code && rounds > before + after)
        code = replay_by_plan(rt, record, NULL, rounds - before - after);
    return code ? code : replay_fork_rounds(rt, record, rounds - after, after);
}

/* Runs rounds of the dynamic path, and reads the flag after each. */
static int replay_fork_while(duite *rt, struct plan_record *record, duite_object flag, uint64_t max)
{
    const struct data_object *object = data_object_find(&rt->graph.table, flag);
    uint64_t forks = rt->graph.root.forks;
    duite_type type = object->type;
    void *values = base_alloc(object->room);
    bool holds = true;
    size_t count;
    int code = values ? DUITE_OK : base_no_memory("a flag");
    while (!code && holds && record->rounds < max) {
        code = replay_fork_rounds(rt, record, record->rounds, 1);
        if (!code) /* the next wait returns a failure */
            holds = !api_get(rt, flag, TASK_ANYWHERE, values, &count, "duite_replay_while") &&
                    count && plan_flag_holds(type, values);
        if (!code && api_is_broken(rt))
            code = rt->comm ? comm_error(rt->comm) : rt->graph.broken;
    }
    rt->graph.root.forks = forks + max * record->n_calls;
    base_free(values);
    return code;
}

static int replay_rounds_while(duite *rt, struct plan_record *record, duite_object flag,
                               uint64_t max)
{
    uint64_t before, after;
    if (!data_object_find(&rt->graph.table, flag))
        return DUITE_E_OBJECT;
    plan_replay_split(record, &flag, max, &before, &after);
    record->rounds = 0;
    record->by_plan = false;
    if (max <= before)
        return replay_fork_while(rt, record, flag, max);
    return replay_by_plan(rt, record, &flag, max);
}

/* flag: NULL, or after each round it tells whether to go on. */
static int graph_replay(duite *rt, duite_graph graph, const duite_object *flag, uint64_t rounds)
{
    struct recorded_graph *found;
    const char *call = flag ? "duite_replay_while" : "duite_replay";
    int code = graph_enter(rt, call, graph, &found);
    if (!code)
        code = api_remember(rt, api_check_turns(rt, call));
    if (code)
        return code;
    task_mix(&rt->graph, graph.slot);
    task_mix(&rt->graph, rounds);
    if (flag)
        task_mix(&rt->graph, task_name_bits(*flag));
    task_mixed(&rt->graph, COMM_CALLED, flag ? COMM_CALLED_REPLAY_WHILE : COMM_CALLED_REPLAY);
    code = graph_prepare(rt, found, rounds);
    if (!code && flag && !rounds)
        code = base_error(DUITE_E_ARGUMENT, "duite_replay_while: at most 0 rounds");
    if (code)
        return api_remember(rt, code);
    trace_replay(rt->trace, graph.slot - 1, found->record, flag, rounds);
    return api_remember(rt, flag ? replay_rounds_while(rt, found->record, *flag, rounds)
                                 : replay_all_rounds(rt, found->record, rounds));
}

int duite_replay(duite *rt, duite_graph graph, uint64_t rounds)
{
    return graph_replay(rt, graph, NULL, rounds);
}

int duite_replay_while(duite *rt, duite_graph graph, duite_object flag, uint64_t max)
{
    return graph_replay(rt, graph, &flag, max);
}

static bool replay_is_over(void *context)
{
    return plan_replay_over(context);
}

int duite_graph_rounds(duite *rt, duite_graph graph, uint64_t *rounds)
{
    int code = api_enter(rt, "duite_graph_rounds");
    if (!code)
        code = api_check_turns(rt, "duite_graph_rounds");
    if (code)
        return code;
    const struct recorded_graph *found = graph_find(rt, graph);
    if (!found)
        return DUITE_E_OBJECT;
    if (!rounds)
        return base_error(DUITE_E_ARGUMENT, "duite_graph_rounds: nowhere to put the number");
    const uint64_t from = rt->trace ? base_ticks() : 0;
    work_until(rt->pool, &(struct work_why){"duite_graph_rounds", "the last replay", NULL},
               replay_is_over, found->record);
    trace_wait(rt->trace, from);
    if (!plan_replay_over(found->record)) {
        api_give_up(rt);
        return comm_error(rt->comm);
    }
    *rounds = plan_replay_rounds(found->record);
    return DUITE_OK;
}
