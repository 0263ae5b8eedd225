/* A record as plain data. Later passes know nothing of the task graph, so it has all they need of a
 * fork's kernel or of an object. */
#include "runtime/plan/record.h"

#include "runtime/base/memory.h"

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
