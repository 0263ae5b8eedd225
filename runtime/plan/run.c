/* Running a plan. A node belongs to the worker that runs it from the moment its counter is 0 until
 * its last successor is counted down, but for one with events: between the end of its body and of
 * its last event it is nobody's (task/event.c). A worker owns an awaited node (node.h) from the
 * moment nothing is missing. Its own counter goes back to `steady` before the first of these
 * decrements, to count for its next round, where no node that it waits for has run yet (see
 * edges.c). A replay is over when all sinks of its last round are. Every other node comes before
 * one of these, and a node with successors to count down keeps one of them waiting. So after its
 * last decrement, of a successor or of the sinks, a worker must not touch the plan: it may be
 * freed.
 *
 * Poison is kept by place, under the same dependences as the bytes. Workers look at it only once
 * something failed: a worker that sees the effects of a failure also sees `tainted`. */
#include "runtime/plan/node.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/data/object.h"

#include <complex.h>
#include <string.h>

/* ---- Beginning and end ---- */

static void place_move(struct plan *plan, struct plan_place *place, void *data)
{
    if (place->data == data)
        return;
    place->data = data;
    for (size_t i = 0; i < place->n_params; i++)
        plan->param[plan->param_of[place->first_param + i]].data = data;
}

/* Takes the present bytes of an object's version, and its poison; rounds work on them in place.
 * False without memory. */
static bool place_bind(struct plan *plan, const struct task_access *access,
                       struct plan_place *place)
{
    struct data_version *version = access->waiter.version;
    place->failure = NULL;
    if (place->mode == DUITE_NONE)
        return true;
    place->failure = data_version_failure(version);
    if (place->failure)
        plan_taint(plan, PLAN_POISONED);
    struct data_packet *packet = data_version_packet(version);
    if (place->mode != DUITE_R && !packet) { /* poisoned again at the end */
        packet = data_packet_new(place->bytes, false);
        version->poisoned = false;
        version->packet = packet;
        if (!packet)
            return false;
    }
    place_move(plan, place, packet ? data_payload(packet) : NULL);
    return true;
}

static void run_change_args(struct plan *plan, struct plan_change *oldest)
{
    BASE_LIST_REVERSE(oldest);
    while (oldest) {
        struct plan_change *next = oldest->next;
        memcpy(plan->args + oldest->at, oldest->args, oldest->bytes);
        base_free(oldest);
        oldest = next;
    }
}

static void run_reset_nodes(struct plan *plan, const struct plan_replay *replay)
{
    for (size_t i = 0; i < plan->n_nodes; i++) {
        struct task *task = plan_task(plan, i);
        uint32_t owner = plan->owner[i];
        atomic_store_explicit(&task->pending, plan->first[i], memory_order_relaxed);
        task->number = replay->number + plan->call[i];
        task->block = owner == PLAN_NONE ? (uint32_t)task->number : replay->block[owner];
        atomic_store_explicit(&task->node->round, 0, memory_order_relaxed);
    }
    atomic_fetch_add_explicit(&plan->begun, 1, memory_order_release);
}

/* There is no memory: no task runs. */
static void run_starve(struct plan *plan, struct task *task)
{
    const struct data_failure *failure = task_fail_memory(task);
    for (size_t i = 0; i < plan->n_objects; i++)
        plan->place[i].failure = failure;
    task->replay->rounds = 0;
    if (plan->gate)
        plan_taint(plan, PLAN_STARVED);
    if (plan->words)
        comm_break_memory(plan->graph->comm, "a replay");
}

void plan_replay_run(struct task *task)
{
    struct plan_replay *replay = task->replay;
    struct plan *plan = replay->plan;
    bool fine = true;
    plan->replay = task;
    plan->first_round = replay->first_round;
    plan->stop = false;
    if (!plan->gate) { /* the main thread sets these itself for an open replay */
        atomic_store_explicit(&plan->last, replay->rounds - 1, memory_order_relaxed);
        atomic_store_explicit(&plan->tainted, 0, memory_order_relaxed);
    }
    atomic_store_explicit(&plan->left, plan->decides ? PLAN_UNKNOWN : (int64_t)plan->n_sinks,
                          memory_order_relaxed);
    run_change_args(plan, replay->changes);
    for (size_t i = plan->n_objects; i < plan->n_places; i++)
        plan->place[i].failure = NULL;
    for (size_t i = 0; i < plan->n_objects; i++)
        fine &= place_bind(plan, &task->access[i], &plan->place[i]);
    run_reset_nodes(plan, replay);
    if (!fine)
        run_starve(plan, task);
}

void plan_replay_end(struct task_graph *graph, struct worker *worker, struct plan *plan,
                     uint64_t rounds)
{
    struct task *task = plan->replay;
    for (size_t i = 0; i < plan->n_objects; i++) {
        struct data_version *out = task_written(&task->access[i]);
        if (out)
            data_version_poison(out, plan->place[i].failure);
    }
    atomic_store_explicit(&plan->rounds, rounds, memory_order_relaxed);
    atomic_fetch_add_explicit(&plan->over, 1, memory_order_release);
    queue_notify(graph->pool);
    task_finish(graph, worker, task); /* the next replay may begin */
    plan_release(plan);
}

void plan_node_ready(struct task_graph *graph, struct worker *worker, struct task *task)
{
    if (task->node->runs_inline) {
        plan_node_run(graph, worker, task, NULL);
        plan_node_finish(graph, worker, task);
    } else if (task_is_channel(task)) {
        comm_channel_ready(graph->comm, worker, task->node->channel);
    } else {
        task_place(graph, worker, task, plan_task_affinity(task));
    }
}

void plan_replay_start(struct task_graph *graph, struct worker *worker, struct task *task)
{
    struct plan *plan = task->replay->plan;
    size_t n = task->replay->rounds || plan->gate ? plan->n_roots : 0;
    if (!n)
        plan_replay_end(graph, worker, plan, task->replay->rounds);
    for (size_t i = 0; i < n; i++)
        if (plan_node_may_run(plan, plan->root[i]))
            plan_node_ready(graph, worker, plan->root[i]);
}

/* ---- Nodes ---- */

const struct data_failure *plan_node_poison(const struct plan *plan, const struct task *task)
{
    const struct plan_node_use *use = plan->use + task->node->first_use;
    const struct data_failure *failure = NULL;
    for (uint32_t i = 0; i < task->n; i++)
        if (use[i].reads)
            failure = data_failure_first(failure, plan->place[use[i].place].failure);
    return failure;
}

void plan_node_set_poison(struct plan *plan, const struct task *task,
                          const struct data_failure *failure)
{
    const struct plan_node_use *use = plan->use + task->node->first_use;
    for (uint32_t i = 0; i < task->n; i++)
        if (use[i].writes)
            plan->place[use[i].place].failure = failure;
}

void plan_node_clear_leaves(const struct plan *plan, const struct task *task)
{
    const struct plan_node_use *use = plan->use + task->node->first_use;
    for (uint32_t i = 0; i < task->n; i++) {
        const struct plan_place *place = &plan->place[use[i].place];
        if (place->law)
            data_law_neutral(place->law, place->data, place->count, place->type);
    }
}

void plan_node_leave_scope(struct task_scope *scope, struct worker *worker,
                           const struct data_failure *failure)
{
    task_scope_fail(scope, failure);
    task_scope_end(scope, worker);
}

/* True if it reads poison, which goes on to what it writes. */
static bool node_is_poisoned(const struct task *task)
{
    struct plan *plan = task->node->plan;
    if (!atomic_load_explicit(&plan->tainted, memory_order_relaxed))
        return false;
    const struct data_failure *failure = plan_node_poison(plan, task);
    plan_node_set_poison(plan, task, failure);
    return failure;
}

static void node_run_set(struct task *task)
{
    struct plan *plan = task->node->plan;
    struct plan_place *place = &plan->place[plan->use[task->node->first_use].place];
    if (task->node->args)
        memcpy(place->data, task->node->args, place->bytes);
    else
        memset(place->data, 0, place->bytes);
    if (atomic_load_explicit(&plan->tainted, memory_order_relaxed))
        place->failure = NULL;
}

/* The first parameter of a sum is the object, the others are the pieces. */
static void node_run_sum(const struct task *task)
{
    const struct plan_tree *tree = task->node->tree;
    const duite_param *param = task->node->param;
    if (node_is_poisoned(task))
        return;
    for (size_t i = 0; i < tree->n; i++)
        tree->law->combine(param[tree->merge[i].left].data, param[tree->merge[i].right].data,
                           param->count, param->type);
    if (task->type == TASK_NODE_SUM)
        tree->law->combine(param[0].data, param[1].data, param->count, param->type);
}

static void node_run_copy(const struct task *task)
{
    const duite_param *param = task->node->param; /* from, to */
    if (!node_is_poisoned(task))
        memcpy(param[1].data, param[0].data, param->count * data_type_size(param->type));
}

bool plan_flag_holds(duite_type type, const void *values)
{
    static const char zero[16];
    switch (type) {
    case DUITE_F32:
        return *(const float *)values != 0;
    case DUITE_F64:
        return *(const double *)values != 0;
    case DUITE_CF32:
        return *(const float complex *)values != 0;
    case DUITE_CF64:
        return *(const double complex *)values != 0;
    default:
        return memcmp(values, zero, data_type_size(type)) != 0;
    }
}

static void node_run_flag(struct task_graph *graph, struct task *task)
{
    struct plan *plan = task->node->plan;
    bool tainted = atomic_load_explicit(&plan->tainted, memory_order_relaxed);
    const uint64_t round = atomic_load_explicit(&task->node->round, memory_order_relaxed);
    plan->stop = round == atomic_load_explicit(&plan->last, memory_order_relaxed) ||
                 task_given_up(graph) || (tainted && plan_node_poison(plan, task)) ||
                 !plan_flag_holds(task->node->param->type, task->node->param->data);
    if (plan->stop)
        atomic_store_explicit(&plan->last, round, memory_order_relaxed);
}

static struct task_held *node_held(const struct task *task)
{
    return task->node->plan->held + plan_node_number(task);
}

bool plan_node_run(struct task_graph *graph, struct worker *worker, struct task *task,
                   const duite_call *call)
{
    if (task->state == TASK_ENDED)
        return false;
    if (task->type == TASK_NODE) {
        struct task_frame frame;
        task_frame_init(&frame, graph, worker, call);
        if (task->state == TASK_HELD)
            task_held_start(frame.body.held = node_held(task));
        return plan_node_run_body(&frame, task);
    }
    atomic_store_explicit(&task->pending, task->node->steady, memory_order_relaxed);
    if (task->type == TASK_NODE_SET)
        node_run_set(task);
    else if (task->type == TASK_NODE_SUM || task->type == TASK_NODE_PARTIAL)
        node_run_sum(task);
    else if (task->type == TASK_NODE_COPY)
        node_run_copy(task);
    else
        node_run_flag(graph, task);
    return false;
}

/* Returns whether a node with events is over. */
static bool node_let_go(struct task *task)
{
    struct plan *plan = task->node->plan;
    struct task_held *held = node_held(task);
    if (task->state == TASK_HELD && !task_held_release(held))
        return false; /* its events end it, at any moment from now on */
    const struct data_failure *failure = atomic_load(&held->failure);
    if (failure) {
        plan_taint(plan, PLAN_POISONED);
        plan_node_set_poison(plan, task, failure);
    }
    task->state = TASK_HELD; /* in its next round */
    return true;
}

void plan_node_finish(struct task_graph *graph, struct worker *worker, struct task *task)
{
    if (task->state == TASK_LOCAL || node_let_go(task))
        plan_node_count_down(graph, worker, task, plan_node_ready, NULL);
}
