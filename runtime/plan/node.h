#ifndef DUITE_PLAN_NODE_H
#define DUITE_PLAN_NODE_H

#include "runtime/plan/plan.h"
#include "runtime/task/call.h"
#include "runtime/task/event.h"

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* A node's body and its end, inline in run.c and in the workers' loop. run.c states their
 * invariants. */

/* With a flag the number of rounds is not known beforehand. Each sink of each round takes one from
 * this; the node that decides to stop takes the remainder. */
#define PLAN_UNKNOWN (INT64_C(1) << 62)

/* The failure that keeps a node from running because it reads poison, or NULL. */
const struct data_failure *plan_node_poison(const struct plan *plan, const struct task *task);
/* Poisons the places that the node writes, or heals them (NULL). */
void plan_node_set_poison(struct plan *plan, const struct task *task,
                          const struct data_failure *failure);
/* Writes the neutral elements that bodies find under cw. */
void plan_node_clear_leaves(const struct plan *plan, const struct task *task);
/* The body forked tasks on its own objects and on its parameters. Not inline: it is rare. */
void plan_node_leave_scope(struct task_scope *scope, struct worker *worker,
                           const struct data_failure *failure);
/* The node's last predecessor is over. A node that a message waits for runs at once, never queued
 * behind other tasks. (It makes ready a node that sends, and tasks.) */
void plan_node_ready(struct task_graph *graph, struct worker *worker, struct task *task);
/* Called after the last sink of the last of so many rounds. */
void plan_replay_end(struct task_graph *graph, struct worker *worker, struct plan *plan,
                     uint64_t rounds);

static inline void plan_taint(struct plan *plan, uint32_t bit)
{
    if (!(atomic_load_explicit(&plan->tainted, memory_order_relaxed) & bit))
        atomic_fetch_or_explicit(&plan->tainted, bit, memory_order_relaxed);
}

/* The task of an open replay was never forked, or the replay had no memory. */
static inline bool plan_node_is_void(const struct plan *plan, const struct task *task,
                                     uint32_t taint)
{
    return taint & PLAN_STARVED ||
           task->number >= atomic_load_explicit(&plan->unforked, memory_order_relaxed);
}

/* The arguments of its current round. */
static inline const void *plan_node_args(const struct plan *plan, const struct plan_node *node)
{
    const unsigned char *args = node->args;
    if (!plan->ring_mask || !args)
        return args;
    const uint64_t round = atomic_load_explicit(&node->round, memory_order_relaxed);
    return args + (round & plan->ring_mask) * plan->stride;
}

/* The round as bodies see it; bodies of an open replay know of no replay. */
static inline uint64_t plan_node_round(const struct plan *plan, const struct plan_node *node)
{
    if (plan->gate)
        return 0;
    return plan->first_round + atomic_load_explicit(&node->round, memory_order_relaxed);
}

/* A node whose task was never forked takes the number of the first task after the replay. So
 * task_may_run lets each later body run it on top while it waits; it has no body of its own that
 * could wait. */
static inline void plan_node_renumber(const struct plan *plan, struct task *task)
{
    const uint64_t end = atomic_load_explicit(&plan->unforked, memory_order_relaxed);
    if (task->number > end)
        task->number = end;
}

/* Returns whether a node that waits for nothing else may run. False: it no longer belongs to the
 * caller. */
static inline bool plan_node_may_run(struct plan *plan, struct task *task)
{
    if (!plan->gate)
        return true;
    if (task->number >= atomic_load_explicit(&plan->gate->seen, memory_order_acquire) &&
        !plan_passes(plan, task))
        return false;
    plan_node_renumber(plan, task);
    return true;
}

/* Runs a NODE; returns whether its body ran. */
__attribute__((always_inline)) static inline bool plan_node_run_body(struct task_frame *frame,
                                                                     struct task *task)
{
    const struct plan_node *node = task->node;
    struct plan *plan = node->plan;
    atomic_store_explicit(&task->pending, node->steady, memory_order_relaxed);
    const uint32_t taint = atomic_load_explicit(&plan->tainted, memory_order_relaxed);
    const struct data_failure *failure = NULL;
    if (__builtin_expect(taint || task_has_given_up(frame->body.graph), 0)) {
        if (taint > PLAN_POISONED && plan_node_is_void(plan, task, taint))
            return false;
        if (taint & PLAN_POISONED)
            failure = plan_node_poison(plan, task);
        if (!failure)
            failure = task_given_up(frame->body.graph);
    }
    const bool runs = !failure;
    if (runs) {
        if (node->n_leaves)
            plan_node_clear_leaves(plan, task);
        struct task_scope *scope = NULL;
        frame->call.round = plan_node_round(plan, node);
        failure = task_frame_call(frame, task, plan_node_args(plan, node), node->param, &scope);
        if (scope)
            plan_node_leave_scope(scope, frame->body.worker, failure);
    }
    if (failure)
        plan_taint(plan, PLAN_POISONED);
    if (failure && task->state == TASK_HELD)
        task_held_fail(frame->body.held, failure);
    if (taint & PLAN_POISONED || failure)
        plan_node_set_poison(plan, task, failure);
    return runs;
}

/* A worker that counts down a node with one more predecessor to come may await it. That predecessor
 * then leaves the node alone, and the worker runs it once nothing is missing, or gives it up
 * before. Meanwhile the replay cannot end, since the node is certain to run. */
#define PLAN_AWAITED (UINT32_C(1) << 31) /* in `pending` */

static inline bool plan_node_await(struct task *task)
{
    uint32_t pending = 2;
    return atomic_compare_exchange_strong_explicit(&task->pending, &pending, PLAN_AWAITED + 1,
                                                   memory_order_acq_rel, memory_order_relaxed);
}

/* Returns whether nothing is missing any more. */
static inline bool plan_node_came(struct task *task)
{
    return atomic_load_explicit(&task->pending, memory_order_acquire) == PLAN_AWAITED;
}

/* False: nothing is missing, and the node is the worker's. */
static inline bool plan_node_give_up(struct task *task)
{
    uint32_t pending = PLAN_AWAITED + 1;
    return atomic_compare_exchange_strong_explicit(&task->pending, &pending, 1,
                                                   memory_order_acq_rel, memory_order_acquire);
}

typedef void plan_ready(struct task_graph *graph, struct worker *worker, struct task *task);
typedef bool plan_awaits(struct worker *worker, struct task *task);

/* A node is over: counts its successors down; `ready` gets each that waits for nothing else.
 * `awaits` (or NULL) gets each with one more predecessor to come, and returns whether it is awaited
 * now. Never await nodes of a round that a flag may cancel: they do not keep the replay from its
 * end. */
__attribute__((always_inline)) static inline void
plan_node_count_down(struct task_graph *graph, struct worker *worker, struct task *task,
                     plan_ready *ready, plan_awaits *awaits)
{
    struct plan_node *node = task->node;
    struct plan *plan = node->plan;
    struct task **next = node->next, **stop = next + node->n_next;
    struct task **certain = next + (plan->decides ? node->n_cyclic : 0);
    const uint64_t round = atomic_load_explicit(&node->round, memory_order_relaxed);
    const uint64_t end = atomic_load_explicit(&plan->last, memory_order_relaxed);
    const bool decides = task->type == TASK_NODE_FLAG;
    const bool last = plan->decides ? decides && plan->stop : round == end;
    int64_t counts = node->sink && (plan->decides || last);
    if (decides && last) /* each sink, this one included, has taken one a round until now */
        counts = PLAN_UNKNOWN - (int64_t)((round + 1) * plan->n_sinks - 1);
    if (plan->gate && task->number < atomic_load_explicit(&plan->unforked, memory_order_relaxed))
        queue_over(graph->pool, worker); /* a task that was forked */
    atomic_store_explicit(&node->round, round + 1, memory_order_release);
    task->number += plan->n_calls;
    for (next += last ? node->n_cyclic : 0; next < stop; next++) {
        _Atomic uint32_t *pending = &(*next)->pending;
        const uint32_t before = atomic_load_explicit(pending, memory_order_acquire);
        if (awaits && before == 2 && next >= certain && awaits(worker, *next))
            continue;
        /* The last one needs no atomic subtraction: no other predecessor has the counter then. */
        const bool was_last =
            before == 1 || atomic_fetch_sub_explicit(pending, 1, memory_order_acq_rel) == 1;
        if (was_last && plan_node_may_run(plan, *next))
            ready(graph, worker, *next);
    }
    if (counts && atomic_fetch_sub_explicit(&plan->left, counts, memory_order_acq_rel) == counts)
        plan_replay_end(graph, worker, plan,
                        atomic_load_explicit(&plan->last, memory_order_relaxed) + 1);
}

#pragma GCC visibility pop

#endif
