/* Nodes of one rank: tasks, by the owner rule; sums of large objects, at the home; views, where
 * their object was written. All other nodes run wherever what they make is needed: tasks of
 * replicated kernels, sets, sums of small objects (which cost as many messages of contributions as
 * one more message would) and views of what such nodes make. Who needs what is gone through
 * backwards until nothing changes; a version that leaves the round is needed where the next one
 * begins with it. So only what is made on one rank ever travels within a round.
 *
 * Phases: a node's is at least that of all that comes before it on its rank, for whatever reason,
 * and above that of each message that it waits for; the phase of a message is that of the nodes
 * that make what it carries. So a packet waits for packets of lower phases only, never in a ring.
 */
#include "runtime/plan/spread.h"
#include "runtime/base/memory.h"

#include <string.h>

enum { SMALL_SUM_BYTES = 1024 };

void spread_free(struct spread *spread)
{
    base_free(spread->at);
    base_free(spread->set);
    base_free(spread->phase);
    base_free(spread->many);
    base_free(spread->reads);
    base_free(spread->makes);
    base_free(spread->version);
    base_free(spread->need);
    base_free(spread->last);
    base_free(spread->leaf);
    base_free(spread->home);
    base_free(spread->latest);
}

static bool alloc(struct spread *spread)
{
    const struct plan_round *round = spread->round;
    size_t nodes = round->n_nodes + 1, uses = round->n_uses + 1, objects = round->n_objects + 1;
    size_t versions = uses + objects, leaves = round->n_places - round->n_objects + 1;
    spread->at = base_alloc(nodes * sizeof *spread->at);
    spread->set = base_alloc_zero(nodes * spread->words * sizeof *spread->set);
    spread->phase = base_alloc(nodes * sizeof *spread->phase);
    spread->many = base_alloc(nodes * sizeof *spread->many);
    spread->reads = base_alloc(uses * sizeof *spread->reads);
    spread->makes = base_alloc(uses * sizeof *spread->makes);
    spread->version = base_alloc(versions * sizeof *spread->version);
    spread->need = base_alloc_zero(versions * spread->words * sizeof *spread->need);
    spread->last = base_alloc(objects * sizeof *spread->last);
    spread->leaf = base_alloc(leaves * sizeof *spread->leaf);
    spread->home = base_alloc(objects * sizeof *spread->home);
    spread->latest = base_alloc((size_t)spread->n_ranks * sizeof *spread->latest);
    return spread->at && spread->set && spread->phase && spread->many && spread->reads &&
           spread->makes && spread->version && spread->need && spread->last && spread->leaf &&
           spread->home && spread->latest;
}

/* ---- Versions ---- */

static void find_versions(struct spread *spread)
{
    const struct plan_round *round = spread->round;
    for (uint32_t i = 0; i < round->n_objects; i++) {
        spread->version[i] = (struct spread_version){.object = i};
        spread->last[i] = i;
    }
    spread->n_versions = round->n_objects;
    for (size_t n = 0; n < round->n_nodes; n++) {
        const struct plan_round_node *node = &round->node[n];
        for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
            const struct plan_node_use *use = &round->use[i];
            spread->reads[i] = spread->makes[i] = SPREAD_NONE;
            if (use->place >= round->n_objects) {
                if (use->writes)
                    spread->leaf[use->place - round->n_objects] = (uint32_t)n;
                continue;
            }
            if (use->reads)
                spread->reads[i] = spread->last[use->place];
            if (!use->writes)
                continue;
            uint32_t made = spread->makes[i] = (uint32_t)spread->n_versions++;
            spread->version[made] = (struct spread_version){use->place, (uint32_t)n + 1};
            spread->last[use->place] = made;
        }
    }
}

uint32_t spread_maker(const struct spread *spread, uint32_t version)
{
    const struct spread_version *found = &spread->version[version];
    if (!found->maker)
        found = &spread->version[spread->last[found->object]];
    return found->maker ? found->maker - 1 : SPREAD_NONE;
}

bool spread_is_there(const struct spread *spread, uint32_t version, int rank)
{
    uint32_t maker = spread_maker(spread, version);
    return maker == SPREAD_NONE || spread_runs(spread, maker, rank);
}

/* ---- Who runs what ---- */

static int owner(const struct spread *spread, const struct plan_round_node *node)
{
    return node->owner == PLAN_NONE ? 0 : spread->home[node->owner];
}

static int rank_of_task(const struct spread *spread, const struct plan_round_node *node)
{
    const struct plan_source_fork *fork = &spread->round->source->fork[node->fork];
    if (fork->replicated)
        return SPREAD_MANY;
    return fork->at != PLAN_BY_OWNER ? fork->at : owner(spread, node);
}

static int rank_of(const struct spread *spread, const struct plan_round_node *node)
{
    const struct plan_node_use *use = &spread->round->use[node->first_use];
    uint32_t maker;
    switch (node->kind) {
    case PLAN_TASK:
        return rank_of_task(spread, node);
    case PLAN_SUM: {
        size_t bytes = spread->round->source->object[use->place].bytes;
        return bytes <= SMALL_SUM_BYTES ? SPREAD_MANY : spread->home[use->place];
    }
    case PLAN_VIEW:
        maker = spread_maker(spread, spread->reads[node->first_use]);
        return maker == SPREAD_NONE ? spread->home[use->place] : spread->at[maker];
    default:
        return SPREAD_MANY;
    }
}

/* Those that make what a round begins with may come later in the list: views are placed last. */
static void place_nodes(struct spread *spread)
{
    const struct plan_round *round = spread->round;
    for (int views = 0; views < 2; views++)
        for (size_t n = 0; n < round->n_nodes; n++) {
            const struct plan_round_node *node = &round->node[n];
            if ((node->kind == PLAN_VIEW) != views)
                continue;
            int at = spread->at[n] = rank_of(spread, node);
            if (at == SPREAD_MANY)
                spread->many[spread->n_many++] = (uint32_t)n;
            else
                spread_add(spread->set + n * spread->words, at);
            for (int rank = 0; node->kind == PLAN_FLAG && rank < spread->n_ranks; rank++)
                spread_add(spread->set + n * spread->words, rank);
        }
}

static bool join(uint64_t *to, const uint64_t *from, size_t words)
{
    uint64_t added = 0;
    for (size_t i = 0; i < words; i++) {
        added |= from[i] & ~to[i];
        to[i] |= from[i];
    }
    return added;
}

/* What the node reads is needed where it runs. */
static bool need_inputs(struct spread *spread, size_t n)
{
    const struct plan_round_node *node = &spread->round->node[n];
    const uint64_t *set = spread_set(spread, n);
    bool changed = false;
    for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
        uint32_t version = spread->reads[i];
        if (version == SPREAD_NONE)
            continue;
        changed |= join(spread->need + version * spread->words, set, spread->words);
    }
    return changed;
}

bool spread_is_dead(const struct spread *spread, size_t n)
{
    const uint64_t *set = spread_set(spread, n);
    uint64_t any = 0;
    for (size_t i = 0; i < spread->words; i++)
        any |= set[i];
    return !any;
}

/* The node makes the version; the last one of a round is what the next round begins with. */
static bool run_where_needed(struct spread *spread, size_t n, uint32_t version)
{
    uint64_t *set = spread->set + n * spread->words;
    uint32_t object = spread->version[version].object;
    bool changed = join(set, spread_need(spread, version), spread->words);
    if (spread->last[object] == version)
        changed |= join(set, spread_need(spread, object), spread->words);
    return changed;
}

/* Nodes of several ranks, the last ones first, until nothing changes. */
static void settle(struct spread *spread)
{
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t k = spread->n_many; k-- > 0;) {
            size_t n = spread->many[k];
            const struct plan_round_node *node = &spread->round->node[n];
            for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++)
                if (spread->makes[i] != SPREAD_NONE)
                    changed |= run_where_needed(spread, n, spread->makes[i]);
            changed |= need_inputs(spread, n);
        }
    }
}

/* A body runs in any case; a set or sum that is overwritten before anybody reads it need not. */
static bool leaves_something(const struct spread *spread, size_t n)
{
    const struct plan_round_node *node = &spread->round->node[n];
    uint32_t made = node->n_uses ? spread->makes[node->first_use] : SPREAD_NONE;
    return node->kind == PLAN_TASK ||
           (made != SPREAD_NONE && spread->last[spread->version[made].object] == made);
}

static void spread_nodes(struct spread *spread)
{
    place_nodes(spread);
    for (size_t n = 0; n < spread->round->n_nodes; n++)
        need_inputs(spread, n);
    settle(spread);
    for (size_t k = 0; k < spread->n_many; k++) { /* what no task needs is kept somewhere */
        size_t n = spread->many[k];
        if (spread_is_dead(spread, n) && leaves_something(spread, n))
            spread_add(spread->set + n * spread->words, owner(spread, &spread->round->node[n]));
    }
    settle(spread);
}

/* ---- Phases ---- */

/* What happened to an object so far in the round: the highest phases of its accesses. */
struct past {
    int rank;           /* that has the present version, or SPREAD_MANY */
    uint32_t here, any; /* there; on all ranks */
};

/* Runs the node on a rank that does not have the version? */
static bool crosses(const struct spread *spread, size_t n, uint32_t version)
{
    uint32_t maker = spread_maker(spread, version);
    if (maker == SPREAD_NONE)
        return false;
    const uint64_t *set = spread_set(spread, n), *has = spread_set(spread, maker);
    uint64_t outside = 0;
    for (size_t i = 0; i < spread->words; i++)
        outside |= set[i] & ~has[i];
    return outside;
}

static uint32_t later(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* The task that contributes what a sum reads. */
static uint32_t leaf_of(const struct spread *spread, const struct plan_node_use *use)
{
    return spread->leaf[use->place - spread->round->n_objects];
}

static uint32_t phase_of_leaves(const struct spread *spread, size_t n,
                                const struct plan_round_node *node)
{
    const struct plan_round *round = spread->round;
    const uint64_t *set = spread_set(spread, n);
    uint32_t phase = 0;
    for (size_t i = node->first_use + 1; i < node->first_use + node->n_uses; i++) {
        uint32_t leaf = leaf_of(spread, &round->use[i]);
        uint64_t others = 0;
        for (size_t w = 0; w < spread->words; w++)
            others |= set[w] & ~spread_set(spread, leaf)[w];
        phase = later(phase, spread->phase[leaf] + (others != 0));
    }
    return phase;
}

static uint32_t phase_of(const struct spread *spread, size_t n, const struct past *pasts)
{
    const struct plan_round_node *node = &spread->round->node[n];
    uint32_t phase = node->kind == PLAN_SUM ? phase_of_leaves(spread, n, node) : 0;
    for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
        uint32_t version = spread->reads[i];
        if (version != SPREAD_NONE) {
            uint32_t maker = spread->version[version].maker;
            uint32_t made = maker ? spread->phase[maker - 1] : 0;
            phase = later(phase, made + crosses(spread, n, version));
        }
        if (spread->makes[i] != SPREAD_NONE) {
            const struct past *past = &pasts[spread->round->use[i].place];
            bool same = spread->at[n] != SPREAD_MANY && spread->at[n] == past->rank;
            phase = later(phase, same ? past->here : past->any);
        }
    }
    return phase;
}

static void note(const struct spread *spread, size_t n, struct past *pasts)
{
    const struct plan_round_node *node = &spread->round->node[n];
    uint32_t phase = spread->phase[n];
    int at = spread->at[n];
    for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
        if (spread->reads[i] == SPREAD_NONE && spread->makes[i] == SPREAD_NONE)
            continue;
        struct past *past = &pasts[spread->round->use[i].place];
        past->any = later(past->any, phase);
        if (spread->makes[i] != SPREAD_NONE)
            *past = (struct past){at, phase, past->any};
        else if (at == past->rank || at == SPREAD_MANY || past->rank == SPREAD_MANY)
            past->here = later(past->here, phase);
    }
}

static bool find_phases(struct spread *spread)
{
    struct past *pasts = base_alloc_zero((spread->round->n_objects + 1) * sizeof *pasts);
    if (!pasts)
        return false;
    for (uint32_t i = 0; i < spread->round->n_objects; i++) {
        uint32_t maker = spread_maker(spread, i);
        pasts[i].rank = maker == SPREAD_NONE ? SPREAD_MANY : spread->at[maker];
    }
    for (size_t n = 0; n < spread->round->n_nodes; n++) {
        spread->phase[n] = phase_of(spread, n, pasts);
        note(spread, n, pasts);
    }
    base_free(pasts);
    return true;
}

/* ---- Sums ---- */

static bool siblings(const struct spread_piece *l, const struct spread_piece *r)
{
    uint64_t half = UINT64_C(1) << l->tree.level;
    return l->rank == r->rank && l->tree.level == r->tree.level &&
           l->tree.first + half == r->tree.first && l->tree.first % (2 * half) == 0;
}

size_t spread_pieces(const struct spread *spread, size_t node, struct spread_piece *piece)
{
    const struct plan_round_node *sum = &spread->round->node[node];
    const struct plan_node_use *use = &spread->round->use[sum->first_use + 1];
    uint32_t leaves = (uint32_t)sum->n_uses - 1;
    size_t n = 0;
    bool one = true; /* rank has them all: it sends the whole */
    for (uint32_t i = 0; i < leaves; i++)
        spread->latest[spread->at[leaf_of(spread, &use[i])]] = 0;
    for (uint32_t i = 0; i < leaves; i++) { /* a rank's pieces move when its last leaf is there */
        int rank = spread->at[leaf_of(spread, &use[i])];
        spread->latest[rank] = later(spread->latest[rank], spread->phase[leaf_of(spread, &use[i])]);
        one &= rank == spread->at[leaf_of(spread, &use[0])];
    }
    for (uint32_t i = 0; i < leaves; i++) {
        int rank = spread->at[leaf_of(spread, &use[i])];
        piece[n++] = (struct spread_piece){.tree.first = i, .n = 1, .rank = rank};
        for (; n > 1 && (one || siblings(&piece[n - 2], &piece[n - 1])); n--) {
            piece[n - 2].tree.level++;
            piece[n - 2].n += piece[n - 1].n;
        }
    }
    for (size_t i = 0; i < n; i++)
        piece[i].phase = spread->latest[piece[i].rank];
    return n;
}

/* ---- All of it ---- */

bool spread_make(struct spread *spread, const duite_object *flag)
{
    const struct plan_record *record = spread->record;
    const struct data_object *objects = spread->graph->table.object;
    spread->rank = spread->graph->rank;
    spread->n_ranks = spread->graph->n_ranks;
    spread->words = ((size_t)spread->n_ranks + 63) / 64;
    if (!alloc(spread))
        return false;
    for (size_t i = 0; i < spread->round->n_objects; i++) {
        duite_object name = i < record->n_objects ? record->object[i].bound : *flag;
        spread->home[i] = objects[name.slot].home;
    }
    find_versions(spread);
    spread_nodes(spread);
    return find_phases(spread);
}
