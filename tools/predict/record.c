/* Recorded graphs of the main program: their forks, from the words of the trace, and the same as
 * the input of the runtime's passes (plan/passes.h). Laws are unknown, so all are the same. */
#include "tools/predict/program.h"

#include "runtime/base/memory.h"

#include <stdlib.h>

static void recorded_forget(struct predict_recorded *recorded)
{
    free(recorded->fork);
    free(recorded->use);
    base_free(recorded->source.fork);
    base_free(recorded->access);
    free(recorded->bound);
    free(recorded->seconds);
    predict_round_free(recorded->round);
    *recorded = (struct predict_recorded){0};
}

static struct predict_recorded *recorded_place(struct predict_program *p, uint32_t name)
{
    p->damaged |= name >= p->graph->run->n_words; /* a graph has several */
    while (p->n_recorded <= name && !p->damaged) {
        if (!predict_grew(p->graph,
                          BASE_GROW(p->recorded, p->recorded_capacity, p->n_recorded + 1)))
            return NULL;
        p->recorded[p->n_recorded++] = (struct predict_recorded){0};
    }
    if (p->damaged)
        return NULL;
    recorded_forget(&p->recorded[name]);
    return &p->recorded[name];
}

/* The uses of all forks lie in one row, which has as many words at most as are left. */
static bool recorded_fork(struct predict_program *p, struct predict_recorded *graph, size_t i,
                          size_t *used)
{
    struct predict_fork *fork = &graph->fork[i];
    *fork = (struct predict_fork){.kernel = trace_words_next(&p->words),
                                  .n = trace_words_next(&p->words)};
    fork->at = (int32_t)trace_words_next(&p->words);
    fork->priority = (int32_t)trace_words_next(&p->words);
    fork->cost = trace_words_float(&p->words);
    fork->object = graph->use + *used;
    if (fork->n > trace_words_left(&p->words) ||
        (fork->kernel != PREDICT_NONE && fork->kernel >= p->graph->run->n_kernels))
        p->damaged = true;
    for (size_t k = 0; k < fork->n && !p->damaged; k++) {
        fork->object[k] = trace_words_next(&p->words);
        const duite_mode mode = predict_fork_mode(p, fork, k);
        p->damaged |= fork->object[k] >= graph->n_objects;
        p->damaged |= mode == DUITE_NONE; /* more objects than parameters */
        p->damaged |= mode == DUITE_CW && p->graph->run->kernel[fork->kernel].replicated;
    }
    p->damaged |= fork->kernel == PREDICT_NONE && fork->n != 1;
    *used += fork->n;
    graph->n_calls += fork->kernel != PREDICT_NONE;
    fork->number = graph->n_calls;
    return !p->damaged && !p->words.short_of;
}

/* The forks as the runtime's passes take them. */
static void recorded_source_add(const struct predict_program *p, struct predict_recorded *recorded,
                                const struct predict_fork *fork)
{
    const bool set = fork->kernel == PREDICT_NONE;
    struct plan_source *source = &recorded->source;
    source->fork[source->n_forks++] = (struct plan_source_fork){
        .first = source->n_accesses,
        .n = (uint32_t)fork->n,
        .owner = set ? fork->object[0] : predict_owner(p->graph, fork, fork->object),
        .rank = set || fork->at < 0 ? PLAN_BY_OWNER : fork->at % (int)p->graph->cluster->hosts,
        .sets = set,
        .replicated = !set && p->graph->run->kernel[fork->kernel].replicated,
        .cost = set ? 0 : (double)fork->cost};
    for (size_t k = 0; k < fork->n; k++)
        recorded->access[source->n_accesses++] =
            (struct plan_access){.object = fork->object[k], .mode = predict_fork_mode(p, fork, k)};
}

static bool recorded_source(const struct predict_program *p, struct predict_recorded *recorded,
                            size_t uses)
{
    struct plan_source *source = &recorded->source;
    source->fork = base_alloc((recorded->n_forks + 1) * sizeof *source->fork);
    source->access = recorded->access = base_alloc((uses + 1) * sizeof *recorded->access);
    for (size_t i = 0; i < recorded->n_forks && source->fork && recorded->access; i++)
        recorded_source_add(p, recorded, &recorded->fork[i]);
    return source->fork && recorded->access;
}

void predict_take_graph(struct predict_program *p, size_t n_objects)
{
    struct predict_recorded *graph = recorded_place(p, trace_words_next(&p->words));
    for (size_t i = 0; i < n_objects; i++)
        trace_words_next(&p->words);
    size_t n = trace_words_next(&p->words), used = 0, left = trace_words_left(&p->words);
    if (!graph || n > left)
        p->damaged = true;
    if (p->damaged || p->words.short_of)
        return;
    graph->n_objects = n_objects;
    graph->fork = malloc((n + 1) * sizeof *graph->fork);
    graph->use = malloc((left + 1) * sizeof *graph->use);
    graph->seconds = calloc(n + 1, sizeof *graph->seconds);
    p->graph->failed |= !graph->fork || !graph->use || !graph->seconds;
    while (!p->graph->failed && graph->n_forks < n &&
           recorded_fork(p, graph, graph->n_forks, &used))
        graph->n_forks++;
    if (!p->graph->failed && !p->damaged && !p->words.short_of)
        p->graph->failed |= !recorded_source(p, graph, used);
}

void predict_graphs_free(struct predict_program *p)
{
    for (size_t i = 0; i < p->n_recorded; i++)
        recorded_forget(&p->recorded[i]);
    free(p->recorded);
}
