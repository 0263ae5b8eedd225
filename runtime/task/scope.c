/* Tasks that fork: the scope of a task, while its body runs. It has an object of its own for each
 * that the children may use. A lent object is a stretch of the chain of versions of the scope
 * above: it begins with the version that the task would have taken over. When the body is over,
 * scope_end.c gives back what the children leave. So nobody waits for a task with postponed
 * parameters, only for the values. A contribution is lent as a sum of its own, whose result becomes
 * the leaf. A task may give a child the rights that its kernel's modes allow, and all objects that
 * it made.
 *
 * While the body runs, only its worker uses the objects. */
#include "runtime/task/scope.h"

#include "runtime/base/memory.h"
#include "runtime/data/law.h"

#include <string.h>

/* With the initial-exec model, also in this file, a thread reaches these without a call. */
#define THREAD_OWN _Thread_local __attribute__((tls_model("initial-exec")))
THREAD_OWN struct duite_call_private *task_innermost;

/* ---- Names ---- */

THREAD_OWN uint32_t task_stamp = UINT32_MAX; /* the last one of no batch */

/* Multiples of a batch are left out, and so is 0, which no name has. */
uint32_t task_new_stamps(void)
{
    static _Atomic uint32_t batches;
    task_stamp = TASK_STAMPS * atomic_fetch_add_explicit(&batches, 1, memory_order_relaxed);
    return ++task_stamp;
}

struct data_object *task_find_object(struct task_scope *scope, duite_object name, duite_mode *right)
{
    *right = DUITE_RWP;
    if (!scope->depth)
        return data_object_find(&scope->graph->table, name);
    struct data_object *local;
    if (task_name_known(scope, name, right, &local) && local)
        return local;
    base_error(DUITE_E_OBJECT,
               "object %u.%u is none of this task's: it was freed, or belongs to "
               "another task",
               name.slot, name.generation);
    return NULL;
}

/* ---- Making a scope, and objects in it ---- */

static size_t nest_size(size_t n_lent)
{
    return sizeof(struct task_nest) + n_lent * sizeof(struct task_exit);
}

/* In whole cache lines, at which cells begin. */
static size_t nest_lines(size_t bytes)
{
    return (bytes + BASE_LINE - 1) / BASE_LINE * BASE_LINE;
}

enum { CELLS = 2 }; /* of a scope to which nothing is lent */

/* Inline because a caller passes a constant. */
static inline struct task_scope *nest_new(const struct task *task, size_t n)
{
    enum { SPARE = 3 };
    const size_t exits = nest_size(n);
    const size_t cells = nest_lines(exits + (n + SPARE) * sizeof(struct data_object));
    const size_t size = n ? cells : cells + CELLS * sizeof(struct task_cell);
    struct task_nest *nest = base_pool_take(size);
    if (!nest)
        return NULL;
    nest->scope = (struct task_scope){.graph = task->scope->graph,
                                      .parent = task->scope,
                                      .top = task->scope->top,
                                      .unfinished = 1,
                                      .number = task->number,
                                      .block = task->block,
                                      .placed = task->placed,
                                      .depth = task->scope->depth + 1};
    nest->body = NULL;
    nest->failure = NULL;
    nest->n_lent = nest->n_local = 0;
    nest->room = (uint32_t)(n + SPARE);
    nest->cells = n ? 0 : (uint32_t)cells;
    nest->vacant = nest->first_read = 0;
    nest->local = (void *)((char *)nest + exits);
    nest->moved = false;
    nest->splits = 0;
    nest->size = size;
    return &nest->scope;
}

struct task_scope *task_scope_new(const struct task *task, size_t n)
{
    return nest_new(task, n);
}

struct data_object *task_lent_object(struct task_scope *scope, size_t lent)
{
    return &task_nest_of(scope)->local[lent];
}

struct task_scope *task_scope_begin(struct duite_call_private *body)
{
    const struct task *task = body->task;
    body->scope = nest_new(task, 0);
    if (!body->scope) {
        base_no_memory("what a task forks");
        return NULL;
    }
    task_nest_of(body->scope)->body = body;
    if (task->type == TASK_NODE) /* the main program waits for what it forks, too */
        queue_more(body->worker);
    return body->scope;
}

/* An object of the scope, without a name and a version. */
static inline void nest_object(const struct task_nest *nest, struct data_object *object,
                               duite_type type, size_t count, size_t max, uint32_t block)
{
    const size_t size = data_type_size(type);
    data_object_clear(object);
    object->type = type;
    object->count = count;
    object->bytes = count * size;
    object->max = max;
    object->room = max * size;
    object->home = object->holder = nest->scope.graph->rank;
    object->block = block;
}

void task_lend(struct task_scope *inner, struct task_access *access,
               const struct data_object *object, struct data_version *version,
               struct data_version *out)
{
    struct task_nest *nest = task_nest_of(inner);
    struct task_exit *exit = &nest->exit[nest->n_lent];
    *exit = (struct task_exit){.scope = inner,
                               .out = out,
                               .bytes = object->room,
                               .overwrites = access->waiter.mode == DUITE_WP};
    if (access->waiter.mode == DUITE_CWP) {
        exit->sum = access->leaf->sum;
        exit->leaf = access->leaf;
    }
    struct data_object *local = &nest->local[nest->n_lent];
    nest_object(nest, local, object->type, object->count, object->max, object->block);
    local->sized = object->sized;
    local->adopted = object->adopted;
    local->law = object->law;
    local->current = version;
    access->lent = nest->n_lent;
    nest->n_local = ++nest->n_lent;
    nest->scope.outward |= access->waiter.mode != DUITE_CWP;
}

/* The objects move to a block with room for n more. */
static int nest_grow(struct task_nest *nest, uint32_t n)
{
    uint32_t room = nest->room;
    while (room - nest->n_local < n)
        room *= 2;
    struct data_object *more = base_pool_take(room * sizeof *more);
    if (!more)
        return base_no_memory("an object");
    memcpy(more, nest->local, nest->n_local * sizeof *more);
    if (nest->moved)
        base_pool_give(nest->local, nest->room * sizeof *more);
    nest->local = more;
    nest->room = room;
    nest->moved = true;
    return DUITE_OK;
}

/* Places for n more objects, one after the other. */
static inline int nest_take_places(struct task_nest *nest, uint32_t n, uint32_t *first)
{
    const int code = nest->room - nest->n_local < n ? nest_grow(nest, n) : DUITE_OK;
    *first = nest->n_local;
    nest->n_local += code ? 0 : n;
    return code;
}

/* A place for an object: of one that was freed, or a new one. */
__attribute__((noinline)) static int nest_place(struct task_nest *nest, uint32_t *at)
{
    if (!nest->vacant)
        return nest_take_places(nest, 1, at);
    *at = nest->vacant - 1;
    nest->vacant = nest->local[*at].hint;
    return DUITE_OK;
}

int task_make_object(struct duite_call_private *body, duite_type type, size_t count, size_t max,
                     bool sized, duite_object *name)
{
    struct task_scope *scope = task_inside(body);
    struct task_nest *nest = task_nest_of(scope);
    int code = data_object_check(type, count, max);
    if (code || !scope)
        return code ? code : DUITE_E_MEMORY;
    uint32_t at = nest->n_local, cell = 0;
    if (nest->vacant || at == nest->room) {
        if ((code = nest_place(nest, &at)))
            return code;
    } else {
        nest->n_local++;
        if (at < CELLS && nest->cells && !sized)
            cell = nest->cells + at * (uint32_t)sizeof(struct task_cell);
    }
    struct data_object *object = &nest->local[at];
    nest_object(nest, object, type, count, max, (uint32_t)scope->forks);
    object->generation = task_new_stamp();
    object->sized = sized;
    object->hint = object->room <= BASE_LINE ? cell : 0;
    uint32_t slot = TASK_LOCAL_NAME | (body->task->n + at - nest->n_lent);
    *name = (duite_object){slot, object->generation};
    return DUITE_OK;
}

/* The version that the body reads: of a forked task the version itself, in a replay a copy of the
 * bytes in place. NULL without memory. */
static struct data_version *read_version(const struct duite_call_private *body, uint32_t i,
                                         const struct data_object *object)
{
    const struct task *task = body->task;
    const duite_param *param = &body->param[i];
    if (task->type != TASK_BODY)
        return task_value_version(object, param->data, param->count * data_type_size(param->type));
    data_version_hold(task->access[i].waiter.version);
    return task->access[i].waiter.version;
}

/* Adds the objects that the body reads to its scope, so that children may read them. Errors:
 * memory. */
static int nest_lend_reads(struct task_scope *scope)
{
    struct task_nest *nest = task_nest_of(scope);
    const struct task *task = nest->body->task;
    uint32_t first;
    if (nest->first_read)
        return DUITE_OK;
    if (nest_take_places(nest, task->n, &first))
        return DUITE_E_MEMORY;
    memset(&nest->local[first], 0, task->n * sizeof *nest->local);
    nest->first_read = first + 1;
    for (uint32_t i = 0; i < task->n; i++) {
        const duite_param *param = &nest->body->param[i];
        struct data_object *object = &nest->local[first + i];
        if (data_mode_of(scope->graph->kernels[task->kernel], i) != DUITE_R)
            continue;
        nest_object(nest, object, param->type, param->count, param->max, task->block);
        object->sized = param->count != param->max;
        object->current = read_version(nest->body, i, object);
        if (!object->current)
            return task_break(scope->graph, "what a task reads");
    }
    return DUITE_OK;
}

void task_drop(struct task_scope *scope, struct data_object *object)
{
    struct task_nest *nest = task_nest_of(scope);
    object->generation = 0;
    object->hint = nest->vacant;
    nest->vacant = (uint32_t)(object - nest->local) + 1;
}

/* ---- Rights ---- */

const char *task_mode_name(duite_mode mode)
{
    static const char *const names[] = {"no right", "r", "w", "rw", "cw", "rp", "wp", "rwp", "cwp"};
    return names[mode];
}

int task_check_right(struct task_scope *scope, const char *call, size_t i, duite_object name,
                     duite_mode wanted)
{
    const struct task *task = ((struct task_nest *)scope)->body->task;
    const char *forker = scope->graph->kernels[task->kernel]->name;
    const char *mode = task_mode_name(wanted);
    struct data_object *local;
    duite_mode held;
    if (!task_name_known(scope, name, &held, &local)) {
        if (name.slot && name.slot < TASK_LOCAL_NAME)
            return base_error(DUITE_E_RIGHT,
                              "%s, parameter %zu: the task (kernel %s) holds no right on object "
                              "%u.%u of the main program, %s is wanted",
                              call, i, forker, name.slot, name.generation, mode);
        return base_error(DUITE_E_OBJECT,
                          "%s, parameter %zu: object %u.%u %s (in a task of kernel %s)", call, i,
                          name.slot, name.generation,
                          name.slot ? "was freed, or is another task's" : "names nothing", forker);
    }
    if (task_right_gives(held, wanted))
        return local ? DUITE_OK : nest_lend_reads(scope);
    return base_error(DUITE_E_RIGHT,
                      "%s, parameter %zu: the task holds %s on object %u.%u, parameter %u of its "
                      "kernel %s, and %s is wanted",
                      call, i, task_mode_name(held), name.slot, name.generation,
                      name.slot - TASK_LOCAL_NAME, forker, mode);
}

int task_wrong_law(const struct task_scope *scope, const duite_kernel *kernel, size_t i,
                   duite_object name)
{
    const struct task *task = ((const struct task_nest *)scope)->body->task;
    const duite_kernel *forker = scope->graph->kernels[task->kernel];
    uint32_t parameter = name.slot - TASK_LOCAL_NAME;
    return base_error(DUITE_E_RIGHT,
                      "%s, parameter %zu: the task holds cwp by law %s on object %u.%u, parameter "
                      "%u of its kernel %s, and law %s is wanted",
                      kernel->name, i, data_law_of(forker, parameter)->name, name.slot,
                      name.generation, parameter, forker->name, data_law_of(kernel, i)->name);
}

int task_check_call(struct duite_call_private *body, const char *call, duite_object object,
                    duite_mode wanted)
{
    struct task_scope *scope = task_inside(body);
    return scope ? task_check_right(scope, call, 0, object, wanted) : DUITE_E_MEMORY;
}

bool task_lent(const struct duite_call_private *body, duite_object object)
{
    return (object.slot & ~TASK_LOCAL_NAME) < body->task->n;
}
