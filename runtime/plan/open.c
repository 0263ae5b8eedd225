/* Open replays. The main program forks the tasks of rounds one after the other, as it would without
 * a plan, and each becomes a node's next run. The gate counts these forks. A node that waits for
 * nothing else runs if its task was forked; otherwise it is parked, and the main thread finds it
 * when it forks that task. Both sides write before they look (sequentially consistent), so one of
 * them sees the other. The node belongs to the thread that takes its number away.
 *
 * The end is a round that runs no body. A node cannot know that it has finished its last task, so
 * it always counts down its successors in the next round. Once no more tasks are forked, all nodes
 * pass the gate. Nodes of tasks that were never forked only count down. The sinks of the first
 * round with no other tasks end the replay: they know its number, since they come after the gate
 * was opened.
 *
 * A worker that parks a node looks at the gate once more, when the replay may be over. So gates
 * outlive plans. Numbers of tasks are never used twice, so the worker takes away only its own. */
#include "runtime/plan/node.h"

#include "runtime/base/memory.h"

bool plan_passes(struct plan *plan, struct task *task)
{
    struct plan_gate *gate = plan->gate;
    uint64_t number = task->number;
    const uint64_t forked = atomic_load_explicit(&gate->forked, memory_order_acquire);
    atomic_store_explicit(&gate->seen, forked, memory_order_release);
    if (number < forked)
        return true;
    _Atomic uint64_t *place = &gate->parked[plan_node_number(task)];
    atomic_store_explicit(place, number, memory_order_seq_cst);
    return number < atomic_load_explicit(&gate->forked, memory_order_seq_cst) &&
           atomic_compare_exchange_strong_explicit(place, &number, 0, memory_order_acq_rel,
                                                   memory_order_relaxed);
}

/* Checks the number: the node may meanwhile have been taken, run, and parked for its next task. */
void plan_unpark(struct plan *plan, struct worker *worker, uint32_t i, uint64_t number)
{
    struct task *task = plan_task(plan, i);
    if (!atomic_compare_exchange_strong_explicit(&plan->gate->parked[i], &number, 0,
                                                 memory_order_acq_rel, memory_order_relaxed))
        return;
    plan_node_renumber(plan, task);
    plan_node_ready(plan->graph, worker, task);
}

void plan_gate_close(struct plan *plan, struct plan_gate *gate, uint64_t first)
{
    plan->gate = gate;
    atomic_store_explicit(&plan->last, UINT64_MAX, memory_order_relaxed);
    atomic_store_explicit(&plan->unforked, UINT64_MAX, memory_order_relaxed);
    atomic_store_explicit(&plan->tainted, 0, memory_order_relaxed);
    atomic_store_explicit(&gate->seen, first, memory_order_relaxed);
    atomic_store_explicit(&gate->forked, first, memory_order_relaxed);
}

void plan_replay_close(struct plan *plan, struct worker *worker, uint64_t first)
{
    struct plan_gate *gate = plan->gate;
    const uint64_t end = plan->graph->root.forks + 1;
    const uint64_t rounds = (end - first + plan->n_calls - 1) / plan->n_calls;
    const uint32_t n = (uint32_t)plan->n_nodes;
    plan->graph->tasks++;
    atomic_store_explicit(&plan->unforked, end, memory_order_relaxed);
    atomic_store_explicit(&plan->last, rounds, memory_order_relaxed);
    atomic_fetch_or_explicit(&plan->tainted, PLAN_CLOSED, memory_order_relaxed);
    atomic_exchange_explicit(&gate->forked, UINT64_MAX, memory_order_seq_cst);
    for (uint32_t i = 0; i < n; i++) {
        const uint64_t number = atomic_load_explicit(&gate->parked[i], memory_order_seq_cst);
        if (number)
            plan_unpark(plan, worker, i, number);
    }
}

bool plan_ring(struct plan *plan, size_t rounds, size_t stride)
{
    unsigned char *ring = base_alloc(rounds * stride);
    if (!ring)
        return false;
    for (size_t i = 0; i < plan->n_nodes; i++) {
        struct plan_node *node = plan_task(plan, i)->node;
        if (node->args)
            node->args = ring + ((unsigned char *)node->args - plan->args);
    }
    base_free(plan->args);
    plan->args = ring;
    plan->ring_mask = rounds - 1;
    plan->stride = stride;
    return true;
}

uint64_t plan_rounds_over(const struct plan *plan)
{
    uint64_t least = UINT64_MAX;
    if (atomic_load_explicit(&plan->begun, memory_order_acquire) != plan->started)
        return 0;
    for (size_t i = 0; i < plan->n_nodes; i++) {
        const struct plan_node *node = plan_task(plan, i)->node;
        const uint64_t rounds = atomic_load_explicit(&node->round, memory_order_acquire);
        if (node->args && rounds < least)
            least = rounds;
    }
    return least;
}

bool plan_is_over(const struct plan *plan)
{
    return atomic_load_explicit(&plan->over, memory_order_acquire) == plan->started;
}
