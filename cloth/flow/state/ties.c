/* A table of ties is one piece of memory: five numbers, then arrays whose places follow from two of
 * them. */
#include "cloth/flow/state/ties.h"

#include "cloth/base/order.h"
#include "cloth/flow/state/room.h"

#include <stdlib.h>
#include <string.h>

/* What a table begins with. */
struct head {
    uint32_t n_inner, n, n_others, n_halo;
    uint32_t room, block_halo; /* places follow from these: rows of the block's halo */
};

/* The arrays, for who makes them. */
struct arrays {
    struct head *head;
    uint32_t *other, *start, *place, (*end)[2], *far, *at, *halo;
    unsigned char *held;
    double *stiffness, *damping, *length;
};

static size_t lay(uint32_t block_halo, size_t room, void *memory, struct arrays *to)
{
    struct flow_room rest = {.base = memory};
    to->head = flow_room_next(&rest, sizeof *to->head);
    if (!room)
        return rest.used;
    to->other = flow_room_next(&rest, room * sizeof *to->other);
    to->start = flow_room_next(&rest, (room + 1) * sizeof *to->start);
    to->place = flow_room_next(&rest, room * sizeof *to->place);
    to->end = flow_room_next(&rest, room * sizeof *to->end);
    to->far = flow_room_next(&rest, room * sizeof *to->far);
    to->at = flow_room_next(&rest, room * sizeof *to->at);
    to->halo = flow_room_next(&rest, (block_halo + 2 * room) * sizeof *to->halo);
    to->held = flow_room_next(&rest, room);
    to->stiffness = flow_room_next(&rest, room * sizeof *to->stiffness);
    to->damping = flow_room_next(&rest, room * sizeof *to->damping);
    to->length = flow_room_next(&rest, room * sizeof *to->length);
    return rest.used;
}

size_t flow_ties_bytes(uint32_t n_halo, uint32_t room)
{
    struct arrays arrays = {0};
    return lay(n_halo, room, NULL, &arrays);
}

/* ---- Making ---- */

/* Which end of a tie is in the block; of an inner one end 0. */
static int end_in(const struct flow_tie *tie, uint32_t block)
{
    return tie->block[0] != block;
}

static bool is_of(const struct flow_tie *tie, const struct flow_ties_of *of)
{
    return flow_tie_acts(tie, of->tick) &&
           (tie->block[0] == of->block || tie->block[1] == of->block);
}

static bool is_inner(const struct flow_tie *tie)
{
    return tie->block[0] == tie->block[1];
}

/* Appends a tie as the end of it that is in the block sees it. second: end 1 of the list's. */
static void append(const struct flow_tie *tie, int here, uint32_t second, struct arrays *to)
{
    const uint32_t i = to->head->n++;
    to->end[i][0] = tie->row[here];
    to->end[i][1] = second;
    to->held[i] = (unsigned char)(tie->held[here] | tie->held[1 - here] << 1);
    to->stiffness[i] = tie->stiffness;
    to->damping[i] = tie->damping;
    to->length[i] = tie->length;
}

/* Lists the ties of the block, for a while, where `at` is. Returns how many there are. */
static uint32_t list_own(const struct flow_ties_of *of, uint32_t *at)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < of->n; i++)
        if (is_of(of->tie + i, of))
            at[n++] = i;
    return n;
}

/* The lowest block from `least` on that shares a tie with this one; UINT32_MAX: there is none. */
static uint32_t next_other(const struct flow_ties_of *of, const struct arrays *to, uint32_t n_own,
                           uint32_t least)
{
    uint32_t other = UINT32_MAX;
    for (uint32_t i = 0; i < n_own; i++) {
        const struct flow_tie *tie = of->tie + to->at[i];
        const uint32_t block = tie->block[1 - end_in(tie, of->block)];
        if (!is_inner(tie) && block >= least && block < other)
            other = block;
    }
    return other;
}

static void append_inner(const struct flow_ties_of *of, uint32_t n_own, struct arrays *to)
{
    for (uint32_t i = 0; i < n_own; i++) {
        const struct flow_tie *tie = of->tie + to->at[i];
        if (is_inner(tie))
            append(tie, 0, tie->row[1], to);
    }
    to->head->n_inner = to->head->n;
}

static void append_shared(const struct flow_ties_of *of, uint32_t n_own, uint32_t other,
                          struct arrays *to)
{
    struct head *head = to->head;
    const uint32_t first = head->n;
    to->other[head->n_others] = other;
    for (uint32_t i = 0; i < n_own; i++) {
        const struct flow_tie *tie = of->tie + to->at[i];
        const int here = end_in(tie, of->block);
        if (is_inner(tie) || tie->block[1 - here] != other)
            continue;
        to->far[head->n - head->n_inner] = tie->row[1 - here];
        append(tie, here, head->n - first, to);
    }
    to->start[++head->n_others] = head->n - head->n_inner;
}

/* Where a block stands among the others; n_others: it is none. */
static uint32_t number_of(const struct arrays *to, uint32_t block)
{
    uint32_t low = 0, high = to->head->n_others;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (to->other[middle] < block)
            low = middle + 1;
        else
            high = middle;
    }
    return low < to->head->n_others && to->other[low] == block ? low : to->head->n_others;
}

/* Of each other block, how many ties it shares with blocks before this one: it shows them first. */
static void find_places(const struct flow_ties_of *of, struct arrays *to)
{
    for (const struct flow_tie *tie = of->tie; tie < of->tie + of->n; tie++) {
        if (is_inner(tie) || !flow_tie_acts(tie, of->tick))
            continue;
        for (int end = 0; end < 2; end++) {
            const uint32_t number = number_of(to, tie->block[end]);
            if (number < to->head->n_others && tie->block[1 - end] < of->block)
                to->place[number]++;
        }
    }
}

/* The rows of the block's halo and of its ties, each once. */
static void make_halo(const struct flow_ties_of *of, struct arrays *to)
{
    struct head *head = to->head;
    uint32_t n = of->n_halo, kept = 0;
    if (n)
        memcpy(to->halo, of->halo, n * sizeof *to->halo);
    for (uint32_t i = 0; i < head->n; i++)
        for (int end = 0; end < (i < head->n_inner ? 2 : 1); end++)
            to->halo[n++] = to->end[i][end];
    qsort(to->halo, n, sizeof *to->halo, cloth_compare_items_u32);
    for (uint32_t i = 0; i < n; i++)
        if (!kept || to->halo[i] != to->halo[kept - 1])
            to->halo[kept++] = to->halo[i];
    head->n_halo = kept;
}

void flow_ties_make(const struct flow_ties_of *of, void *memory)
{
    struct arrays to = {0};
    memset(memory, 0, flow_ties_bytes(of->n_halo, of->room));
    lay(of->n_halo, of->room, memory, &to);
    to.head->room = of->room;
    to.head->block_halo = of->n_halo;
    if (!of->room)
        return;
    const uint32_t n_own = list_own(of, to.at);
    append_inner(of, n_own, &to);
    for (uint32_t other = 0; (other = next_other(of, &to, n_own, other)) != UINT32_MAX; other++)
        append_shared(of, n_own, other, &to);
    find_places(of, &to);
    make_halo(of, &to);
    for (uint32_t i = 0; i < of->room; i++)
        to.at[i] = i;
}

/* ---- Reading ---- */

uint32_t flow_ties_others(const void *memory)
{
    const struct head *head = memory;
    return head ? head->n_others : 0;
}

struct flow_ties flow_ties_open(const void *memory)
{
    const struct head *head = memory;
    struct arrays arrays = {0};
    if (!head)
        return (struct flow_ties){0};
    lay(head->block_halo, head->room, (void *)memory, &arrays); /* it is only read */
    return (struct flow_ties){.n_inner = head->n_inner,
                              .n = head->n,
                              .n_others = head->n_others,
                              .n_halo = head->n_halo,
                              .room = head->room,
                              .other = arrays.other,
                              .start = arrays.start,
                              .place = arrays.place,
                              .end = (const uint32_t(*)[2])arrays.end,
                              .far = arrays.far,
                              .at = arrays.at,
                              .halo = arrays.halo,
                              .held = arrays.held,
                              .stiffness = arrays.stiffness,
                              .damping = arrays.damping,
                              .length = arrays.length};
}
