#ifndef DUITE_PLAN_MEMO_ROUND_H
#define DUITE_PLAN_MEMO_ROUND_H

#include "runtime/plan/memo.h"

/* Recognised rounds and their plans, for memo.c alone. */

/* The round with that key and so many forks, or NULL. */
struct plan_memo_round *memo_round_find(struct plan_memo *memo, uint64_t key, size_t n);
/* Records a fork before it is made. False: not recognisable, or no memory. */
bool memo_round_add(struct plan_memo *memo, const duite_kernel *kernel, const void *args, size_t n,
                    const duite_object *objects);
/* Takes over memo->record and begins to compile it, in place of the least recently used round.
 * NULL: all rounds are in use, no plan is possible, or no memory. */
struct plan_memo_round *memo_round_make(struct plan_memo *memo, uint64_t key);
/* Returns whether compiling is over; *fails: without a plan. */
bool memo_round_is_made(struct plan_memo_round *round, bool *fails);
/* Returns whether its plan is there and no replay of it goes on. */
bool memo_round_is_idle(struct plan_memo_round *round);
/* Opens a replay of an idle round; the next fork is its first. False: an object is gone, or no
 * memory. */
bool memo_round_open(struct plan_memo *memo, struct plan_memo_round *round);
/* Frees all but the gate. */
void memo_round_free(struct plan_memo_round *round, struct worker *worker);

#endif
