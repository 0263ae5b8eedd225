#ifndef DUITE_TASK_SCOPE_H
#define DUITE_TASK_SCOPE_H

#include "runtime/task/internal.h"

#pragma GCC visibility push(hidden) /* called directly: no program can come in between */

/* What a task's scope consists of; shared by scope.c and scope_end.c. */

/* Where a lent parameter goes back to. */
struct task_exit {
    struct data_waiter waiter; /* first; heir of `in`, without a task */
    struct task_scope *scope;
    struct data_version *in, *out; /* wp, rwp */
    struct data_sum *sum;          /* cwp: the sum of the scope above, and this task's leaf */
    struct data_piece *leaf;
    const struct data_failure *failure; /* of the task itself */
    size_t bytes;
    bool overwrites, untouched; /* wp; and nobody did: then old poison does not count */
};

struct task_nest {
    struct task_scope scope; /* first */
    struct duite_call_private *body;
    const struct data_failure *failure; /* of the task, or NULL */
    uint32_t n_lent;                    /* parameters: the first objects */
    uint32_t n_local;                   /* objects; freed ones are among them */
    uint32_t room;
    uint32_t vacant;     /* index + 1 of the first freed object, or 0 */
    uint32_t first_read; /* index + 1 of the first of n objects, one a parameter: those under r
                            are the children's, too; 0 until one is asked for */
    struct data_object *local; /* generation 0: freed, and `hint` links it to the next of these */
    bool moved;                /* `local` is a block of its own */
    size_t size;               /* of this block */
    struct task_exit exit[];   /* n_lent; then the first `room` of local */
};

static inline struct task_nest *task_nest_of(struct task_scope *scope)
{
    return (struct task_nest *)scope;
}

/* The children may read what the body reads: the scope gets the objects. Errors: memory. */
int task_lend_reads(struct task_scope *scope);

#pragma GCC visibility pop

#endif
