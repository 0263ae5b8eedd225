#ifndef DUITE_TASK_CALL_H
#define DUITE_TASK_CALL_H

#include "runtime/task/scope.h"

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Calls bodies; inline, for all runners of the program's tasks. */

/* The body's failure with this code. */
const struct data_failure *task_body_failure(const struct duite_call_private *body, int code);

/* Why nothing runs any more, or NULL. */
static inline const struct data_failure *task_given_up(struct task_graph *graph)
{
    return task_has_given_up(graph) ? &task_lost_failure : NULL;
}

/* A body's call, and the state behind the calls that it makes. One frame may serve many bodies, one
 * after another. */
struct task_frame {
    struct duite_call_private body;
    duite_call call;
};

/* Sets the part that is the same for all bodies of a worker. The rest stays unset until a body is
 * called. */
static inline void task_frame_init(struct task_frame *frame, struct task_graph *graph,
                                   struct worker *worker, const duite_call *template)
{
    frame->call = *template;
    frame->call.own = &frame->body;
    frame->body.graph = graph;
    frame->body.worker = worker;
}

/* Calls the task's body; returns its failure, or NULL. An unread error of its calls counts as one.
 * *scope is its children's scope; NULL as long as there is none. */
__attribute__((always_inline)) static inline const struct data_failure *
task_frame_call(struct task_frame *frame, struct task *task, const void *args,
                const duite_param *param, struct task_scope **scope)
{
    struct duite_call_private *body = &frame->body;
    struct task_graph *graph = body->graph;
    const duite_kernel *kernel = graph->kernels[task->kernel];
    body->task = task;
    body->param = param;
    body->scope = *scope;
    body->refused = DUITE_OK;
    body->remembered = DUITE_OK;
    body->text[0] = '\0';
    frame->call.args = args;
    frame->call.param = param;
    frame->call.n_params = task->n;
    body->outer = task_innermost;
    task_innermost = body; /* meanwhile calls on this thread are this body's */
    if (body->scope)
        task_nest_of(body->scope)->body = body;
    int code = __builtin_expect(graph->check != NULL, 0)
                   ? graph->check(graph->pool, kernel, task->number, &frame->call)
                   : kernel->body(&frame->call);
    task_innermost = body->outer;
    *scope = body->scope;
    if (*scope && task_nest_of(*scope)->splits)
        task_join_rest(body);
    if (!(code | body->refused | body->remembered))
        return NULL;
    return task_body_failure(body, code ? code : body->refused ? body->refused : body->remembered);
}

/* Runs a ready BODY that is LOCAL, in an initialised frame. True if its body was called; else its
 * outputs are poisoned. task_finish then ends the task. */
bool task_run_body(struct task_frame *frame, struct task *task);

#pragma GCC visibility pop

#endif
