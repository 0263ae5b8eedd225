#ifndef DUITE_TASK_PRUNE_H
#define DUITE_TASK_PRUNE_H

#include "runtime/task/internal.h"

/* Forks of which nothing is on this rank: most of them, if there are many ranks. All that task_fork
 * would conclude is that other ranks have new versions and copies; task_prune notes that in one go.
 * Other forks (accumulation, objects beyond the listed ones, values that are here, too) are left to
 * task_prune_more, and errors to task_fork. Inline: the call that forks is as short as this. */

static inline struct data_object *prune_object(const struct data_table *table, duite_object name)
{
    return &table->object[name.slot < table->n_slots ? name.slot : 0];
}

/* True if the objects exist and differ, and this rank has no copy of them and no part in a sum of
 * them. One look decides about all; it does not tell which one failed. The marks differ from those
 * of task_fork. *moves: rank `at` is not the holder of some of them. */
static inline bool prune_look_up(const struct task_graph *graph, int at, size_t n,
                                 const duite_object *objects, struct data_object **found,
                                 uint64_t *hash, bool *moves)
{
    const uint64_t mark = ~graph->root.forks;
    uint32_t alive = 1, others = 0; /* generations of objects are odd */
    uint64_t wrong = 0;
    for (size_t i = 0; i < n; i++) {
        const duite_object name = objects[i];
        struct data_object *object = found[i] = prune_object(&graph->table, name);
        alive &= name.generation;
        others |= (uint32_t)(object->holder ^ at);
        wrong |= (uint64_t)(object->generation ^ name.generation) | (object->mark == mark);
        wrong |= (uintptr_t)object->current | object->leaves;
        object->mark = mark;
        *hash = task_fork_hash_on(*hash, name);
    }
    *moves = others != 0;
    return !wrong && alive;
}

/* Notes that rank `at` gets copies of the objects that it reads and does not hold. False: this rank
 * holds one of the objects. */
static inline bool prune_note_copies(struct task_graph *graph, const struct task_fixed *fixed,
                                     int at, struct data_object *const *found)
{
    for (uint32_t i = 0; i < fixed->n; i++)
        if (found[i]->holder == graph->rank)
            return false;
    for (uint32_t i = 0; i < fixed->n; i++)
        if (fixed->reads >> i & 1)
            task_note_copy(graph, found[i], at);
    return true;
}

/* Forks a task of the main program if neither the task nor anything it names is on this rank: it
 * only notes the fork. False: nothing was done, task_fork is due. Main thread; collective with
 * task_fork on other ranks; the homes of all objects are settled. */
__attribute__((always_inline)) static inline bool task_prune(struct task_graph *graph,
                                                             const duite_kernel *kernel,
                                                             const void *args, size_t n,
                                                             const duite_object *objects)
{
    struct data_object *found[DUITE_MAX_ACCESS];
    const struct task_fixed *fixed = task_kernel_find(graph, kernel);
    if (!fixed || !fixed->prunes || n != fixed->n || !objects ||
        !task_args_fit(args, kernel->args_size))
        return false;
    const int at = task_owner_rank(TASK_ANYWHERE, false,
                                   prune_object(&graph->table, objects[fixed->owner[0]])->home);
    uint64_t hash = task_fork_hash(fixed->index, TASK_ANYWHERE);
    bool moves;
    if (at == graph->rank || !prune_look_up(graph, at, n, objects, found, &hash, &moves) ||
        (moves && !prune_note_copies(graph, fixed, at, found)))
        return false;
    for (uint64_t writes = fixed->writes; writes; writes &= writes - 1)
        task_note_version(found[__builtin_ctzll(writes)], at);
    graph->root.forks++;
    task_mix_fork(graph, hash, COMM_FORKED, fixed->index);
    return true;
}

/* The same if parts of its objects may be here, but the task asks nothing of them
 * (prune_more.c). */
bool task_prune_more(struct task_graph *graph, const duite_kernel *kernel, const void *args,
                     size_t n, const duite_object *objects);

#endif
