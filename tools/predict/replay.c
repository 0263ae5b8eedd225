/* Replays. To nodes before and after it, a replay on a host is one task that reads or writes each
 * object there, as in a run (plan/ranks.c). Inside, the nodes of the compiled round (part.c) are
 * added once for each round. */
#include "tools/predict/program.h"

#include "runtime/base/memory.h"
#include "runtime/base/rank_set.h"

#include <stdlib.h>

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

/* ---- Forked rounds ---- */

static void replay_end_sums(struct predict_program *p, const struct predict_recorded *recorded)
{
    struct predict_graph *graph = p->graph;
    for (size_t i = 0; i < recorded->n_objects && !graph->failed; i++)
        if (graph->object[recorded->bound[i]].leaves != PREDICT_NONE)
            predict_reduce(graph, recorded->bound[i]);
}

/* The flag is read where the next round begins: everywhere. */
static void round_decide(struct predict_graph *graph, uint32_t flag)
{
    predict_prepare_all(graph, flag, DUITE_R);
    for (uint32_t host = 0; host < graph->cluster->hosts && !graph->failed; host++)
        graph->began[host] = predict_fetch(graph, flag, (int)host);
    graph->decided = true;
}

/* A round that has no plan: its tasks are forked like any other. */
static void round_fork_all(struct predict_program *p, const struct predict_recorded *recorded,
                           uint64_t first)
{
    struct predict_graph *graph = p->graph;
    graph->round = (uint32_t)graph->n_nodes;
    for (size_t i = 0; i < recorded->n_forks && !graph->failed; i++) {
        struct predict_fork fork = recorded->fork[i];
        if (!predict_room(p, fork.n))
            return;
        for (size_t k = 0; k < fork.n; k++)
            p->objects[k] = recorded->bound[fork.object[k]];
        fork.object = p->objects;
        fork.number += first;
        if (fork.kernel == PREDICT_NONE)
            predict_set(graph, fork.object[0]);
        else
            predict_fork(p, &fork);
    }
    if (recorded->round->flag != PREDICT_NONE && !graph->failed)
        round_decide(graph, recorded->round->flag);
}

/* ---- Planned rounds ---- */

/* The bodies of a round, each once, however many hosts run it. */
static void round_bodies(struct predict_program *p, const struct predict_recorded *recorded,
                         uint64_t first)
{
    const struct plan_source *source = &recorded->round->source;
    for (size_t i = 0; i < recorded->n_forks; i++) {
        struct predict_fork fork = recorded->fork[i];
        const uint32_t own = source->fork[i].owner;
        fork.number += first;
        if (fork.kernel != PREDICT_NONE)
            recorded->seconds[i] =
                predict_body(p, &fork, own == PLAN_NONE ? PREDICT_NONE : recorded->bound[own]);
    }
}

static void round_count_sums(struct predict_graph *graph, const struct predict_round *round)
{
    const struct plan_assignment *a = &round->assignment;
    for (size_t n = 0; n < round->lowered.n_nodes; n++)
        if (round->lowered.node[n].kind == PLAN_SUM && !plan_is_dead(a, n))
            predict_sum_count(graph, round->lowered.node[n].n_uses - 1,
                              a->set[n] > (uint32_t)a->n_ranks);
}

static struct predict_node round_node(const struct predict_graph *graph,
                                      const struct predict_recorded *recorded, size_t i,
                                      uint64_t first)
{
    struct predict_node node = recorded->round->node[i];
    const uint32_t fork = recorded->round->fork[i];
    if (fork == PREDICT_NONE)
        return node;
    const uint32_t own = recorded->round->source.fork[fork].owner;
    node.number = first + recorded->fork[fork].number;
    node.seconds = (float)recorded->seconds[fork];
    node.block = (uint32_t)node.number;
    if (own != PLAN_NONE) {
        node.block = graph->object[recorded->bound[own]].block;
        node.placed = recorded->bound[own] + 1;
    }
    return node;
}

/* Adds a round. `before`: the first node of the one before it, or NONE: it begins where its host
 * does. Successors are in the order of a plan's, since each edge is added before those there. */
static void round_add(struct predict_program *p, const struct predict_recorded *recorded,
                      uint64_t first, uint32_t before)
{
    struct predict_graph *graph = p->graph;
    const struct predict_round *round = recorded->round;
    const uint32_t base = (uint32_t)graph->n_nodes;
    round_bodies(p, recorded, first);
    round_count_sums(graph, round);
    for (size_t i = 0; i < round->n_nodes && !graph->failed; i++) {
        const struct predict_node node = round_node(graph, recorded, i, first);
        predict_add(graph, &node);
    }
    for (size_t i = round->n_edges; i-- > 0 && !graph->failed;) {
        const struct plan_round_edge *edge = &round->edge[i];
        if (!edge->cyclic)
            predict_edge(graph, base + edge->from, base + edge->to);
        else if (before != PREDICT_NONE)
            predict_edge(graph, before + edge->from, base + edge->to);
    }
    for (size_t i = round->n_nodes; i-- > 0 && before == PREDICT_NONE && !graph->failed;)
        if (round->begins[i])
            predict_edge(graph, graph->began[round->node[i].host], base + (uint32_t)i);
}

/* ---- The beginning and the end of a replay ---- */

/* The hosts on which the value of object i must be when a round begins; and where it is, if the
 * round writes it, before and after each (plan_maker is a node then). */
struct replay_sets {
    const uint64_t *enter, *end; /* NULL: none */
};

static struct replay_sets replay_sets(const struct predict_round *round, uint32_t i)
{
    const struct plan_assignment *a = &round->assignment;
    const uint32_t maker = plan_maker(a, i);
    if (maker == PLAN_NONE)
        return (struct replay_sets){.enter = plan_needs_set(a, i)};
    const uint64_t *end = plan_runs_set(a, maker);
    return (struct replay_sets){.enter = a->need[i] ? end : NULL, .end = end};
}

static void hosts_have_gates(struct predict_graph *graph, uint32_t *gate, const uint64_t *hosts)
{
    const size_t words = base_ranks_words((int)graph->cluster->hosts);
    for (int h = hosts ? base_ranks_next(hosts, words, 0) : -1; h >= 0;
         h = base_ranks_next(hosts, words, h + 1))
        if (gate[h] == PREDICT_NONE)
            gate[h] = predict_add(graph, &(struct predict_node){.host = (uint32_t)h,
                                                                .block = (uint32_t)h,
                                                                .kind = PREDICT_INSTANT});
}

static void replay_gates(struct predict_graph *graph, const struct predict_round *round,
                         uint32_t *gate)
{
    for (uint32_t h = 0; h < graph->cluster->hosts; h++)
        gate[h] = PREDICT_NONE;
    for (size_t n = 0; n < round->lowered.n_nodes && !graph->failed; n++)
        hosts_have_gates(graph, gate, plan_runs_set(&round->assignment, n));
}

/* Values come first, since no edge points back. */
static void replay_fetch(struct predict_graph *graph, const struct predict_recorded *recorded)
{
    const struct predict_round *round = recorded->round;
    const size_t words = round->assignment.words;
    for (uint32_t i = 0; i < round->lowered.n_objects && !graph->failed; i++) {
        const uint64_t *enter = replay_sets(round, i).enter;
        for (int h = enter ? base_ranks_next(enter, words, 0) : -1; h >= 0 && !graph->failed;
             h = base_ranks_next(enter, words, h + 1))
            predict_fetch(graph, predict_round_object(recorded, i), h);
    }
}

static void replay_begin(struct predict_program *p, const struct predict_recorded *recorded)
{
    struct predict_graph *graph = p->graph;
    const struct predict_round *round = recorded->round;
    const size_t words = round->assignment.words;
    replay_fetch(graph, recorded);
    replay_gates(graph, round, graph->began);
    for (uint32_t i = 0; i < round->lowered.n_objects && !graph->failed; i++) {
        const struct replay_sets sets = replay_sets(round, i);
        const uint64_t *hosts = sets.end ? sets.end : sets.enter;
        for (int h = base_ranks_next(hosts, words, 0); h >= 0 && !graph->failed;
             h = base_ranks_next(hosts, words, h + 1))
            predict_enter(graph, graph->began[h], predict_round_object(recorded, i), h, sets.enter,
                          sets.end);
    }
}

/* `before`: the first node of the last round. */
static void replay_end(struct predict_program *p, const struct predict_recorded *recorded,
                       uint32_t before)
{
    struct predict_graph *graph = p->graph;
    const struct predict_round *round = recorded->round;
    replay_gates(graph, round, graph->over);
    for (uint32_t i = 0; i < round->n_nodes && !graph->failed; i++)
        if (round->ends[i])
            predict_edge(graph, before + i, graph->over[round->node[i].host]);
    for (uint32_t i = 0; i < round->lowered.n_objects && !graph->failed; i++) {
        const struct replay_sets sets = replay_sets(round, i);
        predict_leave(graph, predict_round_object(recorded, i), sets.end ? sets.end : sets.enter,
                      sets.end);
    }
}

/* ---- Replays ---- */

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
    const bool forked = recorded->round->forked;
    uint32_t before = PREDICT_NONE;
    predict_op_replays(p, true);
    replay_end_sums(p, recorded);
    graph->replays = !forked;
    for (uint64_t i = 0; i < max && !graph->failed; i++) {
        const uint64_t first = p->forks + i * recorded->n_calls;
        if (!round_ran(p, recorded, first) || !round_is_seen(p, recorded))
            break;
        if (!i && !forked)
            replay_begin(p, recorded);
        const uint32_t now = (uint32_t)graph->n_nodes;
        if (forked)
            round_fork_all(p, recorded, first);
        else
            round_add(p, recorded, first, before);
        before = now;
        recorded->rounds++;
    }
    if (!forked && before != PREDICT_NONE && !graph->failed)
        replay_end(p, recorded, before);
    graph->replays = false;
    graph->round = PREDICT_NONE;
    graph->decided = false;
    replay_end_sums(p, recorded);
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
