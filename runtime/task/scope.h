#ifndef DUITE_TASK_SCOPE_H
#define DUITE_TASK_SCOPE_H

#include "runtime/task/internal.h"

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* The parts of a task's scope, for the files that make, use and end it. */

/* The way back of a lent parameter. */
struct task_exit {
    struct data_waiter waiter; /* first; heir of `in`, without a task */
    struct task_scope *scope;
    struct data_version *in, *out; /* wp, rwp */
    struct data_sum *sum;          /* cwp: the sum of the scope above, and this task's leaf */
    struct data_piece *leaf;
    const struct data_failure *failure; /* of the task itself */
    size_t bytes;
    bool overwrites, untouched; /* wp; and no child wrote it: then old poison does not count */
};

struct task_nest {
    struct task_scope scope; /* first */
    struct duite_call_private *body;
    const struct data_failure *failure; /* of the task, or NULL */
    uint32_t n_lent;                    /* parameters: the first objects */
    uint32_t n_local;                   /* objects; freed ones are among them */
    uint32_t room;
    uint32_t cells;  /* bytes from here to the cells of the first objects made; 0: it has none */
    uint32_t vacant; /* index + 1 of the first freed object, or 0 */
    uint32_t first_read; /* index + 1 of the first of n objects, one a parameter: those under r
                            are the children's, too; 0 until one is asked for */
    struct data_object *local; /* generation 0: freed, and `hint` links it to the next of these;
                                  else `hint` is 0, or bytes from here to its cell */
    bool moved;                /* `local` is a block of its own */
    uint32_t splits;           /* objects that are split now */
    size_t size;               /* of this block */
    struct task_exit exit[];   /* n_lent; then the first `room` of local, and the cells */
};

/* The first version of a small object that a body made, and its bytes. They lie in the scope, which
 * all tasks that use them keep alive: most objects of a body are written once and read by get. */
struct task_cell {
    struct data_version version;
    _Alignas(BASE_LINE) struct data_packet packet;
    char bytes[BASE_LINE];
};

static inline struct task_nest *task_nest_of(struct task_scope *scope)
{
    return (struct task_nest *)scope;
}

/* A version of the object, to be written by a child; `fresh`: there is none yet. NULL without
 * memory. */
static inline struct data_version *task_child_version(struct task_scope *scope,
                                                      struct data_object *object, bool fresh)
{
    if (!fresh || !object->hint)
        return data_object_version(object);
    struct task_cell *cell = (void *)((char *)scope + object->hint);
    object->hint = 0;
    cell->packet.bytes = object->room;
    cell->packet.lines = 0;
    cell->packet.elsewhere = NULL;
    cell->version = (struct data_version){.holds = 2,
                                          .type = (uint8_t)object->type,
                                          .lent = true,
                                          .max = object->max,
                                          .packet = &cell->packet};
    return &cell->version;
}

/* True if the scope of a running body knows the name. *right is the right held on it; *local the
 * object, or NULL if only the body itself uses it. */
static inline bool task_name_known(struct task_scope *scope, duite_object name, duite_mode *right,
                                   struct data_object **local)
{
    struct task_nest *nest = task_nest_of(scope);
    const struct duite_call_private *body = nest->body;
    const struct task *task = body->task;
    uint32_t i = name.slot & ~TASK_LOCAL_NAME;
    *local = NULL;
    if (name.slot < TASK_LOCAL_NAME)
        return false;
    if (i < task->n) {
        *right = data_mode_of(scope->graph->kernels[task->kernel], i);
        if (task_postponed(*right))
            *local = &nest->local[task->access[i].lent];
        else if (*right == DUITE_R && nest->first_read)
            *local = &nest->local[nest->first_read - 1 + i];
        return name.generation == body->param[i].object.generation;
    }
    uint32_t at = i - task->n + nest->n_lent;
    if (at >= nest->n_local)
        return false;
    *right = DUITE_RWP;
    *local = &nest->local[at];
    return (*local)->generation == name.generation;
}

/* True if a task that holds a right on an object may give a child the wanted one. */
static inline bool task_right_gives(duite_mode held, duite_mode wanted)
{
    if (held == DUITE_RWP)
        return true;
    return (task_postponed(held) || held == DUITE_R) &&
           task_immediate(wanted) == task_immediate(held);
}

/* The object of that name, if a child of the body may have it with this mode at once. Else NULL;
 * task_check_right says why, or prepares it. Inline: each fork and get asks. */
static inline struct data_object *task_find_given(struct task_scope *scope, duite_object name,
                                                  duite_mode wanted)
{
    struct data_object *local;
    duite_mode held;
    return task_name_known(scope, name, &held, &local) && task_right_gives(held, wanted) ? local
                                                                                         : NULL;
}

/* The failure of a task's results for lack of memory. */
extern const struct data_failure task_scope_no_memory;

#pragma GCC visibility pop

#endif
