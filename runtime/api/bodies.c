/* The calls of a running body: the same as the main program's, on its own scope, and not
 * collective. A call that returns at once remembers its error for the body's next get or wait; an
 * error that no call returned fails the body. */
#include "runtime/api/instance.h"

#include "runtime/base/error.h"
#include "runtime/task/event.h"
#include "runtime/task/fork.h"
#include "runtime/task/parts.h"

#include <stdio.h>
#include <string.h>

/* Errors of the most frequent calls are functions apart, or each call would save registers for
 * them. */
#define BODY_ERROR __attribute__((noinline, cold)) static int

BODY_ERROR body_keep(struct duite_call_private *body, int code)
{
    if (body->remembered)
        return code;
    body->remembered = code;
    snprintf(body->message, sizeof body->message, "%s", duite_message());
    return code;
}
static inline int body_remember(struct duite_call_private *body, int code)
{
    return code ? body_keep(body, code) : DUITE_OK;
}

/* True if the body may make a call: not after memory ran out in a fork of any task. */
static inline bool body_may_call(const struct duite_call_private *body)
{
    return !atomic_load_explicit(&body->graph->broken, memory_order_relaxed);
}
BODY_ERROR body_refuse(int broken, const char *call)
{
    return base_error(broken, "%s: an earlier call failed beyond repair (%s)", call,
                      duite_code_text(broken));
}
static inline int body_enter(const struct duite_call_private *body, const char *call)
{
    const int broken = atomic_load_explicit(&body->graph->broken, memory_order_relaxed);
    return broken ? body_refuse(broken, call) : DUITE_OK;
}

static int body_recall(struct duite_call_private *body)
{
    int code = body->remembered;
    body->remembered = DUITE_OK;
    return code ? base_error(code, "%s", body->message) : DUITE_OK;
}

BODY_ERROR new_refuse(struct duite_call_private *body, const char *call)
{
    const int code = body_enter(body, call);
    return body_remember(
        body, code ? code : base_error(DUITE_E_ARGUMENT, "%s: nowhere to put the object", call));
}

int api_body_new(struct duite_call_private *body, duite_type type, size_t count, size_t max,
                 bool sized, duite_object *object)
{
    if (!object || !body_may_call(body))
        return new_refuse(body, sized ? "duite_new_sized" : "duite_new");
    return body_remember(body, task_make_object(body, type, count, max, sized, object));
}

int api_body_free(struct duite_call_private *body, duite_object object)
{
    int code = body_enter(body, "duite_free");
    if (!code)
        code = task_check_call(body, "duite_free", object, DUITE_RWP);
    if (!code && task_lent(body, object))
        code = base_error(DUITE_E_RIGHT, "duite_free: the object is the caller's");
    if (!code)
        code = task_free_object(task_inside(body), body->worker, object);
    return body_remember(body, code);
}

/* The first fork of a body that has no scope yet. */
__attribute__((noinline)) static int fork_first(struct duite_call_private *body,
                                                const duite_kernel *kernel, const void *args,
                                                size_t n, const duite_object *objects)
{
    int code = body_enter(body, "duite_fork");
    if (!code)
        code = task_inside(body)
                   ? task_fork_nested(body->scope, body->worker, kernel, args, n, objects)
                   : DUITE_E_MEMORY;
    return body_remember(body, code);
}

int api_body_fork(struct duite_call_private *body, const duite_kernel *kernel, const void *args,
                  size_t n, const duite_object *objects)
{
    if (!body->scope || !body_may_call(body))
        return fork_first(body, kernel, args, n, objects);
    return body_remember(body,
                         task_fork_nested(body->scope, body->worker, kernel, args, n, objects));
}

int api_body_fork_with(struct duite_call_private *body, const duite_task_options *options,
                       const duite_kernel *kernel, const void *args, size_t n,
                       const duite_object *objects)
{
    struct task_options own = {.at = TASK_ANYWHERE};
    int code = body_enter(body, "duite_fork");
    if (!code && options && options->at)
        code = base_error(DUITE_E_STATE,
                          "duite_fork_with: the children of a task run on its rank (%d), none can "
                          "be named",
                          body->graph->rank);
    if (options) {
        own.priority = options->priority;
        own.cost = options->cost > 0 ? options->cost : 0;
    }
    struct task_scope *scope = code ? NULL : task_inside(body);
    if (!code)
        code =
            scope ? task_fork(scope, body->worker, &own, kernel, args, n, objects) : DUITE_E_MEMORY;
    return body_remember(body, code);
}

int api_body_set(struct duite_call_private *body, duite_object object, const void *values,
                 const size_t *count, const char *call)
{
    int code = body_enter(body, call);
    if (!code)
        code = task_check_call(body, call, object, DUITE_W);
    if (!code)
        code =
            task_set_object(task_inside(body), body->worker, object, TASK_ANYWHERE, values, count);
    return body_remember(body, code);
}

int api_body_split(struct duite_call_private *body, duite_object object, size_t n,
                   const size_t *counts, const duite_object *parts)
{
    int code = body_enter(body, "duite_split");
    if (!code && !parts)
        code = base_error(DUITE_E_ARGUMENT, "duite_split: nowhere to put the parts");
    if (!code)
        code = task_check_call(body, "duite_split", object, DUITE_RWP);
    if (!code)
        code = task_split(body->graph, body, body->worker, object, n, counts);
    return body_remember(body, code);
}

int api_body_join(struct duite_call_private *body, duite_object object)
{
    const int code = body_enter(body, "duite_join");
    return body_remember(body, code ? code : task_join(body->graph, body, body->worker, object));
}

/* A body that waits with MPI held could wait for ever. */
static int body_enter_wait(const struct duite_call_private *body, const char *call)
{
    if (task_holds_mpi(body))
        return base_error(DUITE_E_STATE,
                          "%s: a task of kernel %s waits between duite_mpi_begin and duite_mpi_end",
                          call, body->graph->kernels[body->task->kernel]->name);
    return body_enter(body, call);
}

/* `text` becomes the task's message if the body returns the code. */
BODY_ERROR body_too_deep(struct duite_call_private *body, const char *text)
{
    snprintf(body->text, sizeof body->text, "%s", text);
    return DUITE_E_DEPTH;
}

/* The wait did not begin (code), or ended early because communication broke. */
static int body_broken(struct duite_call_private *body, int code)
{
    if (code)
        return body_too_deep(body, duite_message());
    return base_error(DUITE_E_MPI,
                      "communication between the ranks broke while a task of kernel %s waited",
                      body->graph->kernels[body->task->kernel]->name);
}

static bool version_is_there(void *context)
{
    return data_version_ready(context);
}

/* Copies the version's value, or only counts its bytes. */
static int body_read(struct duite_call_private *body, struct data_version *version, void *values,
                     size_t *bytes)
{
    struct task_scope *scope = task_inside(body);
    int code = DUITE_OK;
    if (!data_version_ready(version))
        code = work_inside(body->worker, scope, version_is_there, version);
    if (!data_version_ready(version))
        return body_broken(body, code);
    task_close_segment(scope);
    if (version->poisoned && version->failure->code == DUITE_E_DEPTH)
        body_too_deep(body, version->failure->text);
    if (version->poisoned)
        return task_failure_error(body->graph, version->failure);
    *bytes = version->packet->bytes;
    if (values)
        memcpy(values, data_payload(version->packet), *bytes);
    return DUITE_OK;
}

static int body_get(struct duite_call_private *body, duite_object object, void *values,
                    size_t *count, const char *call)
{
    struct data_version *version = NULL;
    size_t bytes = 0, size;
    int code = body_enter_wait(body, call);
    if (!code && !values && !count)
        code = base_error(DUITE_E_ARGUMENT, "%s: nowhere to put the answer", call);
    if (!code)
        code = task_see(body, call, object, &version, &size);
    if (code)
        return code;
    code = body_read(body, version, values, &bytes);
    if (!code && count)
        *count = bytes / size;
    return code;
}

__attribute__((noinline)) static int get_any(struct duite_call_private *body, duite_object object,
                                             void *values, size_t *count, const char *call)
{
    int code = body_get(body, object, values, count, call);
    int before = body_recall(body);
    return before ? before : code;
}

/* The short way of most gets, of one number that a child writes or wrote. */
int api_body_get(struct duite_call_private *body, duite_object object, void *values, size_t *count,
                 const char *call)
{
    struct data_version *version =
        values && body_may_call(body) ? task_see_given(body, object) : NULL;
    if (!version || (body->remembered | body->refused))
        return get_any(body, object, values, count, call);
    if (!data_version_ready(version))
        work_inside(body->worker, body->scope, version_is_there, version);
    if (!data_version_ready(version) || version->poisoned ||
        version->packet->bytes != sizeof(uint64_t))
        return get_any(body, object, values, count, call);
    task_close_segment(body->scope);
    memcpy(values, data_payload(version->packet), sizeof(uint64_t));
    return DUITE_OK;
}

/* The first object in the list that has an error decides. */
int api_body_wait_for(struct duite_call_private *body, size_t n, const duite_object *objects)
{
    char text[1024];
    int code = n && !objects ? base_error(DUITE_E_ARGUMENT, "duite_wait_for: the objects are NULL")
                             : DUITE_OK;
    snprintf(text, sizeof text, "%s", duite_message());
    for (size_t i = 0; i < n && objects; i++) {
        size_t count;
        const int own = body_get(body, objects[i], NULL, &count, "duite_wait_for");
        if (own && !code)
            snprintf(text, sizeof text, "%s", duite_message());
        code = code ? code : own;
    }
    const int before = body_recall(body);
    if (before)
        return before;
    return code ? base_error(code, "%s", text) : DUITE_OK;
}

static bool body_is_alone(void *context)
{
    return task_alone(context);
}

int api_body_wait(struct duite_call_private *body)
{
    struct task_scope *scope = body->scope;
    int code = DUITE_OK;
    if (task_holds_mpi(body))
        return body_enter_wait(body, "duite_wait");
    if (!scope)
        return body_recall(body);
    if (!task_alone(scope))
        code = work_inside(body->worker, scope, body_is_alone, scope);
    if (!task_alone(scope))
        return body_broken(body, code);
    task_close_segment(scope);
    code = body_recall(body);
    const struct data_failure *failure = code ? NULL : task_first_failure(scope);
    return failure ? task_failure_error(body->graph, failure) : code;
}

/* ---- MPI and events ---- */

/* body->refused makes sure that the end of a body which still holds MPI is seen. */
int api_body_mpi_begin(struct duite_call_private *body)
{
    if (task_holds_mpi(body))
        return base_error(DUITE_E_STATE, "duite_mpi_begin: it was called before in this body");
    comm_guests_hold(&body->graph->guests, body);
    if (!body->refused)
        body->refused = DUITE_E_STATE;
    return DUITE_OK;
}

int api_body_mpi_end(struct duite_call_private *body)
{
    if (!task_holds_mpi(body))
        return base_error(DUITE_E_STATE,
                          "duite_mpi_end: duite_mpi_begin was not called in this body");
    comm_guests_let_go(&body->graph->guests);
    if (body->refused == DUITE_E_STATE)
        body->refused = DUITE_OK;
    return DUITE_OK;
}

/* From any thread. */
int duite_complete(duite *rt, duite_event event, int code)
{
    if (!rt)
        return base_error(DUITE_E_ARGUMENT, "duite_complete: no runtime");
    return task_complete(&rt->graph, event, code);
}
