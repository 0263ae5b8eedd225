/* The life of the graph itself, its kernels, and the failures of tasks, which are kept until stop
 * so that poison can point at them. */
#include "runtime/task/internal.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <stdlib.h>
#include <string.h>

struct task_failure {
    struct task_failure *next;
    struct data_failure failure;
};

/* A replicated kernel leaves the same values on all ranks, and has no other effect. */
static int kernel_check_replicated(const duite_kernel *kernel)
{
    const char *why = kernel->side_effects ? "has side effects"
                      : kernel->events     ? "has events, which would complete once for each rank"
                                           : NULL;
    for (uint32_t i = 0; i <= DUITE_MAX_ACCESS && !why; i++) {
        duite_mode mode = i < DUITE_MAX_ACCESS ? kernel->access[i] : kernel->variadic;
        if (mode == DUITE_CW)
            why = "accumulates (cw), which would count once for each rank";
        else if (task_postponed(mode))
            why = "has a postponed mode: its children would run once for each rank";
    }
    return kernel->replicated && why
               ? base_error(DUITE_E_KERNEL, "kernel %s is replicated, but %s", kernel->name, why)
               : DUITE_OK;
}

static int kernel_check(const duite_kernel *kernel, uint32_t index, struct task_fixed *fixed)
{
    if (!kernel->name || !kernel->name[0])
        return base_error(DUITE_E_KERNEL, "kernel %u of the list has no name", index);
    if (!kernel->body)
        return base_error(DUITE_E_KERNEL, "kernel %s has no body", kernel->name);
    *fixed = (struct task_fixed){.kernel = kernel,
                                 .index = index,
                                 .hash = task_fork_hash(task_fork_what(index, TASK_ANYWHERE)),
                                 .few = kernel->variadic == DUITE_NONE && !kernel->replicated &&
                                        !kernel->events};
    bool contributes = false;
    for (uint32_t i = 0; i < DUITE_MAX_ACCESS; i++) {
        duite_mode mode = kernel->access[i];
        if ((int)mode < DUITE_NONE || mode > DUITE_CWP)
            return base_error(DUITE_E_KERNEL, "kernel %s: parameter %u has no such mode: %d",
                              kernel->name, i, (int)mode);
        if (mode != DUITE_NONE && i != fixed->n)
            return base_error(DUITE_E_KERNEL, "kernel %s: parameter %u has a mode after DUITE_NONE",
                              kernel->name, i);
        fixed->n += mode != DUITE_NONE;
        fixed->postponed += task_postponed(mode);
        fixed->few &= !task_postponed(mode);
        contributes |= mode == DUITE_CW;
    }
    if ((int)kernel->variadic < DUITE_NONE || kernel->variadic > DUITE_CWP)
        return base_error(DUITE_E_KERNEL, "kernel %s: `variadic` has no such mode: %d",
                          kernel->name, (int)kernel->variadic);
    const size_t grains = task_grains(fixed->n, kernel->args_size);
    fixed->few &= fixed->n <= TASK_FEW && grains <= UINT32_MAX;
    fixed->plain = fixed->few && !contributes;
    fixed->grains = (uint32_t)grains;
    fixed->owner[0] = task_owner(kernel->access, kernel->variadic, fixed->n);
    fixed->owner[1] = task_owner(kernel->access, kernel->variadic, (size_t)fixed->n + 1);
    return kernel_check_replicated(kernel);
}

static int kernel_check_unique(const duite_kernel *const kernels[], uint32_t index)
{
    for (uint32_t i = 0; i < index; i++)
        if (!strcmp(kernels[i]->name, kernels[index]->name))
            return base_error(DUITE_E_KERNEL, "two kernels of the list have the name %s",
                              kernels[i]->name);
    return DUITE_OK;
}

/* Finds out once what each fork of a plain kernel needs. */
static int kernel_prepare(const struct task_graph *graph, uint32_t index)
{
    struct task_fixed *fixed = &graph->fixed[index];
    const uint32_t n = fixed->n;
    struct task *head;
    if (!fixed->plain)
        return DUITE_OK;
    fixed->direct = graph->n_ranks == 1;
    fixed->head = head = base_alloc(sizeof *head + n * sizeof head->access[0]);
    if (!head)
        return base_no_memory("the list of kernels");
    *head = (struct task){.pending = n + 1,
                          .n = n,
                          .kernel = index,
                          .grains = fixed->grains,
                          .type = TASK_BODY,
                          .placed = fixed->owner[0] != TASK_NOBODY};
    for (uint32_t i = 0; i < n; i++)
        head->access[i] = (struct task_access){
            .waiter = {.back = (uint32_t)(sizeof *head + i * sizeof head->access[0]),
                       .mode = fixed->kernel->access[i]}};
    return DUITE_OK;
}

/* The places of all kernels by their addresses; at most half of them are taken. */
static int kernels_index(struct task_graph *graph)
{
    graph->kernel_mask = 3;
    while (graph->kernel_mask < 2 * (uint64_t)graph->n_kernels)
        graph->kernel_mask = 2 * graph->kernel_mask + 1;
    graph->kernel_place =
        base_alloc_zero(((size_t)graph->kernel_mask + 1) * sizeof *graph->kernel_place);
    if (!graph->kernel_place)
        return base_no_memory("the list of kernels");
    for (uint32_t i = 0; i < graph->n_kernels; i++) {
        uint32_t at = task_kernel_hash(graph->kernels[i]);
        while (graph->kernel_place[at & graph->kernel_mask])
            at++;
        graph->kernel_place[at & graph->kernel_mask] = &graph->fixed[i];
    }
    return DUITE_OK;
}

static int kernels_take(struct task_graph *graph, const duite_kernel *const *kernels,
                        const duite_law *const *laws)
{
    size_t n = 0;
    while (kernels[n])
        n++;
    graph->kernels = base_alloc(n * sizeof graph->kernels[0]);
    graph->fixed = base_alloc_zero(n * sizeof *graph->fixed);
    if (!graph->kernels || !graph->fixed)
        return base_no_memory("the list of kernels");
    memcpy(graph->kernels, kernels, n * sizeof graph->kernels[0]);
    graph->n_kernels = (uint32_t)n;
    for (uint32_t i = 0; i < n; i++) {
        int code = kernel_check(graph->kernels[i], i, &graph->fixed[i]);
        if (!code)
            code = kernel_check_unique(graph->kernels, i);
        if (!code)
            code = data_law_check_kernel(graph->kernels[i], laws);
        if (!code)
            code = kernel_prepare(graph, i);
        if (code)
            return code;
    }
    return kernels_index(graph);
}

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
    return code ? code : kernels_take(graph, kernels, laws);
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
    for (uint32_t i = 0; i < graph->n_kernels; i++)
        base_free(graph->fixed[i].head);
    base_free(graph->fixed);
    base_free(graph->kernels);
    base_free(graph->kernel_place);
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
