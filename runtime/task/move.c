/* Homes that change. A value is not tied to its object's home: who reads it finds its holder. So a
 * move is one more copy, of which the new home becomes the holder; what other ranks have of it
 * stays good. */
#include "runtime/task/internal.h"

/* Somebody has to wait for what comes: messages belong to tasks, and none may be left at stop. */
static int await(struct task_graph *graph, struct worker *worker, const struct data_object *object)
{
    struct task *task = task_new(&graph->root, TASK_MOVE, 1, 0);
    if (!task)
        return DUITE_E_MEMORY;
    uint32_t done = 0;
    task->block = object->block;
    task->access[0].waiter.mode = DUITE_R;
    task_read(task, 0, object->current, &done);
    task_settled(graph, worker, task, done);
    return DUITE_OK;
}

/* Zeros, as at the beginning, need no message. */
static void move_zeros(struct task_graph *graph, struct worker *worker, struct data_object *object,
                       int to)
{
    if (graph->rank != to)
        task_forget(graph, worker, object);
    data_object_moved(object, to);
}

static int move_value(struct task_graph *graph, struct worker *worker, struct data_object *object,
                      int to)
{
    bool sent = !data_object_has_copy(&graph->table, object, to);
    bool held = graph->rank == object->holder;
    int code = sent ? task_fetch(graph, worker, object, to) : DUITE_OK;
    if (!code && sent && graph->rank == to)
        code = await(graph, worker, object);
    if (code)
        return code;
    data_object_hand_on(&graph->table, object, to);
    if (held)
        task_forget(graph, worker, object);
    return DUITE_OK;
}

int task_move_object(struct task_graph *graph, struct worker *worker, struct data_object *object,
                     int home)
{
    int from = object->home;
    object->home = home;
    if (object->holder != from || object->leaves || from == home)
        return DUITE_OK;
    if (object->number)
        return move_value(graph, worker, object, home);
    move_zeros(graph, worker, object, home);
    return DUITE_OK;
}
