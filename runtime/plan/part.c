/* The part of one rank: its nodes in the order of the round. RECEIVEs come first. A SEND comes once
 * the last item of its message is made. A rank's writes go to its objects' own places. Each
 * received version or piece has a buffer that no other node writes; a node that modifies such a
 * version gets a copy first. Values overwritten before their message can go are copied aside. Edges
 * follow from these places as on one rank. */
#include "runtime/plan/passes.h"

#include "runtime/base/memory.h"

#include <stdlib.h>

#define NEVER UINT64_MAX

struct parting {
    const struct plan_messages *m;
    const struct plan_assignment *a;
    const struct plan_round *round; /* of all ranks */
    struct plan_round *part;
    uint32_t *replica;   /* by version: the buffer that receives it */
    uint32_t *arrival;   /* by piece: likewise */
    uint32_t *place;     /* by item: its place when its message goes, or comes */
    uint32_t *leaf;      /* by buffer of the round, less n_objects: its place here, plus 1; or 0 */
    plan_moment *spoilt; /* by version: when the rank overwrites it */
    size_t next_item;    /* the first that is not made yet */
    plan_moment next;    /* when it is made, or the next message goes */
    uint32_t *order;     /* messages to send, by the moment they are ready */
    size_t n_sends, next_send;
    struct data_subtrees row;                 /* of a node; where: the parameter */
    struct data_subtrees state, joined, came; /* this rank's of the present sum; where: the place */
    uint32_t *param; /* by place: its parameter in the PARTIAL that joins, or PLAN_NONE */
};

static bool part_sends(const struct parting *p, uint32_t message)
{
    return p->m->message[message].from == p->m->rank;
}

/* ---- Places ---- */

static uint32_t part_leaf(struct parting *p, uint32_t place)
{
    uint32_t *leaf = &p->leaf[place - p->round->n_objects];
    if (!*leaf)
        *leaf = 1 + plan_round_buffer(p->part, p->round->place[place].object,
                                      p->round->place[place].law);
    return *leaf - 1;
}

/* The place of a version that this rank reads. */
static uint32_t part_version(const struct parting *p, uint32_t version)
{
    return plan_is_there(p->a, version, p->m->rank) ? p->a->version[version].object
                                                    : p->replica[version];
}

/* The place of a piece of this rank: the buffer of its first leaf. */
static uint32_t part_piece(struct parting *p, const struct plan_piece *piece)
{
    const struct plan_round_node *sum = &p->round->node[piece->node];
    return part_leaf(p, p->round->use[sum->first_use + 1 + piece->tree.first].place);
}

static void part_find_spoilt(struct parting *p, uint32_t *own)
{
    for (uint32_t i = 0; i < p->round->n_objects; i++)
        own[i] = i;
    for (size_t i = 0; i < p->a->n_versions; i++)
        p->spoilt[i] = NEVER;
    for (size_t n = 0; n < p->round->n_nodes; n++) {
        const struct plan_round_node *node = &p->round->node[n];
        if (!plan_runs(p->a, n, p->m->rank))
            continue;
        for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
            if (p->a->makes[i] == PLAN_NONE)
                continue;
            p->spoilt[own[p->round->use[i].place]] = plan_moment_over(n);
            own[p->round->use[i].place] = p->a->makes[i];
        }
    }
}

static void part_copy(struct parting *p, size_t fork, uint32_t from, uint32_t to)
{
    struct plan_round_node *node = plan_round_add(p->part, PLAN_COPY, fork);
    node->owner = p->part->place[from].object;
    plan_round_use(p->part, node, from, true, false);
    plan_round_use(p->part, node, to, false, true);
}

/* ---- Messages ---- */

static int message_compare(const void *a, const void *b, void *context)
{
    const struct plan_message *message = context;
    uint32_t l = *(const uint32_t *)a, r = *(const uint32_t *)b;
    plan_moment left = message[l].ready, right = message[r].ready;
    return left != right ? (left > right) - (left < right) : (l > r) - (l < r);
}

/* Makes the part's channels, and buffers for the items received. */
static void part_channels(struct parting *p)
{
    const struct plan_messages *m = p->m;
    for (uint32_t i = 0; i < m->n_messages; i++) {
        bool sends = part_sends(p, i);
        p->part->channel[i] =
            (struct plan_round_channel){.peer = sends ? m->message[i].to : m->message[i].from,
                                        .phase = m->message[i].phase,
                                        .sends = sends};
        if (sends)
            p->order[p->n_sends++] = i;
    }
    p->part->n_channels = m->n_messages;
    qsort_r(p->order, p->n_sends, sizeof *p->order, message_compare, m->message);
    for (size_t i = 0; i < m->n_items; i++) {
        const struct plan_item *item = &m->item[i];
        if (part_sends(p, item->message))
            continue;
        uint32_t buffer = plan_round_buffer(p->part, item->object, NULL);
        p->place[i] = buffer;
        if (item->version != PLAN_NONE)
            p->replica[item->version] = buffer;
        else if (item->piece != PLAN_NONE)
            p->arrival[item->piece] = buffer;
    }
}

/* The node of a message. */
static void part_message(struct parting *p, uint32_t message, size_t fork)
{
    bool sends = part_sends(p, message);
    struct plan_round_node *node = plan_round_add(p->part, sends ? PLAN_SEND : PLAN_RECEIVE, fork);
    node->channel = message;
    for (size_t i = p->m->message[message].first; i; i = p->m->item[i - 1].next)
        plan_round_use(p->part, node, p->place[i - 1], sends, !sends);
}

/* The place of a subtree that a sum's relay passes on, valid until the next round joins it. */
static uint32_t part_passed(const struct parting *p, const struct data_subtree *tree)
{
    size_t i = 0;
    while (p->state.at[i].first != tree->first)
        i++;
    return p->state.at[i].where;
}

/* Finds the place of an item just made; copies it aside if it is overwritten too soon. */
static void part_made(struct parting *p, size_t i, size_t fork)
{
    const struct plan_item *item = &p->m->item[i];
    plan_moment spoilt;
    if (item->version != PLAN_NONE) {
        p->place[i] = part_version(p, item->version); /* a received one if this rank passes it on */
        spoilt = p->place[i] == item->object ? p->spoilt[item->version] : NEVER;
    } else if (item->piece == PLAN_NONE) {
        p->place[i] = part_passed(p, &item->tree);
        spoilt = item->made + 1;
    } else {
        const struct plan_piece *piece = &p->m->piece[item->piece];
        p->place[i] = part_piece(p, piece);
        spoilt = plan_runs(p->a, piece->node, p->m->rank) ? item->made + 1 : NEVER;
    }
    if (spoilt > p->m->message[item->message].ready)
        return;
    uint32_t aside = plan_round_buffer(p->part, item->object, NULL);
    part_copy(p, fork, p->place[i], aside);
    p->place[i] = aside;
}

static void part_look_ahead(struct parting *p)
{
    const struct plan_messages *m = p->m;
    p->next = NEVER;
    if (p->next_item < m->n_items)
        p->next = m->item[p->next_item].made;
    if (p->next_send < p->n_sends && m->message[p->order[p->next_send]].ready < p->next)
        p->next = m->message[p->order[p->next_send]].ready;
}

/* At this moment: finds the places of items just made, and sends the messages that are ready. */
static void part_moment(struct parting *p, plan_moment now, size_t fork)
{
    const struct plan_messages *m = p->m;
    if (now != p->next)
        return;
    for (; p->next_item < m->n_items && m->item[p->next_item].made == now; p->next_item++)
        if (part_sends(p, m->item[p->next_item].message))
            part_made(p, p->next_item, fork);
    while (p->next_send < p->n_sends && m->message[p->order[p->next_send]].ready == now)
        part_message(p, p->order[p->next_send++], fork);
    part_look_ahead(p);
}

/* ---- Nodes ---- */

/* Copies received versions that the node modifies into the objects' own places. */
static void part_bring_home(struct parting *p, size_t n)
{
    const struct plan_round_node *node = &p->round->node[n];
    for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
        if (p->a->makes[i] == PLAN_NONE || p->a->reads[i] == PLAN_NONE)
            continue;
        uint32_t from = part_version(p, p->a->reads[i]), to = p->round->use[i].place;
        if (from != to)
            part_copy(p, node->fork, from, to);
    }
}

static struct plan_round_node *part_add(struct parting *p, enum plan_kind kind, size_t n)
{
    const struct plan_round_node *node = &p->round->node[n];
    struct plan_round_node *made = plan_round_add(p->part, kind, node->fork);
    made->law = node->law;
    return made;
}

/* Combines this rank's contributions to a piece. */
static void part_combine_leaves(struct parting *p, struct plan_round_node *made,
                                const struct plan_piece *piece)
{
    const struct plan_round_node *node = &p->round->node[piece->node];
    const struct plan_node_use *leaf = &p->round->use[node->first_use + 1];
    const uint64_t end = data_subtree_end(&piece->tree, node->n_uses - 1);
    p->row.n = 0;
    for (uint64_t first = piece->tree.first; first < end; first++) {
        const uint32_t param = made->n_uses;
        plan_round_use(p->part, made, part_leaf(p, leaf[first].place), true, true);
        plan_reduce_push(p->part, &p->row, (struct data_subtree){.first = first, .where = param});
    }
    plan_reduce_fold(p->part, &p->row);
}

/* Combines the contributions of this rank to pieces of more than one leaf. */
static void part_partial(struct parting *p, size_t n)
{
    struct plan_round_node *made = NULL;
    for (size_t i = p->m->first_piece[n]; i < p->m->first_piece[n + 1]; i++) {
        const struct plan_piece *piece = &p->m->piece[i];
        if (piece->rank != p->m->rank || !piece->tree.level)
            continue;
        if (!made)
            made = part_add(p, PLAN_PARTIAL, n);
        part_combine_leaves(p, made, piece);
    }
}

/* A relayed sum begins with this rank's own pieces, any other sum with all pieces. */
static void part_begin_sum(struct parting *p, size_t n)
{
    p->state.n = 0;
    for (size_t i = p->m->first_piece[n]; i < p->m->first_piece[n + 1]; i++) {
        const struct plan_piece *piece = &p->m->piece[i];
        const bool own = piece->rank == p->m->rank;
        if (!own && (p->m->rounds[n] || !plan_runs(p->a, n, p->m->rank)))
            continue;
        struct data_subtree *entry = &p->state.at[p->state.n++];
        *entry = piece->tree;
        entry->where = own ? part_piece(p, piece) : p->arrival[i];
    }
}

/* A PARTIAL that joins the lists of a sum; made once two subtrees combine. */
struct part_joining {
    struct parting *p;
    size_t n; /* the sum */
    struct plan_round_node *made;
};

static uint32_t part_param(struct part_joining *j, uint32_t place)
{
    uint32_t *param = &j->p->param[place];
    if (*param == PLAN_NONE) {
        *param = j->made->n_uses;
        plan_round_use(j->p->part, j->made, place, true, true);
    }
    return *param;
}

static void part_combine_places(void *context, uint32_t left, uint32_t right)
{
    struct part_joining *j = context;
    if (!j->made)
        j->made = part_add(j->p, PLAN_PARTIAL, j->n);
    const uint32_t into = part_param(j, left);
    plan_reduce_merge(j->p->part, into, part_param(j, right));
}

/* Joins the subtrees received in this round, in items from `first` on, with those present. */
static void part_join(struct parting *p, size_t n, size_t first)
{
    struct part_joining joining = {.p = p, .n = n};
    const struct data_subtrees state = p->state;
    p->came.n = 0;
    for (size_t i = first; i < p->next_item; i++) {
        if (part_sends(p, p->m->item[i].message))
            continue;
        struct data_subtree *came = &p->came.at[p->came.n++];
        *came = p->m->item[i].tree;
        came->where = p->place[i];
    }
    data_subtrees_join(&p->joined, &state, &p->came, part_combine_places, &joining);
    p->state = p->joined;
    p->joined = state;
    for (size_t i = 0; joining.made && i < joining.made->n_uses; i++)
        p->param[p->part->use[joining.made->first_use + i].place] = PLAN_NONE;
}

/* Adds all leaves of the sum to the object. */
static void part_sum(struct parting *p, size_t n)
{
    const struct plan_round_node *node = &p->round->node[n];
    struct plan_round_node *made = part_add(p, PLAN_SUM, n);
    made->owner = node->owner;
    plan_round_use(p->part, made, p->round->use[node->first_use].place, true, true);
    p->row.n = 0;
    for (size_t i = 0; i < p->state.n; i++) {
        struct data_subtree subtree = p->state.at[i];
        subtree.where = made->n_uses;
        plan_round_use(p->part, made, p->state.at[i].where, true, true);
        plan_reduce_push(p->part, &p->row, subtree);
    }
    plan_reduce_fold(p->part, &p->row);
}

/* A task, a set or the flag. */
static void part_plain(struct parting *p, size_t n)
{
    const struct plan_round_node *node = &p->round->node[n];
    struct plan_round_node *made = plan_round_add(p->part, node->kind, node->fork);
    made->owner = node->owner;
    for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
        const struct plan_node_use *use = &p->round->use[i];
        uint32_t place = use->place;
        if (place >= p->round->n_objects)
            place = part_leaf(p, place);
        else if (!use->writes)
            place = part_version(p, p->a->reads[i]);
        plan_round_use(p->part, made, place, use->reads, use->writes);
    }
}

/* Everything before the sum: this rank's pieces, and the rounds of the relay. */
static void part_before_sum(struct parting *p, size_t n)
{
    const uint32_t rounds = p->m->rounds[n];
    const size_t fork = p->round->node[n].fork;
    part_partial(p, n);
    part_begin_sum(p, n);
    for (uint32_t round = 0; round <= rounds; round++) {
        const size_t first = p->next_item;
        part_moment(p, plan_moment_sum(n, round), fork);
        if (round < rounds)
            part_join(p, n, first);
    }
}

static void part_nodes(struct parting *p)
{
    for (uint32_t i = 0; i < p->m->n_messages; i++)
        if (!part_sends(p, i))
            part_message(p, i, 0);
    part_look_ahead(p);
    part_moment(p, 0, 0);
    for (size_t n = 0; n < p->round->n_nodes; n++) {
        const struct plan_round_node *node = &p->round->node[n];
        if (node->kind == PLAN_SUM)
            part_before_sum(p, n);
        if (plan_runs(p->a, n, p->m->rank)) {
            part_bring_home(p, n);
            if (node->kind == PLAN_SUM)
                part_sum(p, n);
            else
                part_plain(p, n);
        }
        part_moment(p, plan_moment_over(n), node->fork);
    }
}

/* ---- The pass ---- */

static size_t part_places(const struct parting *p)
{
    return p->round->n_places + 2 * p->m->n_items;
}

/* Memory: for each node that this rank runs, and copies of what it modifies; for each sum's
 * contributions and pieces; for a copy and a join of each item. */
static bool part_round_room(struct parting *p)
{
    const struct plan_messages *m = p->m;
    size_t nodes = 0, plain = 0, copies = 0, sums = 0;
    for (size_t n = 0; n < p->round->n_nodes; n++) {
        const struct plan_round_node *node = &p->round->node[n];
        const bool sum = node->kind == PLAN_SUM;
        if (!sum && !plan_runs(p->a, n, m->rank))
            continue;
        nodes += sum ? 2 : 1;
        *(sum ? &sums : &plain) += node->n_uses;
        for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++)
            copies += p->round->use[i].reads && p->round->use[i].writes;
    }
    return plan_round_room(p->part, nodes + copies + 2 * m->n_items + m->n_messages,
                           plain + 2 * copies + 8 * sums + 6 * m->n_items, part_places(p),
                           2 * sums + m->n_items + 1);
}

static bool part_room(struct parting *p)
{
    const struct plan_messages *m = p->m;
    size_t items = m->n_items;
    size_t leaves = p->round->n_places - p->round->n_objects + 1;
    p->replica = base_alloc(p->a->n_versions * sizeof *p->replica + 1);
    p->arrival = base_alloc(m->n_pieces * sizeof *p->arrival + 1);
    p->place = base_alloc(items * sizeof *p->place + 1);
    p->leaf = base_alloc_zero(leaves * sizeof *p->leaf);
    p->spoilt = base_alloc(p->a->n_versions * sizeof *p->spoilt + 1);
    p->order = base_alloc((m->n_messages + 1) * sizeof *p->order);
    p->row.at = base_alloc(leaves * sizeof *p->row.at);
    p->state.at = base_alloc((leaves + items) * sizeof *p->state.at);
    p->joined.at = base_alloc((leaves + items) * sizeof *p->joined.at);
    p->came.at = base_alloc((items + 1) * sizeof *p->came.at);
    p->param = base_alloc(part_places(p) * sizeof *p->param + 1);
    p->part->channel = base_alloc((m->n_messages + 1) * sizeof *p->part->channel);
    for (size_t i = 0; i < part_places(p) && p->param; i++)
        p->param[i] = PLAN_NONE;
    return p->replica && p->arrival && p->place && p->leaf && p->spoilt && p->order && p->row.at &&
           p->state.at && p->joined.at && p->came.at && p->param && p->part->channel &&
           part_round_room(p);
}

bool plan_part(struct plan_round *part, const struct plan_messages *messages)
{
    const struct plan_assignment *a = messages->assignment;
    struct parting p = {.m = messages, .a = a, .round = a->round, .part = part};
    part->source = a->round->source;
    uint32_t *own = base_alloc((a->round->n_objects + 1) * sizeof *own);
    bool fine = own && part_room(&p);
    if (fine) {
        part_find_spoilt(&p, own);
        part_channels(&p);
        part_nodes(&p);
    }
    base_free(own);
    base_free(p.replica);
    base_free(p.arrival);
    base_free(p.place);
    base_free(p.leaf);
    base_free(p.spoilt);
    base_free(p.order);
    base_free(p.row.at);
    base_free(p.state.at);
    base_free(p.joined.at);
    base_free(p.came.at);
    base_free(p.param);
    return fine;
}
