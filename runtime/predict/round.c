/* A round of a recorded graph, from the words of a trace to the rows that mappings see. The passes
 * of plan/passes.h that make the rows in a run make them here, so a mapping sees the same. */
#include "runtime/predict/program.h"

#include "runtime/base/memory.h"
#include "runtime/map/tasks.h"

static duite_mode round_mode(const struct predict_program *p, const struct predict_fork *fork,
                             size_t k)
{
    return fork->kernel == PREDICT_NONE ? DUITE_W
                                        : trace_mode(&p->graph->run->kernel[fork->kernel], k);
}

static void round_fork(const struct predict_program *p, struct plan_source *source,
                       struct plan_access *access, const struct predict_fork *fork)
{
    const bool set = fork->kernel == PREDICT_NONE;
    source->fork[source->n_forks++] = (struct plan_source_fork){
        .first = source->n_accesses,
        .n = (uint32_t)fork->n,
        .owner = set ? fork->object[0] : predict_owner(p->graph, fork, fork->object),
        .rank = set || fork->at < 0 ? PLAN_BY_OWNER : fork->at,
        .sets = set,
        .replicated = !set && p->graph->run->kernel[fork->kernel].replicated,
        .cost = set ? 0 : (double)fork->cost};
    for (size_t k = 0; k < fork->n; k++)
        access[source->n_accesses++] =
            (struct plan_access){.object = fork->object[k], .mode = round_mode(p, fork, k)};
}

/* The object of a view is among the recorded ones if the graph names it. */
static void round_object(const struct predict_program *p, const struct predict_recorded *recorded,
                         struct plan_source_object *objects, uint32_t i)
{
    const struct predict_object *bound = &p->graph->object[recorded->bound[i]];
    objects[i].bytes = bound->bytes;
    for (uint32_t k = 0; k < recorded->n_objects && bound->parent != PREDICT_NONE; k++)
        if (recorded->bound[k] == bound->parent)
            objects[i].parent = k + 1;
}

struct round_source {
    struct plan_source plain;
    struct plan_access *access; /* of plain */
};

/* False without memory; round_source_free is due all the same. */
static bool round_source_make(const struct predict_program *p,
                              const struct predict_recorded *recorded, struct round_source *source)
{
    size_t uses = 0;
    for (size_t i = 0; i < recorded->n_forks; i++)
        uses += recorded->fork[i].n;
    struct plan_source *plain = &source->plain;
    plain->access = source->access = base_alloc((uses + 1) * sizeof *source->access);
    plain->fork = base_alloc((recorded->n_forks + 1) * sizeof *plain->fork);
    plain->object = base_alloc_zero((recorded->n_objects + 1) * sizeof *plain->object);
    plain->n_objects = recorded->n_objects;
    plain->flag = PLAN_NONE;
    if (!plain->access || !plain->fork || !plain->object)
        return false;
    for (size_t i = 0; i < recorded->n_forks; i++)
        round_fork(p, plain, source->access, &recorded->fork[i]);
    for (uint32_t i = 0; i < recorded->n_objects; i++)
        round_object(p, recorded, plain->object, i);
    return true;
}

static void round_source_free(struct round_source *source)
{
    base_free(source->plain.fork);
    base_free(source->plain.object);
    base_free(source->access);
}

bool predict_round(const struct predict_program *p, const struct predict_recorded *recorded,
                   const uint32_t *block, struct map_tasks *tasks)
{
    struct round_source source = {0};
    struct plan_round round = {0};
    struct plan_tasks *all = &tasks->tasks;
    *tasks = (struct map_tasks){0};
    bool fine = round_source_make(p, recorded, &source) && plan_lower(&round, &source.plain) &&
                plan_tasks_find(all, &round);
    if (fine)
        fine = (tasks->block = base_alloc((all->n + 1) * sizeof *tasks->block)) != NULL;
    for (size_t i = 0; i < all->n && fine; i++)
        tasks->block[i] = all->owner[i] == PLAN_NONE ? DUITE_NO_BLOCK : block[all->owner[i]];
    plan_round_free(&round);
    round_source_free(&source);
    return fine;
}
