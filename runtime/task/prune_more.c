/* The other forks whose task runs elsewhere and asks nothing of this rank. Parts of its objects may
 * be here: a value that the task's rank has, too, or a sum to which it contributes. Forks that ask
 * more are left to task_fork: a value is sent from here or goes stale here, it is the first
 * contribution, or there is an error. */
#include "runtime/task/prune.h"

#include "runtime/data/law.h"

/* True if a task on rank `at` that uses the object so asks nothing of this rank. A sum that this
 * rank adds up must be open here. */
static inline bool more_asks_nothing(const struct task_graph *graph, const duite_kernel *kernel,
                                     size_t i, int at, const struct data_object *object)
{
    const duite_mode mode = task_immediate(data_mode_of(kernel, i));
    const bool held = object->holder == graph->rank;
    if (mode == DUITE_CW)
        return object->leaves && (!held || object->sum) &&
               data_order_joins(mode, data_law_of(kernel, i), object->law);
    if (object->leaves)
        return false;
    if (mode == DUITE_R)
        return !held || data_object_has_copy(&graph->table, object, at);
    return !held && !object->current;
}

/* True if the objects exist, differ, and ask nothing. The result does not tell which one failed.
 * The marks differ from those of task_fork. */
static bool more_look_up(const struct task_graph *graph, const duite_kernel *kernel, int at,
                         size_t n, const duite_object *objects, struct data_object **found,
                         uint64_t *hash)
{
    const uint64_t mark = ~graph->root.forks;
    for (size_t i = 0; i < n; i++) {
        const duite_object name = objects[i];
        struct data_object *object = found[i] = prune_object(&graph->table, name);
        const bool alive = object->generation == name.generation && name.generation % 2;
        if (!alive || object->mark == mark || !more_asks_nothing(graph, kernel, i, at, object))
            return false;
        object->mark = mark;
        *hash = task_fork_hash_on(*hash, name);
    }
    return true;
}

static void more_note(struct task_graph *graph, duite_mode mode, int at, struct data_object *object)
{
    if (mode == DUITE_CW) {
        object->leaves++;
        if (object->holder == graph->rank)
            data_sum_sender(object->sum, at);
        return;
    }
    if (mode != DUITE_W)
        task_note_copy(graph, object, at);
    if (mode != DUITE_R)
        task_note_version(object, at);
}

bool task_prune_more(struct task_graph *graph, const duite_kernel *kernel, const void *args,
                     size_t n, const duite_object *objects)
{
    struct data_object *found[DUITE_MAX_ACCESS];
    const struct task_fixed *fixed = task_kernel_find(graph, kernel);
    if (!fixed || kernel->replicated || !objects || !n || n < fixed->n || n > DUITE_MAX_ACCESS ||
        (n > fixed->n && kernel->variadic == DUITE_NONE) || !task_args_fit(args, kernel->args_size))
        return false;
    const uint32_t own = fixed->owner[n > fixed->n];
    const int at =
        task_owner_rank(TASK_ANYWHERE, false,
                        own == TASK_NOBODY ? -1 : prune_object(&graph->table, objects[own])->home);
    uint64_t hash = task_fork_hash(fixed->index, TASK_ANYWHERE);
    if (at == graph->rank || !more_look_up(graph, kernel, at, n, objects, found, &hash))
        return false;
    for (size_t i = 0; i < n; i++)
        more_note(graph, task_immediate(data_mode_of(kernel, i)), at, found[i]);
    graph->root.forks++;
    task_mix_fork(graph, hash, TASK_FORKED, fixed->index);
    return true;
}
