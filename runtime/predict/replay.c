/* Replays: to what comes before and after, a replay on a host is one task that reads or writes each
 * object there; inside, a round begins where dependences allow, or when a flag was read. */
#include "runtime/predict/program.h"

#include "runtime/base/memory.h"

#include <math.h>
#include <stdlib.h>

static void recorded_forget(struct predict_recorded *recorded)
{
    free(recorded->fork);
    free(recorded->use);
    free(recorded->bound);
    *recorded = (struct predict_recorded){0};
}

static struct predict_recorded *recorded_place(struct predict_program *p, uint32_t name)
{
    p->damaged |= name >= p->graph->run->n_words; /* a graph has several */
    while (p->n_recorded <= name && !p->damaged) {
        void *moved =
            base_grow(p->recorded, &p->recorded_capacity, p->n_recorded + 1, sizeof *p->recorded);
        p->graph->failed |= !moved;
        if (!moved)
            return NULL;
        p->recorded = moved;
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
        p->damaged |= fork->object[k] >= graph->n_objects;
    }
    p->damaged |= fork->kernel == PREDICT_NONE && fork->n != 1;
    *used += fork->n;
    graph->n_calls += fork->kernel != PREDICT_NONE;
    return !p->damaged && !p->words.short_of;
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
    p->graph->failed |= !graph->fork || !graph->use;
    while (!p->graph->failed && graph->n_forks < n &&
           recorded_fork(p, graph, graph->n_forks, &used))
        graph->n_forks++;
}

void predict_graphs_free(struct predict_program *p)
{
    for (size_t i = 0; i < p->n_recorded; i++)
        recorded_forget(&p->recorded[i]);
    free(p->recorded);
}

/* Whether the round counts: one of its tasks ran. If none did, no later one counts either: the flag
 * ended the replay, or what poisoned all of the round poisons all that follow. */
static bool round_ran(const struct predict_program *p, const struct predict_recorded *recorded,
                      uint64_t first)
{
    double seconds;
    bool found = !recorded->n_calls;
    for (uint64_t i = 1; i <= recorded->n_calls && !found; i++)
        found = predict_times_find(p->times, first + i, &seconds);
    return found;
}

/* On each host one node that all its objects wait for, and that waits for them. */
static void replay_gate(struct predict_program *p, const uint32_t *bound, size_t n)
{
    struct predict_graph *graph = p->graph;
    const uint32_t hosts = graph->cluster->hosts;
    for (uint32_t h = 0; h < hosts; h++)
        graph->began[h] = PREDICT_NONE;
    for (size_t i = 0; i < n && !graph->failed; i++)
        if (graph->object[bound[i]].leaves != PREDICT_NONE)
            predict_prepare(graph, bound[i], DUITE_R, graph->object[bound[i]].home);
    for (size_t i = 0; i < n && !graph->failed && !graph->plain; i++) {
        struct predict_object *o = &graph->object[bound[i]];
        if (o->holder == PREDICT_ALL || o->parent != PREDICT_NONE)
            continue;
        uint32_t host = (uint32_t)o->holder;
        if (graph->began[host] == PREDICT_NONE)
            graph->began[host] =
                predict_add(graph, &(struct predict_node){.host = host, .kind = PREDICT_INSTANT});
        if (!graph->failed)
            predict_use(graph, graph->began[host], bound[i], DUITE_RW, o->writer);
    }
}

/* The flag is read where the next round begins: everywhere. */
static void replay_decide(struct predict_graph *graph, uint32_t flag)
{
    uint32_t value = predict_prepare(graph, flag, DUITE_R, PREDICT_ALL);
    if (graph->plain) {
        graph->flag = value;
        return;
    }
    uint32_t node = predict_add(graph, &(struct predict_node){.kind = PREDICT_INSTANT});
    if (graph->failed)
        return;
    predict_edge(graph, value, node);
    graph->flag = node;
}

/* The longest path from each task of the round to its end, in the seconds that forks said. */
static void round_paths(struct predict_graph *graph)
{
    double said = 0;
    size_t n = 0;
    for (size_t i = graph->round; i < graph->n_nodes; i++) {
        said += (double)graph->node[i].cost;
        n += graph->node[i].cost > 0;
    }
    const double mean = n ? said / (double)n : 1;
    for (size_t i = graph->n_nodes; i-- > graph->round;) {
        struct predict_node *node = &graph->node[i];
        double longest = 0;
        for (uint32_t e = node->edge; e != PREDICT_NONE; e = graph->edge[e].next)
            longest = fmax(longest, (double)graph->node[graph->edge[e].to].path);
        bool program = node->kernel < graph->run->n_kernels && node->number &&
                       (node->kind == PREDICT_TASK || node->kind == PREDICT_EVERYWHERE);
        double own = node->cost > 0 ? (double)node->cost : mean;
        node->path = (float)(longest + (program ? own : 0));
    }
}

static void round_nodes(struct predict_program *p, const struct predict_recorded *recorded,
                        const uint32_t *bound, uint64_t first)
{
    struct predict_graph *graph = p->graph;
    graph->round = (uint32_t)graph->n_nodes;
    predict_packets_clear(graph);
    for (size_t i = 0; i < recorded->n_forks && !graph->failed; i++) {
        struct predict_fork fork = recorded->fork[i];
        if (!predict_room(p, fork.n))
            return;
        for (size_t k = 0; k < fork.n; k++)
            p->objects[k] = bound[fork.object[k]];
        fork.object = p->objects;
        fork.number = first + 1;
        if (fork.kernel == PREDICT_NONE) {
            predict_set(p, fork.object[0]);
        } else {
            predict_fork(p, &fork);
            first++;
        }
    }
    if (graph->cluster->scheduler->paths && !graph->failed)
        round_paths(graph);
}

/* More rounds than the file can have seen are damage. One without tasks counts as a task. */
static bool round_is_seen(struct predict_program *p, const struct predict_recorded *recorded)
{
    p->replayed += recorded->n_calls ? recorded->n_calls : 1;
    p->damaged |= p->replayed > p->max_replayed;
    return !p->damaged;
}

static void replay_rounds(struct predict_program *p, struct predict_recorded *recorded,
                          uint32_t flag, uint64_t max)
{
    struct predict_graph *graph = p->graph;
    const uint32_t *bound = recorded->bound;
    bool flagged = flag != PREDICT_NONE;
    predict_op_replays(p, true);
    replay_gate(p, bound, recorded->n_objects);
    graph->replays = true;
    for (uint64_t i = 0; i < max && !graph->failed; i++) {
        uint64_t first = p->forks + i * recorded->n_calls;
        if (!round_ran(p, recorded, first) || !round_is_seen(p, recorded))
            break;
        round_nodes(p, recorded, bound, first);
        recorded->rounds++;
        if (flagged && !graph->failed)
            replay_decide(graph, flag);
    }
    graph->round = graph->flag = PREDICT_NONE;
    replay_gate(p, bound, recorded->n_objects);
    graph->replays = false;
    predict_op_replays(p, false);
}

void predict_replay(struct predict_program *p, size_t n_objects)
{
    uint32_t name = trace_words_next(&p->words), flag_slot = trace_words_next(&p->words);
    uint64_t max = trace_words_next2(&p->words);
    p->forks = trace_words_next2(&p->words);
    if (name >= p->n_recorded || p->recorded[name].n_objects != n_objects) {
        p->damaged = true;
        return;
    }
    struct predict_recorded *recorded = &p->recorded[name];
    uint32_t flag = flag_slot ? predict_object_at(p, flag_slot) : PREDICT_NONE;
    uint32_t *bound = malloc((n_objects + 1) * sizeof *bound);
    p->graph->failed |= !bound;
    for (size_t i = 0; bound && i < n_objects; i++)
        bound[i] = predict_object_at(p, trace_words_next(&p->words));
    free(recorded->bound);
    recorded->bound = bound;
    if (bound && !p->damaged && !p->words.short_of) {
        predict_move(p, recorded);
        replay_rounds(p, recorded, flag, max);
    }
    p->forks += max * recorded->n_calls;
}
