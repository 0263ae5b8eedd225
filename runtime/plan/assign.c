/* Assignment: which ranks run each node and need each version. Tasks run on one rank, by the owner
 * rule; sums of large objects at the home. All other nodes run wherever their result is needed:
 * tasks of replicated kernels, sets, sums of small objects (whose contributions cost no more
 * messages than the sum would). Needs are found by a backward fixpoint; a version that leaves the
 * round is needed where the next round begins with it. */
#include "runtime/plan/passes.h"

#include "runtime/base/memory.h"
#include "runtime/task/owner.h"

#include <stdlib.h>
#include <string.h>

enum { SMALL_SUM_BYTES = 1024 };

struct assigning {
    struct plan_assignment *a;
    uint32_t *many; /* n_many nodes that run on several ranks, in the order of placing */
    size_t n_many;
};

void plan_assignment_free(struct plan_assignment *a)
{
    base_free(a->memory);
    base_free(a->need);
    free(a->sets.word);
}

/* ---- Sets of ranks ---- */

/* A new set, empty. Without memory sets sets->failed and returns 0, the empty set, which the caller
 * must not change. */
static uint32_t sets_add(struct plan_rank_sets *sets)
{
    if (!BASE_GROW(sets->word, sets->words_capacity, (sets->n + 1) * sets->words)) {
        sets->failed = true;
        return 0;
    }
    base_ranks_clear(sets->word + sets->n * sets->words, sets->words);
    return (uint32_t)sets->n++;
}

/* The words of a set that may grow. */
static uint64_t *sets_words(const struct plan_rank_sets *sets, uint32_t set)
{
    return sets->word + set * sets->words;
}

static bool sets_begin(struct plan_rank_sets *sets, int n_ranks)
{
    *sets = (struct plan_rank_sets){.n_ranks = n_ranks, .words = base_ranks_words(n_ranks)};
    sets_add(sets);
    for (int rank = 0; rank < n_ranks && !sets->failed; rank++) {
        const uint32_t alone = sets_add(sets);
        if (alone)
            base_ranks_add(sets_words(sets, alone), rank);
    }
    return !sets->failed;
}

/* The set of one rank. */
static uint32_t sets_alone(int rank)
{
    return (uint32_t)rank + 1;
}

/* Part of sets_join: compares and joins rows. A set that is shared is copied before it grows. */
static bool sets_join_more(struct plan_rank_sets *sets, uint32_t *to, uint32_t from)
{
    if (base_ranks_within(plan_ranks(sets, from), plan_ranks(sets, *to), sets->words))
        return false;
    if (*to <= (uint32_t)sets->n_ranks) {
        const uint32_t copy = sets_add(sets);
        if (sets->failed)
            return false;
        memcpy(sets_words(sets, copy), plan_ranks(sets, *to), sets->words * sizeof *sets->word);
        *to = copy;
    }
    return base_ranks_join(sets_words(sets, *to), plan_ranks(sets, from), sets->words);
}

/* Adds the ranks of `from`. Returns whether *to grew. */
static inline bool sets_join(struct plan_rank_sets *sets, uint32_t *to, uint32_t from)
{
    if (!from || *to == from)
        return false;
    if (*to || from > (uint32_t)sets->n_ranks)
        return sets_join_more(sets, to, from);
    *to = from;
    return true;
}

static uint32_t sets_all(struct plan_rank_sets *sets)
{
    const uint32_t all = sets_add(sets);
    for (int rank = 0; rank < sets->n_ranks && all; rank++)
        base_ranks_add(sets_words(sets, all), rank);
    return all;
}

static bool assign_room(struct plan_assignment *a)
{
    const struct plan_round *round = a->round;
    size_t nodes = round->n_nodes + 1, uses = round->n_uses + 1, objects = round->n_objects + 1;
    const struct base_array arrays[] = {
        BASE_ARRAY(a->home, objects), BASE_ARRAY(a->at, nodes),
        BASE_ZEROS(a->set, nodes),    BASE_ARRAY(a->reads, uses),
        BASE_ARRAY(a->makes, uses),   BASE_ARRAY(a->version, uses + objects),
        BASE_ARRAY(a->last, objects), {0}};
    a->memory = base_arrays(arrays);
    return a->memory && sets_begin(&a->sets, a->n_ranks);
}

/* ---- Versions ---- */

static bool assign_versions(struct plan_assignment *a)
{
    const struct plan_round *round = a->round;
    for (uint32_t i = 0; i < round->n_objects; i++) {
        a->version[i] = (struct plan_version){.object = i};
        a->last[i] = i;
    }
    a->n_versions = round->n_objects;
    for (size_t n = 0; n < round->n_nodes; n++) {
        const struct plan_round_node *node = &round->node[n];
        for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
            const struct plan_node_use *use = &round->use[i];
            a->reads[i] = a->makes[i] = PLAN_NONE;
            if (use->place >= round->n_objects)
                continue;
            if (use->reads)
                a->reads[i] = a->last[use->place];
            if (!use->writes)
                continue;
            uint32_t made = a->makes[i] = (uint32_t)a->n_versions++;
            a->version[made] = (struct plan_version){use->place, (uint32_t)n + 1};
            a->last[use->place] = made;
        }
    }
    a->need = base_alloc_zero((a->n_versions + 1) * sizeof *a->need);
    return a->need;
}

/* ---- The ranks of each node ---- */

static int assign_home(const struct plan_assignment *a, const struct plan_round_node *node)
{
    return node->owner == PLAN_NONE ? 0 : a->home[node->owner];
}

static int assign_task(const struct plan_assignment *a, const struct plan_round_node *node)
{
    const struct plan_source_fork *fork = &a->round->source->fork[node->fork];
    int at = fork->rank == PLAN_BY_OWNER ? TASK_ANYWHERE : fork->rank;
    int rank = task_owner_rank(at, fork->replicated, assign_home(a, node));
    return rank == TASK_EVERYWHERE ? PLAN_MANY : rank;
}

static int assign_rank(const struct plan_assignment *a, const struct plan_round_node *node)
{
    const struct plan_node_use *use = &a->round->use[node->first_use];
    switch (node->kind) {
    case PLAN_TASK:
        return assign_task(a, node);
    case PLAN_SUM:
        return a->round->source->bytes[use->place] <= SMALL_SUM_BYTES ? PLAN_MANY
                                                                      : assign_home(a, node);
    default:
        return PLAN_MANY;
    }
}

static void assign_node(struct assigning *s, size_t n)
{
    struct plan_assignment *a = s->a;
    const struct plan_round_node *node = &a->round->node[n];
    const int at = a->at[n] = assign_rank(a, node);
    if (at == PLAN_MANY)
        s->many[s->n_many++] = (uint32_t)n;
    else
        a->set[n] = sets_alone(at);
    if (node->kind == PLAN_FLAG)
        a->set[n] = sets_all(&a->sets);
}

/* The ranks of a node need its inputs. */
static bool assign_inputs(struct plan_assignment *a, size_t n)
{
    const struct plan_round_node *node = &a->round->node[n];
    bool changed = false;
    for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++)
        if (a->reads[i] != PLAN_NONE)
            changed |= sets_join(&a->sets, &a->need[a->reads[i]], a->set[n]);
    return changed;
}

/* The node that makes a version runs where it is needed; the next round begins with the last
 * version. */
static bool assign_where_needed(struct plan_assignment *a, size_t n, uint32_t version)
{
    uint32_t object = a->version[version].object;
    bool changed = sets_join(&a->sets, &a->set[n], a->need[version]);
    if (a->last[object] == version)
        changed |= sets_join(&a->sets, &a->set[n], a->need[object]);
    return changed;
}

/* Goes through nodes of several ranks, last first, until nothing changes. */
static void assign_settle(struct assigning *s)
{
    struct plan_assignment *a = s->a;
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t k = s->n_many; k-- > 0;) {
            size_t n = s->many[k];
            const struct plan_round_node *node = &a->round->node[n];
            for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++)
                if (a->makes[i] != PLAN_NONE)
                    changed |= assign_where_needed(a, n, a->makes[i]);
            changed |= assign_inputs(a, n);
        }
    }
}

/* A body always runs; a set or sum that is overwritten unread need not. */
static bool assign_keeps(const struct plan_assignment *a, size_t n)
{
    const struct plan_round_node *node = &a->round->node[n];
    uint32_t made = node->n_uses ? a->makes[node->first_use] : PLAN_NONE;
    return node->kind == PLAN_TASK ||
           (made != PLAN_NONE && a->last[a->version[made].object] == made);
}

static void assign_all(struct assigning *s)
{
    struct plan_assignment *a = s->a;
    for (size_t n = 0; n < a->round->n_nodes; n++)
        assign_node(s, n);
    for (size_t n = 0; n < a->round->n_nodes; n++)
        assign_inputs(a, n);
    assign_settle(s);
    for (size_t k = 0; k < s->n_many; k++) { /* results that no task needs are kept at home */
        size_t n = s->many[k];
        if (plan_is_dead(a, n) && assign_keeps(a, n))
            a->set[n] = sets_alone(assign_home(a, &a->round->node[n]));
    }
    assign_settle(s);
}

bool plan_assign(struct plan_assignment *a, const struct plan_round *round, const int *home,
                 int n_ranks)
{
    struct assigning s = {.a = a};
    *a = (struct plan_assignment){
        .round = round, .n_ranks = n_ranks, .words = base_ranks_words(n_ranks)};
    s.many = base_alloc((round->n_nodes + 1) * sizeof *s.many);
    const bool fine = s.many && assign_room(a) && assign_versions(a);
    if (fine) {
        memcpy(a->home, home, round->n_objects * sizeof *home);
        assign_all(&s);
    }
    base_free(s.many);
    return fine && !a->sets.failed;
}
