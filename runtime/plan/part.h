#ifndef DUITE_PLAN_PART_H
#define DUITE_PLAN_PART_H

#include "runtime/plan/passes.h"

/* The pass that makes the part of a rank, between its two files (part.c, part_sums.c). */

/* The arrays are one block of part.c. */
struct plan_parting {
    const struct plan_messages *m;
    const struct plan_assignment *a;
    const struct plan_round *round; /* of all ranks */
    struct plan_round *part;
    uint32_t *replica;   /* by version: the buffer that receives it */
    uint32_t *arrival;   /* by piece: likewise */
    uint32_t *place;     /* by item: its place when its message goes, or comes */
    uint32_t *leaf;      /* by buffer of the round, less n_objects: its place here, plus 1; or 0 */
    plan_moment *spoilt; /* by version: when the rank overwrites it */
    uint32_t *own;       /* by object: the version in its own place, while `spoilt` is found */
    size_t next_item;    /* the first that is not made yet */
    plan_moment next;    /* when it is made, or the next message goes */
    uint32_t *order;     /* messages to send, by the moment they are ready */
    size_t n_sends, next_send;
    struct data_subtrees row;                 /* of a node; where: the parameter */
    struct data_subtrees state, joined, came; /* this rank's of the present sum; where: the place */
    uint32_t *param; /* by place: its parameter in the PARTIAL that joins, or PLAN_NONE */
};

static inline bool plan_part_sends(const struct plan_parting *p, uint32_t message)
{
    return p->m->message[message].from == p->m->rank;
}

/* The place of a buffer of the round here. */
uint32_t plan_part_leaf(struct plan_parting *p, uint32_t place);
/* The place of a piece of this rank: the buffer of its first leaf. */
uint32_t plan_part_piece(struct plan_parting *p, const struct plan_piece *piece);

/* At this moment: finds the places of items just made, and sends the messages that are ready. */
void plan_part_moment(struct plan_parting *p, plan_moment now, size_t fork);

/* Everything before the sum at node n: this rank's pieces, and the rounds of the relay. */
void plan_part_before_sum(struct plan_parting *p, size_t n);
/* Adds all leaves of the sum to the object. */
void plan_part_sum(struct plan_parting *p, size_t n);

#endif
