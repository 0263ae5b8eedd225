/* A record is whole or not begun: a call of build that fails leaves nothing behind. The names that
 * build used stay (`recorded`); replays use the objects bound to them. Arguments lie in one block,
 * which plans copy. Later changes reach a plan as a list. */
#include "runtime/plan/plan.h"
#include "runtime/task/internal.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/data/law.h"
#include "runtime/data/object.h"

#include <stdlib.h>
#include <string.h>

struct plan_record *plan_record_new(struct task_graph *graph)
{
    struct plan_record *record = base_alloc_zero(sizeof *record);
    if (record)
        record->graph = graph;
    return record;
}

void plan_record_forget_changes(struct plan_record *record)
{
    while (record->changes) {
        struct plan_change *next = record->changes->next;
        base_free(record->changes);
        record->changes = next;
    }
}

void plan_record_clear(struct plan_record *record, struct worker *worker)
{
    struct task_graph *graph = record->graph;
    plan_drop(record->plan, worker);
    plan_record_forget_changes(record);
    free(record->fork);
    free(record->access);
    free(record->args);
    free(record->call);
    free(record->object);
    free(record->names);
    base_free(record->index);
    *record = (struct plan_record){.graph = graph};
}

void plan_record_free(struct plan_record *record, struct worker *worker)
{
    plan_record_clear(record, worker);
    base_free(record);
}

/* ---- The calls of build ---- */

/* Room for one more fork with n objects and so many bytes of arguments, and for the index. */
static bool record_reserve(struct plan_record *record, size_t n, size_t bytes)
{
    const struct data_table *table = &record->graph->table;
    if (!record->index) {
        record->n_slots = table->n_slots;
        record->index = base_alloc_zero(record->n_slots * sizeof *record->index);
    }
    return record->index && BASE_GROW(record->fork, record->forks_capacity, record->n_forks + 1) &&
           BASE_GROW(record->call, record->calls_capacity, record->n_calls + 1) &&
           BASE_GROW(record->access, record->accesses_capacity, record->n_accesses + n + 1) &&
           BASE_GROW(record->names, record->names_capacity, n + 1) &&
           BASE_GROW(record->object, record->objects_capacity, record->n_objects + n + 1) &&
           BASE_GROW(record->args, record->args_capacity, record->args_bytes + bytes + 1);
}

static struct plan_recorded_object *record_find(const struct plan_record *record, duite_object name)
{
    uint32_t index = name.slot < record->n_slots ? record->index[name.slot] : 0;
    struct plan_recorded_object *object = index ? &record->object[index - 1] : NULL;
    bool found = object && object->recorded.generation == name.generation;
    return found ? object : NULL;
}

/* Adds an object that is named for the first time. Returns its place. */
__attribute__((noinline)) static uint32_t record_add(struct plan_record *record, duite_object name)
{
    const struct data_object *object = &record->graph->table.object[name.slot];
    record->object[record->n_objects] = (struct plan_recorded_object){.recorded = name,
                                                                      .bound = name,
                                                                      .type = object->type,
                                                                      .count = object->max,
                                                                      .sized = object->sized};
    record->index[name.slot] = (uint32_t)record->n_objects + 1;
    return (uint32_t)record->n_objects++;
}

static inline uint32_t record_index(struct plan_record *record, duite_object name)
{
    const uint32_t index = record->index[name.slot];
    return index ? index - 1 : record_add(record, name);
}

static inline void record_note(struct plan_recorded_object *object, duite_mode mode)
{
    if (mode == DUITE_CW) {
        object->leads |= !object->read && !object->written;
        object->reads_old |= !object->read && !object->written;
        object->sums = object->trails = true;
        return;
    }
    object->reads_old |= mode != DUITE_W && !object->written;
    object->read |= mode == DUITE_R;
    object->written |= mode != DUITE_R;
    object->trails = false;
}

/* Returns the object's place. */
static inline uint32_t record_use(struct plan_record *record, duite_object name, duite_mode mode,
                                  const duite_law *law)
{
    const uint32_t index = record_index(record, name);
    record->access[record->n_accesses++] = (struct plan_access){index, mode, law};
    record_note(&record->object[index], mode);
    return index;
}

/* The object that the task runs for keeps its home, as does any object bound to it. */
static void record_fix_owner(struct plan_record *record, const struct plan_recorded_fork *fork)
{
    const bool replicated = record->graph->kernels[fork->kernel]->replicated;
    if (fork->owner == PLAN_NONE || !task_owner_decides(fork->options.at, replicated))
        return;
    struct plan_recorded_object *object = &record->object[fork->owner];
    object->fixed = true;
    record->graph->table.object[object->bound.slot].fixed = true;
}

/* Appends a fork without objects, owner and arguments, and makes room for them. */
static struct plan_recorded_fork *record_append(struct plan_record *record, uint32_t kernel,
                                                const struct task_options *options, size_t n,
                                                size_t bytes)
{
    size_t whole = (bytes + 15) / 16 * 16;
    if (record->n_forks >= UINT32_MAX / 8 || record->n_accesses + n >= UINT32_MAX / 8 ||
        !record_reserve(record, n, whole)) {
        base_no_memory("a recorded graph");
        return NULL;
    }
    struct plan_recorded_fork *fork = &record->fork[record->n_forks++];
    *fork = (struct plan_recorded_fork){.kernel = kernel,
                                        .options = *options,
                                        .n = (uint32_t)n,
                                        .owner = PLAN_NONE,
                                        .call = (uint32_t)record->n_calls,
                                        .first = record->n_accesses,
                                        .args = record->args_bytes};
    record->args_bytes += whole;
    return fork;
}

static void record_use_all(struct plan_record *record, const struct task_fork_call *call)
{
    for (size_t i = 0; i < call->n; i++) {
        const duite_mode held = data_mode_of(call->kernel, i), mode = task_immediate(held);
        const duite_law *law = mode == DUITE_CW ? data_law_of(call->kernel, i) : NULL;
        record->forked |= task_postponed(held);
        record_use(record, call->objects[i], mode, law);
    }
}

int plan_record_fork(struct plan_record *record, const struct task_options *options,
                     const duite_kernel *kernel, const void *args, size_t n,
                     const duite_object *objects)
{
    struct task_graph *graph = record->graph;
    struct task_fork_call call;
    task_fork_call_init(&call, &graph->root, NULL, kernel, n, objects);
    int code = task_fork_check(&call, options->at, args);
    if (code)
        return code;
    task_fork_unmark(&call, n);
    const uint32_t index = call.fixed->index, owner = task_fork_owner(&call);
    struct plan_recorded_fork *fork = record_append(record, index, options, n, kernel->args_size);
    if (!fork)
        return DUITE_E_MEMORY;
    record_use_all(record, &call);
    if (owner != TASK_NOBODY)
        fork->owner = record->access[fork->first + owner].object;
    if (graph->n_ranks > 1)
        task_mix_fork(graph, task_fork_hash_all(task_fork_what(index, options->at), n, objects),
                      COMM_RECORDED, index);
    if (kernel->args_size)
        memcpy(record->args + fork->args, args, kernel->args_size);
    if (kernel->fixed)
        record_fix_owner(record, fork);
    record->call[record->n_calls++] = record->n_forks - 1;
    return DUITE_OK;
}

int plan_record_set(struct plan_record *record, duite_object name, const void *values,
                    const size_t *wanted)
{
    const struct data_object *object = data_object_find(&record->graph->table, name);
    if (!object)
        return DUITE_E_OBJECT;
    size_t count = wanted ? *wanted : object->max;
    size_t bytes = values ? count * data_type_size(object->type) : 0;
    int code = task_set_check(object, name, count);
    if (code)
        return code;
    struct plan_recorded_fork *fork =
        record_append(record, PLAN_SETS, &(struct task_options){.at = TASK_ANYWHERE}, 1, bytes);
    if (!fork)
        return DUITE_E_MEMORY;
    fork->owner = record_use(record, name, DUITE_W, NULL);
    task_mix(record->graph, task_fork_hash_all(task_fork_what(PLAN_SETS, TASK_ANYWHERE), 1, &name));
    task_mix(record->graph, count);
    task_mixed(record->graph, COMM_CALLED, COMM_CALLED_SET);
    fork->zeros = !values;
    fork->count = count;
    if (bytes)
        memcpy(record->args + fork->args, values, bytes);
    return DUITE_OK;
}

void plan_record_end(struct plan_record *record)
{
    record->whole = true;
    for (size_t i = 0; i < record->n_objects; i++) {
        const struct plan_recorded_object *object = &record->object[i];
        record->forked |= object->sized || (object->leads && object->trails);
        record->leads |= object->leads;
        record->trails |= object->trails;
    }
}

/* ---- Between replays ---- */

int plan_record_args(struct plan_record *record, size_t k, const void *args)
{
    if (k >= record->n_calls)
        return base_error(DUITE_E_ARGUMENT, "duite_graph_args: there is no fork %zu, only %zu", k,
                          record->n_calls);
    const struct plan_recorded_fork *fork = &record->fork[record->call[k]];
    size_t bytes = record->graph->kernels[fork->kernel]->args_size;
    const char *kernel = record->graph->kernels[fork->kernel]->name;
    if (bytes && !args)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_graph_args: fork %zu (kernel %s) needs %zu bytes", k, kernel,
                          bytes);
    if (!bytes && args)
        return base_error(DUITE_E_ARGUMENT,
                          "duite_graph_args: fork %zu (kernel %s) has no arguments", k, kernel);
    if (!bytes)
        return DUITE_OK;
    if (record->plan) {
        struct plan_change *change = base_alloc(sizeof *change + bytes);
        if (!change)
            return base_no_memory("arguments of a recorded graph");
        *change = (struct plan_change){record->changes, fork->args, bytes};
        memcpy(change->args, args, bytes);
        record->changes = change;
    }
    memcpy(record->args + fork->args, args, bytes);
    return DUITE_OK;
}

int plan_record_bind(struct plan_record *record, duite_object recorded, duite_object name)
{
    struct plan_recorded_object *object = record_find(record, recorded);
    const struct data_object *other = data_object_find(&record->graph->table, name);
    if (!other)
        return DUITE_E_OBJECT;
    if (!object)
        return base_error(DUITE_E_BINDING,
                          "duite_graph_bind: object %u.%u, to become %u.%u, is not one that the "
                          "graph was recorded with",
                          recorded.slot, recorded.generation, name.slot, name.generation);
    if (other->type != object->type || other->max != object->count || other->sized != object->sized)
        return base_error(
            DUITE_E_BINDING,
            "duite_graph_bind: object %u.%u has %s%zu elements (%s), and object %u.%u, "
            "bound to it, has %s%zu (%s)",
            recorded.slot, recorded.generation, object->sized ? "at most " : "", object->count,
            data_type_name(object->type), name.slot, name.generation,
            other->sized ? "at most " : "", other->max, data_type_name(other->type));
    task_mix(record->graph, task_name_bits(recorded));
    task_mix(record->graph, task_name_bits(name));
    task_mixed(record->graph, COMM_CALLED, COMM_CALLED_GRAPH_BIND);
    object->bound = name;
    record->graph->table.object[name.slot].fixed |= object->fixed;
    record->rebound = true;
    if (record->plan)
        record->plan->at_home = 0;
    return DUITE_OK;
}

/* `fits` is the state of the table when all bound objects existed. */
bool plan_record_fits(struct plan_record *record)
{
    const struct data_table *table = &record->graph->table;
    const uint64_t now = table->changes + 1;
    for (size_t i = 0; i < record->n_objects && record->fits != now; i++) {
        duite_object bound = record->object[i].bound;
        if (table->object[bound.slot].generation != bound.generation)
            return false;
    }
    record->fits = now;
    return record->whole;
}

/* Marks each bound object with its place in the record, plus one. */
int plan_record_distinct(struct plan_record *record)
{
    struct data_table *table = &record->graph->table;
    int code = DUITE_OK;
    if (!record->rebound)
        return code;
    for (size_t i = 0; i < record->n_objects; i++)
        table->object[record->object[i].bound.slot].mark = 0;
    for (size_t i = 0; i < record->n_objects && !code; i++) {
        const struct plan_recorded_object *object = &record->object[i];
        uint64_t *mark = &table->object[object->bound.slot].mark;
        if (*mark)
            code = base_error(DUITE_E_BINDING,
                              "objects %u.%u and %u.%u of a recorded graph are both bound to %u.%u",
                              record->object[*mark - 1].recorded.slot,
                              record->object[*mark - 1].recorded.generation, object->recorded.slot,
                              object->recorded.generation, object->bound.slot,
                              object->bound.generation);
        *mark = i + 1;
    }
    for (size_t i = 0; i < record->n_objects; i++)
        table->object[record->object[i].bound.slot].mark = 0;
    record->rebound = code != DUITE_OK;
    return code;
}

/* ---- The record as plain data: later passes know nothing of the task graph, so it has all that
 * they need of a fork's kernel or of an object ---- */

static struct plan_source_fork source_fork(const struct plan_record *record,
                                           const struct plan_recorded_fork *fork)
{
    bool sets = fork->kernel == PLAN_SETS;
    return (struct plan_source_fork){
        .first = fork->first,
        .n = fork->n,
        .owner = fork->owner,
        .rank = fork->options.at == TASK_ANYWHERE ? PLAN_BY_OWNER : fork->options.at,
        .sets = sets,
        .replicated = !sets && record->graph->kernels[fork->kernel]->replicated,
        .cost = fork->options.cost};
}

uint32_t plan_record_flag(const struct plan_record *record, duite_object flag)
{
    uint32_t place = 0;
    while (place < record->n_objects && (record->object[place].bound.slot != flag.slot ||
                                         record->object[place].bound.generation != flag.generation))
        place++;
    return place;
}

bool plan_record_source(const struct plan_record *record, const duite_object *flag,
                        struct plan_source *source)
{
    size_t n = record->n_objects;
    struct plan_source_fork *fork = base_alloc((record->n_forks + 1) * sizeof *fork);
    size_t *bytes = base_alloc_zero((n + 1) * sizeof *bytes);
    *source = (struct plan_source){.fork = fork,
                                   .access = record->access,
                                   .bytes = bytes,
                                   .n_forks = record->n_forks,
                                   .n_accesses = record->n_accesses,
                                   .n_objects = n,
                                   .flag = flag ? plan_record_flag(record, *flag) : PLAN_NONE};
    if (!fork || !bytes)
        return false;
    for (size_t i = 0; i < record->n_forks; i++)
        fork[i] = source_fork(record, &record->fork[i]);
    for (size_t i = 0; i < n; i++) {
        const struct plan_recorded_object *from = &record->object[i];
        bytes[i] = from->count * data_type_size(from->type);
    }
    if (flag && source->flag == n) {
        const struct data_object *from = &record->graph->table.object[flag->slot];
        bytes[source->n_objects++] = from->count * data_type_size(from->type);
    }
    return true;
}

void plan_source_free(struct plan_source *source)
{
    base_free(source->fork);
    base_free(source->bytes);
}
