/* Events: a task of a kernel with `events` is HELD. It ends when its body is over and all events
 * that the body made are completed: held->left counts both, and the last one ends the task. A
 * thread of the program cannot end tasks, so it hands the task to the workers by the shared queue.
 * Requests of MPI that a body hands over are one event, which the worker that finds them over
 * completes. */
#include "runtime/task/event.h"

#include "runtime/base/memory.h"
#include "runtime/task/internal.h"
#include "runtime/task/parts.h"

#include <sched.h>
#include <stdio.h>

/* The generation of a slot is odd while its event is not completed. */
struct task_event {
    struct task *task;
    struct task_held *held;      /* the task's */
    uint32_t generation, vacant; /* vacant: the next slot without an event, or 0 */
    int requests;                /* of MPI, which complete it; 0: the program does */
};

/* ---- The held task ---- */

void task_held_start(struct task_held *held)
{
    atomic_store_explicit(&held->failure, NULL, memory_order_relaxed);
    atomic_store_explicit(&held->left, 1, memory_order_relaxed);
}

void task_held_fail(struct task_held *held, const struct data_failure *failure)
{
    const struct data_failure *none = NULL;
    atomic_compare_exchange_strong(&held->failure, &none, failure);
}

bool task_held_release(struct task_held *held)
{
    return atomic_fetch_sub_explicit(&held->left, 1, memory_order_acq_rel) == 1;
}

void task_held_over(struct task_graph *graph, struct worker *worker, struct task *task)
{
    struct task_held *held = task_held_of(graph, task);
    if (task->state == TASK_HELD && !task_held_release(held))
        return; /* its events end it, at any moment from now on */
    const struct data_failure *failure = atomic_load(&held->failure);
    if (failure)
        task_poison_outputs(task, failure);
    const duite_kernel *kernel = graph->kernels[task->kernel];
    if (kernel == &task_join_kernel)
        task_join_over(task_rest(task, task->n), failure);
    else if (task->kernel - graph->own_kernels < graph->n_own && kernel != &task_split_kernel)
        graph->own_over(graph, task_rest(task, task->n), failure);
    task_finish(graph, worker, task);
}

/* ---- Events ---- */

/* The table's lock is held. Slot 0 stays free, so that {0, 0} names nothing. NULL without memory.
 */
static struct task_event *event_take(struct task_events *events, uint32_t *slot)
{
    *slot = events->vacant;
    if (!*slot) {
        const size_t n = events->n ? events->n : 1;
        if (!BASE_GROW(events->event, events->capacity, n + 1))
            return NULL;
        *slot = (uint32_t)n;
        events->n = (uint32_t)n + 1;
        events->event[n] = (struct task_event){0};
    }
    struct task_event *event = events->event + *slot;
    events->vacant = event->vacant;
    event->generation++;
    return event;
}

/* An event of the body's task, which so many requests of MPI complete, or with 0 the program. */
static int event_make(const duite_call *call, const char *name, int requests, duite_event *event)
{
    struct task *task = call->own->task;
    struct task_graph *graph = call->own->graph;
    struct task_held *held = call->own->held;
    uint32_t slot;
    *event = (duite_event){0, 0};
    if (task->state != TASK_HELD)
        return base_error(DUITE_E_STATE, "%s: kernel %s does not say that its tasks have events",
                          name, graph->kernels[task->kernel]->name);
    pthread_mutex_lock(&graph->lock);
    struct task_event *own = event_take(&graph->events, &slot);
    if (own) {
        own->task = task;
        own->held = held;
        own->requests = requests;
        graph->events.pending += !requests;
        *event = (duite_event){slot, own->generation};
        atomic_fetch_add_explicit(&held->left, 1, memory_order_relaxed);
    }
    pthread_mutex_unlock(&graph->lock);
    return own ? DUITE_OK : base_no_memory("an event");
}

int duite_event_new(const duite_call *call, duite_event *event)
{
    if (!event)
        return base_error(DUITE_E_ARGUMENT, "duite_event_new: nowhere to put the event");
    return event_make(call, "duite_event_new", 0, event);
}

/* Takes the event out of the table, one that requests of MPI complete or one of the program's.
 * False: it is not there. */
static bool event_remove(struct task_graph *graph, duite_event name, bool requests,
                         struct task_event *removed)
{
    struct task_events *events = &graph->events;
    pthread_mutex_lock(&graph->lock);
    struct task_event *event = name.slot < events->n ? events->event + name.slot : NULL;
    const bool there = event && event->generation == name.generation && name.generation % 2 &&
                       requests == (event->requests != 0);
    if (there) {
        *removed = *event;
        event->generation++;
        event->vacant = events->vacant;
        events->vacant = name.slot;
        events->pending -= !requests;
    }
    pthread_mutex_unlock(&graph->lock);
    return there;
}

/* Completes a removed event; failure: NULL, or of the event. Returns its task if nothing holds that
 * any more: it is ENDED. */
static struct task *event_complete(const struct task_event *event, struct data_failure *failure)
{
    struct task *task = event->task;
    if (failure)
        task_held_fail(event->held, task_fail_task(task, NULL, failure));
    if (!task_held_release(event->held))
        return NULL;
    task->state = TASK_ENDED;
    return task;
}

void task_end_later(struct task_graph *graph, struct task *task)
{
    queue_put(&graph->pool->shared, task);
    queue_wake_one(graph->pool, DUITE_NO_QUEUE);
}

void task_events_settle(struct task_graph *graph)
{
    while (atomic_load_explicit(&graph->events.inside, memory_order_acquire))
        sched_yield();
}

int task_complete(struct task_graph *graph, duite_event event, int code)
{
    struct data_failure failure = {.code = code, .text = "its event was completed with it"};
    struct task_event removed;
    atomic_fetch_add_explicit(&graph->events.inside, 1, memory_order_relaxed);
    const bool there = event_remove(graph, event, false, &removed);
    struct task *task = there ? event_complete(&removed, code ? &failure : NULL) : NULL;
    if (task)
        task_end_later(graph, task);
    atomic_fetch_sub_explicit(&graph->events.inside, 1, memory_order_release);
    if (there)
        return DUITE_OK;
    return base_error(DUITE_E_OBJECT, "duite_complete: event %u.%u was %s", event.slot,
                      event.generation, event.slot ? "completed already" : "never made");
}

uint32_t task_events_pending(struct task_graph *graph)
{
    pthread_mutex_lock(&graph->lock);
    const uint32_t n = graph->events.pending;
    pthread_mutex_unlock(&graph->lock);
    return n;
}

void task_events_look(struct task_graph *graph, task_event_seen *seen, void *context)
{
    const struct task_events *events = &graph->events;
    pthread_mutex_lock(&graph->lock); /* no task with an event ends meanwhile */
    for (uint32_t slot = 1; slot < events->n; slot++)
        if (events->event[slot].generation % 2)
            seen(context, events->event[slot].task,
                 (duite_event){slot, events->event[slot].generation}, events->event[slot].requests);
    pthread_mutex_unlock(&graph->lock);
}

/* ---- Requests of MPI ---- */

static int await_check(int n, const MPI_Request *requests)
{
    if (n < 0 || (n && !requests))
        return base_error(DUITE_E_ARGUMENT, "duite_await_mpi: %d requests %s", n,
                          n < 0 ? "cannot be" : "at NULL");
    for (int i = 0; i < n; i++)
        if (requests[i] == MPI_REQUEST_NULL)
            return base_error(DUITE_E_ARGUMENT,
                              "duite_await_mpi: request %d of %d is MPI_REQUEST_NULL: it never "
                              "began, is over, or was handed over before",
                              i + 1, n);
    return DUITE_OK;
}

int duite_await_mpi(const duite_call *call, int n, MPI_Request *requests)
{
    struct task_graph *graph = call->own->graph;
    int code = await_check(n, requests);
    if (code || !n)
        return code;
    struct comm_guest *guest = comm_guest_new(n, requests);
    if (!guest)
        return base_no_memory("requests of MPI");
    code = event_make(call, "duite_await_mpi", n, &guest->event);
    if (code) {
        base_free(guest);
        return code;
    }
    for (int i = 0; i < n; i++)
        requests[i] = MPI_REQUEST_NULL;
    comm_guest_add(&graph->guests, guest);
    queue_wake_one(graph->pool, DUITE_NO_QUEUE); /* an idle worker polls; this one may be busy */
    return DUITE_OK;
}

/* MPI's table of handles, too, is for one thread at a time. */
int duite_await_fortran(const duite_call *call, int n, MPI_Fint *requests)
{
    struct comm_guests *guests = &call->own->graph->guests;
    const bool holds = task_holds_mpi(call->own);
    MPI_Request *list;
    if (n <= 0 || !requests)
        return duite_await_mpi(call, n, NULL);
    if (!(list = base_alloc((size_t)n * sizeof *list)))
        return base_no_memory("requests of MPI");
    if (!holds)
        comm_guests_hold(guests, call->own);
    for (int i = 0; i < n; i++)
        list[i] = MPI_Request_f2c(requests[i]);
    const MPI_Fint none = MPI_Request_c2f(MPI_REQUEST_NULL);
    if (!holds)
        comm_guests_let_go(guests);
    const int code = duite_await_mpi(call, n, list);
    base_free(list);
    for (int i = 0; i < n && !code; i++)
        requests[i] = none;
    return code;
}

struct task *task_guest_over(struct task_graph *graph, struct comm_guest *guest)
{
    struct task_event removed;
    struct data_failure failure = {.code = DUITE_E_MPI};
    const bool there = event_remove(graph, guest->event, true, &removed), failed = guest->failed;
    if (failed)
        snprintf(failure.text, sizeof failure.text, "request %d of the %d that it awaits: %.120s",
                 guest->failed, guest->n, guest->text);
    base_free(guest);
    return there ? event_complete(&removed, failed ? &failure : NULL) : NULL;
}
