/* What a program means, one task after the other. An object is its value, the failure it descends
 * from, and the contributions since its last other access: complete subtrees of decreasing size,
 * oldest first, no two alike. */

#include "tests/runtime/random_program.h"

#include <stdlib.h>
#include <string.h>

/* Failures are compared by their place in fork order; NONE is later than all. */
struct failure {
    unsigned number;
    int code;
};
static const struct failure NONE = {~0u, DUITE_OK};

enum { MAX_LEVELS = 32 };

struct cell {
    duite_type type;
    size_t count, most; /* elements; of the largest value */
    unsigned char *value;
    struct failure poison;
    struct failure pending; /* of the contributions */
    enum prog_law law;      /* of the contributions */
    unsigned n_subtrees, level[MAX_LEVELS];
    unsigned char *subtree[MAX_LEVELS];
};

struct machine {
    const struct prog *prog;
    struct prog_answers *answers;
    struct cell *cells;
    struct failure failed; /* since the last wait */
    int refused;           /* the first refused call since the last get or wait */
};

static struct failure first_of(struct failure a, struct failure b)
{
    return a.number <= b.number ? a : b;
}

static size_t bytes_of(const struct cell *cell)
{
    return cell->count * prog_size(cell->type);
}

static void combine(const struct cell *cell, void *left, const void *right)
{
    prog_combine(cell->law, cell->type, cell->count, left, right);
}

/* Adds a leaf, which becomes the cell's. */
static void contribute(struct cell *cell, unsigned char *leaf)
{
    unsigned level = 0;

    while (cell->n_subtrees && cell->level[cell->n_subtrees - 1] == level) {
        unsigned char *left = cell->subtree[--cell->n_subtrees];

        combine(cell, left, leaf);
        free(leaf);
        leaf = left;
        level++;
    }
    cell->level[cell->n_subtrees] = level;
    cell->subtree[cell->n_subtrees++] = leaf;
}

/* Every access but cw, and cw by another law, ends a run of contributions. */
static struct cell *settle(struct cell *cell)
{
    if (cell->n_subtrees) {
        unsigned char *tree = cell->subtree[cell->n_subtrees - 1];

        for (unsigned i = cell->n_subtrees - 1; i-- > 0;) {
            combine(cell, cell->subtree[i], tree);
            free(tree);
            tree = cell->subtree[i];
        }
        combine(cell, cell->value, tree);
        free(tree);
        cell->n_subtrees = 0;
    }
    cell->poison = first_of(cell->poison, cell->pending);
    cell->pending = NONE;
    return cell;
}

/* Ends a task: its outputs are what the body left, or poisoned. */
static void deliver(struct cell *cell, duite_mode mode, const duite_param *param,
                    struct failure failure)
{
    unsigned char *data = param->data;
    const int failed = failure.number != NONE.number;

    if (mode == DUITE_CW) {
        if (failed)
            cell->pending = first_of(cell->pending, failure);
        else
            contribute(cell, data);
        if (failed)
            free(data);
        return;
    }
    if (mode != DUITE_R) {
        cell->poison = failure;
        cell->count = param->count;
        memcpy(cell->value, data, bytes_of(cell));
    }
    free(data);
}

static void run_body(struct machine *m, const struct prog_op *op, duite_param *param,
                     struct failure *failure)
{
    struct prog_args args;
    duite_call call = {.args = &args, .param = param, .n_params = op->n};

    prog_args_fill(m->prog, op, &args);
    m->answers->runs[op->number] = 1;
    m->answers->n_runs++;
    const int code = prog_body(&call);

    if (code) {
        *failure = (struct failure){op->number, code};
        m->failed = first_of(m->failed, *failure);
    }
}

static int fork_task(struct machine *m, const struct prog_op *op)
{
    const duite_kernel *kernel = &m->prog->kernel[op->kernel];
    duite_param param[PROG_MAX_PARAMS];
    struct failure failure = NONE;

    for (unsigned i = 0; i < op->n; i++) {
        const duite_mode mode = prog_mode(kernel, i);
        struct cell *cell = &m->cells[op->objects[i]];

        param[i] = (duite_param){.data = calloc(cell->most, prog_size(cell->type)),
                                 .count = mode == DUITE_W ? cell->most : cell->count,
                                 .type = cell->type};
        if (!param[i].data)
            return -1;
        if (mode == DUITE_CW) {
            if (cell->law != prog_law(kernel, i))
                settle(cell)->law = prog_law(kernel, i);
            prog_neutral(cell->law, cell->type, cell->count, param[i].data);
            continue;
        }
        settle(cell);
        if (mode == DUITE_W)
            continue;
        memcpy(param[i].data, cell->value, bytes_of(cell));
        failure = first_of(failure, cell->poison);
    }
    if (failure.number == NONE.number)
        run_body(m, op, param, &failure);
    for (unsigned i = 0; i < op->n; i++)
        deliver(&m->cells[op->objects[i]], prog_mode(kernel, i), &param[i], failure);
    return 0;
}

static int get(struct machine *m, struct cell *cell, struct prog_expect *expect)
{
    settle(cell);
    expect->code = m->refused ? m->refused : cell->poison.code;
    expect->count = cell->count;
    if (cell->poison.number == NONE.number) {
        expect->bytes = malloc(bytes_of(cell) + 1);
        if (!expect->bytes)
            return -1;
        memcpy(expect->bytes, cell->value, bytes_of(cell));
    }
    m->refused = DUITE_OK;
    return 0;
}

static int wait_all(struct machine *m)
{
    int code = m->refused;

    if (!code) {
        code = m->failed.code;
        m->failed = NONE;
    }
    m->refused = DUITE_OK;
    return code;
}

static int operation(struct machine *m, const struct prog_op *op, struct prog_expect *expect)
{
    struct cell *cell = &m->cells[op->object];

    switch (op->kind) {
    case PROG_NEW:
        cell->type = op->type;
        cell->count = op->count;
        cell->most = op->most ? op->most : op->count;
        cell->poison = cell->pending = NONE;
        cell->value = calloc(cell->most, prog_size(cell->type));
        return cell->value ? 0 : -1;
    case PROG_FREE:
        free(settle(cell)->value);
        cell->value = NULL;
        return 0;
    case PROG_SET:
        settle(cell)->poison = NONE;
        cell->count = op->count;
        memset(cell->value, 0, bytes_of(cell));
        if (op->seed)
            prog_values(cell->type, cell->count, op->seed, cell->value);
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
        expect->code = DUITE_E_ACCESS;
        m->refused = m->refused ? m->refused : DUITE_E_ACCESS;
        return 0;
    default:
        return 0;
    }
}

struct prog_answers *prog_interpret(const struct prog *prog)
{
    struct prog_answers *answers = calloc(1, sizeof *answers);
    struct cell *cells = calloc(prog->n_objects + 1, sizeof *cells);
    struct machine m = {.prog = prog, .answers = answers, .cells = cells, .failed = NONE};
    int left = 0, failed = !answers || !cells;

    if (!failed) {
        answers->op = calloc(prog->n_ops + 1, sizeof *answers->op);
        answers->runs = calloc(prog->n_forks + 1, 1);
        failed = !answers->op || !answers->runs;
    }
    for (size_t i = 0; !failed && i < prog->n_ops; i++)
        failed = operation(&m, &prog->ops[i], &answers->op[i]);
    for (size_t i = 0; cells && i < prog->n_objects; i++) {
        left |= cells[i].value != NULL;
        free(settle(&cells[i])->value);
    }
    free(cells);
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
