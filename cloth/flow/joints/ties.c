/* A table of ties is one piece of memory: its head with its room, then arrays whose places follow
 * from that. Rows of other blocks, and rows shown to them, are keys that are sorted by block and
 * row: both sides of a pair of blocks sort the same rows.
 *
 * In reading order: memory, keys, records, making a table, reading it. */
#include "cloth/flow/joints/ties.h"

#include "cloth/base/order.h"
#include "cloth/flow/state/room.h"

#include <stdlib.h>
#include <string.h>

/* ---- Memory ---- */

/* The arrays while they are made. */
struct arrays {
    struct flow_tie_head *head;
#define MEMBER(type, name, rows)         type *name;
#define MEMBER_CORNERS(type, name, rows) type(*name)[SOLVE_TIE_CORNERS];
    FLOW_TIE_ARRAYS(MEMBER, MEMBER_CORNERS)
};

static size_t lay_ties(size_t n_rows, const struct flow_tie_room *room, void *memory,
                       struct arrays *to)
{
    struct flow_room rest = {.base = memory};
    to->head = flow_room_next(&rest, sizeof *to->head);
#define LAY(type, name, rows) to->name = flow_room_next(&rest, (size_t)(rows) * sizeof *to->name);
    FLOW_TIE_ARRAYS(LAY, LAY)
    return rest.used;
}

/* Needed while it is made: counts of groups, a bit for each row, keys. */
struct sorting {
    uint32_t *count;
    uint64_t *marks, *keys;
};

static size_t lay_sorting(size_t n_rows, const struct flow_tie_room *room, void *memory,
                          struct sorting *to)
{
    struct flow_room rest = {.base = memory};
    to->count = flow_room_next(&rest, (room->others + 3) * sizeof *to->count);
    to->marks = flow_room_next(&rest, (n_rows + 63) / 64 * sizeof *to->marks);
    to->keys = flow_room_next(&rest, flow_ties_scratch(room->ties) * sizeof *to->keys);
    return rest.used;
}

size_t flow_ties_bytes(uint32_t n_rows, const struct flow_tie_room *room)
{
    struct arrays arrays;
    return lay_ties(n_rows, room, NULL, &arrays);
}

/* ---- Keys ---- */

/* A block's ties, by their numbers in a list, with room for their keys. */
struct own {
    const struct flow_tie_list *list;
    uint32_t block, n;
    uint32_t *of;
    uint64_t *key, *spare; /* SOLVE_TIE_CORNERS each */
};

/* Has room for so many. */
static struct own own_in(const struct flow_tie_list *list, uint32_t block, uint64_t *scratch,
                         size_t room)
{
    struct own own = {.list = list, .block = block, .of = (uint32_t *)(void *)scratch};
    if (!room) /* and no scratch */
        return own;
    own.key = scratch + room;
    own.spare = own.key + SOLVE_TIE_CORNERS * room;
    return own;
}

static const struct flow_tie_corners *corners_of(const struct flow_tie_list *list, uint32_t number)
{
    static const struct flow_tie_corners none = {0};
    if (number >= list->n_joints)
        return list->corners[number - list->n_joints];
    const struct flow_tie *joint = list->joint + number;
    return flow_tie_acts(joint, list->tick) ? &joint->at : &none;
}

static bool is_in(const struct flow_tie_corners *tie, uint32_t block)
{
    bool in = false;
    for (uint32_t k = 0; k < tie->n; k++)
        in = in || tie->block[k] == block;
    return in;
}

/* Lists the ties of the block. Returns false if they are more than there is room for. */
static bool list_own(struct own *own, uint32_t room)
{
    for (uint32_t i = 0; i < own->list->n_joints + own->list->n; i++) {
        if (!is_in(corners_of(own->list, i), own->block))
            continue;
        if (own->n == room)
            return false;
        own->of[own->n++] = i;
    }
    return true;
}

static uint64_t key_of(uint32_t block, uint32_t row)
{
    return (uint64_t)block << 32 | row;
}

/* One pass by some bits: from key to spare. */
enum { DIGIT = 11, DIGITS = 1 << DIGIT };
static void sort_by(unsigned shift, size_t n, const uint64_t *key, uint64_t *to)
{
    uint32_t start[DIGITS + 1] = {0};
    for (size_t i = 0; i < n; i++)
        start[1 + (key[i] >> shift & (DIGITS - 1))]++;
    for (int digit = 0; digit < DIGITS; digit++)
        start[digit + 1] += start[digit];
    for (size_t i = 0; i < n; i++)
        to[start[key[i] >> shift & (DIGITS - 1)]++] = key[i];
}

/* Sorts n keys by their bits from `low` on, leaving equal ones in order. Returns where they are: in
 * one of the two arrays. */
static uint64_t *sort_own(struct own *own, unsigned low, size_t n)
{
    uint64_t differ = 0, *from = own->key, *to = own->spare;
    for (size_t i = 1; i < n; i++)
        differ |= from[i] ^ from[0];
    for (unsigned shift = low; shift < 64; shift += DIGIT) {
        if (!(differ >> shift & (DIGITS - 1)))
            continue;
        sort_by(shift, n, from, to);
        uint64_t *const sorted = to;
        to = from;
        from = sorted;
    }
    return from;
}

/* Sorts the keys and keeps each once, in own->key. Returns how many there are. */
static uint32_t sort_once(struct own *own, size_t n)
{
    const uint64_t *sorted = sort_own(own, 0, n);
    uint64_t last = 0;
    uint32_t kept = 0;
    for (size_t i = 0; i < n; i++) { /* a key is read before anything is written there */
        const uint64_t key = sorted[i];
        if (!i || key != last)
            own->key[kept++] = key;
        last = key;
    }
    return kept;
}

/* True if an earlier corner of the tie is in the same block as corner l. */
static bool is_again(const struct flow_tie_corners *tie, uint32_t l)
{
    bool again = false;
    for (uint32_t k = 0; k < l; k++)
        again = again || tie->block[k] == tie->block[l];
    return again;
}

/* The rows of other blocks that the ties end at. */
static uint32_t find_ghosts(struct own *own)
{
    size_t n = 0;
    for (uint32_t i = 0; i < own->n; i++) {
        const struct flow_tie_corners *tie = corners_of(own->list, own->of[i]);
        for (uint32_t k = 0; k < tie->n; k++)
            if (tie->block[k] != own->block)
                own->key[n++] = key_of(tie->block[k], tie->row[k]);
    }
    return sort_once(own, n);
}

/* The rows of the block that others see: (block that sees it, row). */
static uint32_t find_shown(struct own *own)
{
    size_t n = 0;
    for (uint32_t i = 0; i < own->n; i++) {
        const struct flow_tie_corners *tie = corners_of(own->list, own->of[i]);
        for (uint32_t l = 0; l < tie->n; l++) {
            if (tie->block[l] == own->block || is_again(tie, l))
                continue;
            for (uint32_t k = 0; k < tie->n; k++)
                if (tie->block[k] == own->block)
                    own->key[n++] = key_of(tie->block[l], tie->row[k]);
        }
    }
    return sort_once(own, n);
}

/* ---- Records ---- */

bool flow_ties_count(const struct flow_tie_list *list, uint32_t block, uint64_t *scratch,
                     uint32_t max_links, struct flow_tie_record *record, struct flow_tie_link *link)
{
    const uint32_t room = list->n_joints + list->n;
    struct own own = own_in(list, block, scratch, room);
    *record = (struct flow_tie_record){0};
    list_own(&own, room);
    record->n_ties = own.n;
    record->n_ghosts = find_ghosts(&own);
    record->n_shown = find_shown(&own);
    for (uint32_t i = 0; i < record->n_shown; i++) {
        const uint32_t other = (uint32_t)(own.key[i] >> 32);
        if (!record->n_links || link[record->n_links - 1].block != other) {
            if (record->n_links == max_links)
                return false;
            link[record->n_links++] = (struct flow_tie_link){other, 0};
        }
        link[record->n_links - 1].rows++;
    }
    return true;
}

/* ---- Making a table ---- */

/* The index of a block among the others; n_others: it is none of them. */
static uint32_t number_of_block(const struct arrays *to, uint32_t block)
{
    const uint32_t n = to->head->n_others, at = cloth_first_from(to->other, 1, n, block);
    return at < n && to->other[at] == block ? at : n;
}

/* The group of a tie, in order: 0: inner ones; then by the lowest other block, from 1. */
static uint32_t group_of_tie(const struct arrays *to, const struct flow_tie_corners *tie,
                             uint32_t own)
{
    uint32_t lowest = UINT32_MAX;
    for (uint32_t k = 0; k < tie->n; k++)
        if (tie->block[k] != own && tie->block[k] < lowest)
            lowest = tie->block[k];
    return lowest == UINT32_MAX ? 0 : 1 + number_of_block(to, lowest);
}

/* Sorts the ties by group. at: zeros, one more than there are groups. */
static void put_order(const struct own *own, uint32_t *at, struct arrays *to)
{
    const uint32_t n_groups = to->head->n_others + 2; /* one for blocks that are no others */
    for (uint32_t i = 0; i < own->n; i++)
        at[1 + group_of_tie(to, corners_of(own->list, own->of[i]), own->block)]++;
    to->head->n_inner = at[1];
    for (uint32_t group = 0; group < n_groups; group++)
        at[group + 1] += at[group];
    for (uint32_t i = 0; i < own->n; i++)
        to->of[at[group_of_tie(to, corners_of(own->list, own->of[i]), own->block)]++] = own->of[i];
    to->head->n = own->n;
}

/* Keys of corners elsewhere: number of the other block, row there, place among the corners here. */
enum { ROW_AT = 24, OTHER_AT = 48, MOST = 1 << 24, MOST_OTHERS = 1 << 16 };

/* Writes the corners; those elsewhere are keys until put_ghosts. Returns how many these are. */
static size_t joints_ties_put_corners(const struct own *own, struct arrays *to)
{
    size_t n = 0;
    for (uint32_t i = 0; i < own->n; i++) {
        const struct flow_tie_corners *tie = corners_of(own->list, to->of[i]);
        to->held[i] = tie->held;
        for (uint32_t k = 0; k < tie->n; k++) {
            to->corner[i][k] = tie->row[k];
            to->weight[i][k] = tie->weight[k];
            if (tie->block[k] != own->block)
                own->key[n++] = (uint64_t)number_of_block(to, tie->block[k]) << OTHER_AT |
                                (uint64_t)tie->row[k] << ROW_AT | (SOLVE_TIE_CORNERS * i + k);
        }
    }
    return n;
}

/* Numbers the ghosts, by n keys, and gives the corners there their numbers. Returns false if there
 * is no room, or no such other block. */
static bool put_ghosts(struct own *own, size_t n, struct arrays *to)
{
    struct flow_tie_head *head = to->head;
    const uint64_t *key = sort_own(own, ROW_AT, n);
    uint32_t others = 0;
    for (size_t i = 0; i < n; i++) {
        const uint32_t other = (uint32_t)(key[i] >> OTHER_AT), at = key[i] & (MOST - 1);
        if (!i || key[i] >> ROW_AT != key[i - 1] >> ROW_AT) {
            if (other == head->n_others || head->n_ghosts == head->room.rows)
                return false;
            for (; others <= other; others++)
                to->start[others] = head->n_ghosts;
            to->ghost_other[head->n_ghosts] = other;
            to->ghost_row[head->n_ghosts++] = key[i] >> ROW_AT & (MOST - 1);
        }
        to->corner[at / SOLVE_TIE_CORNERS][at % SOLVE_TIE_CORNERS] =
            head->n_rows + head->n_ghosts - 1;
    }
    for (; others <= head->n_others; others++)
        to->start[others] = head->n_ghosts;
    return true;
}

/* Lists the rows that others see: they are those that have ghosts here. */
static bool put_shown(struct own *own, struct arrays *to)
{
    const uint32_t n = find_shown(own);
    uint32_t others = 0;
    if (n > to->head->room.rows)
        return false;
    for (uint32_t i = 0; i < n; i++) {
        for (; to->other[others] < own->key[i] >> 32; others++)
            to->shown_start[others + 1] = i;
        to->shown[i] = (uint32_t)own->key[i];
    }
    for (; others < to->head->n_others; others++)
        to->shown_start[others + 1] = n;
    to->head->n_shown = n;
    return true;
}

/* The rows of the block's halo and of its ties, each once. marks: zeros. */
static void put_halo(const struct flow_ties_of *of, uint64_t *marks, struct arrays *to)
{
    struct flow_tie_head *head = to->head;
    for (uint32_t i = 0; i < of->n_halo; i++)
        marks[of->halo[i] / 64] |= UINT64_C(1) << of->halo[i] % 64;
    for (uint32_t i = 0; i < head->n; i++)
        for (int k = 0; k < SOLVE_TIE_CORNERS; k++)
            if (to->corner[i][k] < of->n_rows && to->weight[i][k] != 0)
                marks[to->corner[i][k] / 64] |= UINT64_C(1) << to->corner[i][k] % 64;
    for (uint32_t row = 0; row < of->n_rows; row++)
        if (marks[row / 64] >> row % 64 & 1)
            to->halo[head->n_halo++] = row;
}

static bool fill_table(const struct flow_ties_of *of, const struct sorting *by, struct arrays *to)
{
    const struct flow_tie_room *room = &of->room;
    if (of->n_others > room->others || of->n_others >= MOST_OTHERS || of->n_rows > MOST ||
        room->ties > MOST / SOLVE_TIE_CORNERS)
        return false;
    to->head->n_others = of->n_others;
    for (uint32_t k = 0; k < of->n_others; k++) {
        to->other[k] = of->others[k][0];
        to->place[k] = of->others[k][1];
    }
    struct own own = own_in(of->list, of->block, by->keys, room->ties);
    if (!list_own(&own, room->ties))
        return false;
    if (!own.n)
        return true;
    put_order(&own, by->count, to);
    if (!put_ghosts(&own, joints_ties_put_corners(&own, to), to) || !put_shown(&own, to))
        return false;
    put_halo(of, by->marks, to);
    return true;
}

bool flow_ties_make(const struct flow_ties_of *of, void *memory)
{
    struct arrays to;
    struct sorting by;
    void *scratch = calloc(lay_sorting(of->n_rows, &of->room, NULL, &by), 1);
    lay_sorting(of->n_rows, &of->room, scratch, &by);
    memset(memory, 0, flow_ties_bytes(of->n_rows, &of->room));
    lay_ties(of->n_rows, &of->room, memory, &to);
    to.head->n_rows = of->n_rows;
    to.head->room = of->room;
    for (uint32_t i = 0; i < of->room.rows; i++)
        to.at[i] = i;
    const bool made = scratch && fill_table(of, &by, &to);
    free(scratch);
    if (!made)
        *to.head = (struct flow_tie_head){.n_rows = of->n_rows, .room = of->room};
    return made;
}

/* ---- Reading it ---- */

uint32_t flow_ties_others(const void *memory)
{
    const struct flow_tie_head *head = memory;
    return head ? head->n_others : 0;
}

struct flow_ties flow_ties_open(const void *memory)
{
    const struct flow_tie_head *head = memory;
    struct flow_ties ties = {0};
    struct arrays arrays;
    if (!head)
        return ties;
    lay_ties(head->n_rows, &head->room, (void *)memory, &arrays); /* it is only read */
    ties.head = *head;
#define OPEN(type, name, rows)         ties.name = arrays.name;
#define OPEN_CORNERS(type, name, rows) ties.name = (const type(*)[SOLVE_TIE_CORNERS])arrays.name;
    FLOW_TIE_ARRAYS(OPEN, OPEN_CORNERS)
    return ties;
}
