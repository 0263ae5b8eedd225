/* Assignment: which ranks run each node and need each version. Nodes of one rank: tasks, by the
 * owner rule; sums of large objects, at the home; views, where their object was written. All other
 * nodes run wherever what they make is needed: tasks of replicated kernels, sets, sums of small
 * objects (which cost as many messages of contributions as one more message would) and views of
 * what such nodes make. Who needs what is gone through backwards until nothing changes; a version
 * that leaves the round is needed where the next one begins with it. */
#include "runtime/plan/passes.h"

#include "runtime/base/memory.h"
#include "runtime/task/owner.h"

#include <string.h>

enum { SMALL_SUM_BYTES = 1024 };

struct assigning {
    struct plan_assignment *a;
    uint32_t *many; /* n_many nodes that run on several ranks, in the order of placing */
    size_t n_many;
};

void plan_assignment_free(struct plan_assignment *a)
{
    base_free(a->home);
    base_free(a->at);
    base_free(a->set);
    base_free(a->reads);
    base_free(a->makes);
    base_free(a->version);
    base_free(a->need);
    base_free(a->last);
}

static bool assign_room(struct plan_assignment *a)
{
    const struct plan_round *round = a->round;
    size_t nodes = round->n_nodes + 1, uses = round->n_uses + 1, objects = round->n_objects + 1;
    size_t versions = uses + objects;
    a->home = base_alloc(objects * sizeof *a->home);
    a->at = base_alloc(nodes * sizeof *a->at);
    a->set = base_alloc_zero(nodes * a->words * sizeof *a->set);
    a->reads = base_alloc(uses * sizeof *a->reads);
    a->makes = base_alloc(uses * sizeof *a->makes);
    a->version = base_alloc(versions * sizeof *a->version);
    a->need = base_alloc_zero(versions * a->words * sizeof *a->need);
    a->last = base_alloc(objects * sizeof *a->last);
    return a->home && a->at && a->set && a->reads && a->makes && a->version && a->need && a->last;
}

/* ---- Versions ---- */

static void assign_versions(struct plan_assignment *a)
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
}

uint32_t plan_maker(const struct plan_assignment *a, uint32_t version)
{
    const struct plan_version *found = &a->version[version];
    if (!found->maker)
        found = &a->version[a->last[found->object]];
    return found->maker ? found->maker - 1 : PLAN_NONE;
}

bool plan_is_there(const struct plan_assignment *a, uint32_t version, int rank)
{
    uint32_t maker = plan_maker(a, version);
    return maker == PLAN_NONE || plan_runs(a, maker, rank);
}

/* ---- Who runs what ---- */

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
    uint32_t maker;
    switch (node->kind) {
    case PLAN_TASK:
        return assign_task(a, node);
    case PLAN_SUM:
        return a->round->source->object[use->place].bytes <= SMALL_SUM_BYTES ? PLAN_MANY
                                                                             : assign_home(a, node);
    case PLAN_VIEW:
        maker = plan_maker(a, a->reads[node->first_use]);
        return maker == PLAN_NONE ? a->home[use->place] : a->at[maker];
    default:
        return PLAN_MANY;
    }
}

/* Those that make what a round begins with may come later in the list: views are placed last. */
static void assign_nodes(struct assigning *s)
{
    struct plan_assignment *a = s->a;
    for (int views = 0; views < 2; views++)
        for (size_t n = 0; n < a->round->n_nodes; n++) {
            const struct plan_round_node *node = &a->round->node[n];
            if ((node->kind == PLAN_VIEW) != views)
                continue;
            int at = a->at[n] = assign_rank(a, node);
            if (at == PLAN_MANY)
                s->many[s->n_many++] = (uint32_t)n;
            else
                base_ranks_add(a->set + n * a->words, at);
            for (int rank = 0; node->kind == PLAN_FLAG && rank < a->n_ranks; rank++)
                base_ranks_add(a->set + n * a->words, rank);
        }
}

/* What the node reads is needed where it runs. */
static bool assign_inputs(struct plan_assignment *a, size_t n)
{
    const struct plan_round_node *node = &a->round->node[n];
    bool changed = false;
    for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++)
        if (a->reads[i] != PLAN_NONE)
            changed |=
                base_ranks_join(a->need + a->reads[i] * a->words, plan_runs_set(a, n), a->words);
    return changed;
}

bool plan_is_dead(const struct plan_assignment *a, size_t n)
{
    return base_ranks_is_empty(plan_runs_set(a, n), a->words);
}

/* The node makes the version; the last one of a round is what the next round begins with. */
static bool assign_where_needed(struct plan_assignment *a, size_t n, uint32_t version)
{
    uint64_t *set = a->set + n * a->words;
    uint32_t object = a->version[version].object;
    bool changed = base_ranks_join(set, plan_needs_set(a, version), a->words);
    if (a->last[object] == version)
        changed |= base_ranks_join(set, plan_needs_set(a, object), a->words);
    return changed;
}

/* Nodes of several ranks, the last ones first, until nothing changes. */
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

/* A body runs in any case; a set or sum that is overwritten before anybody reads it need not. */
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
    assign_nodes(s);
    for (size_t n = 0; n < a->round->n_nodes; n++)
        assign_inputs(a, n);
    assign_settle(s);
    for (size_t k = 0; k < s->n_many; k++) { /* what no task needs is kept somewhere */
        size_t n = s->many[k];
        if (plan_is_dead(a, n) && assign_keeps(a, n))
            base_ranks_add(a->set + n * a->words, assign_home(a, &a->round->node[n]));
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
    bool fine = s.many && assign_room(a);
    if (fine) {
        memcpy(a->home, home, round->n_objects * sizeof *home);
        assign_versions(a);
        assign_all(&s);
    }
    base_free(s.many);
    return fine;
}
