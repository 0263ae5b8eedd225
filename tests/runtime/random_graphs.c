/* Graphs in random programs: recorded in the program like operations of their own, which only
 * replays carry out. Objects that a graph uses are freed like any others; a graph is then recorded
 * again, from what its last PROG_GRAPH_AGAIN says, or cannot be replayed. */

#include "tests/runtime/random_make.h"

int prog_is_recorded(const struct prog *prog, size_t index)
{
    return prog->ops[index].kind == PROG_GRAPH_FORK || prog->ops[index].kind == PROG_GRAPH_SET;
}

int prog_records(const struct prog *prog, size_t first, unsigned object)
{
    for (size_t i = first + 1; i <= first + prog->ops[first].n; i++) {
        const struct prog_op *op = &prog->ops[i];

        if (op->kind == PROG_GRAPH_SET && op->object == object)
            return 1;
        for (unsigned k = 0; op->kind == PROG_GRAPH_FORK && k < op->n; k++)
            if (op->objects[k] == object)
                return 1;
    }
    return 0;
}

/* A graph that is alive; -1 if there is none. */
static int draw_graph(struct maker *m)
{
    for (int attempt = 0; attempt < 8 && m->prog->n_graphs; attempt++) {
        const unsigned graph = make_below(m, (unsigned)m->prog->n_graphs);

        if (m->graph[graph] != SIZE_MAX)
            return (int)graph;
    }
    return -1;
}

static void record(struct maker *m, enum prog_kind kind, unsigned graph)
{
    const size_t first = m->prog->n_ops;
    const unsigned max = make_one_in(m, 10) ? 0 : 1 + make_below(m, MOST_RECORDED - 2);

    const int adds = m->adds;

    m->plain = !make_one_in(m, 3); /* else there is no plan */
    m->adds = 0;
    make_push(m, kind, 0)->graph = graph;
    while (m->prog->n_ops < first + 1 + max) {
        struct prog_op draft = {.kind = PROG_GRAPH_FORK};

        if (make_one_in(m, 8)) {
            make_set(m, PROG_GRAPH_SET, make_draw_object(m), make_one_in(m, 2));
            continue;
        }
        if (!make_draft(m, &draft))
            continue;
        make_body(m, &draft, MAX_DEPTH - 2, 0);
        struct prog_op *op = make_push_fork(m, &draft);

        op->ends = make_one_in(m, 2);
        op->sometimes = make_one_in(m, 2);
        op->pause = make_one_in(m, 3) ? op->pause : 0;
    }
    m->plain = 0;
    m->adds = adds;
    m->prog->ops[first].n = (unsigned)(m->prog->n_ops - first - 1);
    m->graph[graph] = first;
    m->unsettled = m->scope->n;
}

/* An object that a fork of the graph writes and may end, if chance finds one. */
static unsigned draw_flag(struct maker *m, size_t first)
{
    const struct prog *prog = m->prog;

    for (int attempt = 0; attempt < 20 && prog->ops[first].n; attempt++) {
        const struct prog_op *op =
            &prog->ops[first + 1 + make_below(m, (unsigned)prog->ops[first].n)];

        for (unsigned i = 0; op->kind == PROG_GRAPH_FORK && op->ends && i < op->n; i++)
            for (unsigned k = 0; k < m->scope->n_live; k++)
                if (m->scope->live[k] == op->objects[i] &&
                    prog_mode(&prog->kernel[op->kernel], i) != DUITE_R)
                    return op->objects[i];
    }
    return make_draw_object(m);
}

static void replay(struct maker *m, unsigned graph)
{
    const int counted = !make_one_in(m, 3);
    struct prog_op *op = make_push(m, counted ? PROG_REPLAY : PROG_REPLAY_WHILE,
                                   counted ? 0 : draw_flag(m, m->graph[graph]));

    op->graph = graph;
    op->count = (counted ? 0 : 1) + make_below(m, make_one_in(m, 6) ? 40 : 6);
    m->refused = 1; /* it may be */
    m->unsettled = m->scope->n;
    if (make_one_in(m, 3))
        make_push(m, PROG_ROUNDS, 0)->graph = graph;
}

static void change_args(struct maker *m, unsigned graph)
{
    const size_t first = m->graph[graph], n = m->prog->ops[first].n;
    const size_t target = first + 1 + make_below(m, (unsigned)n + 1);

    if (target > first + n || m->prog->ops[target].kind != PROG_GRAPH_FORK)
        return;
    struct prog_op *op = make_push(m, PROG_GRAPH_ARGS, 0);

    m->refused = 1;
    op->graph = graph;
    op->count = target;
    op->fails = make_one_in(m, m->failing) ? 1 + (int)make_below(m, 1000) : 0;
}

/* Another object of the same shape, often one that the graph has already: then both are exchanged,
 * or the replay is refused. */
static void bind(struct maker *m, unsigned graph)
{
    const struct prog_object *objects = m->scope->object;
    const unsigned from = make_draw_object(m), to = make_draw_object(m);
    const int both = !make_one_in(m, 4);

    if (objects[from].type != objects[to].type || objects[from].count != objects[to].count ||
        objects[from].max != objects[to].max || !prog_records(m->prog, m->graph[graph], from))
        return;
    for (int way = 0; way < 1 + both; way++) {
        struct prog_op *op = make_push(m, PROG_GRAPH_BIND, way ? to : from);

        op->graph = graph;
        op->n = 1;
        op->objects[0] = way ? from : to;
        m->refused = 1;
    }
}

static void release(struct maker *m, unsigned graph)
{
    make_push(m, PROG_GRAPH_FREE, 0)->graph = graph;
    m->graph[graph] = SIZE_MAX;
}

void make_graph_operation(struct maker *m)
{
    const int graph = draw_graph(m);
    const unsigned choice = make_below(m, 20);

    if (m->scope->n_live < 2)
        return;
    if (graph < 0 || (choice < 2 && m->prog->n_graphs < MAX_GRAPHS)) {
        if (m->prog->n_graphs < MAX_GRAPHS)
            record(m, PROG_GRAPH, (unsigned)m->prog->n_graphs++);
        return;
    }
    if (choice < 13)
        replay(m, (unsigned)graph);
    else if (choice < 15)
        change_args(m, (unsigned)graph);
    else if (choice < 18)
        for (int i = 0; i < 4; i++)
            bind(m, (unsigned)graph);
    else if (choice < 19)
        record(m, PROG_GRAPH_AGAIN, (unsigned)graph);
    else
        release(m, (unsigned)graph);
}

void make_graphs_free(struct maker *m)
{
    for (unsigned graph = 0; graph < m->prog->n_graphs; graph++)
        if (m->graph[graph] != SIZE_MAX && !make_one_in(m, 30))
            release(m, graph);
}
