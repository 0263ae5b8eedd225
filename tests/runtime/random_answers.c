/* The main program in the reference order: the answers that the runtime has to give. */
#include "tests/runtime/random_interpret.h"

#include <stdlib.h>
#include <string.h>

/* The value, or why there is none. */
static void tell_value(struct prog_cell *cell, struct prog_expect *expect)
{
    prog_cell_settle(cell);
    expect->code = cell->poison.code;
    expect->count = cell->count;
    if (prog_is_failure(cell->poison))
        return;
    expect->bytes = prog_memory(prog_cell_bytes(cell), 1);
    memcpy(expect->bytes, cell->value, prog_cell_bytes(cell));
}

static void get(struct prog_frame *frame, struct prog_cell *cell, struct prog_expect *expect)
{
    const int refused = prog_interpret_told(frame);

    tell_value(cell, expect);
    expect->code = refused ? refused : expect->code;
}

/* The turn stands where it begins. Under w nothing is found. */
static void acquire(struct prog_cell *cell, const struct prog_op *op, struct prog_expect *expect)
{
    struct prog_op write = *op;

    if (op->mode == DUITE_W)
        prog_cell_settle(cell);
    else
        tell_value(cell, expect);
    if (op->mode == DUITE_R)
        return;
    write.count = op->mode == DUITE_W ? op->count : cell->count;
    if (op->mode == DUITE_W || !prog_is_failure(cell->poison))
        prog_interpret_set(cell, &write);
    else
        cell->writes++;
}

/* The first failure of some objects. */
static void wait_for(struct prog_frame *main, const struct prog_op *op, struct prog_expect *expect)
{
    struct prog_failure first = PROG_NO_FAILURE;

    for (unsigned i = 0; i < op->n; i++)
        first = prog_first_failure(first, prog_cell_settle(&main->cells[op->objects[i]])->poison);
    if (op->kind == PROG_WAIT_FOR) {
        const int refused = prog_interpret_told(main);

        expect->code = refused ? refused : first.code;
    }
}

/* The get's answer is that of its begin, but for what the program was refused before its end. */
static void get_later(struct prog_machine *m, const struct prog_op *op, struct prog_expect *expect)
{
    struct prog_frame *main = m->main;
    const int kept = main->refused;

    if (!prog_is_got(m->prog, op))
        return;
    if (op->kind == PROG_GET_BEGIN) {
        main->refused = DUITE_OK;
        get(main, &main->cells[op->object], &m->answers->op[op->body]);
        main->refused = kept;
        return;
    }
    const int refused = prog_interpret_told(main);

    expect->code = refused ? refused : expect->code;
}

static void operation(struct prog_machine *m, const struct prog_op *op, struct prog_expect *expect)
{
    struct prog_frame *main = m->main;
    struct prog_cell *cell = &main->cells[op->object];

    switch (op->kind) {
    case PROG_NEW:
        prog_interpret_object(main, op);
        break;
    case PROG_FREE:
        if (main->shape[op->object].adopted)
            tell_value(cell, expect);
        prog_cell_end(cell);
        break;
    case PROG_ACQUIRE:
        acquire(cell, op, expect);
        break;
    case PROG_SPLIT:
        prog_interpret_split(main, op);
        break;
    case PROG_JOIN:
        prog_interpret_join(main, op);
        break;
    case PROG_SET:
        prog_interpret_set(cell, op);
        break;
    case PROG_FORK:
        prog_interpret_fork(m, main, op, 0);
        break;
    case PROG_GET:
    case PROG_GET_AT:
    case PROG_COUNT:
        get(main, cell, expect);
        break;
    case PROG_WAIT:
        expect->code = prog_interpret_wait(main);
        break;
    case PROG_WAIT_FOR:
    case PROG_TEST:
        wait_for(main, op, expect);
        break;
    case PROG_GET_BEGIN:
    case PROG_GET_END:
        get_later(m, op, expect);
        break;
    case PROG_WRONG:
        expect->code = prog_interpret_refuse(main, op->fails);
        break;
    default:
        if (op->kind >= PROG_GRAPH && !prog_is_recorded(m->prog, (size_t)(op - m->prog->ops)))
            prog_interpret_graph(m, op, expect);
    }
}

struct prog_answers *prog_interpret(const struct prog *prog)
{
    struct prog_answers *answers = prog_memory(1, sizeof *answers);
    struct prog_frame *main = prog_memory(1, sizeof *main);
    struct prog_graph *graphs = prog_memory(prog->n_graphs, sizeof *graphs);
    struct prog_machine m = {.prog = prog, .answers = answers, .main = main, .graphs = graphs};
    int left = 0;

    answers->op = prog_memory(prog->n_ops, sizeof *answers->op);
    answers->runs = prog_memory(prog->n_forks, 1);
    main->cells = prog_memory(PROG_MAX_TABLE, sizeof *main->cells);
    main->failed = PROG_NO_FAILURE;
    memcpy(main->shape, prog->objects, sizeof main->shape);
    for (size_t i = 0; i < PROG_MAX_TABLE; i++)
        main->object[i] = &main->cells[i];
    for (size_t i = 0; i < prog->n_ops; i++)
        operation(&m, &prog->ops[i], &answers->op[i]);
    for (size_t i = 0; i < PROG_MAX_TABLE; i++) {
        left |= main->cells[i].value != NULL;
        prog_cell_end(&main->cells[i]);
    }
    for (size_t i = 0; i < prog->n_graphs; i++) {
        left |= graphs[i].alive;
        prog_graph_end(&graphs[i]);
    }
    answers->stop = prog_interpret_wait(main);
    if (!answers->stop && left)
        answers->stop = DUITE_E_NOT_FREED;
    free(main->cells);
    free(main);
    free(graphs);
    return answers;
}

void prog_answers_free(const struct prog *prog, struct prog_answers *answers)
{
    for (size_t i = 0; i < prog->n_ops; i++)
        free(answers->op[i].bytes);
    free(answers->op);
    free(answers->runs);
    free(answers);
}
