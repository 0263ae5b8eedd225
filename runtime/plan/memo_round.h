#ifndef DUITE_PLAN_MEMO_ROUND_H
#define DUITE_PLAN_MEMO_ROUND_H

#include "runtime/plan/memo.h"

/* Rounds that were recognised, and their plans: of memo.c alone. */

/* The round of that key and so many forks; or NULL. */
struct plan_memo_round *memo_round_find(struct plan_memo *memo, uint64_t key, size_t n);
/* Records a fork that is about to be made. False: it is none for a plan, or there is no memory. */
bool memo_round_add(struct plan_memo *memo, const duite_kernel *kernel, const void *args, size_t n,
                    const duite_object *objects);
/* Begins to compile memo->record, which is not memo's any more, in place of the round that was used
 * longest ago. NULL: there is none for it, or no memory. */
struct plan_memo_round *memo_round_make(struct plan_memo *memo, uint64_t key);
/* Whether its plan is there, or never will be: *fails. */
bool memo_round_is_made(struct plan_memo_round *round, bool *fails);
/* It is made, and no replay of it goes on. */
bool memo_round_is_idle(struct plan_memo_round *round);
/* Opens a replay of one that is idle; the next fork is its first. False: without memory. */
bool memo_round_open(struct plan_memo *memo, struct plan_memo_round *round);
/* All but its gate. */
void memo_round_free(struct plan_memo_round *round, struct worker *worker);

#endif
