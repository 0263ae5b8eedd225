/* The main program's calls for replays. To the rest of the graph a replay of a plan is one task
 * that reads or writes each of its objects; forked rounds are tasks like any other. Both leave the
 * same bytes, the same poison and the same numbers of tasks. */
#include "runtime/plan/plan.h"
#include "runtime/task/ready.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/data/object.h"
#include "runtime/task/fork.h"

/* Returns whether open contributions go on in the first round. */
static bool replay_continues_sums(const struct plan_record *record)
{
    for (size_t i = 0; i < record->n_objects && record->leads; i++)
        if (record->object[i].leads &&
            record->graph->table.object[record->object[i].bound.slot].leaves)
            return true;
    return false;
}

void plan_replay_split(const struct plan_record *record, const duite_object *flag, uint64_t rounds,
                       uint64_t *before, uint64_t *after)
{
    bool begins = rounds && replay_continues_sums(record);
    bool forked = record->forked || (flag && record->graph->table.object[flag->slot].sized);
    /* A flag's own contributions end with the round, since it is read. */
    for (size_t i = 0; flag && record->trails && i < record->n_objects; i++)
        forked |=
            record->object[i].trails && (record->object[i].bound.slot != flag->slot ||
                                         record->object[i].bound.generation != flag->generation);
    forked |= flag && begins;
    *before = forked ? rounds : begins;
    *after = !flag && !forked && record->trails && rounds > *before;
}

/* Forks a task on the objects in record->names. */
static int replay_fork_task(const struct plan_record *record, struct worker *worker,
                            const struct task_options *options,
                            const struct plan_recorded_fork *fork, const void *args)
{
    struct task_graph *graph = record->graph;
    const duite_kernel *kernel = graph->kernels[fork->kernel];
    return task_fork_any(&graph->root, worker, options, kernel, kernel->args_size ? args : NULL,
                         fork->n, record->names);
}

int plan_replay_fork(struct plan_record *record, struct worker *worker, uint64_t round)
{
    struct task_graph *graph = record->graph;
    int code = DUITE_OK;
    for (size_t i = 0; i < record->n_forks && !code; i++) {
        const struct plan_recorded_fork *fork = &record->fork[i];
        struct task_options options = fork->options;
        options.round = round;
        unsigned char *args = record->args + fork->args;
        duite_object *objects = record->names;
        for (uint32_t k = 0; k < fork->n; k++)
            objects[k] = record->object[record->access[fork->first + k].object].bound;
        if (fork->kernel == PLAN_SETS)
            code = task_set_object(&graph->root, worker, objects[0], TASK_ANYWHERE,
                                   fork->zeros ? NULL : args, &fork->count);
        else
            code = replay_fork_task(record, worker, &options, fork, args);
    }
    return code;
}

/* The record's plan, made again if it does not fit. */
static struct plan *replay_plan_for(struct plan_record *record, struct worker *worker,
                                    const duite_object *flag, int *code)
{
    if (record->plan && plan_fits(record->plan, record, flag))
        return record->plan;
    plan_drop(record->plan, worker);
    plan_record_forget_changes(record);
    *code = plan_new(&record->plan, record, flag);
    return record->plan;
}

/* The object that place i of the plan stands for, or the turn. */
static struct data_object *replay_object(const struct plan_record *record, size_t i,
                                         const duite_object *flag)
{
    if (i == record->plan->n_objects)
        return &record->plan->turn;
    duite_object name = i < record->n_objects ? record->object[i].bound : *flag;
    return &record->graph->table.object[name.slot];
}

/* Brings an object's value where the plan needs it, and notes where the plan leaves it, on all
 * ranks. Copies on ranks that do not write it become stale. */
static int replay_move_object(const struct plan *plan, struct worker *worker, size_t i,
                              struct data_object *object, duite_mode mode)
{
    struct task_graph *graph = plan->graph;
    int code = object->leaves ? task_reduce(&graph->root, worker, object) : DUITE_OK;
    if (!code && plan->words && i < plan->n_objects)
        code = plan_fetch(plan, worker, i, object);
    if (!code && data_order_reads(mode) && !task_local(graph, object))
        code = DUITE_E_MEMORY;
    if (code || mode == DUITE_R)
        return code;
    if (plan->words && i < plan->n_objects) {
        if (plan_moves(plan, i, object) && mode == DUITE_NONE)
            task_forget(graph, worker, object);
        return DUITE_OK;
    }
    object->number++;
    data_object_moved(object, graph->rank);
    return DUITE_OK;
}

/* One access of the replay's task, like that of any task on one rank. */
static int replay_use_object(struct task_graph *graph, struct task *task, size_t i, duite_mode mode,
                             struct data_object *object, uint32_t *done)
{
    task->access[i].waiter.mode = mode;
    if (mode == DUITE_NONE) {
        *done += 1;
        return DUITE_OK;
    }
    return task_wait(&graph->root, task, i, object, done);
}

static int replay_use_all(struct plan_record *record, struct worker *worker, struct task *task,
                          const duite_object *flag)
{
    struct task_graph *graph = record->graph;
    struct plan *plan = record->plan;
    uint32_t done = 0;
    for (size_t i = 0; i <= plan->n_objects; i++) {
        plan_prefetch(record, i + PLAN_AHEAD);
        duite_mode mode = i < plan->n_objects ? plan->place[i].mode : DUITE_W;
        struct data_object *object = replay_object(record, i, flag);
        if (i < plan->n_objects)
            task->replay->block[i] = object->block;
        int code = replay_move_object(plan, worker, i, object, mode);
        if (!code)
            code = replay_use_object(graph, task, i, mode, object, &done);
        if (code) {
            task_void(graph, worker, task, i, done);
            return code;
        }
    }
    plan->started++;
    atomic_fetch_add_explicit(&plan->refs, 1, memory_order_relaxed);
    record->changes = NULL;
    ready_take(graph, worker, task, done + 1);
    return DUITE_OK;
}

static int replay_start(struct plan_record *record, struct worker *worker,
                        const struct plan_replay *replay, const duite_object *flag)
{
    const size_t n = replay->plan->n_objects;
    struct task *task = task_new(&record->graph->root, TASK_REPLAY, n + 1,
                                 sizeof *replay + n * sizeof replay->block[0]);
    if (!task)
        return DUITE_E_MEMORY;
    *task->replay = *replay;
    return replay_use_all(record, worker, task, flag);
}

int plan_replay_plan(struct plan_record *record, struct worker *worker, const duite_object *flag,
                     uint64_t rounds)
{
    struct task_graph *graph = record->graph;
    int code = DUITE_OK;
    struct plan *plan = replay_plan_for(record, worker, flag, &code);
    if (code)
        return code;
    const struct plan_replay replay = {.plan = plan,
                                       .first_round = record->rounds,
                                       .rounds = rounds,
                                       .number = graph->root.forks + 1,
                                       .changes = record->changes};
    graph->root.forks += rounds * record->n_calls;
    return replay_start(record, worker, &replay, flag);
}

int plan_replay_open(struct plan_record *record, struct worker *worker, struct plan_gate *gate)
{
    struct task_graph *graph = record->graph;
    const struct plan_replay replay = {
        .plan = record->plan, .rounds = UINT64_MAX, .number = graph->root.forks + 1};
    plan_gate_close(record->plan, gate, replay.number);
    const int code = replay_start(record, worker, &replay, NULL);
    graph->tasks -= !code; /* until it is closed */
    return code;
}

bool plan_replay_over(const struct plan_record *record)
{
    return !record->by_plan || plan_is_over(record->plan);
}

uint64_t plan_replay_rounds(const struct plan_record *record)
{
    return record->rounds + (record->by_plan
                                 ? atomic_load_explicit(&record->plan->rounds, memory_order_relaxed)
                                 : 0);
}
