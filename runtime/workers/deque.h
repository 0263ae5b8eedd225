#ifndef DUITE_WORKERS_DEQUE_H
#define DUITE_WORKERS_DEQUE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

struct task;

/* A work-stealing deque: its owner pushes and takes at the new end, anybody takes at the old end,
 * nobody locks. Chase & Lev, SPAA 2005, with the fences of Lê, Pop, Cohen & Zappa Nardelli, PPoPP
 * 2013. */
struct work_ring {
    uint64_t mask;
    struct work_ring *older; /* rings that were outgrown: thieves may still read them */
    _Atomic(struct task *) slot[];
};

struct work_deque {
    _Alignas(64) _Atomic int64_t oldest; /* thieves take here */
    _Alignas(64) _Atomic int64_t newest; /* the owner pushes here: one past the last */
    _Atomic(struct work_ring *) ring;
    int64_t seen; /* by the owner: an earlier value of `oldest` */
};

/* slots: of the first ring, a power of 2. False without memory. */
bool work_deque_start(struct work_deque *deque, uint64_t slots);
void work_deque_stop(struct work_deque *deque);

/* Owner only. False without memory: nothing was pushed. */
bool work_deque_push(struct work_deque *deque, struct task *task);
/* The same for many, owner only: slots from the end on are filled, and shown to others all at once
 * with the new end. */
int64_t work_deque_end(const struct work_deque *deque);
bool work_deque_fill(struct work_deque *deque, int64_t newest, struct task *task);
void work_deque_show(struct work_deque *deque, int64_t newest);
/* Owner only. NULL if it is empty. */
struct task *work_deque_take_newest(struct work_deque *deque);
/* Anybody. NULL if it is empty or another thief was faster (*again is set then). */
struct task *work_deque_take_oldest(struct work_deque *deque, bool *again);

#endif
