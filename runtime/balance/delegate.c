/* delegate: an idle rank requests tasks of one other, the one that granted last or a random one,
 * and waits ever longer before its next request. The granter grants up to half of its ready tasks,
 * and only those that cost more than their transfer. It keeps half, because it works on meanwhile,
 * and the last ready task, since its own worker takes it next. It grants one task with a subtree of
 * unknown size, the oldest: that is nearest to the root, so probably the largest. A rank that got
 * too much grants in turn. After Blumofe & Leiserson (1999), with half of a queue instead of one
 * task: Hendler & Shavit, Non-blocking steal-half work queues, PODC 2002. */
#include "runtime/balance/balance.h"

/* Seconds that a request stands: the first, and the longest. */
#define FIRST_SECONDS   5e-4
#define LONGEST_SECONDS 5e-2

static int delegate_victim(void *state, unsigned attempt, int granter, double *seconds)
{
    struct balance_chance *own = state;
    double pause = FIRST_SECONDS;
    for (unsigned i = 0; i < attempt && pause < LONGEST_SECONDS; i++)
        pause *= 2;
    *seconds = pause < LONGEST_SECONDS ? pause : LONGEST_SECONDS;
    if (own->n_ranks == 1)
        return DUITE_NO_RANK;
    if (!attempt && granter != DUITE_NO_RANK)
        return granter;
    return (own->rank + 1 + balance_draw(own, own->n_ranks - 1)) % own->n_ranks;
}

static int delegate_grant(void *state, const duite_request *request, const duite_leaf *leaf)
{
    const bool has_more = request->granted < request->ready / 2;
    (void)state;
    if (leaf->forks && leaf->cost <= 0)
        return has_more && !request->granted;
    return has_more && !request->unknown && leaf->cost > leaf->transfer;
}

const duite_balancer balance_delegate = {
    .name = "delegate",
    .summary = "idle ranks get ready tasks that cost more than their transfer",
    .state_size = sizeof(struct balance_chance),
    .start = balance_start_chance,
    .victim = delegate_victim,
    .grant = delegate_grant,
};
