/* The part of one rank: its nodes in the order of the round. RECEIVEs come first. A SEND comes once
 * the last item of its message is made. A rank's writes go to its objects' own places. Each
 * received version or piece has a buffer that no other node writes; a node that modifies such a
 * version gets a copy first. Values overwritten before their message can go are copied aside. Edges
 * follow from these places as on one rank. */
#include "runtime/plan/part.h"

#include "runtime/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define NEVER UINT64_MAX

/* ---- Places ---- */

uint32_t plan_part_leaf(struct plan_parting *p, uint32_t place)
{
    uint32_t *leaf = &p->leaf[place - p->round->n_objects];
    if (!*leaf)
        *leaf = 1 + plan_round_buffer(p->part, p->round->place[place].object,
                                      p->round->place[place].law);
    return *leaf - 1;
}

/* The place of a version that this rank reads. */
static uint32_t part_version(const struct plan_parting *p, uint32_t version)
{
    return plan_is_there(p->a, version, p->m->rank) ? p->a->version[version].object
                                                    : p->replica[version];
}

uint32_t plan_part_piece(struct plan_parting *p, const struct plan_piece *piece)
{
    const struct plan_round_node *sum = &p->round->node[piece->node];
    return plan_part_leaf(p, p->round->use[sum->first_use + 1 + piece->tree.first].place);
}

static void part_find_spoilt(struct plan_parting *p)
{
    for (uint32_t i = 0; i < p->round->n_objects; i++)
        p->own[i] = i;
    for (size_t i = 0; i < p->a->n_versions; i++)
        p->spoilt[i] = NEVER;
    for (size_t n = 0; n < p->round->n_nodes; n++) {
        const struct plan_round_node *node = &p->round->node[n];
        if (!plan_runs(p->a, n, p->m->rank))
            continue;
        for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
            if (p->a->makes[i] == PLAN_NONE)
                continue;
            p->spoilt[p->own[p->round->use[i].place]] = plan_moment_over(n);
            p->own[p->round->use[i].place] = p->a->makes[i];
        }
    }
}

static void part_copy(struct plan_parting *p, size_t fork, uint32_t from, uint32_t to)
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

/* Orders the messages to send, and makes buffers for the items received. */
static void part_items(struct plan_parting *p)
{
    const struct plan_messages *m = p->m;
    for (uint32_t i = 0; i < m->n_messages; i++)
        if (plan_part_sends(p, i))
            p->order[p->n_sends++] = i;
    qsort_r(p->order, p->n_sends, sizeof *p->order, message_compare, m->message);
    for (size_t i = 0; i < m->n_items; i++) {
        const struct plan_item *item = &m->item[i];
        if (plan_part_sends(p, item->message))
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
static void part_message(struct plan_parting *p, uint32_t message, size_t fork)
{
    bool sends = plan_part_sends(p, message);
    struct plan_round_node *node = plan_round_add(p->part, sends ? PLAN_SEND : PLAN_RECEIVE, fork);
    const struct plan_message *of = &p->m->message[message];
    node->channel = message;
    node->peer = sends ? of->to : of->from;
    node->phase = of->phase;
    p->part->n_channels++;
    for (size_t i = of->first; i; i = p->m->item[i - 1].next)
        plan_round_use(p->part, node, p->place[i - 1], sends, !sends);
}

/* The place of a subtree that a sum's relay passes on, valid until the next round joins it. */
static uint32_t part_passed(const struct plan_parting *p, const struct data_subtree *tree)
{
    size_t i = 0;
    while (p->state.at[i].first != tree->first)
        i++;
    return p->state.at[i].where;
}

/* Finds the place of an item just made; copies it aside if it is overwritten too soon. */
static void part_made(struct plan_parting *p, size_t i, size_t fork)
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
        p->place[i] = plan_part_piece(p, piece);
        spoilt = plan_runs(p->a, piece->node, p->m->rank) ? item->made + 1 : NEVER;
    }
    if (spoilt > p->m->message[item->message].ready)
        return;
    uint32_t aside = plan_round_buffer(p->part, item->object, NULL);
    part_copy(p, fork, p->place[i], aside);
    p->place[i] = aside;
}

static void part_look_ahead(struct plan_parting *p)
{
    const struct plan_messages *m = p->m;
    p->next = NEVER;
    if (p->next_item < m->n_items)
        p->next = m->item[p->next_item].made;
    if (p->next_send < p->n_sends && m->message[p->order[p->next_send]].ready < p->next)
        p->next = m->message[p->order[p->next_send]].ready;
}

void plan_part_moment(struct plan_parting *p, plan_moment now, size_t fork)
{
    const struct plan_messages *m = p->m;
    if (now != p->next)
        return;
    for (; p->next_item < m->n_items && m->item[p->next_item].made == now; p->next_item++)
        if (plan_part_sends(p, m->item[p->next_item].message))
            part_made(p, p->next_item, fork);
    while (p->next_send < p->n_sends && m->message[p->order[p->next_send]].ready == now)
        part_message(p, p->order[p->next_send++], fork);
    part_look_ahead(p);
}

/* ---- Nodes ---- */

/* Copies received versions that the node modifies into the objects' own places. */
static void part_bring_home(struct plan_parting *p, size_t n)
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

/* A task, a set or the flag. */
static void part_plain(struct plan_parting *p, size_t n)
{
    const struct plan_round_node *node = &p->round->node[n];
    struct plan_round_node *made = plan_round_add(p->part, node->kind, node->fork);
    made->owner = node->owner;
    for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
        const struct plan_node_use *use = &p->round->use[i];
        uint32_t place = use->place;
        if (place >= p->round->n_objects)
            place = plan_part_leaf(p, place);
        else if (!use->writes)
            place = part_version(p, p->a->reads[i]);
        plan_round_use(p->part, made, place, use->reads, use->writes);
    }
}

static void part_nodes(struct plan_parting *p)
{
    for (uint32_t i = 0; i < p->m->n_messages; i++)
        if (!plan_part_sends(p, i))
            part_message(p, i, 0);
    part_look_ahead(p);
    plan_part_moment(p, 0, 0);
    for (size_t n = 0; n < p->round->n_nodes; n++) {
        const struct plan_round_node *node = &p->round->node[n];
        if (node->kind == PLAN_SUM)
            plan_part_before_sum(p, n);
        if (plan_runs(p->a, n, p->m->rank)) {
            part_bring_home(p, n);
            if (node->kind == PLAN_SUM)
                plan_part_sum(p, n);
            else
                part_plain(p, n);
        }
        plan_part_moment(p, plan_moment_over(n), node->fork);
    }
}

/* ---- The pass ---- */

static size_t part_places(const struct plan_parting *p)
{
    return p->round->n_places + 2 * p->m->n_items;
}

/* Memory: for each node that this rank runs, and copies of what it modifies; for each sum's
 * contributions and pieces; for a copy and a join of each item. */
static bool part_round_room(struct plan_parting *p)
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

/* The arrays of the pass in one block, which the caller frees; NULL without memory. */
static void *part_room(struct plan_parting *p)
{
    const struct plan_messages *m = p->m;
    const size_t items = m->n_items, versions = p->a->n_versions;
    const size_t leaves = p->round->n_places - p->round->n_objects + 1;
    const struct base_array arrays[] = {BASE_ARRAY(p->replica, versions),
                                        BASE_ARRAY(p->arrival, m->n_pieces),
                                        BASE_ARRAY(p->place, items),
                                        BASE_ZEROS(p->leaf, leaves),
                                        BASE_ARRAY(p->spoilt, versions),
                                        BASE_ARRAY(p->own, p->round->n_objects),
                                        BASE_ARRAY(p->order, m->n_messages),
                                        BASE_ARRAY(p->row.at, leaves),
                                        BASE_ARRAY(p->state.at, leaves + items),
                                        BASE_ARRAY(p->joined.at, leaves + items),
                                        BASE_ARRAY(p->came.at, items),
                                        BASE_ARRAY(p->param, part_places(p)),
                                        {0}};
    void *memory = base_arrays(arrays);
    for (size_t i = 0; memory && i < part_places(p); i++)
        p->param[i] = PLAN_NONE;
    return memory;
}

bool plan_part(struct plan_round *part, const struct plan_messages *messages)
{
    const struct plan_assignment *a = messages->assignment;
    struct plan_parting p = {.m = messages, .a = a, .round = a->round, .part = part};
    part->source = a->round->source;
    void *memory = part_room(&p);
    const bool fine = memory && part_round_room(&p);
    if (fine) {
        part_find_spoilt(&p);
        part_items(&p);
        part_nodes(&p);
    }
    base_free(memory);
    return fine;
}
