#ifndef CLOTH_FLOW_JOINTS_TIES_H
#define CLOTH_FLOW_JOINTS_TIES_H

#include "cloth/solve/block.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Ties join rows for some steps only. They are in no table of a block, and so in no partition, halo
 * or matrix that the run began with. A tie has up to four corners, rows with weights, in up to four
 * blocks. Every block with a corner knows the whole tie, and computes its own corners. Timed joints
 * are ties of two corners with the weights 1 and -1, joints that end on edges ties of three with
 * the weights 1, w - 1 and -w. Every rank knows them all.
 *
 * Before a step begins, the main program has a small record of each block: its number of ties, and
 * the number of rows that it shows to each other block. From the records of all blocks it finds the
 * room of each block and the places of the rows that others show it (flow_ties_adopt). Then each
 * block makes a table of its own ties.
 *
 * A block has room for a multiple of FLOW_TIE_CLASS ties, and as many rows that it shows or that
 * others show it. Values lie behind those of its matrix, z and p of the ghosts behind those of its
 * other ghosts. Others read two objects: x and v of the rows shown, and s of the solve. These are
 * made again if the room of a block changes. The round of the solve is recorded again if a room
 * changes, or other blocks share ties than before. Otherwise ties may change in every step. */
enum { FLOW_TIE_CLASS = 128, FLOW_TIE_OTHERS = 8 };

/* The corners of a tie, each a row of a block. */
struct flow_tie_corners {
    uint32_t n; /* 1 .. SOLVE_TIE_CORNERS; 0: there is no tie */
    uint32_t block[SOLVE_TIE_CORNERS], row[SOLVE_TIE_CORNERS];
    unsigned char held; /* bit k: a pin holds corner k */
    double weight[SOLVE_TIE_CORNERS];
};

/* A joint that is no spring of the tables: one that comes or goes while the run is on, or that ends
 * on an edge. */
struct flow_tie {
    struct flow_tie_corners at;        /* weights sum to 0 */
    uint32_t piece[SOLVE_TIE_CORNERS]; /* of free pieces, from 1; 0: none (flow_particles) */
    double stiffness, damping, length; /* N/m, kg/s, m: those of a spring */
    uint64_t begin, end;               /* ticks: steps that begin from .. to - 1 have it */
};

static inline bool flow_tie_acts(const struct flow_tie *tie, uint64_t tick)
{
    return tie->begin <= tick && tick < tie->end;
}

/* A list of ties, among them those of one block: n_joints joints, of which those that act at the
 * tick count, then n others. A tie's number in the list is its place among all of them. */
struct flow_tie_list {
    uint32_t n_joints, n;
    const struct flow_tie *joint; /* n_joints */
    uint64_t tick;
    const struct flow_tie_corners *const *corners; /* n */
};

/* ---- Records ---- */

/* The record of a block's ties: its ties, the rows of others that they end at, the rows that it
 * shows, the links that follow. */
struct flow_tie_record {
    uint32_t n_ties, n_ghosts, n_shown, n_links;
};

/* The number of rows that the block shows to another one. Links go both ways; both may show none.
 */
struct flow_tie_link {
    uint32_t block, rows;
};

/* Room that a record takes while it is made of a list of so many ties: numbers of eight bytes. */
static inline size_t flow_ties_scratch(size_t ties)
{
    return 9 * ties;
}

/* Makes the record of a block, with its links, ascending. scratch: for as many ties as the list
 * has. Returns false if there are more than max_links. Local. */
bool flow_ties_count(const struct flow_tie_list *list, uint32_t block, uint64_t *scratch,
                     uint32_t max_links, struct flow_tie_record *record,
                     struct flow_tie_link *link);

/* ---- The table of a block ---- */

struct flow_tie_room {
    uint32_t ties, rows, others; /* rows: of ghosts, and of rows shown */
};

/* clang-format off */
/* The arrays of a table, in the order of its memory: X(type, name, rows), CORNERS(type, name, rows) of
 * a number for each corner. room: its room; n_rows: of the block. */
#define FLOW_TIE_ARRAYS(X, CORNERS)                                                                \
    X(uint32_t, other, room->others)       /* n_others: blocks, ascending */                       \
    X(uint32_t, start, room->others + 1)   /* n_others + 1: ghosts of block k are start[k] .. */   \
    X(uint32_t, place, room->others)       /* n_others: where that block shows the first of them */ \
    X(uint32_t, shown_start, room->others + 1) /* n_others + 1: rows shown to block k are shown_start[k] .. */ \
    X(uint32_t, ghost_other, room->rows)   /* n_ghosts: which of the others a ghost is of, */      \
    X(uint32_t, ghost_row, room->rows)     /* n_ghosts: its row there */                           \
    X(uint32_t, shown, room->rows)         /* n_shown: rows that others see, block after block */  \
    X(uint32_t, at, room->rows)            /* room.rows: 0, 1, .. */                               \
    X(uint32_t, of, room->ties)            /* n: numbers in the list */                            \
    CORNERS(uint32_t, corner, room->ties)  /* n */                                                 \
    CORNERS(double, weight, room->ties)    /* n */                                                 \
    X(unsigned char, held, room->ties)     /* n: bit k: a pin holds corner k */                    \
    X(uint32_t, halo, room->ties ? n_rows : 0) /* n_halo: rows of the block's halo and of ties, ascending */
/* clang-format on */

/* The ties of one block: inner ones, whose corners are all in the block, then the others, by their
 * lowest other block. Both are in the order of the list. Corners are rows of the block or, from
 * n_rows on, ghosts: rows of other blocks, each once, by block and row. Missing corners are row 0
 * with the weight 0. The block shows each other block the rows that are corners of ties of both,
 * ascending: they are the ghosts there, in this order. Arrays lie in the memory of the table,
 * behind its head. */
#define FLOW_TIE_HEAD                                                                              \
    uint32_t n_inner, n, n_rows, n_ghosts, n_shown, n_others, n_halo;                              \
    struct flow_tie_room room;
struct flow_tie_head {
    FLOW_TIE_HEAD
};
struct flow_ties {
    union { /* by name, or all of it */
        struct flow_tie_head head;
        struct {
            FLOW_TIE_HEAD
        };
    };
#define FLOW_TIE_MEMBER(type, name, rows)  const type *name;
#define FLOW_TIE_CORNERS(type, name, rows) const type(*name)[SOLVE_TIE_CORNERS];
    FLOW_TIE_ARRAYS(FLOW_TIE_MEMBER, FLOW_TIE_CORNERS)
};

/* The input of a table. */
struct flow_ties_of {
    uint32_t block, n_rows, n_halo, n_others;
    const uint32_t *halo;        /* n_halo: that of the block, ascending */
    const uint32_t (*others)[2]; /* n_others: block, ascending; place (flow_ties) */
    const struct flow_tie_list *list;
    struct flow_tie_room room;
};

/* Bytes of the table of a block of so many rows. */
size_t flow_ties_bytes(uint32_t n_rows, const struct flow_tie_room *room);

/* Makes the table. Writes every byte. Returns false without memory, if the room does not do, or if
 * a tie leads to a block that is none of the others: the table has no ties then. Local. */
bool flow_ties_make(const struct flow_ties_of *of, void *memory);

/* Rows of an object that has the rows shown: at least one. */
static inline size_t flow_ties_rows(const struct flow_ties *ties)
{
    return ties->room.rows ? ties->room.rows : 1;
}

/* Finds the arrays of a table. NULL: there are no ties. */
struct flow_ties flow_ties_open(const void *memory);

/* The number of blocks that it shares ties with. */
uint32_t flow_ties_others(const void *memory);

#endif
