/* Messages: the earliest phase of each node, counted in messages, and the values that move between
 * ranks. Versions made on one rank go to the ranks that need them, as do the pieces of sums that a
 * rank can combine alone. All values from one rank to another in one phase are one message. All
 * ranks go through the round in the same order, so both sides list the same items. Each item names
 * its version or its piece, so no pass pairs them by counting. */
#include "runtime/plan/passes.h"

#include "runtime/base/memory.h"

#include <stdlib.h>

struct finding {
    struct plan_messages *m;
    uint32_t *heads; /* by pair of ranks, see message_head: the last message, plus 1 */
    int *ring;       /* scratch, by rank */
    uint32_t leaves; /* the phase of the present sum's last leaf */
    bool failed;
};

static uint32_t phase_later(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* Returns whether `set` has ranks that `has` lacks. Mostly the two are equal. */
static inline bool message_is_outside(const struct plan_assignment *a, uint32_t set, uint32_t has)
{
    return set != has &&
           !base_ranks_within(plan_ranks(&a->sets, set), plan_ranks(&a->sets, has), a->words);
}

/* ---- Phases ---- */

/* The highest phases of an object's accesses so far in the round. */
struct phase_past {
    int rank;           /* has the present version; or PLAN_MANY */
    uint32_t here, any; /* on that rank; on any rank */
};

/* The number of successive messages that bring the version to the node; 0 if all ranks of the node
 * have it. */
static uint32_t phase_crosses(const struct plan_assignment *a, size_t n, uint32_t version)
{
    const uint32_t maker = plan_maker(a, version);
    if (maker == PLAN_NONE || !message_is_outside(a, a->set[n], a->set[maker]))
        return 0;
    const uint32_t rounds = plan_relay_version(a, version, NULL, NULL);
    return rounds ? rounds : 1;
}

static uint32_t phase_of_leaves(const struct plan_messages *m, size_t n,
                                const struct plan_round_node *node)
{
    const struct plan_assignment *a = m->assignment;
    uint32_t phase = 0;
    for (size_t i = node->first_use + 1; i < node->first_use + node->n_uses; i++) {
        uint32_t leaf = plan_message_leaf(m, &a->round->use[i]);
        bool crosses = !m->rounds[n] && message_is_outside(a, a->set[n], a->set[leaf]);
        phase = phase_later(phase, m->phase[leaf] + crosses);
    }
    return phase + m->rounds[n];
}

static uint32_t phase_of(const struct plan_messages *m, size_t n, const struct phase_past *pasts)
{
    const struct plan_assignment *a = m->assignment;
    const struct plan_round_node *node = &a->round->node[n];
    uint32_t phase = node->kind == PLAN_SUM ? phase_of_leaves(m, n, node) : 0;
    for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
        uint32_t version = a->reads[i];
        if (version != PLAN_NONE) {
            uint32_t maker = a->version[version].maker;
            uint32_t made = maker ? m->phase[maker - 1] : 0;
            phase = phase_later(phase, made + phase_crosses(a, n, version));
        }
        if (a->makes[i] != PLAN_NONE) {
            const struct phase_past *past = &pasts[a->round->use[i].place];
            bool same = a->at[n] != PLAN_MANY && a->at[n] == past->rank;
            phase = phase_later(phase, same ? past->here : past->any);
        }
    }
    return phase;
}

static void phase_note(const struct plan_messages *m, size_t n, struct phase_past *pasts)
{
    const struct plan_assignment *a = m->assignment;
    const struct plan_round_node *node = &a->round->node[n];
    uint32_t phase = m->phase[n];
    int at = a->at[n];
    for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
        if (a->reads[i] == PLAN_NONE && a->makes[i] == PLAN_NONE)
            continue;
        struct phase_past *past = &pasts[a->round->use[i].place];
        past->any = phase_later(past->any, phase);
        if (a->makes[i] != PLAN_NONE)
            *past = (struct phase_past){at, phase, past->any};
        else if (at == past->rank || at == PLAN_MANY || past->rank == PLAN_MANY)
            past->here = phase_later(past->here, phase);
    }
}

static bool message_find_phases(struct plan_messages *m)
{
    const struct plan_assignment *a = m->assignment;
    const struct plan_round *round = a->round;
    struct phase_past *pasts = base_alloc_zero((round->n_objects + 1) * sizeof *pasts);
    if (!pasts)
        return false;
    for (uint32_t i = 0; i < round->n_objects; i++) {
        uint32_t maker = plan_maker(a, i);
        pasts[i].rank = maker == PLAN_NONE ? PLAN_MANY : a->at[maker];
    }
    for (size_t n = 0; n < round->n_nodes; n++) {
        m->phase[n] = phase_of(m, n, pasts);
        phase_note(m, n, pasts);
    }
    base_free(pasts);
    return true;
}

/* ---- Messages ---- */

static uint32_t *message_head(const struct finding *f, int from, int to)
{
    const struct plan_messages *m = f->m;
    if (m->rank == PLAN_ALL)
        return &f->heads[(size_t)from * (size_t)m->assignment->n_ranks + (size_t)to];
    return from == m->rank ? &f->heads[2 * (size_t)to + 1] : &f->heads[2 * (size_t)from];
}

static uint32_t message_find(struct finding *f, int from, int to, uint32_t phase)
{
    struct plan_messages *m = f->m;
    uint32_t *head = message_head(f, from, to);
    for (uint32_t i = *head; i; i = m->message[i - 1].next)
        if (m->message[i - 1].phase == phase)
            return i - 1;
    if (!BASE_GROW(m->message, m->messages_capacity, m->n_messages + 1)) {
        f->failed = true;
        return PLAN_NONE;
    }
    m->message[m->n_messages] =
        (struct plan_message){.from = from, .to = to, .phase = phase, .next = *head};
    *head = (uint32_t)++m->n_messages;
    return *head - 1;
}

/* Appends an item to the message between two ranks in a phase, if m->rank takes part. */
static void message_add(struct finding *f, int from, int to, uint32_t phase, struct plan_item item)
{
    struct plan_messages *m = f->m;
    if (f->failed || (m->rank != PLAN_ALL && m->rank != from && m->rank != to))
        return;
    item.message = message_find(f, from, to, phase);
    f->failed |= !BASE_GROW(m->item, m->items_capacity, m->n_items + 1);
    if (f->failed)
        return;
    m->item[m->n_items++] = item;
    struct plan_message *message = &m->message[item.message];
    if (item.made > message->ready)
        message->ready = item.made;
    if (message->last)
        m->item[message->last - 1].next = m->n_items;
    else
        message->first = m->n_items;
    message->last = m->n_items;
}

/* Adds the item for each rank of a set except `from`. If m->rank is one rank and does not send,
 * only it can be the receiver. */
static void message_add_to_set(struct finding *f, int from, const uint64_t *set, uint32_t phase,
                               struct plan_item item)
{
    int rank = f->m->rank, first = 0, end = f->m->assignment->n_ranks;
    if (rank != PLAN_ALL && rank != from) {
        first = rank;
        end = rank + 1;
    }
    for (int to = first; to < end; to++)
        if (to != from && base_ranks_has(set, to))
            message_add(f, from, to, phase, item);
}

/* The version is relayed. */
static void message_version_relay(struct finding *f, const struct plan_item *item, uint32_t phase)
{
    size_t n = 0;
    const uint32_t rounds = plan_relay_version(f->m->assignment, item->version, f->ring, &n);
    for (uint32_t round = 0; round < rounds; round++)
        for (size_t far = (size_t)1 << round, i = 0; i < far && i + far < n; i++)
            message_add(f, f->ring[i], f->ring[i + far], phase + round, *item);
}

/* Versions made on several ranks are made wherever they are needed, so only versions of one rank
 * move. */
static void message_version(struct finding *f, uint32_t version)
{
    const struct plan_assignment *a = f->m->assignment;
    const struct plan_version *found = &a->version[version];
    uint32_t maker = plan_maker(a, version);
    if (maker == PLAN_NONE || a->at[maker] == PLAN_MANY ||
        !message_is_outside(a, a->need[version], a->set[maker]))
        return;
    struct plan_item item = {.object = found->object,
                             .version = version,
                             .piece = PLAN_NONE,
                             .made = found->maker ? plan_moment_over(maker) : 0};
    const uint32_t phase = found->maker ? f->m->phase[maker] : 0;
    if (plan_relay_version(a, version, NULL, NULL))
        message_version_relay(f, &item, phase);
    else
        message_add_to_set(f, a->at[maker], plan_needs_set(a, version), phase, item);
}

/* Items of a sum's relay. Each round is one phase, after that of the last leaf. */
static void message_hop(void *context, const struct plan_hop *hop)
{
    struct finding *f = context;
    const struct plan_round *round = f->m->assignment->round;
    const struct plan_round_node *node = &round->node[hop->node];
    for (size_t i = 0; i < hop->trees.n; i++)
        message_add(f, hop->from, hop->to, f->leaves + hop->round,
                    (struct plan_item){.object = round->use[node->first_use].place,
                                       .version = PLAN_NONE,
                                       .piece = PLAN_NONE,
                                       .tree = hop->trees.at[i],
                                       .made = plan_moment_sum(hop->node, hop->round)});
}

/* The pieces of each rank go to the ranks that run the sum. */
static void message_pieces(struct finding *f, size_t n)
{
    const struct plan_messages *m = f->m;
    const struct plan_assignment *a = m->assignment;
    const struct plan_round_node *node = &a->round->node[n];
    uint32_t object = a->round->use[node->first_use].place;
    if (m->rounds[n]) {
        f->leaves = phase_of_leaves(m, n, node) - m->rounds[n];
        f->failed |= !plan_relay_walk(m, n, message_hop, f);
        return;
    }
    for (size_t i = m->first_piece[n]; i < m->first_piece[n + 1]; i++) {
        struct plan_item item = {.object = object,
                                 .version = PLAN_NONE,
                                 .piece = (uint32_t)i,
                                 .made = plan_moment_sum(n, 0)};
        message_add_to_set(f, m->piece[i].rank, plan_runs_set(a, n), m->piece[i].phase, item);
    }
}

static void message_find_all(struct finding *f)
{
    const struct plan_assignment *a = f->m->assignment;
    for (uint32_t i = 0; i < a->round->n_objects; i++)
        message_version(f, i);
    for (size_t n = 0; n < a->round->n_nodes; n++) {
        const struct plan_round_node *node = &a->round->node[n];
        if (node->kind == PLAN_SUM)
            message_pieces(f, n);
        for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++)
            if (a->makes[i] != PLAN_NONE)
                message_version(f, a->makes[i]);
    }
}

/* ---- The pass ---- */

void plan_messages_free(struct plan_messages *m)
{
    base_free(m->memory);
    free(m->message);
    free(m->item);
}

static bool message_room(struct plan_messages *m)
{
    const struct plan_round *round = m->assignment->round;
    size_t leaves = round->n_places - round->n_objects + 1;
    const struct base_array arrays[] = {BASE_ARRAY(m->phase, round->n_nodes + 1),
                                        BASE_ZEROS(m->rounds, round->n_nodes + 1),
                                        BASE_ARRAY(m->leaf, leaves),
                                        BASE_ARRAY(m->piece, leaves),
                                        BASE_ZEROS(m->first_piece, round->n_nodes + 1),
                                        {0}};
    return (m->memory = base_arrays(arrays)) != NULL;
}

static void message_find_leaves(struct plan_messages *m)
{
    const struct plan_round *round = m->assignment->round;
    const bool adds = round->n_places > round->n_objects;
    for (size_t n = 0; n < round->n_nodes && adds; n++) {
        const struct plan_round_node *node = &round->node[n];
        for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++)
            if (round->use[i].place >= round->n_objects && round->use[i].writes)
                m->leaf[round->use[i].place - round->n_objects] = (uint32_t)n;
    }
}

bool plan_messages_find(struct plan_messages *m, const struct plan_assignment *a, int rank)
{
    struct finding f = {.m = m};
    const size_t ranks = (size_t)a->n_ranks, pairs = rank == PLAN_ALL ? ranks * ranks : 2 * ranks;
    *m = (struct plan_messages){.assignment = a, .rank = rank};
    f.heads = base_alloc_zero(pairs * sizeof *f.heads);
    f.ring = base_alloc(ranks * sizeof *f.ring);
    bool fine = f.heads && f.ring && message_room(m);
    if (fine) {
        message_find_leaves(m);
        fine = plan_relay_find(m) && message_find_phases(m) && plan_pieces_find(m);
    }
    if (fine)
        message_find_all(&f);
    base_free(f.heads);
    base_free(f.ring);
    return fine && !f.failed;
}
