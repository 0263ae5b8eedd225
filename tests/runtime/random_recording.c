/* Calls on graphs: what is recorded stands in the program behind the call that records it. */

#include "tests/runtime/random_run.h"

static int build(duite *rt, void *context)
{
    struct run_graph *graph = context;
    struct run *run = graph->run;
    const struct prog_op *from = &run->prog->ops[graph->again];

    (void)rt; /* it is the run's */
    graph->first = graph->again;
    for (size_t i = 1; i <= from->n; i++) {
        const struct prog_op *op = &from[i];

        if (op->kind == PROG_GRAPH_SET)
            prog_call_set(&run->main, op);
        else if (op->kind == PROG_GRAPH_FORK)
            prog_call_fork(&run->main, op);
    }
    return 0;
}

static int change_args(struct run *run, struct run_graph *graph, const struct prog_op *op)
{
    struct prog_op target = run->prog->ops[op->count];
    struct prog_args args;
    size_t k = 0;

    if (target.kind != PROG_GRAPH_FORK || op->count <= graph->first ||
        op->count > graph->first + run->prog->ops[graph->first].n)
        return DUITE_OK;
    for (size_t i = graph->first + 1; i < op->count; i++)
        k += run->prog->ops[i].kind == PROG_GRAPH_FORK;
    target.seed = op->seed;
    target.fails = op->fails;
    prog_args_fill(run->prog, &target, run->main.shape, &args);
    return duite_graph_args(run->main.rt, graph->name, k, &args);
}

static void rounds(struct run *run, const struct run_graph *graph, uint64_t expected)
{
    uint64_t n = 0;

    prog_expect_code(run, "rounds", duite_graph_rounds(run->main.rt, graph->name, &n), DUITE_OK);
    if (n != expected)
        prog_found(run, "%llu rounds, expected %llu", (unsigned long long)n,
                   (unsigned long long)expected);
}

void prog_call_graph(struct run *run, const struct prog_op *op, const struct prog_expect *answer)
{
    struct run_graph *graph = &run->graph[op->graph];
    const duite_object object = run->main.name[op->object];
    int code = DUITE_OK;

    if (op->kind == PROG_GRAPH) {
        *graph = (struct run_graph){.run = run, .alive = 1, .again = (size_t)(op - run->prog->ops)};
        code = duite_graph_new(run->main.rt, build, graph, &graph->name);
    }
    if (!graph->alive)
        return;
    if (op->kind == PROG_GRAPH_AGAIN) {
        graph->again = (size_t)(op - run->prog->ops);
    } else if (op->kind == PROG_REPLAY) {
        code = duite_replay(run->main.rt, graph->name, op->count);
    } else if (op->kind == PROG_REPLAY_WHILE) {
        code = duite_replay_while(run->main.rt, graph->name, object, op->count);
    } else if (op->kind == PROG_ROUNDS) {
        rounds(run, graph, answer->rounds);
    } else if (op->kind == PROG_GRAPH_ARGS) {
        code = change_args(run, graph, op);
    } else if (op->kind == PROG_GRAPH_BIND) {
        graph->rebound = 1;
        code = duite_graph_bind(run->main.rt, graph->name, object, run->main.name[op->objects[0]]);
    } else if (op->kind == PROG_GRAPH_FREE) {
        graph->alive = 0;
        code = duite_graph_free(run->main.rt, graph->name);
    }
    prog_expect_code(run, "a call on a graph", code, answer->code);
}
