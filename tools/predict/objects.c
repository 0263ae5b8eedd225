/* Objects of the main program, and their homes. Homes are those of the trace, or the mapping gives
 * them by the same code as in a run, on a table that has nothing but these objects. */
#include "tools/predict/program.h"

#include "runtime/base/memory.h"
#include "runtime/map/map.h"

#include <stdlib.h>
#include <string.h>

/* Slots are used one after the other, and an object has several words in the trace. So a slot
 * beyond the number of words is damage, and gets no room. */
static uint32_t *slot_object(struct predict_program *p, uint32_t slot)
{
    static uint32_t none;
    if (slot >= p->graph->run->n_words) {
        p->damaged = true;
        return &none;
    }
    size_t before = p->slots_capacity;
    if (!predict_grew(p->graph, BASE_GROW(p->slot, p->slots_capacity, (size_t)slot + 1)))
        return &none;
    if (p->slots_capacity > before)
        memset(p->slot + before, 0xff, (p->slots_capacity - before) * sizeof *p->slot);
    return &p->slot[slot];
}

/* The object that a slot names. */
uint32_t predict_object_at(struct predict_program *p, uint32_t slot)
{
    uint32_t found = *slot_object(p, slot);
    p->damaged |= found >= p->graph->n_objects;
    return found < p->graph->n_objects ? found : 0;
}

void predict_make(struct predict_program *p)
{
    struct predict_graph *graph = p->graph;
    uint32_t slot = trace_words_next(&p->words);
    uint64_t bytes = trace_words_next2(&p->words);
    if (!predict_grew(graph,
                      BASE_GROW(graph->object, graph->objects_capacity, graph->n_objects + 1) &&
                          BASE_GROW(p->name, p->names_capacity, graph->n_objects + 1)))
        return;
    struct predict_object new = {.bytes = bytes,
                                 .copies = PREDICT_NONE,
                                 .leaves = PREDICT_NONE,
                                 .leader = PREDICT_NONE,
                                 .hints = PREDICT_NONE};
    p->name[graph->n_objects] = DUITE_NO_OBJECT;
    if (data_object_new(&p->table, DUITE_BYTE, 1, 1, false, &p->name[graph->n_objects]))
        graph->failed = true;
    graph->object[graph->n_objects] = new;
    *slot_object(p, slot) = (uint32_t)graph->n_objects++;
}

void predict_drop(struct predict_program *p)
{
    uint32_t slot = trace_words_next(&p->words);
    duite_object name = p->name ? p->name[predict_object_at(p, slot)] : DUITE_NO_OBJECT;
    if (name.slot)
        data_object_drop(&p->table, name);
    *slot_object(p, slot) = PREDICT_NONE;
}

void predict_hint(struct predict_program *p, size_t n)
{
    uint32_t slot = trace_words_next(&p->words);
    double weight = trace_words_double(&p->words);
    duite_object *names = malloc((n + 1) * sizeof *names);
    double *weights = malloc((n + 1) * sizeof *weights);
    const uint32_t own = predict_object_at(p, slot);
    p->graph->failed |= !names || !weights;
    for (size_t i = 0; i < n && !p->graph->failed && !p->words.short_of; i++) {
        uint32_t other = predict_object_at(p, trace_words_next(&p->words));
        weights[i] = trace_words_double(&p->words);
        if (p->damaged)
            continue;
        names[i] = p->name[other];
        if (p->graph->cluster->packed)
            predict_hint_add(p->graph, own, other, weights[i]);
    }
    if (!p->graph->failed && !p->damaged && !p->words.short_of)
        p->code = map_hint(&p->table, p->name[own], weight, n, names, weights);
    free(names);
    free(weights);
}

void predict_follow(struct predict_program *p)
{
    uint32_t own = predict_object_at(p, trace_words_next(&p->words)),
             leader = predict_object_at(p, trace_words_next(&p->words));
    if (p->damaged)
        return;
    p->graph->object[own].leader = leader;
    p->code = map_colocate(&p->table, p->name[own], p->name[leader]);
}

/* Blocks with traced homes are numbered on their host in the order in which they came there.
 * `block`: their number among all. */
static uint32_t home_block(struct predict_program *p, uint32_t block, int host)
{
    if (!predict_grew(p->graph, BASE_GROW(p->block, p->blocks_capacity, (size_t)block + 1)))
        return 0;
    while (p->n_blocks <= block)
        p->block[p->n_blocks++] = PREDICT_NONE;
    if (p->block[block] == PREDICT_NONE)
        p->block[block] = p->blocks_on[host]++;
    return p->block[block];
}

static void home_give(struct predict_program *p, uint32_t own, uint32_t traced)
{
    struct predict_object *o = &p->graph->object[own];
    const struct data_object *settled = &p->table.object[p->name[own].slot];
    const bool maps = p->graph->cluster->mapping;
    const bool moves =
        predict_writer(o) != PREDICT_NONE; /* by migration: a mapping does not see it */
    p->damaged |= traced >= p->graph->run->n_ranks || settled->home < 0;
    if (p->damaged || (maps && moves))
        return;
    o->home = maps ? settled->home : (int)traced;
    o->block = maps ? settled->block : home_block(p, settled->block, o->home);
    if (!moves)
        o->holder = o->home;
}

/* Gives objects the traced homes; or, if there is a mapping, its homes to objects without one. */
void predict_homes(struct predict_program *p, size_t n)
{
    const struct predict_cluster *cluster = p->graph->cluster;
    const struct map_policy mapping = {.own = cluster->mapping};
    p->code = map_settle(&p->table, &mapping, cluster->seed);
    for (size_t i = 0; i < n && !p->code && !p->words.short_of && !p->damaged; i++) {
        uint32_t own = predict_object_at(p, trace_words_next(&p->words)),
                 home = trace_words_next(&p->words);
        if (!p->damaged)
            home_give(p, own, home);
    }
}
