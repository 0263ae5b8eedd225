/* This rank's part of a round: its nodes in the order of the round, first of all those that
 * receive, and each one that sends as soon as the last thing that its message carries is made. What
 * a rank writes lies in its objects' own places; what it receives, in a place of its own for each
 * version, which nobody writes to; who would write on from there gets a copy first. What is
 * overwritten before its message can go is copied aside. The edges follow from these places as on
 * one rank. */
#include "runtime/base/memory.h"
#include "runtime/plan/spread.h"

#include <stdlib.h>

/* A moment in the round: 2 n + 1 when the pieces of the sum at node n are made, 2 n + 2 when node n
 * is over; 0 is its beginning. */
typedef uint64_t moment;
#define NEVER UINT64_MAX

struct channel {
    struct plan_round_channel is;
    uint32_t next;      /* of the same peer and way, plus 1 */
    moment ready;       /* all that it carries is made */
    size_t first, last; /* items, plus 1 */
};

/* One thing that one message carries. */
struct item {
    uint32_t channel, object;
    size_t next;         /* of its channel, plus 1 */
    uint32_t version;    /* SPREAD_NONE: a piece of a sum */
    size_t leaf;         /* of a piece to be sent: the round's place of its first contribution */
    size_t place;        /* where it lies, or comes to lie */
    moment made, spoilt; /* spoilt: when it is overwritten */
};

struct local {
    const struct spread *spread;
    struct plan_round *draft;
    struct channel *channel;
    size_t n_channels, channels_capacity;
    uint32_t *heads; /* by peer and way: the first channel, plus 1 */
    struct item *item;
    size_t n_items, items_capacity;
    size_t next_send, next_piece; /* items, in the order in which they are made or needed */
    size_t *replica;              /* by version: the place where it is received */
    moment *spoilt;               /* by version */
    uint32_t *own;                /* by object: the version in its own place */
    size_t *leaf;                 /* by contribution: its place here, plus 1; 0: none yet */
    struct spread_piece *piece;   /* scratch: those of one sum */
    struct plan_subtree *merge;
    uint32_t *order; /* channels that send, by the moment they are ready */
    size_t n_sends, next_channel;
    bool failed;
};

/* ---- What is sent and received ---- */

static void *grow(struct local *l, void *array, size_t *capacity, size_t n, size_t element)
{
    void *moved = base_grow(array, capacity, n, element);
    l->failed |= !moved;
    return moved ? moved : array;
}

static uint32_t find_channel(struct local *l, int peer, bool sends, uint32_t phase)
{
    uint32_t *link = &l->heads[2 * (size_t)peer + sends];
    for (uint32_t i = *link; i; i = l->channel[i - 1].next)
        if (l->channel[i - 1].is.phase == phase)
            return i - 1;
    l->channel = grow(l, l->channel, &l->channels_capacity, l->n_channels + 1, sizeof *l->channel);
    if (l->failed)
        return SPREAD_NONE;
    l->channel[l->n_channels] =
        (struct channel){.is = {.peer = peer, .phase = phase, .sends = sends}, .next = *link};
    *link = (uint32_t)++l->n_channels;
    return *link - 1;
}

static void add_item(struct local *l, int peer, bool sends, uint32_t phase, struct item item)
{
    item.channel = find_channel(l, peer, sends, phase);
    l->item = grow(l, l->item, &l->items_capacity, l->n_items + 1, sizeof *l->item);
    if (l->failed)
        return;
    struct channel *channel = &l->channel[item.channel];
    if (item.made > channel->ready)
        channel->ready = item.made;
    l->item[l->n_items++] = item;
    if (channel->last)
        l->item[channel->last - 1].next = l->n_items;
    else
        channel->first = l->n_items;
    channel->last = l->n_items;
}

/* The version goes from the rank that makes it to those that need it; what is made on several ranks
 * is made wherever it is needed. */
static void move_version(struct local *l, uint32_t version, moment made)
{
    const struct spread *spread = l->spread;
    const struct spread_version *found = &spread->version[version];
    uint32_t maker = spread_maker(spread, version);
    const uint64_t *need = spread_need(spread, version);
    if (maker == SPREAD_NONE || spread->at[maker] == SPREAD_MANY)
        return;
    int from = spread->at[maker];
    uint32_t phase = found->maker ? spread->phase[maker] : 0;
    struct item item = {.object = found->object, .version = version, .made = made};
    for (int to = 0; from == spread->rank && to < spread->n_ranks; to++)
        if (to != from && spread_has(need, to))
            add_item(l, to, true, phase, item);
    if (from != spread->rank && spread_has(need, spread->rank))
        add_item(l, from, false, phase, item);
}

/* The pieces of each rank go to those that add them all up. */
static void move_pieces(struct local *l, size_t n)
{
    const struct spread *spread = l->spread;
    const struct plan_round_node *node = &spread->round->node[n];
    const struct plan_node_use *use = &spread->round->use[node->first_use];
    const uint64_t *set = spread_set(spread, n);
    size_t pieces = spread_pieces(spread, n, l->piece);
    for (size_t i = 0; i < pieces; i++) {
        const struct spread_piece *piece = &l->piece[i];
        struct item item = {.object = use->place,
                            .version = SPREAD_NONE,
                            .leaf = use[1 + piece->tree.first].place,
                            .made = 2 * n + 1,
                            .spoilt = spread_has(set, spread->rank) ? 2 * n + 2 : NEVER};
        for (int to = 0; piece->rank == spread->rank && to < spread->n_ranks; to++)
            if (to != piece->rank && spread_has(set, to))
                add_item(l, to, true, piece->phase, item);
        if (piece->rank != spread->rank && spread_has(set, spread->rank))
            add_item(l, piece->rank, false, piece->phase, item);
    }
}

/* In the order of the round, which is the same on both sides of each channel. */
static void move_all(struct local *l)
{
    const struct spread *spread = l->spread;
    const struct plan_round *round = spread->round;
    for (uint32_t i = 0; i < round->n_objects; i++) {
        l->own[i] = i;
        move_version(l, i, 0);
    }
    for (size_t n = 0; n < round->n_nodes; n++) {
        const struct plan_round_node *node = &round->node[n];
        bool here = spread_runs(spread, n, spread->rank);
        if (node->kind == PLAN_SUM)
            move_pieces(l, n);
        for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
            if (spread->makes[i] == SPREAD_NONE)
                continue;
            if (here) {
                l->spoilt[l->own[round->use[i].place]] = 2 * n + 2;
                l->own[round->use[i].place] = spread->makes[i];
            }
            move_version(l, spread->makes[i], 2 * n + 2);
        }
    }
}

/* ---- Nodes ---- */

static size_t new_place(struct local *l, uint32_t object, const duite_law *law)
{
    return plan_round_buffer(l->draft, object, law);
}

static size_t leaf_place(struct local *l, size_t round_place)
{
    const struct plan_round *round = l->spread->round;
    size_t *leaf = &l->leaf[round_place - round->n_objects];
    if (!*leaf)
        *leaf = 1 + new_place(l, round->place[round_place].object, round->place[round_place].law);
    return *leaf - 1;
}

static void add_copy(struct local *l, size_t fork, size_t from, size_t to)
{
    struct plan_round_node *node = plan_round_add(l->draft, PLAN_COPY, fork);
    node->owner = l->draft->place[from].object;
    plan_round_use(l->draft, node, from, true, false);
    plan_round_use(l->draft, node, to, false, true);
}

static int by_moment(const void *a, const void *b, void *context)
{
    const struct channel *channel = context;
    uint32_t l = *(const uint32_t *)a, r = *(const uint32_t *)b;
    moment left = channel[l].ready, right = channel[r].ready;
    return left != right ? (left > right) - (left < right) : (l > r) - (l < r);
}

/* The channels of the draft, and memory for what is received. */
static void begin(struct local *l)
{
    struct plan_round *draft = l->draft;
    for (uint32_t i = 0; i < l->n_channels; i++) {
        draft->channel[i] = l->channel[i].is;
        if (l->channel[i].is.sends)
            l->order[l->n_sends++] = i;
    }
    draft->n_channels = l->n_channels;
    qsort_r(l->order, l->n_sends, sizeof *l->order, by_moment, l->channel);
    for (size_t i = 0; i < l->n_items; i++) {
        struct item *item = &l->item[i];
        if (l->channel[item->channel].is.sends)
            continue;
        item->place = new_place(l, item->object, NULL);
        if (item->version != SPREAD_NONE)
            l->replica[item->version] = item->place;
    }
}

/* The node of a channel. */
static void add_channel(struct local *l, uint32_t channel, size_t fork)
{
    bool sends = l->channel[channel].is.sends;
    struct plan_round_node *node = plan_round_add(l->draft, sends ? PLAN_SEND : PLAN_RECEIVE, fork);
    node->channel = channel;
    for (size_t i = l->channel[channel].first; i; i = l->item[i - 1].next)
        plan_round_use(l->draft, node, l->item[i - 1].place, sends, !sends);
}

/* What was made at this moment is copied aside if it is overwritten before its message goes; the
 * messages that are ready go. */
static void send_at(struct local *l, moment now, size_t fork)
{
    for (; l->next_send < l->n_items && l->item[l->next_send].made == now; l->next_send++) {
        struct item *item = &l->item[l->next_send];
        if (!l->channel[item->channel].is.sends)
            continue;
        bool piece = item->version == SPREAD_NONE;
        item->place = piece ? leaf_place(l, item->leaf) : item->object;
        moment spoilt = piece ? item->spoilt : l->spoilt[item->version];
        if (spoilt > l->channel[item->channel].ready)
            continue;
        size_t aside = new_place(l, item->object, NULL);
        add_copy(l, fork, item->place, aside);
        item->place = aside;
    }
    for (; l->next_channel < l->n_sends; l->next_channel++) {
        uint32_t channel = l->order[l->next_channel];
        if (l->channel[channel].ready != now)
            return;
        add_channel(l, channel, fork);
    }
}

/* Where this rank has a version that it reads. */
static size_t read_place(const struct local *l, uint32_t version)
{
    const struct spread *spread = l->spread;
    return spread_is_there(spread, version, spread->rank) ? spread->version[version].object
                                                          : l->replica[version];
}

/* A node writes on what came from elsewhere: into the object's own place. */
static void bring_home(struct local *l, size_t n)
{
    const struct spread *spread = l->spread;
    const struct plan_round_node *node = &spread->round->node[n];
    for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
        if (spread->makes[i] == SPREAD_NONE || spread->reads[i] == SPREAD_NONE)
            continue;
        size_t from = read_place(l, spread->reads[i]), to = spread->round->use[i].place;
        if (from != to)
            add_copy(l, node->fork, from, to);
    }
}

/* The contributions of this rank become pieces where that takes more than one. */
static void add_partial(struct local *l, const struct plan_round_node *node, size_t pieces)
{
    const struct plan_round *round = l->spread->round;
    const struct plan_node_use *leaf = &round->use[node->first_use + 1];
    struct plan_round_node *made = NULL;
    for (size_t i = 0; i < pieces; i++) {
        const struct spread_piece *piece = &l->piece[i];
        if (piece->rank != l->spread->rank || piece->n == 1)
            continue;
        if (!made)
            made = plan_round_add(l->draft, PLAN_PARTIAL, node->fork);
        made->law = round->place[leaf->place].law;
        size_t n = 0;
        for (uint32_t k = 0; k < piece->n; k++) {
            uint64_t first = piece->tree.first + k;
            l->merge[n] = (struct plan_subtree){.first = first, .param = (uint32_t)made->n_uses};
            plan_round_use(l->draft, made, leaf_place(l, leaf[first].place), true, true);
            n = plan_reduce_push(l->draft, made, l->merge, n);
        }
        plan_reduce_fold(l->draft, made, l->merge, n);
    }
}

/* All pieces, own ones and received ones, and the object. */
static void add_whole(struct local *l, const struct plan_round_node *node, size_t pieces)
{
    const struct plan_round *round = l->spread->round;
    const struct plan_node_use *leaf = &round->use[node->first_use + 1];
    struct plan_round_node *made = plan_round_add(l->draft, PLAN_SUM, node->fork);
    made->owner = node->owner;
    size_t n = 0;
    made->law = round->place[leaf->place].law;
    plan_round_use(l->draft, made, round->use[node->first_use].place, true, true);
    for (size_t i = 0; i < pieces; i++) {
        const struct spread_piece *piece = &l->piece[i];
        size_t place;
        l->merge[n] = piece->tree;
        l->merge[n].param = (uint32_t)made->n_uses;
        if (piece->rank == l->spread->rank) {
            place = leaf_place(l, leaf[piece->tree.first].place);
        } else {
            while (l->channel[l->item[l->next_piece].channel].is.sends ||
                   l->item[l->next_piece].version != SPREAD_NONE)
                l->next_piece++;
            place = l->item[l->next_piece++].place;
        }
        plan_round_use(l->draft, made, place, true, true);
        n = plan_reduce_push(l->draft, made, l->merge, n);
    }
    plan_reduce_fold(l->draft, made, l->merge, n);
}

/* A task, a set, a view or the flag. */
static void add_plain(struct local *l, size_t n)
{
    const struct spread *spread = l->spread;
    const struct plan_round *round = spread->round;
    const struct plan_round_node *node = &round->node[n];
    struct plan_round_node *made = plan_round_add(l->draft, node->kind, node->fork);
    made->owner = node->owner;
    for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
        const struct plan_node_use *use = &round->use[i];
        size_t place = use->place;
        if (use->place >= round->n_objects)
            place = leaf_place(l, use->place);
        else if (!use->writes)
            place = read_place(l, spread->reads[i]);
        plan_round_use(l->draft, made, place, use->reads, use->writes);
    }
}

/* The pieces of a sum; what one rank contributes and reads alone need not be cut into any. */
static size_t cut(struct local *l, size_t n)
{
    const struct spread *spread = l->spread;
    const uint64_t *set = spread_set(spread, n);
    size_t pieces = spread_pieces(spread, n, l->piece);
    for (int rank = 0; rank < spread->n_ranks; rank++)
        if (pieces > 1 || (rank == l->piece[0].rank) != spread_has(set, rank))
            return pieces;
    uint32_t leaves = l->piece[0].n;
    for (uint32_t i = 0; i < leaves; i++)
        l->piece[i] = (struct spread_piece){
            .tree.first = i, .n = 1, .rank = l->piece[0].rank, .phase = l->piece[0].phase};
    return leaves;
}

static void add_nodes(struct local *l)
{
    const struct spread *spread = l->spread;
    const struct plan_round *round = spread->round;
    for (uint32_t i = 0; i < l->n_channels; i++)
        if (!l->channel[i].is.sends)
            add_channel(l, i, 0);
    send_at(l, 0, 0);
    for (size_t n = 0; n < round->n_nodes; n++) {
        const struct plan_round_node *node = &round->node[n];
        bool sum = node->kind == PLAN_SUM, here = spread_runs(spread, n, spread->rank);
        size_t pieces = sum && !spread_is_dead(spread, n) ? cut(l, n) : 0;
        if (sum)
            add_partial(l, node, pieces);
        send_at(l, 2 * n + 1, node->fork);
        if (here) {
            bring_home(l, n);
            if (sum)
                add_whole(l, node, pieces);
            else
                add_plain(l, n);
        }
        send_at(l, 2 * n + 2, node->fork);
    }
}

/* ---- All of it ---- */

static bool alloc(struct local *l)
{
    const struct spread *spread = l->spread;
    const struct plan_round *round = spread->round;
    size_t leaves = round->n_places - round->n_objects + 1;
    l->heads = base_alloc_zero(2 * (size_t)spread->n_ranks * sizeof *l->heads);
    l->replica = base_alloc(spread->n_versions * sizeof *l->replica + 1);
    l->spoilt = base_alloc(spread->n_versions * sizeof *l->spoilt + 1);
    l->own = base_alloc((round->n_objects + 1) * sizeof *l->own);
    l->leaf = base_alloc_zero(leaves * sizeof *l->leaf);
    l->piece = base_alloc(leaves * sizeof *l->piece);
    l->merge = base_alloc(leaves * sizeof *l->merge);
    if (!l->heads || !l->replica || !l->spoilt || !l->own || !l->leaf || !l->piece || !l->merge)
        return false;
    for (size_t i = 0; i < spread->n_versions; i++)
        l->spoilt[i] = NEVER;
    return true;
}

static bool room(struct local *l)
{
    const struct plan_round *round = l->spread->round;
    size_t nodes = round->n_nodes, uses = round->n_uses, items = l->n_items;
    l->order = base_alloc((l->n_channels + 1) * sizeof *l->order);
    return l->order &&
           (l->draft->channel = base_alloc((l->n_channels + 1) * sizeof *l->draft->channel)) &&
           plan_round_room(l->draft, 2 * nodes + uses + items + l->n_channels, 5 * uses + 3 * items,
                           round->n_places + items, 2 * uses + 1);
}

static void free_local(struct local *l)
{
    free(l->channel);
    free(l->item);
    base_free(l->heads);
    base_free(l->replica);
    base_free(l->spoilt);
    base_free(l->own);
    base_free(l->leaf);
    base_free(l->piece);
    base_free(l->merge);
    base_free(l->order);
}

bool spread_local(const struct spread *spread, struct plan_round *draft)
{
    struct local l = {.spread = spread, .draft = draft};
    draft->source = spread->round->source;
    bool fine = alloc(&l);
    if (fine)
        move_all(&l);
    fine = fine && !l.failed && room(&l);
    if (fine) {
        begin(&l);
        add_nodes(&l);
    }
    free_local(&l);
    return fine;
}
