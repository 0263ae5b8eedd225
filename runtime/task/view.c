/* Views are gathered when they are asked for: a view whose elements were taken from an older
 * version of its parent than the forks so far leave gets a new version, written where the parent's
 * value is by a task that reads the parent. Every rank concludes the same. From then on the view is
 * an object like any other, and what travels between ranks is the view. */
#include "runtime/task/internal.h"

#include "runtime/data/view.h"

static int gather_here(struct task_graph *graph, struct worker *worker, struct data_object *object,
                       struct data_object *parent)
{
    struct data_version *version = task_local(graph, parent);
    struct task *task = version ? task_new(&graph->root, TASK_VIEW, 2, 0) : NULL;
    if (!task)
        return DUITE_E_MEMORY;
    uint32_t done = 0;
    task->block = object->block;
    task->access[0].waiter.mode = DUITE_R;
    task_read(task, 0, version, &done);
    task->access[1].waiter.mode = DUITE_W;
    version = task_rename(graph, worker, object);
    int code = task_overwrite(graph, task, 1, object, version, &done);
    if (code) {
        task_void(graph, worker, task, 1, done);
        return code;
    }
    task->view = data_view_hold(object->view);
    task_settled(graph, worker, task, done);
    return DUITE_OK;
}

int task_view_gather(struct task_graph *graph, struct worker *worker, struct data_object *object)
{
    struct data_view *view = object->view;
    if (!view)
        return DUITE_OK;
    struct data_object *parent = &graph->table.object[view->parent];
    int code = parent->leaves ? task_close_sum(&graph->root, worker, parent) : DUITE_OK;
    if (code || view->seen == parent->number + 1)
        return code;
    view->seen = parent->number + 1;
    object->number++;
    data_object_moved(object, parent->holder);
    if (parent->holder == graph->rank)
        return gather_here(graph, worker, object, parent);
    task_forget(graph, worker, object);
    return DUITE_OK;
}
