#ifndef CLOTH_FLOW_STATE_TIES_H
#define CLOTH_FLOW_STATE_TIES_H

#include "cloth/physics/spring.h"
#include "cloth/solve/block.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Ties: what joins rows for some steps only, springs of the scene that come or go while the run is
 * on. They are in no table of a block, and so in no partition, halo or matrix that the run began
 * with. Every rank knows all ties. Before a step begins, the main program finds the ties of the
 * step (flow_ties_choose). Where they change, each block makes a table of its own ties. A tie
 * between two blocks is known to both, and each computes its own end.
 *
 * A block has room for a multiple of FLOW_TIE_CLASS ties. Values lie behind those of its matrix, z
 * and p of the other ends behind those of its ghosts. Others read two objects: x and v of its ends,
 * and s of the solve. Where the room of a block changes, these objects are made again. Where it
 * does, or where other blocks share ties than before, the round of the solve is recorded again.
 * Otherwise ties may change in every step. */
enum { FLOW_TIE_CLASS = 128 };

/* A tie, as every rank knows it. */
struct flow_tie {
    uint32_t block[2], row[2];
    unsigned char held[2];             /* a pin holds that end */
    uint32_t piece[2];                 /* of free pieces, from 1; 0: none (flow_particles) */
    double stiffness, damping, length; /* N/m, kg/s, m: those of a spring */
    uint64_t begin, end;               /* ticks: steps that begin from .. to - 1 have it */
};

static inline bool flow_tie_acts(const struct flow_tie *tie, uint64_t tick)
{
    return tie->begin <= tick && tick < tie->end;
}

/* The ties of one block: inner ones, then those that end in other blocks, block after block; in
 * both the order of all ties. Where both ends of a tie list it, they find the other's row in its
 * place among those that the two share. Arrays lie in the memory of the table. */
struct flow_ties {
    uint32_t n_inner, n, n_others, n_halo;
    uint32_t room;             /* for so many */
    const uint32_t *other;     /* n_others: blocks, ascending */
    const uint32_t *start;     /* n_others + 1: those into block k are n_inner + start[k] .. */
    const uint32_t *place;     /* n_others: where that block shows the first of their other ends */
    const uint32_t (*end)[2];  /* n: rows; of those into other blocks: row, number in the block */
    const uint32_t *far;       /* n - n_inner: the row there */
    const uint32_t *at;        /* room: 0, 1, .. */
    const uint32_t *halo;      /* n_halo: rows of the block's halo and those of ties, ascending */
    const unsigned char *held; /* n: bit k: a pin holds end k */
    const double *stiffness, *damping, *length;
};

/* Bytes of the table of a block with so many rows in its halo, and room for so many ties. */
size_t flow_ties_bytes(uint32_t n_halo, uint32_t room);

/* Makes the table of a block, of those of n ties that act at the tick. halo: that of the block.
 * Writes every byte. Local. */
struct flow_ties_of {
    uint32_t block, room;
    uint64_t tick;
    uint32_t n, n_halo;
    const struct flow_tie *tie; /* n */
    const uint32_t *halo;       /* n_halo */
};
void flow_ties_make(const struct flow_ties_of *of, void *memory);

/* Finds the arrays of a table. NULL: there are no ties. */
struct flow_ties flow_ties_open(const void *memory);

/* How many blocks it shares ties with. */
uint32_t flow_ties_others(const void *memory);

/* Ties from .. to - 1 as springs. Where there are none there may be no arrays to point into. */
static inline struct phys_springs flow_ties_springs(const struct flow_ties *ties, uint32_t from,
                                                    uint32_t to)
{
    if (from == to)
        return (struct phys_springs){0};
    return (struct phys_springs){to - from,
                                 ties->end + from,
                                 ties->stiffness + from,
                                 ties->damping + from,
                                 ties->length + from,
                                 0};
}

/* Those into the k-th other block. */
static inline struct phys_springs flow_ties_into(const struct flow_ties *ties, uint32_t k)
{
    return flow_ties_springs(ties, ties->n_inner + ties->start[k],
                             ties->n_inner + ties->start[k + 1]);
}

#endif
