/* What a tree of tasks means. Places in the reference order are numbered as they come by; an object
 * is its value, the failure it descends from and its open contributions: complete subtrees of
 * decreasing size, oldest first, where a subtree without any contribution has no value. */

#include "tests/runtime/nested_program.h"

#include <stdlib.h>
#include <string.h>

enum { BYTES = NEST_MAX_COUNT * 8, MAX_LEVELS = 16 };

struct failure {
    unsigned place;
    int code;
};
static const struct failure NONE = {~0u, DUITE_OK};

struct subtree {
    unsigned level;
    bool present;
    _Alignas(8) unsigned char value[BYTES];
};

struct cell {
    duite_type type;
    size_t count, max;
    unsigned law; /* of the open contributions */
    _Alignas(8) unsigned char value[BYTES];
    struct failure poison, pending; /* pending: of the contributions */
    unsigned writes;
    unsigned n_subtrees;
    struct subtree subtree[MAX_LEVELS];
};

/* A task that runs, and those above it. */
struct frame {
    struct frame *above;
    const struct nest_task *task;
    struct cell *object[NEST_MAX_OBJECTS];
    unsigned writes[NEST_MAX_PARAMS]; /* of what it was given */
    unsigned n_objects;
    struct cell made[NEST_MAX_OBJECTS];
    unsigned first_pending, n_done; /* actions that wait for the end of the segment: up to n_done */
    struct failure failed;          /* of its descendants since its last wait */
};

struct machine {
    const struct nest_program *program;
    struct nest_answers *answers;
    unsigned place;
    bool no_memory;
};

static struct failure first_of(struct failure a, struct failure b)
{
    return a.place <= b.place ? a : b;
}

static void add(const struct cell *cell, void *left, const void *right)
{
    for (size_t i = 0; i < cell->count; i++)
        if (cell->type == DUITE_F64)
            ((double *)left)[i] += ((const double *)right)[i];
        else if (cell->type == DUITE_F32)
            ((float *)left)[i] += ((const float *)right)[i];
        else if (cell->type == DUITE_I32)
            ((uint32_t *)left)[i] += ((const uint32_t *)right)[i];
        else
            ((uint64_t *)left)[i] += ((const uint64_t *)right)[i];
}

/* Of numbers that are never equal to -0 and never NaN. */
static void choose(const struct cell *cell, void *left, const void *right, bool largest)
{
#define CHOOSE(type)                                                                               \
    if (largest ? ((const type *)right)[i] > ((type *)left)[i]                                     \
                : ((const type *)right)[i] < ((type *)left)[i])                                    \
    ((type *)left)[i] = ((const type *)right)[i]
    for (size_t i = 0; i < cell->count; i++) {
        if (cell->type == DUITE_F64) {
            CHOOSE(double);
        } else if (cell->type == DUITE_F32) {
            CHOOSE(float);
        } else if (cell->type == DUITE_I32) {
            CHOOSE(int32_t);
        } else {
            CHOOSE(int64_t);
        }
    }
#undef CHOOSE
}

static void combine(const struct cell *cell, void *left, const void *right)
{
    if (cell->law == 0)
        add(cell, left, right);
    else if (cell->law == 3)
        nest_law(left, right, cell->count, cell->type);
    else
        choose(cell, left, right, cell->law == 2);
}

/* left becomes left and right; what is absent is skipped. */
static void join(const struct cell *cell, struct subtree *left, const struct subtree *right)
{
    if (left->present && right->present)
        combine(cell, left->value, right->value);
    else if (right->present)
        memcpy(left->value, right->value, BYTES);
    left->present |= right->present;
}

static void settle(struct cell *cell);

static void contribute(struct cell *cell, unsigned law, const void *value)
{
    if (cell->law != law)
        settle(cell);
    cell->law = law;
    struct subtree *top = &cell->subtree[cell->n_subtrees++];

    *top = (struct subtree){.present = value != NULL};
    if (value)
        memcpy(top->value, value, BYTES);
    for (; cell->n_subtrees > 1 && top[-1].level == top->level; cell->n_subtrees--) {
        join(cell, &top[-1], top);
        top--;
        top->level++;
    }
}

/* The whole tree in the first subtree; whether there is one with a value. */
static bool fold(struct cell *cell)
{
    if (!cell->n_subtrees)
        return false;
    for (; cell->n_subtrees > 1; cell->n_subtrees--)
        join(cell, &cell->subtree[cell->n_subtrees - 2], &cell->subtree[cell->n_subtrees - 1]);
    cell->n_subtrees = 0;
    return cell->subtree[0].present;
}

/* Any access but cw and cwp. */
static void settle(struct cell *cell)
{
    if (fold(cell))
        combine(cell, cell->value, cell->subtree[0].value);
    cell->poison = first_of(cell->poison, cell->pending);
    cell->pending = NONE;
}

static void start(struct cell *cell, duite_type type, size_t count, size_t max)
{
    memset(cell, 0, sizeof *cell);
    cell->type = type;
    cell->count = count;
    cell->max = max;
    cell->poison = cell->pending = NONE;
}

static void run_task(struct machine *m, struct frame *above, unsigned number,
                     const unsigned *objects);

static void set(const struct nest_action *action, struct cell *cell)
{
    settle(cell);
    cell->writes++;
    cell->poison = NONE;
    memset(cell->value, 0, BYTES);
    cell->count = action->seed ? action->count : cell->max;
    if (action->seed)
        nest_values(cell->type, cell->count, action->seed, cell->value);
}

static void contribute_self(const struct nest_action *action, unsigned law, struct cell *cell)
{
    _Alignas(8) unsigned char value[BYTES] = {0};

    nest_values(cell->type, cell->count, action->seed, value);
    contribute(cell, law, value);
}

/* The children forked so far come now. */
static void end_segment(struct machine *m, struct frame *frame)
{
    for (unsigned a = frame->first_pending; a < frame->n_done; a++) {
        const struct nest_action *action = &frame->task->action[a];

        if (action->kind == NEST_FORK)
            run_task(m, frame, action->task, action->object);
        else if (action->kind == NEST_SET)
            set(action, frame->object[action->object[0]]);
        else if (action->kind == NEST_CONTRIBUTE)
            contribute_self(action, frame->task->law, frame->object[action->object[0]]);
    }
    frame->first_pending = frame->n_done;
}

static uint64_t told(struct machine *m, struct frame *frame, unsigned a, int code,
                     const struct cell *cell, uint64_t digest)
{
    struct nest_answer answer = {.code = code};

    if (cell && !code) {
        answer.bytes = cell->count * nest_size(cell->type);
        memcpy(answer.value, cell->value, answer.bytes);
    }
    if (!frame->above)
        m->answers->of[a] = answer;
    digest = nest_mix(digest, &code, sizeof code);
    return nest_mix(digest, answer.value, answer.bytes);
}

/* Does what the task does; returns what it knows in the end. */
static uint64_t act(struct machine *m, struct frame *frame, uint64_t digest)
{
    for (unsigned a = 0; a < frame->task->n_actions; a++) {
        const struct nest_action *action = &frame->task->action[a];

        frame->n_done = a + 1;
        if (action->kind == NEST_REPLAY) {
            frame->n_done = a + 1 + (unsigned)action->count;
            for (size_t round = 0; round < action->max; round++) {
                frame->first_pending = a + 1;
                end_segment(m, frame);
            }
            a += (unsigned)action->count;
        } else if (action->kind == NEST_NEW) {
            struct cell *cell = &frame->made[frame->n_objects];

            start(cell, action->type, action->count, action->max);
            frame->object[frame->n_objects++] = cell;
        } else if (action->kind == NEST_GET) {
            struct cell *cell = frame->object[action->object[0]];

            end_segment(m, frame);
            settle(cell);
            digest = told(m, frame, a, cell->poison.code, cell, digest);
        } else if (action->kind == NEST_WAIT) {
            end_segment(m, frame);
            digest = told(m, frame, a, frame->failed.code, NULL, digest);
            frame->failed = NONE;
        } else if (!frame->above) {
            end_segment(m, frame); /* the main program's tasks come in fork order */
        }
    }
    return digest;
}

static bool immediate(duite_mode mode)
{
    return mode <= DUITE_CW;
}

/* What the task was given: its own copies of what it uses itself, the very objects of what its
 * children use, a new tree for their contributions. Returns the poison it reads. */
static struct failure enter(struct frame *frame, struct frame *above, const unsigned *objects,
                            struct cell *own, duite_param *param)
{
    struct failure failure = NONE;

    for (unsigned i = 0; i < frame->task->n; i++) {
        const duite_mode mode = frame->task->mode[i];
        struct cell *cell = above->object[objects[i]];

        frame->writes[i] = cell->writes;
        frame->object[i] = immediate(mode) || mode == DUITE_CWP ? &own[i] : cell;
        if (mode != DUITE_CW && mode != DUITE_CWP)
            settle(cell);
        start(&own[i], cell->type, mode == DUITE_W ? cell->max : cell->count, cell->max);
        own[i].law = frame->task->law;
        param[i] = (duite_param){.count = own[i].count, .type = cell->type, .max = cell->max};
        if (immediate(mode))
            param[i].data = own[i].value;
        if (mode == DUITE_R || mode == DUITE_RW) {
            memcpy(own[i].value, cell->value, BYTES);
            failure = first_of(failure, cell->poison);
        }
    }
    frame->n_objects = frame->task->n;
    return failure;
}

/* What the task did to the objects of the one above. */
static void leave(const struct frame *frame, struct frame *above, const unsigned *objects,
                  struct cell *own, const duite_param *param, struct failure failure)
{
    for (unsigned i = 0; i < frame->task->n; i++) {
        const duite_mode mode = frame->task->mode[i];
        struct cell *cell = above->object[objects[i]];
        struct failure bad = first_of(failure, own[i].pending);

        if (mode == DUITE_W || mode == DUITE_RW) {
            memcpy(cell->value, own[i].value, BYTES);
            cell->count = param[i].count;
            cell->poison = failure;
            cell->writes++;
        } else if (mode == DUITE_WP || mode == DUITE_RWP) {
            settle(cell);
            if (mode == DUITE_WP && cell->writes == frame->writes[i]) {
                memset(cell->value, 0, BYTES); /* what was there does not count */
                cell->count = cell->max;
                cell->poison = NONE;
            }
            cell->writes++;
            cell->poison = first_of(cell->poison, failure);
        } else if (mode == DUITE_CW || mode == DUITE_CWP) {
            const bool present = mode == DUITE_CW || fold(&own[i]);

            contribute(cell, frame->task->law,
                       !present           ? NULL
                       : mode == DUITE_CW ? own[i].value
                                          : own[i].subtree[0].value);
            cell->pending = first_of(cell->pending, bad);
        }
    }
}

static void fail(struct frame *frame, struct failure failure)
{
    for (; frame; frame = frame->above)
        frame->failed = first_of(frame->failed, failure);
}

static void run_task(struct machine *m, struct frame *above, unsigned number,
                     const unsigned *objects)
{
    const struct nest_task *task = &m->program->task[number];
    struct frame *frame = calloc(1, sizeof *frame);
    struct cell *own = calloc(NEST_MAX_PARAMS, sizeof *own);
    duite_param param[NEST_MAX_PARAMS];

    if (!frame || !own) {
        m->no_memory = true;
    } else {
        frame->above = above;
        frame->task = task;
        frame->failed = NONE;
        struct failure failure = enter(frame, above, objects, own, param);

        if (failure.place == NONE.place) {
            m->answers->runs[number]++;
            const uint64_t digest = act(m, frame, nest_read(task, param));

            for (unsigned i = 0; i < task->n; i++)
                param[i].count = nest_count(task, param, i, digest);
            nest_write(task, param, digest);
            if (task->fails) {
                failure = (struct failure){m->place++, task->fails};
                fail(above, failure);
            }
            end_segment(m, frame);
        }
        leave(frame, above, objects, own, param, failure);
    }
    free(own);
    free(frame);
}

bool nest_interpret(const struct nest_program *program, struct nest_answers *answers)
{
    struct machine m = {.program = program, .answers = answers};
    struct frame *frame = calloc(1, sizeof *frame);

    memset(answers, 0, sizeof *answers);
    if (!frame)
        return false;
    frame->task = &program->task[0];
    frame->failed = NONE;
    act(&m, frame, 0);
    free(frame);
    return !m.no_memory;
}
