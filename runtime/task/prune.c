/* Forks of which nothing is on this rank: most of them, where there are many ranks. What task_fork
 * would conclude about them is that other ranks have new versions and copies; it is noted in one
 * go. Whatever is not plain (accumulation, views, further objects than the listed ones, anything
 * wrong) is left to task_fork. */
#include "runtime/task/internal.h"

static inline bool prune_writes(duite_mode mode)
{
    mode = task_immediate(mode);
    return mode == DUITE_W || mode == DUITE_RW;
}

/* Makes it the kernel of graph->prune, if its tasks are plain. */
static bool prune_find_kernel(struct task_graph *graph, const duite_kernel *kernel)
{
    uint32_t i = task_kernel_index(graph, kernel), n = 0;
    if (i == graph->n_kernels || kernel->replicated)
        return false;
    struct task_prune prune = {
        .kernel = kernel, .index = i, .n = graph->fixed[i].n, .owner = graph->fixed[i].owner[0]};
    for (; n < prune.n; n++) {
        duite_mode mode = kernel->access[n];
        if (task_immediate(mode) == DUITE_CW)
            return false;
        prune.reads |= (uint64_t)(task_immediate(mode) != DUITE_W) << n;
        prune.writes |= (uint64_t)prune_writes(mode) << n;
    }
    graph->prune = prune;
    return true;
}

/* Whether the objects exist, are different ones, and nothing of them is here. One look decides
 * about all: which of them is to blame does not matter. Marks are not those of task_fork. */
static inline bool prune_look_up(const struct task_graph *graph, size_t n,
                                 const duite_object *objects, struct data_object **found,
                                 uint64_t *hash)
{
    const uint32_t n_slots = graph->table.n_slots;
    const int rank = graph->rank;
    const uint64_t mark = ~graph->root.forks;
    uint32_t alive = 1; /* generations of objects are odd */
    uint64_t wrong = 0;
    for (size_t i = 0; i < n; i++) {
        const duite_object name = objects[i];
        struct data_object *object = &graph->table.object[name.slot < n_slots ? name.slot : 0];
        found[i] = object;
        alive &= name.generation;
        wrong |= (uint64_t)(object->generation ^ name.generation) |
                 (uint64_t)(object->holder == rank) | (uint64_t)(object->mark == mark);
        wrong |= (uintptr_t)object->current | (uintptr_t)object->view | object->leaves;
        object->mark = mark;
        *hash = task_fork_hash_on(*hash, name);
    }
    return !wrong && alive;
}

bool task_prune(struct task_graph *graph, const duite_kernel *kernel, const void *args, size_t n,
                const duite_object *objects)
{
    struct data_object *found[DUITE_MAX_ACCESS];
    if (!kernel || (kernel != graph->prune.kernel && !prune_find_kernel(graph, kernel)))
        return false;
    const struct task_prune *const prune = &graph->prune;
    uint64_t hash = task_fork_hash(prune->index, TASK_ANYWHERE);
    if (n != prune->n || !n || !objects || (kernel->args_size && !args) ||
        !prune_look_up(graph, n, objects, found, &hash))
        return false;
    int at = task_owner_rank(TASK_ANYWHERE, false, found[prune->owner]->home);
    if (at == graph->rank)
        return false;
    const uint64_t reads = prune->reads, writes = prune->writes;
    for (size_t i = 0; i < n; i++) {
        if (reads >> i & 1)
            task_note_copy(graph, found[i], at);
        if (writes >> i & 1)
            task_note_version(found[i], at);
    }
    graph->root.forks++;
    task_mix_fork(graph, hash, prune->index);
    return true;
}
