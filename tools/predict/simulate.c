/* Virtual time: next a node is over, or the main program forks one more. A worker that ends a task
 * runs the one that the scheduler lets it run inline. Else it searches its own queue, the shared
 * one and those of its victims. A task that no worker made ready (a message came) goes through the
 * worker of its host that ended last. */
#include "tools/predict/machine.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/plan/plan.h"

#include <math.h>
#include <stdlib.h>

/* ---- The cores' time for messages ---- */

/* A host handles one message after the other, on whichever core. The latency includes the handling
 * of a single message, so a message only waits for those before it. Returns when the host comes to
 * the present one. */
static double message_handle(struct predict_machine *m, uint32_t host)
{
    const double begins = fmax(m->now, m->handler[host]), message = m->graph->costs[host].message;
    m->handler[host] = begins + message;
    m->handled[host] += message;
    return begins;
}

/* A worker begins a task. Before that it does the work left for messages, if no core was idle, and
 * now and then it looks for more. */
static double worker_pay(struct predict_machine *m, uint32_t worker, uint32_t host)
{
    const bool none_idle = m->state[worker] != IDLE && !m->idle[host];
    double seconds = none_idle ? m->handled[host] : 0;
    m->handled[host] = 0;
    const double look = m->graph->costs[host].look;
    if (look > 0 && m->now - m->looked[worker] >= PREDICT_LOOKS) {
        m->looked[worker] = m->now;
        seconds += look;
    }
    return seconds;
}

/* ---- Workers ---- */

static void worker_begin(struct predict_machine *m, uint32_t node, uint32_t worker)
{
    const struct predict_node *n = &m->graph->node[node];
    uint32_t before = m->ran[worker];
    double begin = m->now + (before == PREDICT_NONE ? 0 : m->graph->costs[n->host].overhead);
    begin += worker_pay(m, worker, n->host);
    /* The worker held the task up, if the task was ready before the worker was free. */
    if (before != PREDICT_NONE && m->end[before] >= m->now && m->begin[node] < m->now)
        m->cause[node] = (struct predict_cause){before, LEFT_WORKER, 0};
    m->begin[node] = begin;
    m->busy += (double)n->seconds;
    m->ran[worker] = node;
    if (n->placed)
        m->affinity[n->placed - 1] =
            (double)n->seconds >= PLAN_AFFINITY_SECONDS ? worker : PREDICT_NONE;
    if (m->state[worker] == IDLE)
        m->idle[n->host]--;
    m->state[worker] = BUSY;
    if (m->runs_on)
        m->runs_on[node] = worker;
    m->failed |= !predict_event_put(&m->events, begin + (double)n->seconds, node, worker);
}

static uint32_t worker_search(struct predict_machine *m, uint32_t worker)
{
    const struct predict_node *nodes = m->graph->node;
    const uint32_t host = m->host_of[worker], first = m->first[host], cores = m->host[host].cores;
    void *state = predict_worker_state(m, worker);
    if (!m->waiting[host])
        return PREDICT_NONE;
    duite_end end = m->scheduler->serve(state);
    uint32_t node = predict_queue_take(&m->queue[worker], nodes, end);
    if (node == PREDICT_NONE)
        node = predict_queue_take(&m->shared[host], nodes, end);
    for (unsigned attempt = 0; node == PREDICT_NONE && attempt < 64 + 16 * cores; attempt++) {
        unsigned victim = m->scheduler->victim(state, attempt);
        if (victim >= cores)
            break;
        if (first + victim != worker)
            node = predict_queue_take(&m->queue[first + victim], nodes, DUITE_OLDEST);
        m->stolen += node != PREDICT_NONE;
    }
    m->waiting[host] -= node != PREDICT_NONE;
    return node;
}

/* The worker looks for work. */
static void worker_look(struct predict_machine *m, uint32_t worker)
{
    uint32_t node = worker_search(m, worker);
    if (node != PREDICT_NONE) {
        worker_begin(m, node, worker);
    } else if (m->state[worker] != IDLE) {
        m->state[worker] = IDLE;
        m->idle[m->host_of[worker]]++;
    }
}

/* Wakes a worker for the tasks in `queue`: its owner, or one that may take them. */
static void host_wake(struct predict_machine *m, uint32_t host, unsigned queue)
{
    const uint32_t cores = m->host[host].cores, first = m->first[host];
    unsigned begin = queue < cores ? queue : 0;
    for (unsigned i = 0; i < cores && m->idle[host]; i++) {
        uint32_t worker = first + (begin + i) % cores;
        if (m->state[worker] != IDLE)
            continue;
        worker_look(m, worker);
        if (m->state[worker] == BUSY)
            return;
    }
}

static void node_wait(struct predict_machine *m, struct predict_queue *queue, uint32_t node)
{
    m->failed |= !predict_queue_put(queue, m->graph->node, node);
    m->waiting[m->graph->node[node].host]++;
}

/* A task is ready. worker: the one that made it ready, or NONE. */
static void node_task_ready(struct predict_machine *m, uint32_t node, uint32_t worker)
{
    const uint32_t host = m->graph->node[node].host;
    bool here = worker != PREDICT_NONE && m->host_of[worker] == host;
    void *state = predict_worker_state(m, here ? worker : m->last[host]);
    duite_ready ready = predict_describe(m, node);
    m->begin[node] = m->now; /* until it starts: since when it is ready */
    if (here && m->next[worker] == PREDICT_NONE) {
        if (m->scheduler->chain(state, &ready)) {
            m->next[worker] = node;
            return;
        }
    }
    unsigned queue = m->scheduler->place(state, &ready);
    bool own = queue < m->host[host].cores;
    node_wait(m, own ? &m->queue[m->first[host] + queue] : &m->shared[host], node);
    host_wake(m, host, queue);
}

/* ---- Nodes ---- */

static void message_goes(struct predict_machine *m, uint32_t node)
{
    m->failed |= !predict_network_send(&m->network, m->now, node);
}

/* The message goes as soon as its host comes to it. */
static void message_send(struct predict_machine *m, uint32_t node)
{
    const uint32_t host = m->graph->node[node].host;
    const double begins = message_handle(m, host);
    const double left = begins + m->graph->costs[host].message;
    m->failed |= !predict_event_put(&m->events, left, node, PREDICT_LEFT);
    if (begins > m->now)
        m->failed |= !predict_event_put(&m->events, begins, node, PREDICT_GOES);
    else
        message_goes(m, node);
}

static void flow_is_due(struct predict_machine *m, const struct predict_event *event)
{
    double latency;
    const uint32_t node =
        predict_network_take(&m->network, m->now, event->node, event->order, &latency, &m->failed);
    if (node == PREDICT_NONE)
        return;
    m->cause[node].flight = (float)latency;
    m->failed |= !predict_event_put(&m->events, m->now + latency, node, PREDICT_COMES);
}

static void machine_ready(struct predict_machine *m, uint32_t node, uint32_t worker)
{
    m->begin[node] = m->now;
    switch (m->graph->node[node].kind) {
    case PREDICT_TASK:
        node_task_ready(m, node, worker);
        break;
    case PREDICT_MESSAGE:
        message_send(m, node);
        break;
    default:
        m->failed |= !predict_event_put(&m->events, m->now, node, PREDICT_NONE);
    }
}

/* A message is in its host's card: there it waits until the host comes to it. */
static bool message_waits(struct predict_machine *m, uint32_t node)
{
    const struct predict_node *n = &m->graph->node[node];
    const double begins = message_handle(m, n->block);
    if (begins > m->now)
        m->failed |= !predict_event_put(&m->events, begins, node, PREDICT_NONE);
    return begins > m->now;
}

/* A node is over for the one that waits for it. */
static void path_extend(struct predict_machine *m, uint32_t node, uint32_t to)
{
    const double path = m->path[node] + (double)m->graph->node[node].seconds;
    if (path > m->path[to])
        m->path[to] = path;
}

static void node_count_down(struct predict_machine *m, uint32_t node, uint32_t by, uint32_t worker)
{
    struct predict_node *n = &m->graph->node[node];
    if (--n->pending)
        return;
    m->cause[node] = by == PREDICT_NONE ? (struct predict_cause){m->went_on, FORKED, 0}
                                        : (struct predict_cause){by, MADE_READY, 0};
    machine_ready(m, node, worker);
}

/* ---- The main program ---- */

/* True if its wait is over. */
static bool main_may_go_on(const struct predict_machine *m)
{
    const struct predict_op *op = &m->graph->op[m->op];
    if (!op->waits)
        return true;
    return op->node == PREDICT_NONE ? m->over == op->end : m->end[op->node] >= 0;
}

/* The main program goes on and takes a worker of each host. On other hosts a busy one ends its task
 * first. */
static void main_go_on(struct predict_machine *m)
{
    m->blocked = m->wanted = false;
    m->main_time = m->now;
    m->op++;
    if (m->op == m->graph->n_ops)
        return;
    for (uint32_t host = 0; host < m->cluster->hosts; host++) {
        uint32_t worker = m->first[host];
        if (m->state[worker] == IDLE) {
            m->idle[host]--;
            m->state[worker] = RESERVED;
        }
    }
}

static void main_try(struct predict_machine *m)
{
    if (!m->blocked || !main_may_go_on(m))
        return;
    m->wanted = true;
    if (m->state[0] == BUSY)
        return;
    m->went_on = m->latest;
    main_go_on(m);
}

/* The main program waits, and its workers run tasks. */
static void main_block(struct predict_machine *m)
{
    m->blocked = true;
    m->now = fmax(m->now, m->main_time);
    for (uint32_t host = 0; host < m->cluster->hosts; host++)
        if (m->state[m->first[host]] == RESERVED)
            worker_look(m, m->first[host]);
    if (main_may_go_on(m))
        main_go_on(m); /* it does not wait */
}

/* Forks one more node, or comes to the end of an op. */
static void main_step(struct predict_machine *m)
{
    const struct predict_op *op = &m->graph->op[m->op];
    if (m->cursor < op->end) {
        m->main_time += op->each;
        m->now = m->main_time;
        node_count_down(m, (uint32_t)m->cursor++, PREDICT_NONE, PREDICT_NONE);
    } else if (op->waits) {
        main_block(m);
    } else {
        m->op++;
    }
}

static double main_next(const struct predict_machine *m)
{
    if (m->blocked || m->op == m->graph->n_ops)
        return INFINITY;
    const struct predict_op *op = &m->graph->op[m->op];
    return m->main_time + (m->cursor < op->end ? op->each : 0);
}

/* ---- Events ---- */

static void worker_free(struct predict_machine *m, uint32_t worker)
{
    uint32_t node = m->next[worker];
    m->next[worker] = PREDICT_NONE;
    const uint32_t host = m->host_of[worker];
    bool taken = !m->blocked && m->op < m->graph->n_ops && worker == m->first[host];
    if (worker == 0 && m->wanted) {
        if (node != PREDICT_NONE) /* others take the node that it would have run */
            node_wait(m, &m->queue[0], node);
        m->state[0] = RESERVED;
        m->went_on = m->latest;
        main_go_on(m);
        host_wake(m, 0, 1);
    } else if (taken) {
        if (node != PREDICT_NONE)
            node_wait(m, &m->queue[worker], node);
        m->state[worker] = RESERVED;
        host_wake(m, host, 1);
    } else if (node != PREDICT_NONE) {
        worker_begin(m, node, worker);
    } else {
        worker_look(m, worker);
    }
}

/* Nodes on one side of a message go on: those of its host when it has left, as if the node before
 * the message had released them, all others when it has come. */
static void message_release(struct predict_machine *m, uint32_t node, bool left)
{
    const struct predict_graph *graph = m->graph;
    const struct predict_node *n = &graph->node[node];
    for (uint32_t e = n->edge; e != PREDICT_NONE; e = graph->edge[e].next) {
        const struct predict_node *to = &graph->node[graph->edge[e].to];
        if ((to->host == n->host) != left)
            continue;
        path_extend(m, node, graph->edge[e].to);
        node_count_down(m, graph->edge[e].to, left ? m->cause[node].by : node, PREDICT_NONE);
    }
}

static void node_over(struct predict_machine *m, uint32_t node, uint32_t worker)
{
    const struct predict_graph *graph = m->graph;
    m->end[node] = m->now;
    m->over++;
    m->latest = node;
    if (worker != PREDICT_NONE)
        m->last[m->host_of[worker]] = worker;
    m->longest = fmax(m->longest, m->path[node] + (double)graph->node[node].seconds);
    if (graph->node[node].kind == PREDICT_MESSAGE)
        message_release(m, node, false);
    else
        for (uint32_t e = graph->node[node].edge; e != PREDICT_NONE; e = graph->edge[e].next) {
            path_extend(m, node, graph->edge[e].to);
            node_count_down(m, graph->edge[e].to, node, worker);
        }
    if (worker != PREDICT_NONE)
        worker_free(m, worker);
    main_try(m);
}

static void event_handle(struct predict_machine *m, const struct predict_event *event)
{
    switch (event->worker) {
    case PREDICT_FLOW:
        flow_is_due(m, event);
        break;
    case PREDICT_GOES:
        message_goes(m, event->node);
        break;
    case PREDICT_LEFT:
        message_release(m, event->node, true);
        break;
    case PREDICT_COMES:
        if (message_waits(m, event->node))
            break;
        node_over(m, event->node, PREDICT_NONE);
        break;
    default:
        node_over(m, event->node, event->worker);
    }
}

static int machine_run(struct predict_machine *m)
{
    struct predict_event event;
    while (!m->failed) {
        double next = main_next(m);
        if (m->events.n && m->events.event[0].time < next) {
            predict_event_take(&m->events, &event);
            m->now = event.time;
            event_handle(m, &event);
        } else if (next < INFINITY) {
            main_step(m);
        } else {
            break;
        }
    }
    if (m->failed)
        return base_no_memory("the prediction");
    if (m->over < m->graph->n_nodes)
        return base_error(DUITE_E_ARGUMENT,
                          "after %llu of %zu tasks and messages nothing goes on: the scheduler %s "
                          "leaves tasks where nobody takes them",
                          (unsigned long long)m->over, m->graph->n_nodes, m->scheduler->name);
    return DUITE_OK;
}

int predict_simulate(struct predict_graph *graph, struct predict_result *result,
                     const struct predict_more *more)
{
    struct predict_machine m = {.graph = graph,
                                .cluster = graph->cluster,
                                .scheduler = graph->cluster->scheduler,
                                .host = graph->platform->place,
                                .n_workers = predict_platform_cores(graph->platform),
                                .latest = PREDICT_NONE,
                                .went_on = PREDICT_NONE};
    int code =
        predict_machine_start(&m, more->paje != NULL) ? DUITE_OK : base_no_memory("the prediction");
    if (!code)
        code = machine_run(&m);
    if (!code && more->paje)
        code = predict_write_paje(&m, more->paje);
    if (!code)
        predict_conclude(&m, result, more->chain);
    predict_machine_stop(&m);
    return code;
}
