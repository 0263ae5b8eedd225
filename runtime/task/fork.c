/* Forking, the first stage of a task. Every rank comes through here for every task of the main
 * program, in the same order. Each draws the same conclusions about where the task runs and which
 * versions move. A rank keeps only what it runs, sends or receives itself. A task forks by the same
 * rules in its own scope, whose objects are here and nowhere else. Errors are refused before
 * anything is changed (check.c); afterwards only memory can be missing.
 *
 * One pass over the objects finds them, and one makes the accesses wait. There are three ways, of
 * the same steps (access.h): a short one on one rank, for plain kernels; a short one on several,
 * for kernels with few accesses (task_fixed); and the general one, whose second pass is in
 * depend.c. The short ways leave to it what they do not know, before anything is changed. */
#include "runtime/task/access.h"
#include "runtime/task/event.h"
#include "runtime/task/ready.h"

#include <string.h>

/* ---- The task of a fork ---- */

static inline void fork_copy_args(void *to, const void *from, size_t size)
{
    if (!size)
        return;
    if (size == sizeof(uint64_t)) /* as often: without a call */
        memcpy(to, from, sizeof(uint64_t));
    else
        memcpy(to, from, size);
}

/* The task counts as unfinished. */
ACCESS_INLINE void fork_count(struct task_scope *scope, bool nested)
{
    if (nested)
        atomic_fetch_add_explicit(&scope->unfinished, 1, memory_order_relaxed);
    else
        scope->graph->tasks++;
}

struct task *task_make(struct task_scope *scope, enum task_type type, size_t n, size_t extra)
{
    struct task *task;
    const size_t grains = task_grains(n, extra);
    task = grains <= UINT32_MAX ? base_pool_take(grains * TASK_GRAIN) : NULL;
    if (!task)
        return NULL;
    *task = (struct task){
        .pending = (uint32_t)n + 1,
        .n = (uint32_t)n,
        .scope = scope,
        .number = scope->forks,
        .kernel = UINT32_MAX,
        .block = (uint32_t)scope->forks, /* until it is known to run for an object */
        .priority = INT32_MAX,           /* unless the program forks it */
        .grains = (uint32_t)grains,
        .type = type,
    };
    if (type != TASK_BODY && extra)
        task->sum = task_rest(task, n);
    for (size_t i = 0; i < n; i++)
        task->access[i] = (struct task_access){
            .waiter.back = (uint32_t)(sizeof *task + i * sizeof task->access[0])};
    return task;
}

struct task *task_new(struct task_scope *scope, enum task_type type, size_t n, size_t extra)
{
    struct task *task = task_make(scope, type, n, extra);
    if (!task) {
        task_break(scope->graph, "a task");
        return NULL;
    }
    fork_count(scope, scope->parent != NULL);
    return task;
}

void task_void(struct task_graph *graph, struct worker *worker, struct task *task, size_t made,
               uint32_t done)
{
    uint32_t missing = task->n - (uint32_t)made;
    if (task->type != TASK_BODY)
        task->inner = NULL;
    task->state = TASK_VOID;
    task->n = (uint32_t)made;
    ready_take(graph, worker, task, done + missing + 1);
}

uint64_t task_later_round(const struct task *task)
{
    uint64_t round;
    const size_t args_size = task->scope->graph->kernels[task->kernel]->args_size;
    const char *rest = (const char *)task + sizeof *task + task->n * sizeof task->access[0];
    memcpy(&round, rest + task_round_at(args_size), sizeof round);
    return round;
}

/* ---- The short way on one rank. Compiled once for the main program and once for bodies ---- */

/* This fork names none of the objects of the accesses before `end` after all. Returns false. */
__attribute__((noinline)) static bool plain_unmark(struct task *task, const struct task_access *end)
{
    for (struct task_access *access = task->access; access < end; access++)
        access->object->mark = 0;
    return false;
}

/* Finds the objects. False: one of them needs a second look; nothing was done. */
ACCESS_INLINE bool plain_take_objects(const struct task_fork_call *call, bool nested)
{
    const struct access_look look = access_look_of(call->scope, nested, true);
    const struct task_access *like = call->fixed->head->access;
    struct task_access *access = call->task->access, *const end = access + call->fixed->n;
    for (const duite_object *name = call->objects; access < end; access++, like++, name++) {
        struct data_object *object = access_find(&look, *name, like->waiter.mode);
        if (!object)
            return plain_unmark(call->task, access);
        base_prefetch(object->current);
        *access = *like;
        access->object = object;
        if (!object->current && like->waiter.mode != DUITE_W)
            return plain_unmark(call->task, access + 1);
    }
    return true;
}

/* Makes all of the task but its accesses. */
ACCESS_INLINE void plain_make(const struct task_fork_call *call, const void *args, bool nested)
{
    const struct task_fixed *fixed = call->fixed;
    struct task_scope *scope = call->scope;
    struct task *task = call->task;
    *task = *fixed->head;
    task->scope = scope;
    task->number = ++scope->forks;
    task->block = fixed->owner[0] == TASK_NOBODY ? (uint32_t)scope->forks
                                                 : task->access[fixed->owner[0]].object->block;
    fork_copy_args(task_rest(task, fixed->n), args, fixed->kernel->args_size);
    fork_count(scope, nested);
}

/* The accesses wait. Returns how many have nothing to wait for; *stop: their end, or the one for
 * which there was no memory. */
ACCESS_INLINE uint32_t plain_depend(const struct task_fork_call *call,
                                    const struct task_access **stop, bool nested)
{
    struct task_access *access = call->task->access, *const end = access + call->fixed->n;
    uint32_t done = 0;
    for (; access < end; access++) {
        struct data_object *object = access->object;
        const bool writes = access->waiter.mode != DUITE_R;
        object->number += writes; /* it is nowhere else: its holder stays this rank */
        if (!access_wait(call->scope, access, object, writes, nested, &done))
            break;
    }
    *stop = access;
    return done;
}

/* True if the fork is of this kind: then its task has memory, and its objects are found. */
ACCESS_INLINE bool plain_fits(struct task_fork_call *call, const void *args, bool nested)
{
    const struct task_fixed *fixed = call->fixed =
        task_kernel_find(call->scope->graph, call->kernel);
    if (!fixed || !(nested ? fixed->plain : fixed->direct) || call->n != fixed->n ||
        !task_fork_fits(fixed, args, call->n, call->objects))
        return false;
    const size_t bytes = (size_t)fixed->grains * TASK_GRAIN;
    call->task = base_pool_take(bytes);
    if (!call->task || plain_take_objects(call, nested))
        return call->task != NULL;
    base_pool_give(call->task, bytes);
    return false;
}

/* The compiler knows `nested` and whether there are options. */
ACCESS_INLINE int plain_fork(struct task_scope *scope, struct worker *worker,
                             const struct task_options *options, const duite_kernel *kernel,
                             const void *args, size_t n, const duite_object *objects, bool nested)
{
    struct task_fork_call call;
    const struct task_access *stop;
    task_fork_call_init(&call, scope, worker, kernel, n, objects);
    if (!plain_fits(&call, args, nested))
        return task_fork_any(scope, worker, options ? options : &task_no_options, kernel, args, n,
                             objects);
    plain_make(&call, args, nested);
    if (options) {
        call.task->priority = options->priority;
        call.task->cost = (float)options->cost;
    }
    const uint32_t done = plain_depend(&call, &stop, nested);
    if (stop == call.task->access + call.fixed->n) {
        ready_take(scope->graph, worker, call.task, done + 1);
        return DUITE_OK;
    }
    task_void(scope->graph, worker, call.task, (size_t)(stop - call.task->access), done);
    return task_break(scope->graph, "a version");
}

/* ---- The general way ---- */

const struct task_options task_no_options = {.at = TASK_ANYWHERE};

/* Finds the objects of a fork whose call is right. False: one of them needs a second look; nothing
 * was done. */
ACCESS_INLINE bool fork_take_objects(struct task_fork_call *call, bool nested)
{
    const struct access_look look = access_look_of(call->scope, nested, false);
    for (size_t i = 0; i < call->n; i++) {
        call->object[i] = access_find_any(&look, call->fixed, i, call->objects[i], ACCESS_ANY);
        if (!call->object[i]) {
            access_unmark(call->object, i);
            return false;
        }
    }
    return true;
}

/* True if the fork is right; then its objects are found. Else check.c looks again. */
static inline bool fork_take(struct task_fork_call *call, int at, const void *args)
{
    const struct task_fixed *fixed = call->fixed =
        task_kernel_find(call->scope->graph, call->kernel);
    if (!fixed || at != TASK_ANYWHERE || call->n > TASK_FEW ||
        !task_fork_fits(fixed, args, call->n, call->objects))
        return false;
    return call->scope->depth ? fork_take_objects(call, true) : fork_take_objects(call, false);
}

/* NULL without memory. */
static struct task *fork_body(const struct task_fork_call *call, const struct task_options *options,
                              const void *args)
{
    struct task_scope *scope = call->scope;
    const duite_kernel *kernel = call->kernel;
    const size_t round_at = task_round_at(kernel->args_size);
    size_t rest = options->round ? round_at + sizeof options->round : kernel->args_size;
    if (kernel->events)
        rest = task_held_at(kernel->args_size) + sizeof(struct task_held);
    struct task *task = task_new(scope, TASK_BODY, call->n, rest);
    if (!task)
        return NULL;
    task->state = kernel->events ? TASK_HELD : TASK_LOCAL;
    task->later = options->round != 0;
    if (task->later)
        memcpy((char *)task_rest(task, call->n) + round_at, &options->round, sizeof options->round);
    task->kernel = call->fixed->index;
    task->priority = options->priority;
    task->cost = (float)options->cost;
    task->at_rank = options->at != TASK_ANYWHERE;
    fork_copy_args(task_rest(task, call->n), args, kernel->args_size);
    size_t postponed = call->fixed->postponed;
    if (task_postponed(kernel->variadic))
        postponed += call->n - call->fixed->n;
    if (!postponed || (task->inner = task_scope_new(task, postponed)))
        return task;
    task_break(scope->graph, "a task");
    task_void(scope->graph, call->worker, task, 0, 0);
    return NULL;
}

/* Makes the task run for the object; `follows`: at the object's home. */
static void fork_give_block(struct task *task, struct data_object *own, bool follows)
{
    task->block = own->block;
    task->placed = follows;
    own->fixed |= follows && task->scope->graph->kernels[task->kernel]->fixed;
    if (task->inner) {
        task->inner->block = task->block;
        task->inner->placed = task->placed;
    }
}

/* The object that the task runs for, or NULL. */
static inline struct data_object *fork_own(const struct task_fork_call *call)
{
    const uint32_t owner = task_fork_owner(call);
    return owner == TASK_NOBODY ? NULL : task_fork_object(call, owner);
}

/* This rank runs the task of a right fork: only memory can be missing. */
static int fork_here(struct task_fork_call *call, const struct task_options *options,
                     const void *args)
{
    struct data_object *own = fork_own(call);
    if (!(call->task = fork_body(call, options, args)))
        return DUITE_E_MEMORY;
    if (own)
        fork_give_block(call->task, own, task_owner_decides(options->at, call->kernel->replicated));
    return task_depend(call);
}

int task_fork_any(struct task_scope *scope, struct worker *worker,
                  const struct task_options *options, const duite_kernel *kernel, const void *args,
                  size_t n, const duite_object *objects)
{
    struct task_graph *graph = scope->graph;
    struct task_fork_call call;
    task_fork_call_init(&call, scope, worker, kernel, n, objects);
    const int code =
        fork_take(&call, options->at, args) ? DUITE_OK : task_fork_check(&call, options->at, args);
    if (code)
        return code;
    scope->forks++;
    call.at = graph->rank;
    if (!scope->depth && graph->n_ranks > 1) {
        const struct data_object *own = fork_own(&call);
        call.at = task_owner_rank(options->at, kernel->replicated, own ? own->home : -1);
        task_mix_fork(
            graph, task_fork_hash_all(task_fork_what(call.fixed->index, options->at), n, objects),
            COMM_FORKED, call.fixed->index);
    }
    if (call.at != graph->rank && call.at != TASK_EVERYWHERE)
        return task_depend(&call);
    call.at = graph->rank;
    return fork_here(&call, options, args);
}

/* ---- The short way on several ranks, whose tasks mostly run elsewhere. Compiled once for plain
 * kernels and once for those that contribute, too ---- */

/* Finds the objects, and hashes their names. False: one needs a second look; nothing was done. */
ACCESS_INLINE bool ranks_take_objects(const struct task_fork_call *call,
                                      struct data_object **object, uint64_t *hash,
                                      enum access_kernels kernels)
{
    const bool plain = kernels == ACCESS_PLAIN;
    const struct access_look look = access_look_of(call->scope, false, plain);
    for (size_t i = 0; i < call->n; i++) {
        object[i] = plain ? access_find(&look, call->objects[i], DUITE_NONE)
                          : access_find_any(&look, call->fixed, i, call->objects[i], kernels);
        *hash = task_fork_hash_on(*hash, call->objects[i]);
        if (!object[i]) {
            access_unmark(object, i);
            return false;
        }
    }
    return true;
}

/* This rank runs it. A function apart: in the other ones the call stays in registers. */
__attribute__((noinline)) static int ranks_here(const struct task_fixed *fixed,
                                                struct task_scope *scope, struct worker *worker,
                                                const void *args, const duite_object *objects,
                                                struct data_object *const *object)
{
    struct task_fork_call call;
    task_fork_call_init(&call, scope, worker, fixed->kernel, fixed->n, objects);
    call.fixed = fixed;
    call.at = scope->graph->rank;
    memcpy(call.object, object, fixed->n * sizeof *object);
    return fork_here(&call, &task_no_options, args);
}

ACCESS_INLINE int ranks_fork(struct task_graph *graph, struct worker *worker,
                             const struct task_fixed *fixed, const void *args, size_t n,
                             const duite_object *objects, enum access_kernels kernels)
{
    struct task_scope *root = &graph->root;
    struct data_object *object[TASK_FEW];
    struct task_fork_call call;
    uint64_t hash = fixed->hash;
    task_fork_call_init(&call, root, worker, fixed->kernel, n, objects);
    call.fixed = fixed;
    if (!ranks_take_objects(&call, object, &hash, kernels))
        return task_fork_any(root, worker, &task_no_options, fixed->kernel, args, n, objects);
    root->forks++;
    task_mix_fork(graph, hash, COMM_FORKED, fixed->index);
    const uint32_t own = fixed->owner[0];
    call.at = task_owner_rank(TASK_ANYWHERE, false, own == TASK_NOBODY ? -1 : object[own]->home);
    if (call.at == graph->rank)
        return ranks_here(fixed, root, worker, args, objects, object);
    int code = DUITE_OK;
    for (size_t i = 0; i < n && !code; i++)
        code = access_elsewhere(&call, i, object[i], kernels);
    return code;
}

__attribute__((noinline)) static int
ranks_contribute(struct task_graph *graph, struct worker *worker, const struct task_fixed *fixed,
                 const void *args, size_t n, const duite_object *objects)
{
    return ranks_fork(graph, worker, fixed, args, n, objects, ACCESS_FEW);
}

int task_fork_ranks(struct task_graph *graph, struct worker *worker, const duite_kernel *kernel,
                    const void *args, size_t n, const duite_object *objects)
{
    const struct task_fixed *fixed = task_kernel_find(graph, kernel);
    if (!fixed || !fixed->few || n != fixed->n || !n || !objects ||
        !task_args_fit(args, kernel->args_size))
        return task_fork_any(&graph->root, worker, &task_no_options, kernel, args, n, objects);
    return fixed->plain ? ranks_fork(graph, worker, fixed, args, n, objects, ACCESS_PLAIN)
                        : ranks_contribute(graph, worker, fixed, args, n, objects);
}

/* ---- The entries ---- */

int task_fork_main(struct task_graph *graph, struct worker *worker, const duite_kernel *kernel,
                   const void *args, size_t n, const duite_object *objects)
{
    return plain_fork(&graph->root, worker, NULL, kernel, args, n, objects, false);
}

int task_fork_nested(struct task_scope *scope, struct worker *worker, const duite_kernel *kernel,
                     const void *args, size_t n, const duite_object *objects)
{
    return plain_fork(scope, worker, NULL, kernel, args, n, objects, true);
}

int task_fork(struct task_scope *scope, struct worker *worker, const struct task_options *options,
              const duite_kernel *kernel, const void *args, size_t n, const duite_object *objects)
{
    if (options->at != TASK_ANYWHERE)
        return task_fork_any(scope, worker, options, kernel, args, n, objects);
    return plain_fork(scope, worker, options, kernel, args, n, objects, scope->depth != 0);
}
