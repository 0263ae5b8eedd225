/* Replays: to what comes before and after, a replay on a host is one task that reads or writes each
 * object there; inside, a round begins where dependences allow, or when a flag was read. The passes
 * of plan/passes.h that compile a round for a run compile it here, from the words of a trace: they
 * say which nodes it has, which hosts run them, which hosts need what they make, and in which phase
 * it moves. Mappings see the same rows as in a run, too. */
#include "runtime/predict/program.h"

#include "runtime/base/memory.h"
#include "runtime/map/tasks.h"

#include <stdlib.h>

struct round_source {
    struct plan_source plain;
    struct plan_access *access; /* of plain */
};

/* A round that was compiled, and what it was compiled for. */
struct predict_round {
    struct round_source source;
    struct plan_round nodes;
    struct plan_assignment assignment;
    struct plan_messages messages;
    float *path;   /* by fork; NULL: the scheduler does not ask */
    int *home;     /* by object of the source */
    uint32_t flag; /* an object of the program, or NONE */
    bool forked;   /* it has no plan: nothing behind `home` is there */
};

enum { ROUND_NOWHERE = -2 }; /* in place of a host: what it makes is overwritten unread */

/* ---- A round as plain data ---- */

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
        .rank = set || fork->at < 0 ? PLAN_BY_OWNER : fork->at % (int)p->graph->cluster->hosts,
        .sets = set,
        .replicated = !set && p->graph->run->kernel[fork->kernel].replicated,
        .cost = set ? 0 : (double)fork->cost};
    for (size_t k = 0; k < fork->n; k++)
        access[source->n_accesses++] =
            (struct plan_access){.object = fork->object[k], .mode = round_mode(p, fork, k)};
}

/* The objects of a record, and a flag that is none of them. The object of a view is among them if
 * the graph names it. NULL without memory. */
static struct plan_source_object *round_objects(const struct predict_program *p,
                                                const struct predict_recorded *recorded,
                                                uint32_t flag, size_t *n, uint32_t *place)
{
    struct predict_object *all = p->graph->object;
    struct plan_source_object *objects =
        base_alloc_zero((recorded->n_objects + 2) * sizeof *objects);
    *n = recorded->n_objects;
    for (uint32_t i = 0; i < *n && objects; i++)
        all[recorded->bound[i]].place = i + 1;
    for (uint32_t i = 0; i < *n && objects; i++) {
        const struct predict_object *bound = &all[recorded->bound[i]];
        objects[i].bytes = bound->bytes;
        if (bound->parent != PREDICT_NONE)
            objects[i].parent = all[bound->parent].place;
    }
    *place = PLAN_NONE;
    if (flag != PREDICT_NONE && objects) {
        *place = all[flag].place ? all[flag].place - 1 : (uint32_t)(*n)++;
        objects[*place].bytes = all[flag].bytes;
    }
    for (uint32_t i = 0; i < recorded->n_objects; i++)
        all[recorded->bound[i]].place = 0;
    return objects;
}

/* Takes the objects. False without memory; round_source_free is due all the same. */
static bool round_source_make(const struct predict_program *p,
                              const struct predict_recorded *recorded, struct round_source *source)
{
    size_t uses = 0;
    for (size_t i = 0; i < recorded->n_forks; i++)
        uses += recorded->fork[i].n;
    struct plan_source *plain = &source->plain;
    plain->access = source->access = base_alloc((uses + 1) * sizeof *source->access);
    plain->fork = base_alloc((recorded->n_forks + 1) * sizeof *plain->fork);
    if (!plain->access || !plain->fork || !plain->object)
        return false;
    for (size_t i = 0; i < recorded->n_forks; i++)
        round_fork(p, plain, source->access, &recorded->fork[i]);
    return true;
}

static void round_source_free(struct round_source *source)
{
    base_free(source->plain.fork);
    base_free(source->plain.object);
    base_free(source->access);
}

bool predict_round_tasks(const struct predict_program *p, const struct predict_recorded *recorded,
                         const uint32_t *block, struct map_tasks *tasks)
{
    struct round_source source = {0};
    struct plan_round round = {0};
    struct plan_tasks *all = &tasks->tasks;
    *tasks = (struct map_tasks){0};
    source.plain.object =
        round_objects(p, recorded, PREDICT_NONE, &source.plain.n_objects, &source.plain.flag);
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

/* ---- A round for hosts ---- */

/* How a round begins and ends with an object. */
struct round_ends {
    bool touched, leads, trails; /* leads, trails: with contributions */
};

static void ends_note(struct round_ends *ends, bool contributes)
{
    ends->leads |= contributes && !ends->touched;
    ends->trails = contributes;
    ends->touched = true;
}

/* Whether contributions of one round and of the next make one sum, or a flag waits for
 * contributions to be continued: such rounds are forked, as plan_replay_split has it. */
static bool source_is_forked(const struct plan_source *source, struct round_ends *ends)
{
    bool forked = false;
    for (size_t i = 0; i < source->n_forks; i++) {
        const struct plan_source_fork *fork = &source->fork[i];
        const struct plan_access *access = source->access + fork->first;
        for (uint32_t k = 0; k < fork->n; k++)
            if (source->object[access[k].object].parent)
                ends_note(&ends[source->object[access[k].object].parent - 1], false);
        for (uint32_t k = 0; k < fork->n; k++)
            ends_note(&ends[access[k].object], access[k].mode == DUITE_CW);
    }
    for (uint32_t i = 0; i < source->n_objects; i++) {
        const bool flagged = source->flag != PLAN_NONE;
        forked |= ends[i].leads && (ends[i].trails || flagged);
        forked |= ends[i].trails && flagged && source->flag != i;
    }
    return forked;
}

void predict_round_free(struct predict_round *round)
{
    if (!round)
        return;
    plan_messages_free(&round->messages);
    plan_assignment_free(&round->assignment);
    plan_round_free(&round->nodes);
    round_source_free(&round->source);
    base_free(round->path);
    base_free(round->home);
    base_free(round);
}

/* Is the round that is there the one that is wanted? */
static bool round_fits(const struct predict_round *there, const struct predict_round *wanted)
{
    const struct plan_source *a = &there->source.plain, *b = &wanted->source.plain;
    bool fits = a->n_objects == b->n_objects && a->flag == b->flag;
    for (size_t i = 0; i < b->n_objects && fits; i++)
        fits = a->object[i].parent == b->object[i].parent &&
               a->object[i].bytes == b->object[i].bytes && there->home[i] == wanted->home[i];
    return fits;
}

/* All passes but those of one rank; edges are for paths alone. */
static bool round_compile(const struct predict_program *p, const struct predict_recorded *recorded,
                          struct predict_round *round)
{
    const struct predict_cluster *cluster = p->graph->cluster;
    if (!round_source_make(p, recorded, &round->source))
        return false;
    const struct plan_source *source = &round->source.plain;
    struct round_ends *ends = base_alloc_zero((source->n_objects + 1) * sizeof *ends);
    round->forked = ends && source_is_forked(source, ends);
    base_free(ends);
    if (!ends || round->forked)
        return ends;
    bool fine = plan_lower(&round->nodes, source) &&
                plan_assign(&round->assignment, &round->nodes, round->home, (int)cluster->hosts) &&
                plan_messages_find(&round->messages, &round->assignment, PLAN_NO_RANK);
    if (fine && cluster->scheduler->paths)
        fine = plan_edges(&round->nodes) && (round->path = plan_paths_find(&round->nodes));
    return fine;
}

/* The record's round is there, for these homes, sizes and this flag. False without memory. */
static bool round_prepare(struct predict_program *p, struct predict_recorded *recorded,
                          uint32_t flag)
{
    struct predict_round *round = base_alloc_zero(sizeof *round);
    bool fine = round;
    if (fine) {
        struct plan_source *source = &round->source.plain;
        source->object = round_objects(p, recorded, flag, &source->n_objects, &source->flag);
        round->home = base_alloc((recorded->n_objects + 2) * sizeof *round->home);
        round->flag = flag;
        fine = source->object && round->home;
        for (size_t i = 0; i < source->n_objects && fine; i++)
            round->home[i] =
                p->graph->object[i < recorded->n_objects ? recorded->bound[i] : flag].home;
    }
    if (fine && recorded->round && round_fits(recorded->round, round)) {
        recorded->round->flag = flag;
        predict_round_free(round);
        return true;
    }
    fine = fine && round_compile(p, recorded, round);
    p->graph->failed |= !fine;
    predict_round_free(recorded->round);
    recorded->round = round;
    return fine;
}

/* ---- Recorded graphs ---- */

static void recorded_forget(struct predict_recorded *recorded)
{
    free(recorded->fork);
    free(recorded->use);
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
        p->damaged |= fork->object[k] >= graph->n_objects;
        p->damaged |= fork->kernel != PREDICT_NONE &&
                      p->graph->run->kernel[fork->kernel].replicated &&
                      trace_mode(&p->graph->run->kernel[fork->kernel], k) == DUITE_CW;
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

/* ---- Rounds ---- */

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

/* A round that is forked: by the rules of forks, not of rounds. */
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

/* What the round says of the value that a node reads. */
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

/* The round gathers a view of what it writes; any other is gathered before, if it is stale. */
uint32_t predict_round_fetch(struct predict_program *p, const struct predict_fork *fork,
                             const struct predict_where *where, size_t k)
{
    struct predict_graph *graph = p->graph;
    const struct predict_round *round = where->round;
    const size_t use = round->nodes.node[where->node].first_use + k;
    const uint32_t object = fork->object[k], place = round->nodes.use[use].place;
    const duite_mode mode = trace_mode(&graph->run->kernel[fork->kernel], k);
    if (mode == DUITE_CW)
        return PREDICT_NONE;
    round_travel(graph, round, where->node, use);
    const uint32_t parent = round->source.plain.object[place].parent;
    if (parent && plan_maker(&round->assignment, parent - 1) != PLAN_NONE)
        return mode == DUITE_W ? PREDICT_NONE : predict_fetch(graph, object, where->host);
    return predict_prepare(graph, object, mode, where->host);
}

/* Contributions end: on the hosts that the round says, if any. */
static void round_reduce(struct predict_graph *graph, const struct predict_round *round, size_t n,
                         uint32_t object, int host)
{
    const struct plan_messages *m = &round->messages;
    for (size_t i = m->first_piece[n]; i < m->first_piece[n + 1]; i++)
        graph->phase[m->piece[i].rank] = m->piece[i].phase;
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

/* What the runtime adds to a round, or a set. */
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
    else if (host != ROUND_NOWHERE && node->kind == PLAN_SET)
        predict_set(graph, bound[use->place], host);
    else if (host != ROUND_NOWHERE)
        predict_gather(graph, bound[use[1].place], host);
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
    round_forks(p, recorded, first);
    if (recorded->round->flag != PREDICT_NONE && !p->graph->failed)
        replay_decide(p->graph, recorded->round->flag);
}

/* More rounds than the file can have seen are damage. One without tasks counts as a task. */
static bool round_is_seen(struct predict_program *p, const struct predict_recorded *recorded)
{
    p->replayed += recorded->n_calls ? recorded->n_calls : 1;
    p->damaged |= p->replayed > p->max_replayed;
    return !p->damaged;
}

static void replay_rounds(struct predict_program *p, struct predict_recorded *recorded,
                          uint64_t max)
{
    struct predict_graph *graph = p->graph;
    const uint32_t *bound = recorded->bound;
    predict_op_replays(p, true);
    replay_gate(p, bound, recorded->n_objects);
    graph->replays = true;
    for (uint64_t i = 0; i < max && !graph->failed; i++) {
        uint64_t first = p->forks + i * recorded->n_calls;
        if (!round_ran(p, recorded, first) || !round_is_seen(p, recorded))
            break;
        round_add(p, recorded, first);
        recorded->rounds++;
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
        if (!p->graph->failed && round_prepare(p, recorded, flag))
            replay_rounds(p, recorded, max);
    }
    p->forks += max * recorded->n_calls;
}
