/* The life of the graph itself, and the failures of tasks, which are kept until stop so that poison
 * can point at them. */
#include "runtime/task/internal.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <stdlib.h>
#include <string.h>

struct task_failure {
    struct task_failure *next;
    struct data_failure failure;
};

int task_graph_start(struct task_graph *graph, int rank, int n_ranks,
                     const duite_kernel *const *kernels, const duite_law *const *laws)
{
    memset(graph, 0, sizeof *graph);
    graph->rank = rank;
    graph->n_ranks = n_ranks;
    graph->root.graph = graph;
    graph->root.top = &graph->root;
    atomic_init(&graph->given_up, 0);
    atomic_init(&graph->offloaded, 0);
    pthread_mutex_init(&graph->lock, NULL); /* cannot fail with default attributes */
    int code = data_table_start(&graph->table, n_ranks);
    if (!code && n_ranks > 1 && !(graph->history = base_alloc_zero(sizeof *graph->history)))
        code = base_no_memory("the history of calls");
    if (!code)
        code = data_laws_check(laws);
    return code ? code : task_kernels_start(graph, kernels, laws);
}

void task_graph_stop(struct task_graph *graph)
{
    for (uint32_t slot = 1; slot < graph->table.n_slots; slot++) {
        struct data_object *object = &graph->table.object[slot];
        if (object->memory)
            task_leave_now(object);
        if (object->split)
            task_split_drop(object);
        task_forget(graph, NULL, object);
        if (object->sum)
            data_sum_free(object->sum);
    }
    for (struct data_sum *sum = graph->unclosed, *next; sum; sum = next) {
        next = sum->next;
        data_sum_free(sum);
    }
    for (struct task_failure *node = graph->failures, *next; node; node = next) {
        next = node->next;
        base_free(node);
    }
    base_free(graph->history);
    base_free(graph->events.event);
    task_kernels_stop(graph);
    data_table_stop(&graph->table);
    pthread_mutex_destroy(&graph->lock);
}

const struct data_failure *task_fail(struct task_graph *graph, const struct data_failure *failure,
                                     struct task_scope *scope)
{
    static const struct data_failure unrecorded = {
        .code = DUITE_E_MEMORY, .text = "and there was no memory to record which task failed"};
    struct task_failure *node = base_alloc(sizeof *node);
    if (node)
        node->failure = *failure;
    const struct data_failure *kept = node ? &node->failure : &unrecorded;
    pthread_mutex_lock(&graph->lock);
    if (node) {
        node->next = graph->failures;
        graph->failures = node;
    }
    for (; scope; scope = scope->parent)
        scope->failure = data_failure_first(scope->failure, kept);
    pthread_mutex_unlock(&graph->lock);
    return kept;
}

/* The place at home of the offloaded task that a task of this scope is or descends from; NULL: it
 * is at home. The main program's scope is not read: the main thread writes its cache line with
 * every fork. */
static const struct data_failure *failure_home(const struct task_scope *scope)
{
    return scope->top == &scope->graph->root ? NULL : scope->top->place;
}

/* A body's actions after a wait come after the children forked before it. The place of an offloaded
 * task continues its place at home. */
void task_failure_place(struct data_failure *failure, const struct task *task,
                        const struct task_scope *inner)
{
    uint64_t index[sizeof failure->path];
    uint32_t depth = task->scope->depth, max = sizeof index / sizeof index[0];
    const struct data_failure *home = failure_home(task->scope);
    if (depth && depth <= max)
        index[depth - 1] = task->number;
    failure->number = task->number;
    for (const struct task_scope *scope = task->scope; scope->depth; scope = scope->parent) {
        failure->number = scope->number;
        if (scope->depth > 1 && scope->depth - 2 < max)
            index[scope->depth - 2] = scope->number;
    }
    if (home) {
        failure->number = home->number;
        failure->path_length = home->path_length;
        memcpy(failure->path, home->path, sizeof home->path);
    }
    for (uint32_t i = 0; i < depth && i < max; i++)
        data_path_add(failure, index[i]);
    if (inner && inner->segment)
        data_path_add(failure, inner->segment);
}

const struct data_failure *task_fail_task(const struct task *task, const struct task_scope *inner,
                                          struct data_failure *failure)
{
    struct task_graph *graph = task->scope->graph;
    failure->rank = graph->rank;
    failure->kernel = task->kernel;
    task_failure_place(failure, task, inner);
    return task_fail(graph, failure, task->scope);
}

const struct data_failure *task_fail_memory(const struct task *task)
{
    struct data_failure failure = {.code = DUITE_E_MEMORY, .text = "no memory for what it writes"};
    return task_fail_task(task, NULL, &failure);
}

struct data_key task_version_of(const struct task_graph *graph, duite_object object)
{
    return task_key(graph, &graph->table.object[object.slot]);
}

int task_failure_error(const struct task_graph *graph, const struct data_failure *failure)
{
    const char *kernel =
        failure->kernel < graph->n_kernels ? graph->kernels[failure->kernel]->name : "of duite";
    char place[120];
    data_path_print(failure, place, sizeof place);
    return base_error(failure->code, "task %s (kernel %s) failed on rank %d with code %d%s%s",
                      place, kernel, failure->rank, failure->code, failure->text[0] ? ": " : "",
                      failure->text);
}

uint64_t task_main_number(const struct task *task, bool *nested)
{
    const struct task_scope *scope = task->scope;
    const struct data_failure *place = failure_home(scope);
    *nested = scope->depth || (place && place->path_length);
    if (place)
        return place->number;
    while (scope->depth > 1)
        scope = scope->parent;
    return scope->depth ? scope->number : task->number;
}

const char *task_own_name(uint32_t number)
{
    static const char *const own[] = {[TASK_COMBINE] = "duite_sum",
                                      [TASK_PIECES] = "duite_sum",
                                      [TASK_GATHER] = "duite_sum",
                                      [TASK_COPY] = "duite_get",
                                      [TASK_LEAVE] = "duite_free",
                                      [TASK_MOVE] = "duite_replay",
                                      [TASK_TRACED_VOID] = "duite_fork",
                                      [TASK_REPLAY] = "duite_replay",
                                      [TASK_NODE_SET] = "duite_set",
                                      [TASK_NODE_SUM] = "duite_sum",
                                      [TASK_NODE_PARTIAL] = "duite_sum",
                                      [TASK_NODE_COPY] = "duite_replay",
                                      [TASK_NODE_FLAG] = "duite_replay_while"};
    const char *name = number < sizeof own / sizeof own[0] ? own[number] : NULL;
    return name ? name : "duite";
}
