#ifndef DUITE_PLAN_NODE_H
#define DUITE_PLAN_NODE_H

#include "runtime/plan/plan.h"
#include "runtime/task/call.h"

#pragma GCC visibility push(hidden) /* called directly: no program can come in between */

/* A node's body and what follows, inline for those who run nodes: run.c, and the loop of workers.
 * What holds of the two is said in run.c. */

/* With a flag the number of rounds is not known beforehand. Each sink of each round takes one from
 * this, and the node that decides to stop takes the remainder. */
#define PLAN_UNKNOWN (INT64_C(1) << 62)

/* Why a node that reads poison does not run, or NULL. */
const struct data_failure *plan_node_poison(const struct plan *plan, const struct task *task);
/* Poisons, or heals, what the node writes. */
void plan_node_set_poison(struct plan *plan, const struct task *task,
                          const struct data_failure *failure);
/* What bodies find under cw. */
void plan_node_clear_leaves(const struct plan *plan, const struct task *task);
/* The body forked tasks on objects of its own and on what it read. */
void plan_node_leave_scope(struct task_scope *scope, struct worker *worker,
                           const struct data_failure *failure);
/* The node's last predecessor is over. What a message waits for is not queued behind other tasks:
 * it runs here and now. (What it makes ready is a node that sends, and tasks.) */
void plan_node_ready(struct task_graph *graph, struct worker *worker, struct task *task);
/* After the last sink of the last of so many rounds. */
void plan_replay_end(struct task_graph *graph, struct worker *worker, struct plan *plan,
                     uint64_t rounds);

/* Runs a NODE; returns whether its body ran. */
__attribute__((always_inline)) static inline bool plan_node_run_body(struct task_frame *frame,
                                                                     struct task *task)
{
    const struct plan_node *node = task->node;
    struct plan *plan = node->plan;
    atomic_store_explicit(&task->pending, node->steady, memory_order_relaxed);
    const bool tainted = atomic_load_explicit(&plan->tainted, memory_order_relaxed);
    const struct data_failure *failure = tainted ? plan_node_poison(plan, task) : NULL;
    if (!failure)
        failure = task_given_up(frame->body.graph);
    const bool runs = !failure;
    if (runs) {
        if (node->n_leaves)
            plan_node_clear_leaves(plan, task);
        struct task_scope *scope = NULL;
        frame->call.round = plan->first_round + node->round;
        failure = task_frame_call(frame, task, node->args, node->param, &scope);
        if (scope)
            plan_node_leave_scope(scope, frame->body.worker, failure);
    }
    if (failure)
        atomic_store_explicit(&plan->tainted, 1, memory_order_relaxed);
    if (tainted || failure)
        plan_node_set_poison(plan, task, failure);
    return runs;
}

typedef void plan_ready(struct task_graph *graph, struct worker *worker, struct task *task);

/* A node is over: counts its successors down; `ready` gets each for which it was the last. */
__attribute__((always_inline)) static inline void plan_node_count_down(struct task_graph *graph,
                                                                       struct worker *worker,
                                                                       struct task *task,
                                                                       plan_ready *ready)
{
    struct plan_node *node = task->node;
    struct plan *plan = node->plan;
    struct task **next = node->next, **stop = next + node->n_next;
    const uint64_t round = node->round++;
    const bool decides = task->type == TASK_NODE_FLAG;
    const bool last = plan->decides ? decides && plan->stop : round == plan->last;
    int64_t counts = node->sink && (plan->decides || last);
    if (decides && last) /* the other sinks take one a round, and so did this one until now */
        counts = PLAN_UNKNOWN - (int64_t)((round + 1) * plan->n_sinks - 1);
    task->number += plan->n_calls;
    for (next += last ? node->n_cyclic : 0; next < stop; next++) {
        _Atomic uint32_t *pending = &(*next)->pending;
        /* The last one needs no atomic subtraction: nobody else has the counter then. */
        if (atomic_load_explicit(pending, memory_order_acquire) == 1 ||
            atomic_fetch_sub_explicit(pending, 1, memory_order_acq_rel) == 1)
            ready(graph, worker, *next);
    }
    if (counts && atomic_fetch_sub_explicit(&plan->left, counts, memory_order_acq_rel) == counts)
        plan_replay_end(graph, worker, plan, plan->last + 1);
}

#pragma GCC visibility pop

#endif
