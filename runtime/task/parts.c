/* Parts of an object. A split is a task that changes the object and overwrites each of its parts; a
 * join overwrites the object and changes its parts. So order, messages and poison are those of
 * forks. Meanwhile the object's name is retired: its generation is one more.
 *
 * The parts' memory lies in the bytes of the object's version, where the body of the split finds
 * them. Like adopted memory it passes from version to version; a value that lies elsewhere comes
 * there at the join, whose task an event holds until no part uses its memory (data/adopted.h).
 * Until then the split owns the bytes, and the object's version has a view of them. */
#include "runtime/task/parts.h"
#include "runtime/task/body.h"
#include "runtime/task/event.h"
#include "runtime/task/scope.h"

#include "runtime/base/memory.h"
#include "runtime/data/adopted.h"
#include "runtime/data/object.h"

struct task_split {
    struct task_graph *graph;
    _Atomic uint32_t holders;   /* the object; at its home also its parts, and the join's task */
    _Atomic size_t used;        /* parts whose memory is in use */
    struct data_packet *bytes;  /* owned while the object's version has the view; else NULL */
    struct data_adopted view;   /* of them */
    struct data_version *whole; /* that the join writes */
    duite_event joined;         /* of the join's task, if: */
    bool joins;                 /* its body ran */
    bool adopted;               /* the object was before */
    size_t n;
    duite_object *name; /* the object, then its parts */
    struct data_adopted part[];
};

/* ---- The end of the memory ---- */

static void split_drop(struct task_split *split)
{
    if (atomic_fetch_sub_explicit(&split->holders, 1, memory_order_acq_rel) != 1)
        return;
    data_packet_free(split->bytes);
    base_free(split->name);
    base_free(split);
}

/* A part's memory is used no more. The last one lets the join end. */
static void part_back(struct data_adopted *part)
{
    struct task_split *split = part->user;
    if (atomic_fetch_sub_explicit(&split->used, 1, memory_order_acq_rel) != 1)
        return;
    if (split->joins)
        task_complete(split->graph, split->joined, DUITE_OK);
    split_drop(split);
}

/* The main program may wait for it. */
static void part_rested(void *graph)
{
    queue_notify(((const struct task_graph *)graph)->pool);
}

/* ---- The tasks ---- */

static void split_place(struct task_split *split, char *at)
{
    for (size_t i = 0; i < split->n; i++) {
        split->part[i].packet.elsewhere = at;
        at += split->part[i].packet.bytes;
    }
}

static int split_body(const duite_call *call)
{
    struct task_split *split = *(struct task_split *const *)call->args;
    struct data_version *whole = call->own->task->access[0].waiter.version;
    split->bytes = whole->packet;
    split->view.packet.bytes = whole->packet->bytes;
    split->view.packet.elsewhere = call->param[0].data;
    whole->packet = &split->view.packet;
    split_place(split, call->param[0].data);
    return DUITE_OK;
}

/* The body runs if no part is poisoned. The object has other bytes if it was before the split. */
static int join_body(const duite_call *call)
{
    struct task_split *split = *(struct task_split *const *)call->args;
    const struct task *task = call->own->task;
    const int code = duite_event_new(call, &split->joined);
    if (code)
        return code;
    split->whole = task->access[0].waiter.version;
    split->joins = true;
    if (!split->bytes)
        split_place(split, call->param[0].data);
    for (size_t i = 0; i < split->n; i++) {
        struct data_version *version = task->access[1 + i].waiter.version;
        struct data_packet *last = version->packet;
        version->packet = NULL;
        data_adopted_leave(&split->part[i], last);
    }
    return DUITE_OK;
}

void task_join_over(const void *args, const struct data_failure *failure)
{
    struct task_split *split = *(struct task_split *const *)args;
    if (!split->joins)
        for (size_t i = 0; i < split->n; i++)
            data_adopted_leave(&split->part[i], NULL);
    else if (!failure && split->bytes) {
        split->whole->packet = split->bytes;
        split->bytes = NULL;
    }
    split_drop(split);
}

/* Bodies of kernels with events are called directly in checking mode, too. */
const duite_kernel task_split_kernel = {.name = "duite_split",
                                        .body = split_body,
                                        .access = {DUITE_RW},
                                        .variadic = DUITE_W,
                                        .args_size = sizeof(struct task_split *),
                                        .side_effects = 1,
                                        .events = 1};
const duite_kernel task_join_kernel = {.name = "duite_join",
                                       .body = join_body,
                                       .access = {DUITE_W},
                                       .variadic = DUITE_RW,
                                       .args_size = sizeof(struct task_split *),
                                       .side_effects = 1,
                                       .events = 1};

/* ---- The calls ---- */

static struct task_scope *parts_scope(struct task_graph *graph, struct duite_call_private *body)
{
    return body ? task_inside(body) : &graph->root;
}

static int split_check(const struct data_object *object, duite_object name, size_t n,
                       const size_t *counts)
{
    size_t left = object->count;
    if (object->sized)
        return base_error(DUITE_E_SIZE, "duite_split: the size of object %u.%u may change",
                          name.slot, name.generation);
    if (!n || !counts)
        return base_error(DUITE_E_ARGUMENT, "duite_split: %s", n ? "no counts" : "no parts");
    for (size_t i = 0; i < n; i++) {
        if (!counts[i] || counts[i] > left)
            return base_error(DUITE_E_ARGUMENT,
                              "duite_split: part %zu has %zu elements, and %zu of the object's %zu "
                              "are left",
                              i, counts[i], left, object->count);
        left -= counts[i];
    }
    return left ? base_error(DUITE_E_ARGUMENT,
                             "duite_split: the parts leave %zu of the object's %zu elements", left,
                             object->count)
                : DUITE_OK;
}

static struct task_split *split_new(struct task_graph *graph, duite_object name, size_t n,
                                    const size_t *counts, size_t size, bool here)
{
    enum { OBJECT_AND_PARTS = 2, VERSION_AND_SPLIT = 2 };
    const size_t bytes = sizeof(struct task_split) + n * sizeof(struct data_adopted);
    struct task_split *split = base_alloc_zero(bytes);
    duite_object *names = base_alloc_zero((n + 1) * sizeof *names);
    if (!split || !names) {
        base_free(split);
        base_free(names);
        base_no_memory("the parts of an object");
        return NULL;
    }
    split->graph = graph;
    split->n = n;
    split->name = names;
    names[0] = name;
    atomic_init(&split->holders, here ? OBJECT_AND_PARTS : 1);
    atomic_init(&split->used, n);
    split->view = (struct data_adopted){.rested = part_rested, .context = graph};
    atomic_init(&split->view.holds, VERSION_AND_SPLIT); /* it never ends on its own */
    for (size_t i = 0; i < n; i++) {
        split->part[i] = (struct data_adopted){
            .packet = {.bytes = counts[i] * size, .kind = DATA_VALUE, .elsewhere = data_nowhere},
            .back = part_back,
            .user = split,
            .rested = part_rested,
            .context = graph};
        atomic_init(&split->part[i].holds, 1);
    }
    return split;
}

static void parts_drop(struct task_scope *scope, struct worker *worker, const duite_object *part,
                       size_t n)
{
    duite_mode right;
    for (size_t i = 0; i < n; i++) {
        struct data_object *object = task_find_object(scope, part[i], &right);
        object->memory = NULL;
        object->part = object->adopted = false;
        task_forget(scope->graph, worker, object);
        if (scope->depth)
            task_drop(scope, object);
        else
            data_object_drop(&scope->graph->table, part[i]);
    }
}

/* Makes the parts, without memory. */
static int parts_make(const struct task_split *split, struct duite_call_private *body,
                      struct worker *worker, duite_type type, const size_t *counts)
{
    struct data_table *table = &split->graph->table;
    struct task_scope *scope = parts_scope(split->graph, body);
    duite_object *part = split->name + 1;
    for (size_t i = 0; i < split->n; i++) {
        const int code =
            body ? task_make_object(body, type, counts[i], counts[i], false, &part[i])
                 : data_object_new_at(table, type, counts[i], -1, &split->name->slot, &part[i]);
        if (!code)
            continue;
        parts_drop(scope, worker, part, i);
        return code;
    }
    return DUITE_OK;
}

/* Gives a part its memory, which has no place yet, in a version that the split's task takes over.
 */
static int part_begin(struct task_split *split, struct task_scope *scope, size_t i, bool here)
{
    duite_mode right;
    struct data_object *object = task_find_object(scope, split->name[1 + i], &right);
    object->part = object->adopted = object->fixed = true;
    object->hint = 0;
    if (!here)
        return DUITE_OK;
    struct data_version *version = data_object_version(object);
    if (!version)
        return task_break(scope->graph, "a version");
    object->memory = &split->part[i];
    version->packet = data_adopted_take(object->memory);
    data_version_produced(version);
    data_version_release(version); /* the object alone holds it */
    object->current = version;
    return DUITE_OK;
}

/* The generation in an object's name: that of a parameter stands in the body's call. */
static uint32_t *name_generation(struct duite_call_private *body, duite_object name,
                                 struct data_object *object)
{
    const uint32_t i = name.slot & ~TASK_LOCAL_NAME;
    if (body && i < body->task->n)
        return &((duite_param *)body->param)[i].object.generation; /* the runtime's own */
    return &object->generation;
}

/* The name names nothing; back: it does again. */
static void name_retire(struct task_graph *graph, struct duite_call_private *body,
                        duite_object name, struct data_object *object, bool back)
{
    *name_generation(body, name, object) = name.generation + !back;
    if (body)
        task_nest_of(body->scope)->splits += back ? UINT32_MAX : 1;
    else
        graph->table.changes++;
}

int task_split(struct task_graph *graph, struct duite_call_private *body, struct worker *worker,
               duite_object name, size_t n, const size_t *counts)
{
    struct task_scope *scope = parts_scope(graph, body);
    duite_mode right;
    struct data_object *object = scope ? task_find_object(scope, name, &right) : NULL;
    if (!object)
        return scope ? DUITE_E_OBJECT : DUITE_E_MEMORY;
    int code = split_check(object, name, n, counts);
    if (code)
        return code;
    const bool here = body || object->home == graph->rank;
    struct task_split *split =
        split_new(graph, name, n, counts, data_type_size(object->type), here);
    if (!split)
        return DUITE_E_MEMORY;
    if ((code = parts_make(split, body, worker, object->type, counts))) {
        atomic_init(&split->holders, 1);
        split_drop(split);
        return code;
    }
    for (size_t i = 0; i < n && !code; i++)
        code = part_begin(split, scope, i, here);
    for (size_t i = 0; i < n && !body; i++)
        task_mix(graph, counts[i]);
    object = task_find_object(scope, name, &right); /* the others may have moved it */
    split->adopted = object->adopted;
    object->adopted = true;
    object->split = split;
    if (!code)
        code = task_fork(scope, worker, &task_no_options, &task_split_kernel, &split, n + 1,
                         split->name);
    name_retire(graph, body, name, object, false);
    return code;
}

/* The object behind a name that is retired; NULL: it is not. */
static struct data_object *object_split(struct task_graph *graph, struct duite_call_private *body,
                                        duite_object name)
{
    const duite_object retired = {name.slot, name.generation + 1};
    struct data_object *object = NULL;
    duite_mode right;
    if (!body)
        object = name.slot < graph->table.n_slots ? &graph->table.object[name.slot] : NULL;
    else if (!body->scope || !task_name_known(body->scope, retired, &right, &object))
        return NULL;
    const bool fits =
        object && object->split && *name_generation(body, name, object) == retired.generation;
    return fits ? object : NULL;
}

const duite_object *task_split_names(struct task_graph *graph, struct duite_call_private *body,
                                     duite_object name, size_t *n)
{
    duite_mode right;
    const struct data_object *object = object_split(graph, body, name);
    if (!object) {
        base_error(DUITE_E_OBJECT, "duite_join: object %u.%u is not split", name.slot,
                   name.generation);
        return NULL;
    }
    const struct task_split *split = object->split;
    for (size_t i = 0; i < split->n; i++)
        if (!task_find_object(parts_scope(graph, body), split->name[1 + i], &right))
            return NULL; /* it is split itself */
    *n = split->n;
    return split->name;
}

int task_join(struct task_graph *graph, struct duite_call_private *body, struct worker *worker,
              duite_object name)
{
    struct task_scope *scope = parts_scope(graph, body);
    size_t n;
    if (!task_split_names(graph, body, name, &n))
        return DUITE_E_OBJECT;
    struct data_object *object = object_split(graph, body, name);
    struct task_split *split = object->split;
    name_retire(graph, body, name, object, true);
    if (body || object->home == graph->rank) /* for the task */
        atomic_fetch_add_explicit(&split->holders, 1, memory_order_relaxed);
    const int code =
        task_fork(scope, worker, &task_no_options, &task_join_kernel, &split, n + 1, split->name);
    if (code)
        return code;
    object->adopted = split->adopted;
    object->split = NULL;
    parts_drop(scope, worker, split->name + 1, n);
    split_drop(split);
    return DUITE_OK;
}

/* A part that is split is joined before the object that it is part of. */
void task_join_rest(struct duite_call_private *body)
{
    struct task_nest *nest = task_nest_of(body->scope);
    uint32_t before;
    do {
        before = nest->splits;
        for (uint32_t i = 0; i < nest->n_local; i++)
            if (nest->local[i].split)
                task_join(body->graph, body, body->worker, nest->local[i].split->name[0]);
    } while (nest->splits && nest->splits < before);
    if (nest->splits && !body->remembered)
        body->remembered = DUITE_E_MEMORY;
}

void task_split_drop(struct data_object *object)
{
    split_drop(object->split);
    object->split = NULL;
}
