/* The room and links that ties need in the blocks: alike on every rank, as all ranks have the same
 * records. In reading order: memory, evaluating records, applying the result. */
#include "cloth/base/order.h"
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/state/bodies.h"

/* ---- Memory ---- */

/* Room for the others of now and of before, of three corners each. */
size_t flow_tied_others(uint32_t n_blocks, uint32_t n_joints, bool seeks)
{
    const size_t joints = 12 * (size_t)n_joints, all = (size_t)n_blocks * n_blocks;
    return joints < all && !seeks ? joints : all;
}

static void take_tied(struct flow_tied_blocks *blocks, size_t n_blocks, size_t n_others,
                      struct flow *flow)
{
    blocks->room = flow_take(flow, n_blocks, sizeof *blocks->room);
    blocks->first = flow_take(flow, n_blocks + 1, sizeof *blocks->first);
    blocks->other = flow_take(flow, n_others, sizeof *blocks->other);
    blocks->place = flow_take(flow, n_others, sizeof *blocks->place);
}

void flow_ties_take(struct flow_state *state)
{
    const struct flow_head *head = &state->head;
    struct flow_tied *tied = &state->tied;
    struct flow *flow = state->flow;
    const size_t n = head->n_blocks;
    const size_t others = flow_tied_others(head->n_blocks, head->n_ties, model_seeks(flow->model));
    if (!head->n_ties && !model_seeks(flow->model))
        return;
    tied->parent = flow_take(flow, (size_t)head->n_pieces + 1, sizeof *tied->parent);
    tied->group = flow_take(flow, head->n_pieces, sizeof *tied->group);
    tied->said.of = flow_take(flow, n, sizeof *tied->said.of);
    tied->said.first = flow_take(flow, n + 1, sizeof *tied->said.first);
    tied->said.link = flow_take(flow, others, sizeof *tied->said.link);
    tied->said.max_links = (uint32_t)others;
    tied->scratch = flow_take(flow, flow_ties_scratch(head->n_ties), sizeof *tied->scratch);
    tied->links = flow_take(flow, n + FLOW_TIE_OTHERS, sizeof *tied->links);
    take_tied(&tied->now, n, others, flow);
    take_tied(&tied->next, n, others, flow);
}

/* ---- Evaluating records ---- */

/* Merges the others of each block: those that records name and, where `kept`, those of now. */
static void find_others(const struct flow_tied *tied, uint32_t n_blocks, bool kept,
                        struct flow_tied_blocks *to)
{
    const struct flow_tie_records *said = &tied->said;
    const struct flow_tied_blocks *now = &tied->now;
    uint32_t n = 0;
    for (uint32_t b = 0; b < n_blocks; b++) {
        uint32_t i = said->first[b], k = kept ? now->first[b] : now->first[b + 1];
        to->first[b] = n;
        while (i < said->first[b + 1] || k < now->first[b + 1]) {
            const uint32_t next = i < said->first[b + 1] ? said->link[i].block : UINT32_MAX;
            const uint32_t old = k < now->first[b + 1] ? now->other[k] : UINT32_MAX;
            i += next <= old;
            k += old <= next;
            to->other[n++] = next < old ? next : old;
        }
    }
    to->first[n_blocks] = n;
}

/* The index of block b among the others of a block, which has it. */
static uint32_t number_among_others(const struct flow_tied_blocks *blocks, uint32_t block,
                                    uint32_t b)
{
    const uint32_t first = blocks->first[block], n = blocks->first[block + 1] - first;
    return first + cloth_first_from(blocks->other + first, 1, n, b);
}

/* A block shows the rows of its links one after the other. */
static void adopted_find_places(const struct flow_tie_records *said, uint32_t n_blocks,
                                struct flow_tied_blocks *to)
{
    memset(to->place, 0, to->first[n_blocks] * sizeof *to->place);
    for (uint32_t b = 0; b < n_blocks; b++)
        for (uint32_t i = said->first[b], place = 0; i < said->first[b + 1]; i++) {
            to->place[number_among_others(to, said->link[i].block, b)] = place;
            place += said->link[i].rows;
        }
}

/* Room for so many, in whole classes. Room stays while about half of it is used, so half a class
 * lies between growing and shrinking. The last class stays while any block has ties. */
static uint32_t room_for(uint32_t n, uint32_t class, uint32_t before, bool any)
{
    const uint32_t least = (n + class - 1) / class * class;
    if (least <= before && n + class / 2 > before / 2)
        return before;
    return !least && before && any ? class : least;
}

static void find_rooms(const struct flow_tied *tied, uint32_t n_blocks, struct flow_tied_blocks *to)
{
    bool any = false;
    for (uint32_t b = 0; b < n_blocks; b++)
        any = any || tied->said.of[b].n_ties;
    for (uint32_t b = 0; b < n_blocks; b++) {
        const struct flow_tie_record *said = tied->said.of + b;
        const struct flow_tie_room *now = tied->now.room + b;
        const uint32_t rows = said->n_ghosts > said->n_shown ? said->n_ghosts : said->n_shown;
        const uint32_t others = to->first[b + 1] - to->first[b];
        to->room[b] = (struct flow_tie_room){room_for(said->n_ties, FLOW_TIE_CLASS, now->ties, any),
                                             room_for(rows, FLOW_TIE_CLASS, now->rows, any),
                                             room_for(others, FLOW_TIE_OTHERS, now->others, any)};
    }
}

/* True if the recorded round serves the next ones, too. */
static bool is_recorded(const struct flow_tied *tied, uint32_t n_blocks)
{
    const struct flow_tied_blocks *now = &tied->now, *next = &tied->next;
    return !memcmp(now->room, next->room, n_blocks * sizeof *now->room) &&
           !memcmp(now->first, next->first, ((size_t)n_blocks + 1) * sizeof *now->first) &&
           !memcmp(now->other, next->other, now->first[n_blocks] * sizeof *now->other);
}

/* True if a block shares ties with the same others as before, and each shows them at the same
 * place. */
static bool has_links(const struct flow_tied *tied, uint32_t b)
{
    const struct flow_tied_blocks *now = &tied->now, *before = &tied->next;
    const uint32_t n = now->first[b + 1] - now->first[b];
    const uint32_t *other = now->other + now->first[b], *place = now->place + now->first[b];
    return now->room[b].others == before->room[b].others &&
           n == before->first[b + 1] - before->first[b] &&
           !memcmp(other, before->other + before->first[b], n * sizeof *other) &&
           !memcmp(place, before->place + before->first[b], n * sizeof *place);
}

static void set_links(struct flow_state *state, uint32_t b)
{
    const struct flow_tied_blocks *now = &state->tied.now;
    uint32_t(*to)[2] = state->tied.links;
    const uint32_t first = now->first[b], n = now->first[b + 1] - first;
    memset(to, 0, (1 + (size_t)now->room[b].others) * sizeof *to);
    to[0][0] = n;
    for (uint32_t i = 0; i < n; i++) {
        to[1 + i][0] = now->other[first + i];
        to[1 + i][1] = now->place[first + i];
    }
    flow_noted(state, duite_set(state->rt, state->block[b].tie_links, to));
}

/* ---- Applying the result ---- */

/* Makes the next rooms and links those of now, and sets links that changed. */
static int fit_objects(struct flow_state *state)
{
    struct flow_tied *tied = &state->tied;
    const struct flow_tied_blocks before = tied->now;
    for (uint32_t b = 0; b < state->flow->tables.n_blocks; b++)
        if (memcmp(before.room + b, tied->next.room + b, sizeof *before.room)) {
            const struct flow_tie_room was = before.room[b];
            flow_objects_fit(state, b, tied->next.room + b);
            before.room[b] = was;
        }
    tied->now = tied->next;
    tied->next = before;
    for (uint32_t b = 0; b < state->flow->tables.n_blocks && !state->code; b++)
        if (!has_links(tied, b))
            set_links(state, b);
    return state->code;
}

void flow_ties_copy(const struct flow_tied_blocks *from, uint32_t n_blocks,
                    const struct flow_tied_blocks *to)
{
    memcpy(to->room, from->room, n_blocks * sizeof *to->room);
    memcpy(to->first, from->first, ((size_t)n_blocks + 1) * sizeof *to->first);
    memcpy(to->other, from->other, from->first[n_blocks] * sizeof *to->other);
    memcpy(to->place, from->place, from->first[n_blocks] * sizeof *to->place);
}

int flow_ties_again(struct flow_state *state, const struct flow_tied_blocks *tied)
{
    flow_ties_copy(tied, state->flow->tables.n_blocks, &state->tied.next);
    return fit_objects(state);
}

int flow_ties_adopt(struct flow_state *state)
{
    struct flow_tied *tied = &state->tied;
    const uint32_t n_blocks = state->flow->tables.n_blocks;
    find_others(tied, n_blocks, true, &tied->next);
    if (tied->next.first[n_blocks] > 2 * tied->said.first[n_blocks])
        find_others(tied, n_blocks, false, &tied->next);
    adopted_find_places(&tied->said, n_blocks, &tied->next);
    find_rooms(tied, n_blocks, &tied->next);
    const bool recorded = is_recorded(tied, n_blocks);
    if (!recorded && state->solve.generation) {
        duite_graph_free(state->rt, state->solve); /* a failure is returned by the next fork */
        state->solve = (duite_graph){0};
    }
    if (fit_objects(state) || recorded || !model_is_implicit(state->flow->model))
        return state->code;
    state->report->contact_graphs += model_seeks(state->flow->model);
    return flow_cg_record(state);
}
