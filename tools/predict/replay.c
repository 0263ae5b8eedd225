/* Replays. To nodes before and after it, a replay on a host is one task that reads or writes each
 * object there. Inside, a round begins where dependences allow, or when a flag was read. The
 * compiled round (round.c) says which nodes it has, where they run, and which hosts need their
 * results. */
#include "tools/predict/program.h"

#include "runtime/base/memory.h"

#include <stdlib.h>

enum { ROUND_NOWHERE = -2 }; /* in place of a host: the result is overwritten unread */

/* ---- Recorded graphs ---- */

static void recorded_forget(struct predict_recorded *recorded)
{
    free(recorded->fork);
    free(recorded->use);
    free(recorded->writes);
    free(recorded->bound);
    predict_round_free(recorded->round);
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
        const duite_mode mode = predict_fork_mode(p, fork, k);
        p->damaged |= fork->object[k] >= graph->n_objects;
        p->damaged |= mode == DUITE_CW && p->graph->run->kernel[fork->kernel].replicated;
        if (!p->damaged)
            graph->writes[fork->object[k]] |= mode != DUITE_R;
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
    graph->writes = calloc(n_objects + 1, sizeof *graph->writes);
    p->graph->failed |= !graph->fork || !graph->use || !graph->writes;
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

/* ---- Rounds ---- */

/* True if the round counts: one of its tasks ran. If none did, no later one counts either: the flag
 * ended the replay, or the poison of the whole round poisons all that follow. */
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
static void replay_gate(struct predict_program *p, const struct predict_recorded *recorded)
{
    struct predict_graph *graph = p->graph;
    const uint32_t *bound = recorded->bound;
    const size_t n = recorded->n_objects;
    const uint32_t hosts = graph->cluster->hosts;
    for (uint32_t h = 0; h < hosts; h++)
        graph->began[h] = PREDICT_NONE;
    for (size_t i = 0; i < n && !graph->failed; i++)
        if (graph->object[bound[i]].leaves != PREDICT_NONE)
            predict_prepare(graph, bound[i], DUITE_R, graph->object[bound[i]].home);
    for (size_t i = 0; i < n && !graph->failed && !graph->plain; i++) {
        struct predict_object *o = &graph->object[bound[i]];
        if (o->holder == PREDICT_ALL)
            continue;
        uint32_t host = (uint32_t)o->holder;
        if (graph->began[host] == PREDICT_NONE)
            graph->began[host] =
                predict_add(graph, &(struct predict_node){.host = host, .kind = PREDICT_INSTANT});
        if (!graph->failed)
            predict_use(graph, graph->began[host], bound[i],
                        recorded->writes[i] ? DUITE_RW : DUITE_R, o->writer);
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

/* The next fork of a round, with its objects; false without memory. */
static bool round_bind(struct predict_program *p, const struct predict_recorded *recorded, size_t i,
                       struct predict_fork *fork)
{
    *fork = recorded->fork[i];
    if (!predict_room(p, fork->n))
        return false;
    for (size_t k = 0; k < fork->n; k++)
        p->objects[k] = recorded->bound[fork->object[k]];
    fork->object = p->objects;
    return true;
}

/* Forks a round: by the rules of forks, not of rounds. */
static void round_forks(struct predict_program *p, const struct predict_recorded *recorded,
                        uint64_t first)
{
    struct predict_graph *graph = p->graph;
    struct predict_fork fork;
    for (size_t i = 0; i < recorded->n_forks && !graph->failed; i++) {
        if (!round_bind(p, recorded, i, &fork))
            return;
        fork.number = first + 1;
        if (fork.kernel == PREDICT_NONE) {
            predict_set(graph, fork.object[0], graph->object[fork.object[0]].home);
        } else {
            predict_fork(p, &fork);
            first++;
        }
    }
}

/* Sets graph->travel from the round, for the value that a node reads. */
static void round_travel(struct predict_graph *graph, const struct predict_round *round,
                         size_t node, size_t use)
{
    const struct plan_assignment *a = &round->assignment;
    const uint32_t version = a->reads[use];
    graph->travel = (struct predict_travel){.runs = plan_runs_set(a, node)};
    if (version == PLAN_NONE)
        return;
    const uint32_t maker = a->version[version].maker; /* plus 1 */
    graph->travel.need = plan_needs_set(a, version);
    graph->travel.phase = maker ? round->messages.phase[maker - 1] : 0;
}

uint32_t predict_round_fetch(struct predict_program *p, const struct predict_fork *fork,
                             const struct predict_where *where, size_t k)
{
    struct predict_graph *graph = p->graph;
    const struct predict_round *round = where->round;
    const size_t use = round->nodes.node[where->node].first_use + k;
    const duite_mode mode = trace_mode(&graph->run->kernel[fork->kernel], k);
    if (mode == DUITE_CW)
        return PREDICT_NONE;
    round_travel(graph, round, where->node, use);
    return predict_prepare(graph, fork->object[k], mode, where->host);
}

/* Contributions combine on the hosts that the round says, if any. */
static void round_reduce(struct predict_graph *graph, const struct predict_round *round, size_t n,
                         uint32_t object, int host)
{
    const struct plan_messages *m = &round->messages;
    struct predict_travel *travel = &graph->travel;
    travel->sum_phase = 0;
    for (size_t i = m->first_piece[n]; i < m->first_piece[n + 1]; i++) {
        const uint32_t phase = graph->phase[m->piece[i].rank] = m->piece[i].phase;
        travel->sum_phase = phase > travel->sum_phase ? phase : travel->sum_phase;
    }
    travel->n_hops = round->first_hop[n + 1] - round->first_hop[n];
    travel->hop = travel->n_hops ? round->hop + round->first_hop[n] : NULL;
    travel->rounds = m->rounds[n];
    if (host == ROUND_NOWHERE)
        graph->object[object].leaves = PREDICT_NONE;
    else
        predict_reduce(graph, object, host);
}

/* A set with a row of its own has several ranks, if there are several. */
static int round_host(const struct predict_round *round, size_t n)
{
    const struct plan_assignment *a = &round->assignment;
    const uint32_t set = a->set[n];
    if (!set)
        return ROUND_NOWHERE;
    if (a->n_ranks == 1)
        return 0;
    return set <= (uint32_t)a->n_ranks ? (int)set - 1 : PREDICT_ALL;
}

/* Makes a node that the runtime adds to a round, or a set. */
static void round_own(struct predict_program *p, const uint32_t *bound,
                      const struct predict_round *round, size_t n)
{
    struct predict_graph *graph = p->graph;
    const struct plan_round_node *node = &round->nodes.node[n];
    const struct plan_node_use *use = &round->nodes.use[node->first_use];
    const int host = round_host(round, n);
    round_travel(graph, round, n, node->first_use);
    if (node->kind == PLAN_SUM)
        round_reduce(graph, round, n, bound[use->place], host);
    else if (node->kind == PLAN_FLAG)
        replay_decide(graph, round->flag);
    else if (host != ROUND_NOWHERE)
        predict_set(graph, bound[use->place], host);
}

static void round_nodes(struct predict_program *p, const struct predict_recorded *recorded,
                        uint64_t first)
{
    struct predict_graph *graph = p->graph;
    const struct predict_round *round = recorded->round;
    struct predict_fork fork;
    for (size_t n = 0; n < round->nodes.n_nodes && !graph->failed; n++) {
        const struct plan_round_node *node = &round->nodes.node[n];
        if (node->kind != PLAN_TASK) {
            round_own(p, recorded->bound, round, n);
            continue;
        }
        if (!round_bind(p, recorded, node->fork, &fork))
            return;
        fork.number = ++first;
        predict_task(p, &fork,
                     &(struct predict_where){.own = node->owner == PLAN_NONE
                                                        ? PREDICT_NONE
                                                        : recorded->bound[node->owner],
                                             .host = round_host(round, n),
                                             .path = round->path ? round->path[node->fork] : 0,
                                             .round = round,
                                             .node = n});
    }
    graph->travel = (struct predict_travel){0};
}

static void round_add(struct predict_program *p, const struct predict_recorded *recorded,
                      uint64_t first)
{
    p->graph->round = (uint32_t)p->graph->n_nodes;
    predict_packets_clear(p->graph);
    if (!recorded->round->forked) {
        round_nodes(p, recorded, first);
        return;
    }
    p->graph->replays = false; /* the rules of forks, for its messages, too */
    round_forks(p, recorded, first);
    p->graph->replays = true;
    if (recorded->round->flag != PREDICT_NONE && !p->graph->failed)
        replay_decide(p->graph, recorded->round->flag);
}

/* More rounds than the file can have are damage. A round without tasks counts as one task. */
static bool round_is_seen(struct predict_program *p, const struct predict_recorded *recorded)
{
    p->replayed += recorded->n_calls ? recorded->n_calls : 1;
    p->damaged |= p->replayed > p->max_replayed;
    return !p->damaged;
}

static void replay_simulate(struct predict_program *p, struct predict_recorded *recorded,
                            uint64_t max)
{
    struct predict_graph *graph = p->graph;
    predict_op_replays(p, true);
    replay_gate(p, recorded);
    graph->replays = true;
    for (uint64_t i = 0; i < max && !graph->failed; i++) {
        uint64_t first = p->forks + i * recorded->n_calls;
        if (!round_ran(p, recorded, first) || !round_is_seen(p, recorded))
            break;
        round_add(p, recorded, first);
        recorded->rounds++;
    }
    graph->round = graph->flag = PREDICT_NONE;
    replay_gate(p, recorded);
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
        if (!p->graph->failed && predict_round_prepare(p, recorded, flag))
            replay_simulate(p, recorded, max);
    }
    p->forks += max * recorded->n_calls;
}
