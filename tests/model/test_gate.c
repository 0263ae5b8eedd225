/* The gate of an open replay (runtime/plan/open.c): a node runs each of its tasks once, in order,
 * none before the main program forked it, and none is forgotten, whoever comes first; after the
 * close each node passes once more, without a task. Then it has the number of the first task after
 * the replay, so that any body forked later may run it while it waits (task_may_run). A gate is
 * used again by the next replay, while nobody is left in the one before.
 *
 * Nodes wait for nothing else here: whoever has one runs it again and again, until it is parked. A
 * node that the main thread finds there runs at once, on the main thread. */
#include "tests/model/runtime.h"

#define plan_node_ready made_ready
#include "runtime/plan/node.h"

#include "runtime/plan/open.c"

enum { NODES = 2, ROUNDS = 2, TASKS = NODES * ROUNDS };

/* How many tasks the main program forks before it closes. */
static uint64_t forks;

static struct {
    struct task_graph graph;
    struct plan plan;
    struct plan_node node; /* of all tasks */
    struct plan_gate gate;
    _Atomic int argument[TASKS]; /* what the main program leaves for a body */
    int ran[TASKS], voids[NODES];
} its;

/* The node's task with this number, from 1. */
static void run(uint32_t node, uint64_t number)
{
    if (number > forks) {
        explore_check(number == forks + 1);
        explore_check(++its.voids[node] == 1);
        return;
    }
    explore_check(++its.ran[number - 1] == 1);
    explore_check(atomic_load_explicit(&its.argument[number - 1], memory_order_relaxed));
    explore_check(number <= NODES || its.ran[number - 1 - NODES]);
}

/* The holder of the node goes on with it. */
static void go_on(uint32_t node, struct task *task)
{
    bool mine = true;
    while (mine) {
        run(node, task->number);
        if (its.voids[node])
            return;
        task->number += NODES;
        mine = plan_node_may_run(&its.plan, task);
    }
}

void made_ready(struct task_graph *graph, struct worker *worker, struct task *task)
{
    (void)graph;
    (void)worker;
    go_on((uint32_t)plan_node_number(task), task);
}

static void start(void)
{
    memset(&its, 0, sizeof its);
    its.plan.graph = &its.graph;
    its.plan.n_nodes = its.plan.n_calls = NODES;
    its.plan.nodes = explore_alloc(NODES * PLAN_NODE_BYTES);
    its.node.plan = &its.plan;
    for (uint32_t i = 0; i < NODES; i++) {
        plan_task(&its.plan, i)->number = i + 1;
        plan_task(&its.plan, i)->node = &its.node;
    }
    plan_gate_close(&its.plan, &its.gate, 1);
}

/* The main program; then it closes. */
static void main_forks(void)
{
    for (uint64_t i = 0; i < forks; i++) {
        atomic_store_explicit(&its.argument[i], 1, memory_order_relaxed);
        plan_forked(&its.plan, NULL, (uint32_t)(i % NODES));
    }
    plan_replay_close(&its.plan, NULL, 1);
}

/* A worker has the node, which waits for nothing but its fork. */
static void worker_has(uint32_t node)
{
    struct task *task = plan_task(&its.plan, node);
    if (plan_node_may_run(&its.plan, task))
        go_on(node, task);
}

static void first_node(void)
{
    worker_has(0);
}

static void second_node(void)
{
    worker_has(1);
}

static void end(void)
{
    for (uint64_t i = 0; i < TASKS; i++)
        explore_check(its.ran[i] == (i < forks));
    for (uint32_t i = 0; i < NODES; i++)
        explore_check(its.voids[i] == 1 && !its.gate.parked[i]);
}

static struct explore_case of(const char *name, uint64_t n)
{
    forks = n;
    return (struct explore_case){
        .name = name, .start = start, .thread = {main_forks, first_node, second_node}, .end = end};
}

static const struct {
    struct explore_plant plant;
    const char *shows;
} plants[] = {
    {{"plan_passes", "place", EXPLORE_RELAX},
     "a node is parked late, and its fork does not see it"},
    {{"plan_forked", "&plan->gate->forked", EXPLORE_RELAX},
     "a task runs before its arguments are there"},
    {{"plan_replay_close", "&gate->forked", EXPLORE_RELAX},
     "the close is shown late, and a parked node is left"},
    {{"plan_unpark", "&plan->gate->parked[i]", EXPLORE_RELAX}, "a node is run twice"},
};

int main(int argc, char **argv)
{
    struct explore_case now;
    explore_begin(argc, argv);
    explore_passes((now = of("nothing is forked", 0), &now));
    explore_passes((now = of("half a round", 1), &now));
    explore_passes((now = of("a round", 2), &now));
    now = of("two rounds, some orders", 4);
    now.max = 20000;
    now.max_deep = 2000000;
    explore_passes(&now);
    if (explore_deep())
        explore_passes((now = of("a round and a half", 3), &now));
    for (size_t i = 0; i < sizeof plants / sizeof plants[0]; i++)
        explore_finds((now = of(plants[i].shows, 2), &now), plants[i].plant);
    return explore_end();
}
