#ifndef DUITE_TASK_INTERNAL_H
#define DUITE_TASK_INTERNAL_H

#include "runtime/task/body.h"

#include "runtime/base/error.h"
#include "runtime/task/fork.h"

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Shared by this folder and those that make tasks: plan/ and offload/. */

/* A task with n accesses and `extra` bytes behind them (task_rest); pending is n + 1; counted
 * as unfinished. NULL without memory: then the graph is broken. */
struct task *task_new(struct task_scope *scope, enum task_type type, size_t n, size_t extra);

/* The same, not counted. NULL without memory: nothing else happened. */
struct task *task_make(struct task_scope *scope, enum task_type type, size_t n, size_t extra);

/* The size of such a task in units of TASK_GRAIN. */
static inline size_t task_grains(size_t n, size_t extra)
{
    return (sizeof(struct task) + n * sizeof(struct task_access) + extra + TASK_GRAIN - 1) /
           TASK_GRAIN;
}

/* Access i of the task, by its mode r, w or rw, waits for the object's current version, and leaves
 * a new one if it writes. Adds one to *done if there is nothing to wait for. Errors: memory; the
 * graph is broken. */
int task_wait(struct task_scope *scope, struct task *task, size_t i, struct data_object *object,
              uint32_t *done);

/* This rank's copy of the current version, which must be here or on its way (task_fetch); zeros if
 * it was never written. NULL without memory: the graph is broken. */
struct data_version *task_local(struct task_graph *graph, struct data_object *object);

/* Every rank notes this for every task, even if it has no part in it. task_note_copy: `rank` reads
 * the current version; true if it gets a copy only now. task_note_version: `holder` makes a new
 * version, and alone has a copy. */
static inline bool task_note_copy(struct task_graph *graph, struct data_object *object, int rank)
{
    if (object->holder == rank || data_object_has_copy(&graph->table, object, rank))
        return false;
    data_object_add_copy(&graph->table, object, rank);
    return true;
}
static inline void task_note_version(struct data_object *object, int holder)
{
    object->number++;
    data_object_moved(object, holder);
}

/* Brings the current version to rank `to`: this rank sends it, awaits it, or notes that others do
 * so. */
int task_fetch(struct task_graph *graph, struct worker *worker, struct data_object *object, int to);
/* The same for all ranks. */
int task_fetch_all(struct task_graph *graph, struct worker *worker, struct data_object *object);

/* All ranks read the current version, and have the one that they all write. */
int task_note_everywhere(struct task_graph *graph, struct worker *worker,
                         struct data_object *object, duite_mode mode);

/* The object has a new version on another rank: this rank's copy is stale. */
void task_forget(struct task_graph *graph, struct worker *worker, struct data_object *object);
/* Adopted memory is given back. task_leave: the value that the forks so far leave comes home, and a
 * task puts it there (task_run_leave). task_leave_now: at stop, of an object that was not freed;
 * unless a task uses it that can never end. */
int task_leave(struct task_graph *graph, struct worker *worker, struct data_object *object);
void task_run_leave(struct task *task);
void task_leave_now(struct data_object *object);

/* Parts. task_join_over: the task of a join is over, with or without its body. task_join_rest:
 * joins what a body that ends has split. task_split_drop: at stop, of an object that was not
 * joined; its parts leave on their own. */
void task_join_over(const void *args, const struct data_failure *failure);
void task_join_rest(struct duite_call_private *body);
void task_split_drop(struct data_object *object);
/* A version of the object with these bytes (values NULL: zeros), for the object alone to hold. NULL
 * without memory. */
struct data_version *task_value_version(const struct data_object *object, const void *values,
                                        size_t bytes);

/* Contributions. task_contribute adds a leaf for access i of a task on rank `at` (NULL: another
 * one); a sum of another law is closed. task_reduce closes the sum: its contributions are
 * combined. */
int task_contribute(struct task_graph *graph, struct task *task, size_t i,
                    struct data_object *object, const duite_law *law, int at);
int task_reduce(struct task_scope *scope, struct worker *worker, struct data_object *object);
extern const struct data_failure task_sum_no_memory;
void task_run_combine(struct task *task);
void task_run_pieces(struct task *task);
/* Combines the contributions of a task's children into `leaf`, which is the task's. */
int task_gather(struct task_scope *scope, struct worker *worker, struct data_object *object,
                struct data_piece *leaf);
void task_run_gather(struct task *task);

/* The kernels of a graph that starts, or stops (kernels.c). Errors: DUITE_E_KERNEL, DUITE_E_LAW,
 * memory; the stop is due all the same. */
int task_kernels_start(struct task_graph *graph, const duite_kernel *const *kernels,
                       const duite_law *const *laws);
void task_kernels_stop(struct task_graph *graph);

/* The place where a search for a kernel begins in the table of kernel addresses. */
static inline uint32_t task_kernel_hash(const duite_kernel *kernel)
{
    return (uint32_t)((uint64_t)(uintptr_t)kernel * 0x9e3779b97f4a7c15u >> 32);
}

/* The kernel among those given at start, or NULL. Each fork asks, so this is an open table: uthash
 * would hash all bytes of the key and take two more dependent loads. */
static inline const struct task_fixed *task_kernel_find(const struct task_graph *graph,
                                                        const duite_kernel *kernel)
{
    for (uint32_t at = task_kernel_hash(kernel);; at++) {
        const struct task_fixed *found = graph->kernel_place[at & graph->kernel_mask];
        if (!found || found->kernel == kernel)
            return found;
    }
}

/* ---- Nesting ---- */

static inline bool task_postponed(duite_mode mode)
{
    return mode >= DUITE_RP;
}
/* The mode that makes the same dependences. */
static inline duite_mode task_immediate(duite_mode mode)
{
    return task_postponed(mode) ? (duite_mode)(mode - DUITE_RP + DUITE_R) : mode;
}
const char *task_mode_name(duite_mode mode);

/* The scope of a task that has room for n postponed parameters. NULL without memory. */
struct task_scope *task_scope_new(const struct task *task, size_t n);
/* Moves a postponed parameter into the task's scope: the object with its version, and `out` or the
 * access's leaf, to be passed back at the end. */
void task_lend(struct task_scope *inner, struct task_access *access,
               const struct data_object *object, struct data_version *version,
               struct data_version *out);
/* A task on another rank (away.c). There, task_lend_value does the same for an object with this
 * value; the object's `current` does not count. Later, task_lent_left returns the result: no values
 * if the object was only read, got no contributions, or is poisoned. The access owns the values
 * until task_lent_drop, which is due for each lent parameter. At home, task_lent_comes_home gives
 * the scope a copy of the result. */
struct task_left_value {
    const void *values;
    size_t bytes;
    const struct data_failure *failure;
};
bool task_lend_value(struct task_scope *inner, struct task_access *access,
                     const struct data_object *object, const void *values, size_t bytes);
struct task_left_value task_lent_left(const struct task_access *access);
void task_lent_drop(struct task_access *access);
void task_lent_comes_home(struct task_scope *inner, struct worker *worker, size_t lent,
                          const struct task_left_value *left);
/* The object in the scope of a postponed parameter; `lent` is access->lent. */
struct data_object *task_lent_object(struct task_scope *scope, size_t lent);
/* The task of the scope failed, or read poison: its results will be poisoned. */
void task_scope_fail(struct task_scope *scope, const struct data_failure *failure);
/* The body is over, or never ran: the children's results go to the scope above, poisoned after
 * task_scope_fail. */
void task_scope_end(struct task_scope *scope, struct worker *worker);
/* A task of the scope is over with its descendants, or a value was passed on. The last to leave a
 * task's scope frees it and leaves the one above: task_left_last, not inline. */
void task_left_last(struct task_graph *graph, struct task_scope *scope, struct worker *worker);
static inline void task_left(struct task_graph *graph, struct task_scope *scope,
                             struct worker *worker)
{
    /* No look into the root: the main thread writes its line with every fork. */
    if (scope == &graph->root)
        queue_over(graph->pool, worker);
    else if (!scope->parent ||
             atomic_fetch_sub_explicit(&scope->unfinished, 1, memory_order_acq_rel) == 1)
        task_left_last(graph, scope, worker);
}
/* The object of that name, with the right held on it; NULL with the error's message set. */
struct data_object *task_find_object(struct task_scope *scope, duite_object name,
                                     duite_mode *right);

/* A fork under way. fork.c finds its objects and decides where its task runs; depend.c goes through
 * its accesses. It is passed by pointer, since handing data between stages is most of a fork's
 * cost. */
enum { TASK_FEW = 16 };
struct task_fork_call {
    struct task_scope *scope; /* where it is forked */
    struct worker *worker;    /* who forks */
    const duite_kernel *kernel;
    size_t n;
    const duite_object *objects;
    const struct task_fixed *fixed;       /* of the kernel */
    struct task *task;                    /* NULL: other ranks run it */
    int at;                               /* the rank that runs it */
    uint32_t done;                        /* accesses that have nothing to wait for, so far */
    struct data_object *object[TASK_FEW]; /* the first ones */
};

/* `object` stays unset to save time: each is looked up before it is used. */
static inline void task_fork_call_init(struct task_fork_call *call, struct task_scope *scope,
                                       struct worker *worker, const duite_kernel *kernel, size_t n,
                                       const duite_object *objects)
{
    call->scope = scope;
    call->worker = worker;
    call->kernel = kernel;
    call->n = n;
    call->objects = objects;
    call->task = NULL;
    call->done = 0;
}

/* The mode of parameter i, as data_mode_of. */
static inline duite_mode task_mode_of(const struct task_fixed *fixed, size_t i)
{
    return i < fixed->n ? (duite_mode)fixed->kernel->access[i] : fixed->kernel->variadic;
}

/* True if arguments and number of objects are right. */
static inline bool task_fork_fits(const struct task_fixed *fixed, const void *args, size_t n,
                                  const duite_object *objects)
{
    const bool n_fits = n == fixed->n || (n > fixed->n && fixed->kernel->variadic != DUITE_NONE);
    return n_fits && (objects || !n) && task_args_fit(args, fixed->kernel->args_size);
}

/* The parameter that the task runs for, or TASK_NOBODY. */
static inline uint32_t task_fork_owner(const struct task_fork_call *call)
{
    return call->fixed->owner[call->n > call->fixed->n];
}

/* Object i of the fork. The first TASK_FEW were found already. */
static inline struct data_object *task_fork_object(const struct task_fork_call *call, size_t i)
{
    duite_mode right;
    return i < TASK_FEW ? call->object[i] : task_find_object(call->scope, call->objects[i], &right);
}

/* Checks that a fork fits its kernel, arguments and objects, which are found and marked. at: the
 * rank that it names, or TASK_ANYWHERE. */
int task_fork_check(struct task_fork_call *call, int at, const void *args);
/* Unmarks the first n objects: this fork does not name them after all. */
void task_fork_unmark(const struct task_fork_call *call, size_t n);

/* Turns the task's accesses into versions on this rank, which runs it or not. The task is ready
 * once all its inputs are there. Errors: memory, broken; the accesses before the error are kept,
 * and the task is void. */
int task_depend(struct task_fork_call *call);

/* Retires the name of an object that the task made. */
void task_drop(struct task_scope *scope, struct data_object *object);
/* The slots of the names that bodies use: parameters first, then the objects they made. */
#define TASK_LOCAL_NAME UINT32_C(0x80000000)
/* The generations of such names: each number recurs in this process only after 2^32 of them.
 * Threads draw them in batches. */
enum { TASK_STAMPS = 1 << 20 /* a batch */ };
extern _Thread_local uint32_t task_stamp __attribute__((tls_model("initial-exec")));
uint32_t task_new_stamps(void);
static inline uint32_t task_new_stamp(void)
{
    return (task_stamp + 1) % TASK_STAMPS ? ++task_stamp : task_new_stamps();
}
/* Passes a value on for a waiter that is no task (a task_exit). Returns the heir of the version
 * that gets the value, if that version has no more holds. */
struct data_waiter *task_pass(struct worker *worker, struct data_waiter *waiter);
/* Checks that a child may have the object with this mode. The message names `call` (a call or a
 * kernel) and parameter i. */
int task_check_right(struct task_scope *scope, const char *call, size_t i, duite_object name,
                     duite_mode wanted);
/* DUITE_E_RIGHT: a child contributes by another law than that of the contribution it is part of. */
int task_wrong_law(const struct task_scope *scope, const duite_kernel *kernel, size_t i,
                   duite_object name);

/* ---- Failures ---- */

/* The version that a BODY writes by this access (w, rw), or NULL. */
static inline struct data_version *task_written(const struct task_access *access)
{
    const uint32_t mode = access->waiter.mode;
    return mode == DUITE_W || mode == DUITE_RW ? access->waiter.version : NULL;
}

/* Keeps a failure, its place filled in, until stop; the waits of `scope` (NULL: of none) and of all
 * scopes above return it. Never NULL. */
const struct data_failure *task_fail(struct task_graph *graph, const struct data_failure *failure,
                                     struct task_scope *scope);
/* The same for a task, with its scope or NULL. Fills in the failure's place; the waits of all
 * scopes above return it, too. */
const struct data_failure *task_fail_task(const struct task *task, const struct task_scope *inner,
                                          struct data_failure *failure);
/* Its place: number and path. */
void task_failure_place(struct data_failure *failure, const struct task *task,
                        const struct task_scope *inner);
/* Poisons all that the task writes. */
void task_poison_outputs(struct task *task, const struct data_failure *failure);
/* The failure of a task for want of memory. */
const struct data_failure *task_fail_memory(const struct task *task);
struct data_packet *task_poison_packet(struct data_key key, const struct data_failure *failure);

/* Checks that the object may be set to so many elements. */
int task_set_check(const struct data_object *object, duite_object name, size_t count);

/* Memory ran out at access `made`: the accesses before it are kept, or others would wait for ever.
 */
void task_void(struct task_graph *graph, struct worker *worker, struct task *task, size_t made,
               uint32_t done);

/* The failure of values that did not come because communication broke. */
extern const struct data_failure task_lost_failure;

/* The key of the current version of a main program's object. */
static inline struct data_key task_key(const struct task_graph *graph,
                                       const struct data_object *object)
{
    const uint32_t slot = (uint32_t)(object - graph->table.object);
    return (struct data_key){slot, object->generation, object->number};
}

/* There is no memory for `what` in the middle of a fork: the ranks no longer agree on what was
 * forked. */
static inline int task_break(struct task_graph *graph, const char *what)
{
    graph->broken = DUITE_E_MEMORY;
    return base_no_memory(what);
}

#pragma GCC visibility pop

#endif
