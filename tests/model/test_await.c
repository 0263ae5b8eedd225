/* A node that a worker awaits (runtime/plan/node.h): whoever counts it down, and whether the worker
 * that awaits it waits to the end or gives it up, each node runs once, after all that it waits for.
 *
 * Each thread is a worker at the end of a node of its own, which every successor waits for. Like
 * the workers of await.c it awaits one successor at most, and none once another one is its next.
 *
 * In two cases the successors are those of a round that may not come: they wait for one node more,
 * which decides on it, and does not run. */
#include "tests/model/runtime.h"

#include "runtime/plan/node.h"

enum { MOST = 3, LOOKS = 2 /* of a worker at what it awaits */ };

/* Workers, each with one node that is over; nodes that wait for all of these. */
static uint32_t workers, nodes;
static bool undecided; /* the nodes are those of a round that may not come */

static struct {
    struct plan plan;
    struct awaiter {
        struct task *awaited, *next;
    } worker[MOST];
    struct task *next[MOST];
    _Atomic int left[MOST]; /* what a worker's node leaves for its successors */
    int ran[MOST];
} its;

static void run(struct task *task)
{
    const size_t node =
        (size_t)((unsigned char *)task - its.plan.nodes) / PLAN_NODE_BYTES - workers;
    explore_check(++its.ran[node] == 1);
    for (uint32_t i = 0; i < workers; i++)
        explore_check(atomic_load_explicit(&its.left[i], memory_order_relaxed));
}

static void made_ready(struct task_graph *graph, struct worker *worker, struct task *task)
{
    (void)graph;
    ((struct awaiter *)(void *)worker)->next = task;
    run(task);
}

static bool awaits(struct worker *worker, struct task *task)
{
    struct awaiter *own = (struct awaiter *)(void *)worker;
    if (own->awaited || own->next || !plan_node_await(task))
        return false;
    own->awaited = task;
    return true;
}

static void worker_ends_node(uint32_t i)
{
    struct awaiter *own = &its.worker[i];
    atomic_store_explicit(&its.left[i], 1, memory_order_relaxed);
    plan_node_count_down(NULL, (struct worker *)(void *)own, plan_task(&its.plan, i), made_ready,
                         awaits);
    bool came = false;
    for (int look = 0; own->awaited && !own->next && look < LOOKS && !came; look++)
        came = plan_node_came(own->awaited);
    if (own->awaited && (came || !plan_node_give_up(own->awaited)))
        run(own->awaited);
}

static void first(void)
{
    worker_ends_node(0);
}

static void second(void)
{
    worker_ends_node(1);
}

static void third(void)
{
    worker_ends_node(2);
}

static void start(void)
{
    memset(&its, 0, sizeof its);
    atomic_init(&its.plan.last, 1); /* not the last round */
    its.plan.decides = undecided;
    its.plan.nodes = explore_alloc((workers + nodes) * PLAN_NODE_BYTES);
    for (uint32_t i = 0; i < workers + nodes; i++) {
        struct task *task = plan_task(&its.plan, i);
        task->type = TASK_NODE;
        task->node = (struct plan_node *)(void *)((unsigned char *)task + PLAN_NODE_AT);
        *task->node = (struct plan_node){.plan = &its.plan,
                                         .next = its.next,
                                         .n_next = nodes,
                                         .n_cyclic = undecided ? nodes : 0};
        atomic_init(&task->pending, workers + undecided);
        if (i >= workers)
            its.next[i - workers] = task;
    }
}

static void end(void)
{
    for (uint32_t i = 0; i < nodes; i++)
        explore_check(its.ran[i] == 1);
}

/* Counters are what the next replay finds: none is marked as awaited. */
static void end_undecided(void)
{
    for (uint32_t i = 0; i < workers; i++)
        explore_check(!its.worker[i].awaited);
    for (uint32_t i = 0; i < nodes; i++)
        explore_check(!its.ran[i] &&
                      atomic_load_explicit(&its.next[i]->pending, memory_order_relaxed) == 1);
}

static struct explore_case of(const char *name, uint32_t n_workers, uint32_t n_nodes)
{
    workers = n_workers;
    nodes = n_nodes;
    undecided = false;
    return (struct explore_case){.name = name,
                                 .start = start,
                                 .thread = {first, second, workers > 2 ? third : NULL},
                                 .end = end};
}

static struct explore_case of_undecided(const char *name, uint32_t n_nodes)
{
    struct explore_case now = of(name, 2, n_nodes);
    undecided = true;
    now.end = end_undecided;
    return now;
}

static const struct {
    struct explore_plant plant;
    const char *shows;
} plants[] = {
    {{"plan_node_await", "&task->pending", EXPLORE_RELAX},
     "a node is awaited that another one has counted down"},
    {{"plan_node_give_up", "&task->pending", EXPLORE_RELAX}, "a node is given up that has come"},
    {{"plan_node_count_down", "pending", EXPLORE_REORDER},
     "a node runs before what it waits for is there"},
};

int main(int argc, char **argv)
{
    struct explore_case now;
    explore_begin(argc, argv);
    explore_passes((now = of("two workers, a node", 2, 1), &now));
    explore_passes((now = of("two workers, two nodes", 2, 2), &now));
    explore_passes((now = of("three workers, a node", 3, 1), &now));
    explore_passes((now = of("three workers, two nodes", 3, 2), &now));
    explore_passes((now = of_undecided("two workers, a node that may not come", 1), &now));
    explore_passes((now = of_undecided("two workers, two nodes that may not come", 2), &now));
    for (size_t i = 0; i < sizeof plants / sizeof plants[0]; i++)
        explore_finds((now = of(plants[i].shows, 2, 1), &now), plants[i].plant);
    return explore_end();
}
