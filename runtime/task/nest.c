/* Tasks that fork. A task's scope has an object of its own for each that its children may use. What
 * the task was lent is a stretch of the chain of versions of the scope above: the local object
 * begins with the version that the task would have taken over, and when the body is over, the last
 * version its children make has an `exit` for its heir, which passes the bytes on to the version
 * that the scope above has waited for since the fork. So nobody waits for a task with postponed
 * parameters but for the values alone. A contribution is lent as a sum of its own, whose result
 * becomes the leaf.
 *
 * While the body runs its worker alone uses the objects; the exits belong to whoever releases the
 * last hold on a version. The scope is freed with the last count of `unfinished`. */
#include "runtime/task/nest.h"

#include "runtime/base/error.h"
#include "runtime/base/pool.h"
#include "runtime/data/mode.h"

#include <string.h>

/* The calling thread's innermost body. */
static _Thread_local struct duite_call_private *running __attribute__((tls_model("initial-exec")));

static struct task_nest *nest_of(struct task_scope *scope)
{
    return (struct task_nest *)scope;
}

struct duite_call_private *task_running(const struct task_graph *graph)
{
    return running && running->graph == graph ? running : NULL;
}

/* ---- Names ---- */

uint32_t task_new_stamp(void)
{
    enum { BATCH = 1 << 20 };
    static _Atomic uint32_t batches;
    static _Thread_local uint32_t next;
    if (next % BATCH == 0)
        next = BATCH * atomic_fetch_add_explicit(&batches, 1, memory_order_relaxed);
    return ++next;
}

void task_body_begins(struct duite_call_private *body)
{
    body->outer = running;
    running = body;
    if (body->scope)
        nest_of(body->scope)->body = body;
}

void task_body_ends(struct duite_call_private *body)
{
    running = body->outer;
}

bool task_known(struct task_scope *scope, duite_object name, duite_mode *right,
                struct data_object **local)
{
    struct task_nest *nest = nest_of(scope);
    const struct duite_call_private *body = nest->body;
    const struct task *task = body->task;
    uint32_t i = name.slot & ~TASK_LOCAL_NAME;
    *local = NULL;
    if (name.slot < TASK_LOCAL_NAME)
        return false;
    if (i < task->n) {
        *right = data_mode_of(scope->graph->kernels[task->kernel], i);
        if (task_postponed(*right))
            *local = &nest->local[task->access[i].lent];
        else if (*right == DUITE_R && nest->first_read)
            *local = &nest->local[nest->first_read - 1 + i];
        return name.generation == body->param[i].object.generation;
    }
    uint32_t at = i - task->n + nest->n_lent;
    if (at >= nest->n_local)
        return false;
    *right = DUITE_RWP;
    *local = &nest->local[at];
    return (*local)->generation == name.generation;
}

struct data_object *task_find_object(struct task_scope *scope, duite_object name, duite_mode *right)
{
    *right = DUITE_RWP;
    if (!scope->depth)
        return data_object_find(&scope->graph->table, name);
    struct data_object *local;
    if (task_known(scope, name, right, &local) && local)
        return local;
    base_error(DUITE_E_OBJECT,
               "object %u.%u is none of this task's: it was freed, or belongs to "
               "another task",
               name.slot, name.generation);
    return NULL;
}

/* ---- Making a scope ---- */

static size_t size_of(size_t n_lent)
{
    return sizeof(struct task_nest) + n_lent * sizeof(struct graph_exit);
}

struct task_scope *task_scope_new(const struct task *task, size_t n)
{
    enum { SPARE = 3 };
    size_t exits = size_of(n), size = exits + (n + SPARE) * sizeof(struct data_object);
    struct task_nest *nest = base_pool_take(size);
    if (!nest)
        return NULL;
    *nest = (struct task_nest){.scope = {.graph = task->scope->graph,
                                         .parent = task->scope,
                                         .top = task->scope->top,
                                         .number = task->number,
                                         .block = task->block,
                                         .placed = task->placed,
                                         .depth = task->scope->depth + 1},
                               .room = (uint32_t)(n + SPARE),
                               .size = size,
                               .local = (void *)((char *)nest + exits)};
    atomic_init(&nest->scope.unfinished, 1);
    return &nest->scope;
}

const struct data_object *task_lent_object(const struct task_scope *scope, size_t lent)
{
    return &((const struct task_nest *)scope)->local[lent];
}

struct task_scope *task_inside(struct duite_call_private *body)
{
    const struct task *task = body->task;
    if (!body->scope) {
        body->scope = task_scope_new(task, 0);
        if (!body->scope) {
            base_no_memory("what a task forks");
            return NULL;
        }
        nest_of(body->scope)->body = body;
        if (task->kind == TASK_NODE) /* the main program waits for what it forks, too */
            work_over(body->graph->pool, body->worker, -1);
    }
    return body->scope;
}

void task_lend(struct task *task, size_t i, const struct data_object *object,
               struct data_version *version, struct data_version *out)
{
    struct task_nest *nest = nest_of(task->inner);
    struct task_access *access = &task->access[i];
    struct graph_exit *exit = &nest->exit[nest->n_lent];
    *exit = (struct graph_exit){.scope = task->inner,
                                .out = out,
                                .bytes = object->room,
                                .overwrites = access->waiter.mode == DUITE_WP};
    if (access->waiter.mode == DUITE_CWP) {
        exit->sum = access->sum;
        exit->leaf = access->leaf;
    }
    int rank = nest->scope.graph->rank;
    nest->local[nest->n_lent] = (struct data_object){.type = object->type,
                                                     .sized = object->sized,
                                                     .count = object->count,
                                                     .bytes = object->bytes,
                                                     .most = object->most,
                                                     .room = object->room,
                                                     .home = rank,
                                                     .holder = rank,
                                                     .block = object->block,
                                                     .law = object->law,
                                                     .current = version};
    access->lent = nest->n_lent;
    nest->n_local = ++nest->n_lent;
    nest->scope.outward |= access->waiter.mode != DUITE_CWP;
}

/* Places for n more objects, one after the other. */
static int take_places(struct task_nest *nest, uint32_t n, uint32_t *first)
{
    uint32_t room = nest->room;
    *first = nest->n_local;
    while (room - nest->n_local < n)
        room *= 2;
    if (room > nest->room) {
        struct data_object *more = base_pool_take(room * sizeof *more);
        if (!more)
            return base_no_memory("an object");
        memcpy(more, nest->local, nest->n_local * sizeof *more);
        if (nest->moved)
            base_pool_give(nest->local, nest->room * sizeof *more);
        nest->local = more;
        nest->room = room;
        nest->moved = true;
    }
    nest->n_local += n;
    return DUITE_OK;
}

int task_make_object(struct duite_call_private *body, duite_type type, size_t count, size_t most,
                     bool sized, duite_object *name)
{
    struct task_scope *scope = task_inside(body);
    struct task_nest *nest = nest_of(scope);
    uint32_t at;
    int code = data_object_check(type, count, most);
    if (!code && !scope)
        code = DUITE_E_MEMORY;
    if (!code && nest->vacant) {
        at = nest->vacant - 1;
        nest->vacant = nest->local[at].hint;
    } else if (!code) {
        code = take_places(nest, 1, &at);
    }
    if (code)
        return code;
    size_t size = data_type_size(type);
    int rank = scope->graph->rank;
    nest->local[at] = (struct data_object){.generation = task_new_stamp(),
                                           .type = type,
                                           .sized = sized,
                                           .count = count,
                                           .bytes = count * size,
                                           .most = most,
                                           .room = most * size,
                                           .home = rank,
                                           .holder = rank,
                                           .block = (uint32_t)scope->forks};
    uint32_t slot = TASK_LOCAL_NAME | (body->task->n + at - nest->n_lent);
    *name = (duite_object){slot, nest->local[at].generation};
    return DUITE_OK;
}

/* What the body reads, as a version: the very one, or a copy of what lies in place. */
static struct data_version *version_read(const struct duite_call_private *body, uint32_t i)
{
    const struct task *task = body->task;
    if (task->kind == TASK_BODY) {
        data_version_hold(task->access[i].in);
        return task->access[i].in;
    }
    const duite_param *param = &body->param[i];
    size_t bytes = param->count * data_type_size(param->type);
    struct data_version *version =
        data_version_new(param->type, param->most, param->count != param->most);
    if (version)
        version->packet = data_packet_new(bytes, false);
    if (!version || !version->packet) {
        if (version)
            data_version_free(version);
        return NULL;
    }
    memcpy(data_payload(version->packet), param->data, bytes);
    data_version_produced(version);
    data_version_release(version); /* the object alone holds it */
    return version;
}

int offload_lend_reads(struct task_scope *scope)
{
    struct task_nest *nest = nest_of(scope);
    const struct task *task = nest->body->task;
    uint32_t first;
    if (nest->first_read)
        return DUITE_OK;
    if (take_places(nest, task->n, &first))
        return DUITE_E_MEMORY;
    memset(&nest->local[first], 0, task->n * sizeof *nest->local);
    nest->first_read = first + 1;
    int rank = scope->graph->rank;
    for (uint32_t i = 0; i < task->n; i++) {
        const duite_param *param = &nest->body->param[i];
        struct data_object *object = &nest->local[first + i];
        if (data_mode_of(scope->graph->kernels[task->kernel], i) != DUITE_R)
            continue;
        *object = (struct data_object){.type = param->type,
                                       .sized = param->count != param->most,
                                       .most = param->most,
                                       .room = param->most * data_type_size(param->type),
                                       .home = rank,
                                       .holder = rank,
                                       .block = task->block,
                                       .current = version_read(nest->body, i)};
        if (!object->current) {
            base_no_memory("what a task reads");
            return task_break(scope->graph);
        }
    }
    return DUITE_OK;
}

void task_drop(struct task_scope *scope, struct data_object *object)
{
    struct task_nest *nest = nest_of(scope);
    object->generation = 0;
    object->hint = nest->vacant;
    nest->vacant = (uint32_t)(object - nest->local) + 1;
}

/* ---- The end ---- */

void task_left(struct task_graph *graph, struct task_scope *scope, struct worker *worker)
{
    struct task_scope *parent;
    /* No look into the root: the main thread writes its line with every fork. */
    while (scope != &graph->root && (parent = scope->parent)) {
        if (atomic_fetch_sub_explicit(&scope->unfinished, 1, memory_order_acq_rel) != 1)
            return;
        struct task_nest *nest = nest_of(scope);
        if (nest->moved)
            base_pool_give(nest->local, nest->room * sizeof *nest->local);
        base_pool_give(nest, nest->size);
        scope = parent;
    }
    if (scope == &graph->root)
        work_over(graph->pool, worker, 1);
    else
        offload_guest_over(scope, worker);
}

static const struct data_failure no_memory = {
    .code = DUITE_E_MEMORY, .kernel = UINT32_MAX, .text = "no memory for what a task leaves"};

/* Nobody wrote the version: zeros, as many as there can be. */
static void give_zeros(const struct graph_exit *exit)
{
    struct data_version *out = exit->out;
    if (out->packet)
        data_packet_free(out->packet);
    out->packet = data_packet_new(exit->bytes, true);
    if (!out->packet)
        data_version_poison(out, task_fail(exit->scope->graph, &no_memory, true));
}

struct data_waiter *task_pass(struct worker *worker, struct data_waiter *waiter)
{
    struct graph_exit *exit = (struct graph_exit *)waiter;
    struct task_scope *scope = exit->scope;
    struct data_version *out = exit->out;
    const struct data_failure *failure =
        data_first(exit->untouched ? NULL : data_version_failure(exit->in), exit->failure);
    out->packet = data_version_packet(exit->in);
    data_version_free(exit->in);
    data_version_poison(out, failure);
    if (exit->untouched && !failure)
        give_zeros(exit);
    struct data_waiter *heir = task_produced(scope->graph, worker, out);
    task_left(scope->graph, scope, worker);
    return heir;
}

/* A written parameter goes back to the scope above. */
static void give_back(struct graph_exit *exit, struct worker *worker, struct data_object *object,
                      const struct data_failure *failure)
{
    struct task_scope *scope = exit->scope;
    exit->in = object->current;
    exit->failure = failure;
    if (!exit->in) {
        data_version_poison(exit->out, failure);
        if (!failure)
            give_zeros(exit);
        task_publish(scope->graph, worker, exit->out);
        return;
    }
    exit->in->heir = &exit->waiter;
    atomic_fetch_add_explicit(&scope->unfinished, 1, memory_order_relaxed);
    task_release(scope->graph, worker, exit->in);
}

/* The children's contributions, or none, are this task's. */
static void contribute(struct graph_exit *exit, struct worker *worker, struct data_object *object,
                       const struct data_failure *failure)
{
    struct task_scope *scope = exit->scope;
    exit->leaf->failure = failure;
    if (object->leaves) {
        if (!task_gather(scope, worker, object, exit->sum, exit->leaf))
            return;
        exit->leaf->failure = &no_memory;
    }
    task_wake(scope->graph, worker, data_sum_release(exit->sum));
}

void task_scope_fail(struct task_scope *scope, const struct data_failure *failure)
{
    nest_of(scope)->failure = failure;
}

void task_scope_end(struct task_scope *scope, struct worker *worker)
{
    struct task_nest *nest = nest_of(scope);
    const struct data_failure *failure = nest->failure;
    struct task_graph *graph = scope->graph;
    for (uint32_t i = 0; i < nest->n_local; i++) {
        struct data_object *object = &nest->local[i];
        struct graph_exit *exit = i < nest->n_lent ? &nest->exit[i] : NULL;
        if (exit && exit->sum) {
            contribute(exit, worker, object, failure);
            continue;
        }
        bool lost = object->leaves && task_close_sum(scope, worker, object);
        if (exit && exit->out) {
            exit->untouched = exit->overwrites && !object->number;
            give_back(exit, worker, object, lost ? &no_memory : failure);
        } else {
            task_forget(graph, worker, object);
        }
    }
    task_left(graph, scope, worker);
}
