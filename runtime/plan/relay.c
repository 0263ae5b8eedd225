/* Relayed sums. The ranks that contribute to a sum or add it up form a ring in rank order. In round
 * s each sends its list to the rank 2^s places before it, and takes the list of the rank 2^s places
 * behind it. So all n ranks have everything after log2(n) rounds, rounded up. Lists, and how two
 * become one, are those of data/subtrees.h: so the result has the bits of the tree for any ranks
 * and any relay. Every rank follows all lists, so all know the items of each message. */
#include "runtime/plan/passes.h"

#include "runtime/base/memory.h"

enum { DIRECT_RANKS = 4 }; /* up to so many ranks: sent directly, in one hop */

struct relay {
    const struct plan_messages *m;
    size_t n;    /* the sum */
    int *member; /* the ring */
    size_t n_members;
    struct data_subtrees *list, *next; /* by member: now; after this round; `at` is owned */
};

/* ---- Rings ---- */

/* The ranks that contribute to the sum or add it up. */
static void relay_ring(const struct plan_messages *m, size_t n, uint64_t *set)
{
    const struct plan_assignment *a = m->assignment;
    const struct plan_round_node *node = &a->round->node[n];
    base_ranks_clear(set, a->words);
    base_ranks_join(set, plan_runs_set(a, n), a->words);
    for (size_t i = node->first_use + 1; i < node->first_use + node->n_uses; i++)
        base_ranks_add(set, a->at[plan_message_leaf(m, &a->round->use[i])]);
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
static bool relay_begin_list(const struct relay *r, int rank, struct data_subtrees *list)
{
    const size_t first = r->m->first_piece[r->n], end = r->m->first_piece[r->n + 1];
    list->at = base_alloc((end - first + 1) * sizeof *list->at);
    for (size_t i = first; i < end && list->at; i++)
        if (r->m->piece[i].rank == rank)
            list->at[list->n++] = r->m->piece[i].tree;
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
    const struct data_subtrees *has = &r->list[to], *sent = &r->list[from];
    struct data_subtrees *next = &r->next[to], *came = &hop->trees;
    *came = (struct data_subtrees){.at = base_alloc((sent->n + 1) * sizeof *came->at)};
    next->at = base_alloc((has->n + sent->n + 1) * sizeof *next->at);
    const bool fine = came->at && next->at;
    if (fine) {
        const bool last = hop->round + 1 == r->m->rounds[r->n];
        hop->from = r->member[from];
        hop->to = r->member[to];
        if (!last || plan_runs(r->m->assignment, r->n, hop->to))
            data_subtrees_missing(came, has, sent);
        if (came->n)
            visit(context, hop);
        data_subtrees_join(next, has, came, NULL, NULL);
    }
    base_free(came->at);
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
        r->next[i] = (struct data_subtrees){0};
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
