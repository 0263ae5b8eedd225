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

int prog_interpret_refuse(struct prog_frame *frame, int code)
{
    frame->refused = frame->refused ? frame->refused : code;
    return code;
}

/* Takes what the next get or wait returns before all else. */
int prog_interpret_told(struct prog_frame *frame)
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

void prog_interpret_split(struct prog_frame *frame, const struct prog_op *op)
{
    struct prog_cell *whole = prog_cell_settle(frame->object[op->object]);
    const unsigned char *from = whole->value;

    for (unsigned i = 0; i < op->n; i++) {
        const unsigned place = op->objects[i];
        struct prog_cell *part = frame->object[place] = &frame->cells[place];

        frame->shape[place] = (struct prog_object){whole->type, op->part[i], 0, -1, 0};
        prog_cell_start(part, &frame->shape[place]);
        memcpy(part->value, from, prog_cell_bytes(part));
        part->poison = whole->poison;
        part->writes++;
        from += prog_cell_bytes(part);
    }
    prog_cell_end(whole);
    frame->split[frame->n_split++] = op;
}

void prog_interpret_join(struct prog_frame *frame, const struct prog_op *op)
{
    struct prog_cell *whole = frame->object[op->object];

    prog_cell_start(whole, &frame->shape[op->object]);
    unsigned char *to = whole->value;

    for (unsigned i = 0; i < op->n; i++) {
        struct prog_cell *part = prog_cell_settle(frame->object[op->objects[i]]);

        memcpy(to, part->value, prog_cell_bytes(part));
        to += prog_cell_bytes(part);
        whole->poison = prog_first_failure(whole->poison, part->poison);
        prog_cell_end(part);
    }
    whole->writes++;
    frame->n_split--; /* the last one is joined first */
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
        else if (op->kind == PROG_SPLIT)
            prog_interpret_split(frame, op);
        else if (op->kind == PROG_JOIN)
            prog_interpret_join(frame, op);
        else if (op->kind == PROG_CONTRIBUTE)
            contribute(frame, op);
    }
    frame->first_pending = frame->n_done;
}

int prog_interpret_wait(struct prog_frame *frame)
{
    int code = prog_interpret_told(frame);

    if (!code) {
        code = frame->failed.code;
        frame->failed = PROG_NO_FAILURE;
    }
    return code;
}

void prog_interpret_object(struct prog_frame *frame, const struct prog_op *op)
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
    const int refused = prog_interpret_told(frame), code = refused ? refused : cell->poison.code;
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
            prog_interpret_object(frame, op);
        } else if (op->kind == PROG_WRONG) {
            prog_interpret_refuse(frame, op->fails);
        } else if (op->kind == PROG_GET || op->kind == PROG_COUNT || op->kind == PROG_WAIT_FOR) {
            end_segment(m, frame);
            hash = get_in_body(frame, op, hash);
        } else if (op->kind == PROG_WAIT) {
            end_segment(m, frame);
            hash = prog_body_told(hash, prog_interpret_wait(frame), NULL, 0);
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
    while (frame->n_split)
        prog_interpret_join(frame, frame->split[frame->n_split - 1]);
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

    if (!prog_is_failure(failure))
        failure = run_task(m, frame, op, &call);
    for (unsigned i = 0; i < op->n; i++)
        leave(frame, i, (duite_mode)args.mode[i], above->object[op->objects[i]], param[i].count,
              failure);
    for (size_t i = 0; i < n_cells; i++)
        prog_cell_end(&frame->cells[i]);
    free(frame->cells);
    free(frame);
}
