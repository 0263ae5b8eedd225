/* The meaning of graphs: their operations are done one after the other, round after
 * round, on what is bound to their objects. */

#include "tests/runtime/random_interpret.h"

#include <stdlib.h>
#include <string.h>

/* Records; DUITE_E_OBJECT if it names something that is gone. */
static int build(struct prog_machine *m, struct prog_graph *graph)
{
    const struct prog_op *from = &m->prog->ops[graph->again];

    m->answers->n_recorded++;
    graph->first = graph->again;
    graph->whole = 0;
    graph->rounds = 0;
    graph->n = 0;
    for (size_t i = 0; i < m->prog->n_objects; i++)
        graph->bound[i] = (unsigned)i;
    for (size_t i = 1; i <= from->n; i++) {
        const struct prog_op *op = &from[i];

        if (!prog_is_recorded(m->prog, graph->first + i))
            continue;
        if (op->kind == PROG_GRAPH_SET && !m->main->object[op->object]->value)
            return DUITE_E_OBJECT;
        for (unsigned k = 0; op->kind == PROG_GRAPH_FORK && k < op->n; k++)
            if (!m->main->object[op->objects[k]]->value)
                return DUITE_E_OBJECT;
        graph->op[graph->n++] = *op;
    }
    graph->whole = 1;
    return DUITE_OK;
}

static int fits(const struct prog_machine *m, const struct prog_graph *graph)
{
    for (unsigned i = 0; i < m->prog->n_objects; i++)
        if (prog_records(m->prog, graph->first, i) && !m->main->object[graph->bound[i]]->value)
            return 0;
    return graph->whole;
}

static int is_distinct(const struct prog_machine *m, const struct prog_graph *graph)
{
    for (unsigned i = 0; i < m->prog->n_objects; i++)
        for (unsigned k = 0; k < i; k++)
            if (graph->bound[i] == graph->bound[k] && prog_records(m->prog, graph->first, i) &&
                prog_records(m->prog, graph->first, k))
                return 0;
    return 1;
}

static void run_round(struct prog_machine *m, const struct prog_graph *graph)
{
    for (size_t i = 0; i < graph->n; i++) {
        struct prog_op op = graph->op[i];

        if (op.kind == PROG_GRAPH_SET) {
            prog_interpret_set(m->main->object[graph->bound[op.object]], &op);
            continue;
        }
        for (unsigned k = 0; k < op.n; k++)
            op.objects[k] = graph->bound[op.objects[k]];
        prog_interpret_fork(m, m->main, &op, graph->rounds);
    }
}

static int holds(struct prog_cell *flag)
{
    static const unsigned char zero[16];
    const unsigned char *value = prog_cell_settle(flag)->value;

    if (flag->poison.number != PROG_NO_FAILURE.number || !flag->count)
        return 0;
    if (flag->type == DUITE_F64)
        return *(const double *)(const void *)value != 0;
    if (flag->type == DUITE_CF64)
        return ((const double *)(const void *)value)[0] != 0 ||
               ((const double *)(const void *)value)[1] != 0;
    if (flag->type == DUITE_F32)
        return *(const float *)(const void *)value != 0;
    return memcmp(value, zero, prog_size(flag->type)) != 0;
}

static int replay(struct prog_machine *m, struct prog_graph *graph, const struct prog_op *op)
{
    int code = fits(m, graph) ? DUITE_OK : build(m, graph), going = 1;

    if (!code && !is_distinct(m, graph))
        code = DUITE_E_BINDING;
    if (code)
        return prog_interpret_refuse(m->main, code);
    graph->rounds = 0;
    while (going && graph->rounds < op->count) {
        run_round(m, graph);
        graph->rounds++;
        if (op->kind == PROG_REPLAY_WHILE)
            going = holds(m->main->object[op->object]);
    }
    return DUITE_OK;
}

static int change_args(struct prog_machine *m, struct prog_graph *graph, const struct prog_op *op)
{
    const struct prog_op *target = &m->prog->ops[op->count];

    if (target->kind != PROG_GRAPH_FORK || op->count <= graph->first ||
        op->count > graph->first + m->prog->ops[graph->first].n)
        return DUITE_OK;
    for (size_t i = 0; i < graph->n; i++)
        if (graph->op[i].kind == PROG_GRAPH_FORK && graph->op[i].number == target->number) {
            graph->op[i].seed = op->seed;
            graph->op[i].fails = op->fails;
        }
    return graph->whole ? DUITE_OK : prog_interpret_refuse(m->main, DUITE_E_ARGUMENT);
}

static int bind(struct prog_machine *m, struct prog_graph *graph, const struct prog_op *op)
{
    if (!m->main->object[op->objects[0]]->value)
        return prog_interpret_refuse(m->main, DUITE_E_OBJECT);
    if (!graph->whole || !prog_records(m->prog, graph->first, op->object))
        return prog_interpret_refuse(m->main, DUITE_E_BINDING);
    graph->bound[op->object] = op->objects[0];
    return DUITE_OK;
}

static int make_graph(struct prog_machine *m, struct prog_graph *graph, const struct prog_op *op)
{
    graph->alive = 1;
    graph->again = (size_t)(op - m->prog->ops);
    graph->op = prog_memory(m->prog->n_ops, sizeof *graph->op);
    graph->bound = prog_memory(m->prog->n_objects, sizeof *graph->bound);
    return build(m, graph);
}

void prog_graph_end(struct prog_graph *graph)
{
    free(graph->op);
    free(graph->bound);
    *graph = (struct prog_graph){0};
}

void prog_interpret_graph(struct prog_machine *m, const struct prog_op *op,
                          struct prog_expect *expect)
{
    struct prog_graph *graph = &m->graphs[op->graph];

    if (op->kind == PROG_GRAPH)
        expect->code = make_graph(m, graph, op);
    else if (!graph->alive)
        return;
    else if (op->kind == PROG_GRAPH_AGAIN)
        graph->again = (size_t)(op - m->prog->ops);
    else if (op->kind == PROG_REPLAY || op->kind == PROG_REPLAY_WHILE)
        expect->code = replay(m, graph, op);
    else if (op->kind == PROG_ROUNDS)
        expect->rounds = graph->rounds;
    else if (op->kind == PROG_GRAPH_BIND)
        expect->code = bind(m, graph, op);
    else if (op->kind == PROG_GRAPH_ARGS)
        expect->code = change_args(m, graph, op);
    else if (op->kind == PROG_GRAPH_FREE)
        prog_graph_end(graph);
}
