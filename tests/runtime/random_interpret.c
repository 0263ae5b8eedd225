/* What a program means, one task after the other. */

#include "tests/runtime/random_cells.h"

#include <stdlib.h>
#include <string.h>

/* A graph: what it recorded, with the seeds and failures of now, and what stands for each object.
 */
struct graph {
    int alive, whole;
    size_t first, again; /* operations: what it recorded, and what it would record now */
    size_t n;
    struct prog_op *op;
    unsigned *bound; /* n_objects */
    uint64_t rounds; /* of the last replay */
};

struct machine {
    const struct prog *prog;
    struct prog_answers *answers;
    struct prog_cell *cells;
    struct graph *graphs;
    uint64_t round;             /* of the replay that runs, or 0 */
    unsigned forks;             /* that came before: failures are compared by these */
    struct prog_failure failed; /* since the last wait */
    int refused;                /* the first refused call since the last get or wait */
};

/* Ends a task: its outputs are what the body left, or poisoned. */
static void deliver(struct prog_cell *cell, duite_mode mode, const duite_param *param,
                    struct prog_failure failure)
{
    unsigned char *data = param->data;
    const int failed = failure.number != PROG_NO_FAILURE.number;

    if (mode == DUITE_CW) {
        if (failed)
            cell->pending = prog_first_failure(cell->pending, failure);
        else
            prog_cell_contribute(cell, data);
        if (failed)
            free(data);
        return;
    }
    if (mode != DUITE_R) {
        cell->poison = failure;
        cell->count = param->count;
        memcpy(cell->value, data, prog_cell_bytes(cell));
    }
    free(data);
}

static void run_body(struct machine *m, const struct prog_op *op, duite_param *param,
                     struct prog_failure *failure)
{
    struct prog_args args;
    duite_call call = {.args = &args, .param = param, .n_params = op->n, .round = m->round};

    prog_args_fill(m->prog, op, &args);
    m->answers->runs[op->number]++;
    m->answers->n_runs++;
    const int code = prog_body(&call);

    if (code) {
        *failure = (struct prog_failure){m->forks, code};
        m->failed = prog_first_failure(m->failed, *failure);
    }
}

static int fork_task(struct machine *m, const struct prog_op *op)
{
    const duite_kernel *kernel = &m->prog->kernel[op->kernel];
    duite_param param[PROG_MAX_PARAMS];
    struct prog_failure failure = PROG_NO_FAILURE;

    m->forks++;
    for (unsigned i = 0; i < op->n; i++) {
        const duite_mode mode = prog_mode(kernel, i);
        struct prog_cell *cell = &m->cells[op->objects[i]];

        param[i] = (duite_param){.data = calloc(cell->max, prog_size(cell->type)),
                                 .count = mode == DUITE_W ? cell->max : cell->count,
                                 .type = cell->type};
        if (!param[i].data)
            return -1;
        if (mode == DUITE_CW) {
            if (cell->law != prog_law(kernel, i))
                prog_cell_settle(cell)->law = prog_law(kernel, i);
            prog_neutral(cell->law, cell->type, cell->count, param[i].data);
            continue;
        }
        prog_cell_settle(cell);
        if (mode == DUITE_W)
            continue;
        memcpy(param[i].data, cell->value, prog_cell_bytes(cell));
        failure = prog_first_failure(failure, cell->poison);
    }
    if (failure.number == PROG_NO_FAILURE.number)
        run_body(m, op, param, &failure);
    for (unsigned i = 0; i < op->n; i++)
        deliver(&m->cells[op->objects[i]], prog_mode(kernel, i), &param[i], failure);
    return 0;
}

static int get(struct machine *m, struct prog_cell *cell, struct prog_expect *expect)
{
    prog_cell_settle(cell);
    expect->code = m->refused ? m->refused : cell->poison.code;
    expect->count = cell->count;
    if (cell->poison.number == PROG_NO_FAILURE.number) {
        expect->bytes = malloc(prog_cell_bytes(cell) + 1);
        if (!expect->bytes)
            return -1;
        memcpy(expect->bytes, cell->value, prog_cell_bytes(cell));
    }
    m->refused = DUITE_OK;
    return 0;
}

static int wait_all(struct machine *m)
{
    int code = m->refused;

    if (!code) {
        code = m->failed.code;
        m->failed = PROG_NO_FAILURE;
    }
    m->refused = DUITE_OK;
    return code;
}

static void set(struct prog_cell *cell, const struct prog_op *op)
{
    prog_cell_settle(cell)->poison = PROG_NO_FAILURE;
    cell->count = op->count;
    memset(cell->value, 0, prog_cell_bytes(cell));
    if (op->seed)
        prog_values(cell->type, cell->count, op->seed, cell->value);
}

/* ---- Graphs ---- */

static int refuse(struct machine *m, int code)
{
    m->refused = m->refused ? m->refused : code;
    return code;
}

/* Records; DUITE_E_OBJECT if it names something that is gone. */
static int build(struct machine *m, struct graph *graph)
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
        if (op->kind == PROG_GRAPH_SET && !m->cells[op->object].value)
            return DUITE_E_OBJECT;
        for (unsigned k = 0; op->kind == PROG_GRAPH_FORK && k < op->n; k++)
            if (!m->cells[op->objects[k]].value)
                return DUITE_E_OBJECT;
        graph->op[graph->n++] = *op;
    }
    graph->whole = 1;
    return DUITE_OK;
}

static int fits(const struct machine *m, const struct graph *graph)
{
    for (unsigned i = 0; i < m->prog->n_objects; i++)
        if (prog_records(m->prog, graph->first, i) && !m->cells[graph->bound[i]].value)
            return 0;
    return graph->whole;
}

static int is_distinct(const struct machine *m, const struct graph *graph)
{
    for (unsigned i = 0; i < m->prog->n_objects; i++)
        for (unsigned k = 0; k < i; k++)
            if (graph->bound[i] == graph->bound[k] && prog_records(m->prog, graph->first, i) &&
                prog_records(m->prog, graph->first, k))
                return 0;
    return 1;
}

static int run_round(struct machine *m, const struct graph *graph)
{
    for (size_t i = 0; i < graph->n; i++) {
        struct prog_op op = graph->op[i];

        if (op.kind == PROG_GRAPH_SET) {
            set(&m->cells[graph->bound[op.object]], &op);
            continue;
        }
        for (unsigned k = 0; k < op.n; k++)
            op.objects[k] = graph->bound[op.objects[k]];
        if (fork_task(m, &op))
            return -1;
    }
    return 0;
}

static int holds(struct prog_cell *flag)
{
    static const unsigned char zero[8];
    const unsigned char *value = prog_cell_settle(flag)->value;

    if (flag->poison.number != PROG_NO_FAILURE.number || !flag->count)
        return 0;
    if (flag->type == DUITE_F64)
        return *(const double *)(const void *)value != 0;
    if (flag->type == DUITE_F32)
        return *(const float *)(const void *)value != 0;
    return memcmp(value, zero, prog_size(flag->type)) != 0;
}

static int replay(struct machine *m, struct graph *graph, const struct prog_op *op)
{
    int code = fits(m, graph) ? DUITE_OK : build(m, graph), going = 1;

    if (!code && !is_distinct(m, graph))
        code = DUITE_E_BINDING;
    if (code)
        return refuse(m, code);
    graph->rounds = 0;
    while (going && graph->rounds < op->count) {
        m->round = graph->rounds;
        if (run_round(m, graph))
            return DUITE_E_MEMORY;
        graph->rounds++;
        if (op->kind == PROG_REPLAY_WHILE)
            going = holds(&m->cells[op->object]);
    }
    m->round = 0;
    return DUITE_OK;
}

static int change_args(struct machine *m, struct graph *graph, const struct prog_op *op)
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
    return graph->whole ? DUITE_OK : refuse(m, DUITE_E_ARGUMENT);
}

static int bind(struct machine *m, struct graph *graph, const struct prog_op *op)
{
    if (!m->cells[op->objects[0]].value)
        return refuse(m, DUITE_E_OBJECT);
    if (!graph->whole || !prog_records(m->prog, graph->first, op->object))
        return refuse(m, DUITE_E_BINDING);
    graph->bound[op->object] = op->objects[0];
    return DUITE_OK;
}

static int make_graph(struct machine *m, struct graph *graph, const struct prog_op *op)
{
    graph->alive = 1;
    graph->again = (size_t)(op - m->prog->ops);
    graph->op = calloc(m->prog->n_ops + 1, sizeof *graph->op);
    graph->bound = calloc(m->prog->n_objects + 1, sizeof *graph->bound);
    return graph->op && graph->bound ? build(m, graph) : DUITE_E_MEMORY;
}

static void free_graph(struct graph *graph)
{
    free(graph->op);
    free(graph->bound);
    *graph = (struct graph){0};
}

/* A graph that was left out of the program is left alone. */
static int graph_operation(struct machine *m, const struct prog_op *op, struct prog_expect *expect)
{
    struct graph *graph = &m->graphs[op->graph];

    if (op->kind == PROG_GRAPH)
        expect->code = make_graph(m, graph, op);
    else if (!graph->alive)
        return 0;
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
        free_graph(graph);
    return expect->code == DUITE_E_MEMORY ? -1 : 0;
}

static int make_object(struct machine *m, const struct prog_op *op)
{
    const struct prog_object *object = &m->prog->objects[op->object];
    struct prog_cell *cell = &m->cells[op->object];

    cell->type = object->type;
    cell->count = op->count;
    cell->max = object->max ? object->max : op->count;
    cell->poison = cell->pending = PROG_NO_FAILURE;
    cell->value = calloc(cell->max, prog_size(cell->type));
    return cell->value ? 0 : -1;
}

static void free_object(struct prog_cell *cell)
{
    free(prog_cell_settle(cell)->value);
    cell->value = NULL;
}

static int operation(struct machine *m, const struct prog_op *op, struct prog_expect *expect)
{
    struct prog_cell *cell = &m->cells[op->object];

    switch (op->kind) {
    case PROG_NEW:
        return make_object(m, op);
    case PROG_FREE:
        free_object(cell);
        return 0;
    case PROG_SET:
        set(cell, op);
        return 0;
    case PROG_FORK:
        return fork_task(m, op);
    case PROG_GET:
    case PROG_GET_AT:
    case PROG_COUNT:
        return get(m, cell, expect);
    case PROG_WAIT:
        expect->code = wait_all(m);
        return 0;
    case PROG_WRONG:
        expect->code = refuse(m, DUITE_E_ACCESS);
        return 0;
    default:
        return op->kind >= PROG_GRAPH && !prog_is_recorded(m->prog, (size_t)(op - m->prog->ops))
                   ? graph_operation(m, op, expect)
                   : 0;
    }
}

struct prog_answers *prog_interpret(const struct prog *prog)
{
    struct prog_answers *answers = calloc(1, sizeof *answers);
    struct prog_cell *cells = calloc(prog->n_objects + 1, sizeof *cells);
    struct graph *graphs = calloc(prog->n_graphs + 1, sizeof *graphs);
    struct machine m = {.prog = prog,
                        .answers = answers,
                        .cells = cells,
                        .graphs = graphs,
                        .failed = PROG_NO_FAILURE};
    int left = 0, failed = !answers || !cells || !graphs;

    if (!failed) {
        answers->op = calloc(prog->n_ops + 1, sizeof *answers->op);
        answers->runs = calloc(prog->n_forks + 1, 1);
        failed = !answers->op || !answers->runs;
    }
    for (size_t i = 0; !failed && i < prog->n_ops; i++)
        failed = operation(&m, &prog->ops[i], &answers->op[i]);
    for (size_t i = 0; cells && i < prog->n_objects; i++) {
        left |= cells[i].value != NULL;
        free_object(&cells[i]);
    }
    for (size_t i = 0; graphs && i < prog->n_graphs; i++) {
        left |= graphs[i].alive;
        free_graph(&graphs[i]);
    }
    free(cells);
    free(graphs);
    if (failed) {
        prog_answers_free(prog, answers);
        return NULL;
    }
    answers->stop = wait_all(&m);
    if (!answers->stop && left)
        answers->stop = DUITE_E_NOT_FREED;
    return answers;
}

void prog_answers_free(const struct prog *prog, struct prog_answers *answers)
{
    if (!answers)
        return;
    for (size_t i = 0; answers->op && i < prog->n_ops; i++)
        free(answers->op[i].bytes);
    free(answers->op);
    free(answers->runs);
    free(answers);
}
