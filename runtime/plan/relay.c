/* Relayed sums. The ranks that contribute to a sum or add it up form a ring in rank order. In round
 * s each sends its list to the rank 2^s places before it, and takes the list of the rank 2^s places
 * behind it. So all n ranks have everything after log2(n) rounds, rounded up. A list has complete
 * subtrees in the order of their leaves. Halves combine once both are there; a subtree inside a
 * larger one is dropped. So the result has the bits of the tree (data/reduce.h) for any ranks and
 * any relay. Every rank follows all lists, so all know the items of each message. */
#include "runtime/plan/passes.h"

#include "runtime/base/memory.h"

enum { DIRECT_RANKS = 4 }; /* up to so many ranks: sent directly, in one hop */

struct relay_list {
    struct plan_leaves *at; /* owned */
    size_t n;
};

struct relay {
    const struct plan_messages *m;
    size_t n;    /* the sum */
    int *member; /* the ring */
    size_t n_members;
    struct relay_list *list, *next; /* by member: now; after this round */
};

/* ---- Lists ---- */

static uint64_t leaves_end(const struct plan_leaves *leaves)
{
    return leaves->tree.first + leaves->n;
}

static bool leaves_within(const struct plan_leaves *some, const struct plan_leaves *all)
{
    return some->tree.first >= all->tree.first && leaves_end(some) <= leaves_end(all);
}

size_t plan_leaves_missing(const struct plan_leaves *has, size_t n_has,
                           const struct plan_leaves *from, size_t n_from, struct plan_leaves *out)
{
    size_t n = 0, k = 0;
    for (size_t i = 0; i < n_from; i++) {
        while (k < n_has && leaves_end(&has[k]) <= from[i].tree.first)
            k++;
        if (k == n_has || !leaves_within(&from[i], &has[k]))
            out[n++] = from[i];
    }
    return n;
}

/* Returns whether `a` is before `b` in the order of leaves; of equal beginnings the larger is
 * first. */
static bool leaves_before(const struct plan_leaves *a, const struct plan_leaves *b)
{
    return a->tree.first != b->tree.first ? a->tree.first < b->tree.first : a->n >= b->n;
}

size_t plan_leaves_join(const struct plan_leaves *a, size_t n_a, const struct plan_leaves *b,
                        size_t n_b, struct plan_leaves *out)
{
    size_t n = 0, i = 0, k = 0;
    while (i < n_a || k < n_b) {
        const bool first = k == n_b || (i < n_a && leaves_before(&a[i], &b[k]));
        const struct plan_leaves *next = first ? &a[i++] : &b[k++];
        if (!n || !leaves_within(next, &out[n - 1]))
            out[n++] = *next;
    }
    return n;
}

bool plan_leaves_are_halves(const struct plan_leaves *left, const struct plan_leaves *right)
{
    return data_subtree_are_halves(&left->tree, &right->tree);
}

static size_t leaves_combine(struct plan_leaves *list, size_t n)
{
    size_t left = 0;
    for (size_t i = 0; i < n; i++) {
        list[left++] = list[i];
        for (; left > 1 && plan_leaves_are_halves(&list[left - 2], &list[left - 1]); left--) {
            list[left - 2].tree.level++;
            list[left - 2].n += list[left - 1].n;
        }
    }
    return left;
}

/* ---- Rings ---- */

/* The ranks that contribute to the sum or add it up. */
static void relay_ring(const struct plan_messages *m, size_t n, uint64_t *set)
{
    const struct plan_assignment *a = m->assignment;
    const struct plan_round_node *node = &a->round->node[n];
    base_ranks_clear(set, a->words);
    base_ranks_join(set, plan_runs_set(a, n), a->words);
    for (size_t i = node->first_use + 1; i < node->first_use + node->n_uses; i++)
        base_ranks_add(set, a->at[m->leaf[a->round->use[i].place - a->round->n_objects]]);
}

static uint8_t relay_rounds(size_t ranks)
{
    uint8_t rounds = 0;
    while ((size_t)1 << rounds < ranks)
        rounds++;
    return rounds;
}

uint32_t plan_relay_ring(const uint64_t *set, int n_ranks, int from, int *ring, size_t *n)
{
    const size_t ranks =
        base_ranks_count(set, base_ranks_words(n_ranks)) + !base_ranks_has(set, from);
    /* Values for few ranks ride in messages that are sent anyway. */
    if (ranks <= DIRECT_RANKS || 2 * ranks <= (size_t)n_ranks)
        return 0;
    if (!ring)
        return relay_rounds(ranks);
    *n = 0;
    for (int i = 0, rank = from; i < n_ranks; i++) {
        if (!i || base_ranks_has(set, rank))
            ring[(*n)++] = rank;
        rank = rank ? rank - 1 : n_ranks - 1;
    }
    return relay_rounds(ranks);
}

uint32_t plan_relay_version(const struct plan_assignment *a, uint32_t version, int *ring, size_t *n)
{
    const uint32_t maker = plan_maker(a, version);
    if (maker == PLAN_NONE || a->at[maker] == PLAN_MANY)
        return 0;
    return plan_relay_ring(plan_needs_set(a, version), a->n_ranks, a->at[maker], ring, n);
}

bool plan_relay_find(struct plan_messages *m)
{
    const struct plan_assignment *a = m->assignment;
    uint64_t *set = base_alloc(a->words * sizeof *set + 1);
    for (size_t n = 0; n < a->round->n_nodes && set && a->n_ranks > DIRECT_RANKS; n++) {
        if (a->round->node[n].kind != PLAN_SUM ||
            base_ranks_count(plan_runs_set(a, n), a->words) <= DIRECT_RANKS)
            continue;
        relay_ring(m, n, set);
        m->rounds[n] = relay_rounds(base_ranks_count(set, a->words));
    }
    base_free(set);
    return set;
}

/* ---- Rounds ---- */

static void relay_free(struct relay *r)
{
    for (size_t i = 0; i < r->n_members && r->list && r->next; i++) {
        base_free(r->list[i].at);
        base_free(r->next[i].at);
    }
    base_free(r->member);
    base_free(r->list);
    base_free(r->next);
}

/* A rank begins with the pieces that it can make alone. */
static bool relay_begin_list(const struct relay *r, int rank, struct relay_list *list)
{
    const size_t first = r->m->first_piece[r->n], end = r->m->first_piece[r->n + 1];
    list->at = base_alloc((end - first + 1) * sizeof *list->at);
    for (size_t i = first; i < end && list->at; i++)
        if (r->m->piece[i].rank == rank)
            list->at[list->n++] = r->m->piece[i].leaves;
    return list->at;
}

static bool relay_begin(struct relay *r)
{
    const struct plan_assignment *a = r->m->assignment;
    const size_t ranks = (size_t)a->n_ranks;
    uint64_t *set = base_alloc(a->words * sizeof *set + 1);
    r->member = base_alloc(ranks * sizeof *r->member);
    r->list = base_alloc_zero(ranks * sizeof *r->list);
    r->next = base_alloc_zero(ranks * sizeof *r->next);
    bool fine = set && r->member && r->list && r->next;
    if (fine)
        relay_ring(r->m, r->n, set);
    for (int rank = 0; rank < a->n_ranks && fine; rank++) {
        if (!base_ranks_has(set, rank))
            continue;
        r->member[r->n_members] = rank;
        fine = relay_begin_list(r, rank, &r->list[r->n_members++]);
    }
    base_free(set);
    return fine;
}

/* One member takes the list of another. In the last round, ranks that do not need the sum receive
 * nothing. */
static bool relay_hop(struct relay *r, struct plan_hop *hop, size_t from, size_t to,
                      plan_relay_visit *visit, void *context)
{
    const struct relay_list *has = &r->list[to], *sent = &r->list[from];
    struct relay_list *next = &r->next[to];
    struct plan_leaves *came = base_alloc((sent->n + 1) * sizeof *came);
    next->at = base_alloc((has->n + sent->n + 1) * sizeof *next->at);
    const bool fine = came && next->at;
    if (fine) {
        const bool last = hop->round + 1 == r->m->rounds[r->n];
        hop->from = r->member[from];
        hop->to = r->member[to];
        hop->n = last && !plan_runs(r->m->assignment, r->n, hop->to)
                     ? 0
                     : plan_leaves_missing(has->at, has->n, sent->at, sent->n, came);
        hop->leaves = came;
        if (hop->n)
            visit(context, hop);
        next->n = plan_leaves_join(has->at, has->n, came, hop->n, next->at);
        next->n = leaves_combine(next->at, next->n);
    }
    base_free(came);
    return fine;
}

static bool relay_round(struct relay *r, uint32_t round, plan_relay_visit *visit, void *context)
{
    const size_t n = r->n_members, far = (size_t)1 << round;
    struct plan_hop hop = {.node = (uint32_t)r->n, .round = round};
    bool fine = true;
    for (size_t to = 0; to < n && fine; to++)
        fine = relay_hop(r, &hop, (to + far) % n, to, visit, context);
    for (size_t i = 0; i < n; i++) {
        base_free(r->list[i].at);
        r->list[i] = r->next[i];
        r->next[i] = (struct relay_list){0};
    }
    return fine;
}

bool plan_relay_walk(const struct plan_messages *m, size_t n, plan_relay_visit *visit,
                     void *context)
{
    struct relay r = {.m = m, .n = n};
    bool fine = relay_begin(&r);
    for (uint32_t round = 0; round < m->rounds[n] && fine; round++)
        fine = relay_round(&r, round, visit, context);
    relay_free(&r);
    return fine;
}
