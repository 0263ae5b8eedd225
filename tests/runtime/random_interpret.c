/* The meaning of a program, in the reference order: a body, then its children one after the other
 * with all their descendants, then the next task. A get or wait of a body closes a segment: what
 * the body does afterwards comes after the children forked so far. */

#include "tests/runtime/random_interpret.h"

#include <stdlib.h>
#include <string.h>

static int is_immediate(duite_mode mode)
{
    return !prog_is_postponed(mode);
}

static int writes(duite_mode mode)
{
    return mode == DUITE_W || mode == DUITE_RW;
}

static int is_failure(struct prog_failure failure)
{
    return failure.number != PROG_NO_FAILURE.number;
}

int prog_interpret_refuse(struct prog_frame *frame, int code)
{
    frame->refused = frame->refused ? frame->refused : code;
    return code;
}

/* Takes what the next get or wait returns before all else. */
static int take_refused(struct prog_frame *frame)
{
    const int code = frame->refused;

    frame->refused = DUITE_OK;
    return code;
}

void prog_interpret_set(struct prog_cell *cell, const struct prog_op *op)
{
    prog_cell_settle(cell)->poison = PROG_NO_FAILURE;
    cell->writes++;
    cell->count = op->count;
    memset(cell->value, 0, prog_cell_bytes(cell));
    if (op->seed)
        prog_values(cell->type, cell->count, op->seed, cell->value);
}

static void contribute(struct prog_frame *frame, const struct prog_op *op)
{
    struct prog_cell *cell = frame->object[op->object];
    unsigned char *leaf = prog_memory(cell->count, prog_size(cell->type));

    prog_values(cell->type, cell->count, op->seed, leaf);
    prog_cell_contribute(cell, frame->law[op->object], leaf);
}

/* The children forked so far come now. */
static void end_segment(struct prog_machine *m, struct prog_frame *frame)
{
    for (size_t i = frame->first_pending; i < frame->n_done; i++) {
        const struct prog_op *op = &frame->ops[i];

        if (op->kind == PROG_FORK)
            prog_interpret_fork(m, frame, op, 0);
        else if (op->kind == PROG_SET)
            prog_interpret_set(frame->object[op->object], op);
        else if (op->kind == PROG_CONTRIBUTE)
            contribute(frame, op);
    }
    frame->first_pending = frame->n_done;
}

static int wait_all(struct prog_frame *frame)
{
    int code = take_refused(frame);

    if (!code) {
        code = frame->failed.code;
        frame->failed = PROG_NO_FAILURE;
    }
    return code;
}

static void make_object(struct prog_frame *frame, const struct prog_op *op)
{
    const unsigned place = op->object;

    frame->shape[place] = (struct prog_object){op->type, op->count, op->max, -1, op->rank + 1};
    frame->object[place] = &frame->cells[place];
    prog_cell_start(frame->object[place], &frame->shape[place]);
    if (op->rank >= 0)
        prog_interpret_set(frame->object[place], op);
}

/* A body learns from a get. */
static uint64_t get_in_body(struct prog_frame *frame, const struct prog_op *op, uint64_t hash)
{
    const struct prog_cell *cell = prog_cell_settle(frame->object[op->object]);
    const int refused = take_refused(frame), code = refused ? refused : cell->poison.code;
    const uint64_t count = cell->count;

    if (op->kind == PROG_WAIT_FOR)
        return prog_body_told(hash, code, NULL, 0);
    if (op->kind == PROG_COUNT)
        return prog_body_told(hash, code, &count, code ? 0 : sizeof count);
    return prog_body_told(hash, code, cell->value, code ? 0 : prog_cell_bytes(cell));
}

/* Does what a body does; returns its hash in the end. */
static uint64_t act(struct prog_machine *m, struct prog_frame *frame, size_t n, uint64_t hash)
{
    for (size_t i = 0; i < n; i++) {
        const struct prog_op *op = &frame->ops[i];

        frame->n_done = i + 1;
        if (op->kind == PROG_NEW) {
            make_object(frame, op);
        } else if (op->kind == PROG_WRONG) {
            prog_interpret_refuse(frame, op->fails);
        } else if (op->kind == PROG_GET || op->kind == PROG_COUNT || op->kind == PROG_WAIT_FOR) {
            end_segment(m, frame);
            hash = get_in_body(frame, op, hash);
        } else if (op->kind == PROG_WAIT) {
            end_segment(m, frame);
            hash = prog_body_told(hash, wait_all(frame), NULL, 0);
        }
    }
    return hash;
}

/* The task gets its own copies of the objects that it uses itself, the very objects that its
 * children use, and a tree of its own for their contributions. Returns the poison that it reads. */
static struct prog_failure enter(struct prog_frame *frame, const struct prog_op *op,
                                 const struct prog_args *args, duite_param *param)
{
    struct prog_failure failure = PROG_NO_FAILURE;

    for (unsigned i = 0; i < op->n; i++) {
        const duite_mode mode = (duite_mode)args->mode[i];
        struct prog_cell *cell = frame->above->object[op->objects[i]], *own = &frame->cells[i];

        frame->writes[i] = cell->writes;
        frame->law[i] = (enum prog_law)args->law[i];
        if (mode != DUITE_CW && mode != DUITE_CWP)
            prog_cell_settle(cell);
        frame->object[i] = is_immediate(mode) || mode == DUITE_CWP ? own : cell;
        if (frame->object[i] == own)
            prog_cell_start(own, &frame->shape[i]);
        own->law = frame->law[i];
        own->count = mode == DUITE_W ? cell->max : cell->count;
        param[i] = (duite_param){.count = own->count, .type = cell->type};
        if (is_immediate(mode))
            param[i].data = own->value;
        if (mode == DUITE_CW)
            prog_neutral(own->law, own->type, own->count, own->value);
        if (mode == DUITE_R || mode == DUITE_RW) {
            memcpy(own->value, cell->value, prog_cell_bytes(cell));
            failure = prog_first_failure(failure, cell->poison);
        }
    }
    return failure;
}

/* A parameter that the children wrote, or nobody. */
static void leave_written(struct prog_cell *cell, duite_mode mode, unsigned before,
                          struct prog_failure failure)
{
    prog_cell_settle(cell);
    if (mode == DUITE_WP && cell->writes == before) { /* what was there does not count */
        cell->count = cell->max;
        memset(cell->value, 0, prog_cell_bytes(cell));
        cell->poison = PROG_NO_FAILURE;
    }
    cell->writes++;
    cell->poison = prog_first_failure(cell->poison, failure);
}

/* The object of the task above gets what the task did to it. */
static void leave(struct prog_frame *frame, unsigned i, duite_mode mode, struct prog_cell *cell,
                  size_t count, struct prog_failure failure)
{
    struct prog_cell *own = &frame->cells[i];

    if (writes(mode)) {
        unsigned char *before = cell->value;

        cell->value = own->value;
        own->value = before;
        cell->count = count;
        cell->poison = failure;
        cell->writes++;
    } else if (mode == DUITE_WP || mode == DUITE_RWP) {
        leave_written(cell, mode, frame->writes[i], failure);
    } else if (mode == DUITE_CW) {
        prog_cell_contribute(cell, own->law, own->value);
        own->value = NULL;
        cell->pending = prog_first_failure(cell->pending, failure);
    } else if (mode == DUITE_CWP) {
        prog_cell_contribute(cell, own->law, prog_cell_fold(own));
        failure = prog_first_failure(failure, own->pending);
        cell->pending = prog_first_failure(cell->pending, failure);
    }
}

static struct prog_failure fail(struct prog_machine *m, struct prog_frame *above, int code)
{
    const struct prog_failure failure = {m->place++, code};

    for (; above; above = above->above)
        above->failed = prog_first_failure(above->failed, failure);
    return failure;
}

/* The body and its children. */
static struct prog_failure run_task(struct prog_machine *m, struct prog_frame *frame,
                                    const struct prog_op *op, const duite_call *call)
{
    struct prog_failure failure = PROG_NO_FAILURE;

    m->answers->runs[op->number]++;
    const uint64_t hash = act(m, frame, op->n_inner, prog_body_begin(call));
    const int returned = prog_body_end(call, hash), code = returned ? returned : frame->refused;

    if (code)
        failure = fail(m, frame->above, code);
    end_segment(m, frame);
    return failure;
}

void prog_interpret_fork(struct prog_machine *m, struct prog_frame *above, const struct prog_op *op,
                         uint64_t round)
{
    const size_t n_cells = op->n_inner ? PROG_MAX_TABLE : op->n;
    struct prog_frame *frame = prog_memory(1, sizeof *frame);
    duite_param param[PROG_MAX_PARAMS];
    struct prog_args args;
    const duite_call call = {.args = &args, .param = param, .n_params = op->n, .round = round};

    prog_args_fill(m->prog, op, above->shape, &args);
    frame->above = above;
    frame->ops = &m->prog->inner[op->body];
    frame->cells = prog_memory(n_cells, sizeof *frame->cells);
    frame->failed = PROG_NO_FAILURE;
    prog_shapes(&args, frame->shape);
    struct prog_failure failure = enter(frame, op, &args, param);

    if (!is_failure(failure))
        failure = run_task(m, frame, op, &call);
    for (unsigned i = 0; i < op->n; i++)
        leave(frame, i, (duite_mode)args.mode[i], above->object[op->objects[i]], param[i].count,
              failure);
    for (size_t i = 0; i < n_cells; i++)
        prog_cell_end(&frame->cells[i]);
    free(frame->cells);
    free(frame);
}

/* ---- The main program ---- */

/* The value, or why there is none. */
static void tell_value(struct prog_cell *cell, struct prog_expect *expect)
{
    prog_cell_settle(cell);
    expect->code = cell->poison.code;
    expect->count = cell->count;
    if (is_failure(cell->poison))
        return;
    expect->bytes = prog_memory(prog_cell_bytes(cell), 1);
    memcpy(expect->bytes, cell->value, prog_cell_bytes(cell));
}

static void get(struct prog_frame *frame, struct prog_cell *cell, struct prog_expect *expect)
{
    const int refused = take_refused(frame);

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
    if (op->mode == DUITE_W || !is_failure(cell->poison))
        prog_interpret_set(cell, &write);
    else
        cell->writes++;
}

/* The parts take the value, or the poison; and give it back. */
static void split(struct prog_frame *main, const struct prog_op *op)
{
    struct prog_cell *whole = prog_cell_settle(&main->cells[op->object]);
    const unsigned char *from = whole->value;

    for (unsigned i = 0; i < op->n; i++) {
        struct prog_cell *part = &main->cells[op->objects[i]];

        prog_cell_start(part, &main->shape[op->objects[i]]);
        memcpy(part->value, from, prog_cell_bytes(part));
        part->poison = whole->poison;
        part->writes++;
        from += prog_cell_bytes(part);
    }
    prog_cell_end(whole);
}

static void join(struct prog_frame *main, const struct prog_op *op)
{
    struct prog_cell *whole = &main->cells[op->object];

    prog_cell_start(whole, &main->shape[op->object]);
    unsigned char *to = whole->value;

    for (unsigned i = 0; i < op->n; i++) {
        struct prog_cell *part = prog_cell_settle(&main->cells[op->objects[i]]);

        memcpy(to, part->value, prog_cell_bytes(part));
        to += prog_cell_bytes(part);
        whole->poison = prog_first_failure(whole->poison, part->poison);
        prog_cell_end(part);
    }
    whole->writes++;
}

/* The first failure of some objects. */
static void wait_for(struct prog_frame *main, const struct prog_op *op, struct prog_expect *expect)
{
    struct prog_failure first = PROG_NO_FAILURE;

    for (unsigned i = 0; i < op->n; i++)
        first = prog_first_failure(first, prog_cell_settle(&main->cells[op->objects[i]])->poison);
    if (op->kind == PROG_WAIT_FOR) {
        const int refused = take_refused(main);

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
    const int refused = take_refused(main);

    expect->code = refused ? refused : expect->code;
}

static void operation(struct prog_machine *m, const struct prog_op *op, struct prog_expect *expect)
{
    struct prog_frame *main = m->main;
    struct prog_cell *cell = &main->cells[op->object];

    switch (op->kind) {
    case PROG_NEW:
        make_object(main, op);
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
        split(main, op);
        break;
    case PROG_JOIN:
        join(main, op);
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
        expect->code = wait_all(main);
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
    answers->stop = wait_all(main);
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
