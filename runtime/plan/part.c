/* The part of one rank: its nodes in the order of the round. Nodes that receive come first. A node
 * that sends comes as soon as the last thing that its message carries is made. What a rank writes
 * lies in its objects' own places. What it receives lies in a buffer for each version and piece,
 * which no other node writes; a node that would write on from there gets a copy first. What is
 * overwritten before its message can go is copied aside. Edges follow from these places as on one
 * rank. */
#include "runtime/plan/passes.h"

#include "runtime/base/memory.h"

#include <stdlib.h>

#define NEVER UINT64_MAX

struct parting {
    const struct plan_messages *m;
    const struct plan_assignment *a;
    const struct plan_round *round; /* of all ranks */
    struct plan_round *part;
    uint32_t *replica;   /* by version: the buffer that it is received in */
    uint32_t *arrival;   /* by piece: likewise */
    uint32_t *place;     /* by item that is sent: where it lies when its message goes */
    uint32_t *leaf;      /* by buffer of the round, less n_objects: its place here, plus 1; or 0 */
    plan_moment *spoilt; /* by version: when the rank overwrites it */
    size_t next_item;    /* the first that is not made */
    uint32_t *order;     /* the messages that go, by the moment they are ready */
    size_t n_sends, next_send;
    struct data_subtree *row; /* scratch: of one sum */
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

/* Where this rank has a version that it reads. */
static uint32_t part_version(const struct parting *p, uint32_t version)
{
    return plan_is_there(p->a, version, p->m->rank) ? p->a->version[version].object
                                                    : p->replica[version];
}

/* The round's buffer that a piece of this rank begins with, where all of it comes to lie. */
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
            p->spoilt[own[p->round->use[i].place]] = 2 * n + 2;
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

/* The messages as channels of the part, and memory for what is received. */
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
        if (item->version != PLAN_NONE)
            p->replica[item->version] = buffer;
        else
            p->arrival[item->piece] = buffer;
    }
}

static uint32_t part_item(const struct parting *p, size_t i)
{
    const struct plan_item *item = &p->m->item[i];
    if (part_sends(p, item->message))
        return p->place[i];
    return item->version != PLAN_NONE ? p->replica[item->version] : p->arrival[item->piece];
}

/* The node of a message. */
static void part_message(struct parting *p, uint32_t message, size_t fork)
{
    bool sends = part_sends(p, message);
    struct plan_round_node *node = plan_round_add(p->part, sends ? PLAN_SEND : PLAN_RECEIVE, fork);
    node->channel = message;
    for (size_t i = p->m->message[message].first; i; i = p->m->item[i - 1].next)
        plan_round_use(p->part, node, part_item(p, i - 1), sends, !sends);
}

/* Where an item lies that was made just now: copied aside if it is overwritten too soon. */
static void part_made(struct parting *p, size_t i, size_t fork)
{
    const struct plan_item *item = &p->m->item[i];
    plan_moment spoilt;
    if (item->version != PLAN_NONE) {
        p->place[i] = item->object;
        spoilt = p->spoilt[item->version];
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

/* A moment has come: what it makes has its place, and messages that are ready go. */
static void part_moment(struct parting *p, plan_moment now, size_t fork)
{
    const struct plan_messages *m = p->m;
    for (; p->next_item < m->n_items && m->item[p->next_item].made == now; p->next_item++)
        if (part_sends(p, m->item[p->next_item].message))
            part_made(p, p->next_item, fork);
    while (p->next_send < p->n_sends && m->message[p->order[p->next_send]].ready == now)
        part_message(p, p->order[p->next_send++], fork);
}

/* ---- Nodes ---- */

/* A node writes on what came from elsewhere: into the object's own place. */
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

/* The contributions of this rank become pieces where that takes more than one. */
static void part_partial(struct parting *p, size_t n)
{
    const struct plan_round_node *node = &p->round->node[n];
    const struct plan_node_use *leaf = &p->round->use[node->first_use + 1];
    struct plan_round_node *made = NULL;
    for (size_t i = p->m->first_piece[n]; i < p->m->first_piece[n + 1]; i++) {
        const struct plan_piece *piece = &p->m->piece[i];
        if (piece->rank != p->m->rank || piece->n == 1)
            continue;
        if (!made)
            made = plan_round_add(p->part, PLAN_PARTIAL, node->fork);
        made->law = node->law;
        size_t rows = 0;
        for (uint32_t k = 0; k < piece->n; k++) {
            uint64_t first = piece->tree.first + k;
            p->row[rows] = (struct data_subtree){.first = first, .where = (uint32_t)made->n_uses};
            plan_round_use(p->part, made, part_leaf(p, leaf[first].place), true, true);
            rows = plan_reduce_push(p->part, made, p->row, rows);
        }
        plan_reduce_fold(p->part, made, p->row, rows);
    }
}

/* All pieces, own ones and received ones, and the object. */
static void part_sum(struct parting *p, size_t n)
{
    const struct plan_round_node *node = &p->round->node[n];
    struct plan_round_node *made = plan_round_add(p->part, PLAN_SUM, node->fork);
    size_t rows = 0;
    made->owner = node->owner;
    made->law = node->law;
    plan_round_use(p->part, made, p->round->use[node->first_use].place, true, true);
    for (size_t i = p->m->first_piece[n]; i < p->m->first_piece[n + 1]; i++) {
        const struct plan_piece *piece = &p->m->piece[i];
        bool own = piece->rank == p->m->rank;
        p->row[rows] = piece->tree;
        p->row[rows].where = (uint32_t)made->n_uses;
        plan_round_use(p->part, made, own ? part_piece(p, piece) : p->arrival[i], true, true);
        rows = plan_reduce_push(p->part, made, p->row, rows);
    }
    plan_reduce_fold(p->part, made, p->row, rows);
}

/* A task, a set, a view or the flag. */
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

static void part_nodes(struct parting *p)
{
    for (uint32_t i = 0; i < p->m->n_messages; i++)
        if (!part_sends(p, i))
            part_message(p, i, 0);
    part_moment(p, 0, 0);
    for (size_t n = 0; n < p->round->n_nodes; n++) {
        const struct plan_round_node *node = &p->round->node[n];
        if (node->kind == PLAN_SUM)
            part_partial(p, n);
        part_moment(p, 2 * n + 1, node->fork);
        if (plan_runs(p->a, n, p->m->rank)) {
            part_bring_home(p, n);
            if (node->kind == PLAN_SUM)
                part_sum(p, n);
            else
                part_plain(p, n);
        }
        part_moment(p, 2 * n + 2, node->fork);
    }
}

/* ---- The pass ---- */

static bool part_room(struct parting *p)
{
    const struct plan_messages *m = p->m;
    size_t nodes = p->round->n_nodes, uses = p->round->n_uses, items = m->n_items;
    size_t leaves = p->round->n_places - p->round->n_objects + 1;
    p->replica = base_alloc(p->a->n_versions * sizeof *p->replica + 1);
    p->arrival = base_alloc(m->n_pieces * sizeof *p->arrival + 1);
    p->place = base_alloc(items * sizeof *p->place + 1);
    p->leaf = base_alloc_zero(leaves * sizeof *p->leaf);
    p->spoilt = base_alloc(p->a->n_versions * sizeof *p->spoilt + 1);
    p->order = base_alloc((m->n_messages + 1) * sizeof *p->order);
    p->row = base_alloc(leaves * sizeof *p->row);
    p->part->channel = base_alloc((m->n_messages + 1) * sizeof *p->part->channel);
    return p->replica && p->arrival && p->place && p->leaf && p->spoilt && p->order && p->row &&
           p->part->channel &&
           plan_round_room(p->part, 2 * nodes + uses + items + m->n_messages, 5 * uses + 3 * items,
                           p->round->n_places + 2 * items, 2 * uses + 1);
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
    base_free(p.row);
    return fine;
}
