/* Virtual time: the next thing that happens is a node that is over, or the main program that brings
 * the next one into being. A worker that ends a task runs the one that the scheduler lets it chain,
 * or what it finds: its queue, the shared one, those of the victims. What becomes ready while no
 * worker makes it so (a message came) goes through the worker of that host that ended last. */
#include "runtime/predict/machine.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/graph/graph.h"
#include "runtime/trace/export.h"

#include <math.h>
#include <stdlib.h>

enum { IDLE, BUSY, RESERVED }; /* of a worker; the last: it is the main program's */

/* Why a node began, or was ready, when it did: another one was over, and made it ready, or left it
 * its worker, or let the main program go on, which then brought it into being. */
struct cause {
    uint32_t by; /* NONE: the beginning */
    enum { MADE_READY, LEFT_WORKER, FORKED } how;
    float flight; /* s of a message */
};

struct machine {
    struct predict_graph *graph;
    const struct predict_cluster *cluster;
    const duite_scheduler *scheduler;
    uint32_t n_workers;
    unsigned char *states;
    size_t stride;
    struct predict_queue *queue, *shared; /* by worker; by host */
    unsigned char *state;                 /* by worker */
    uint32_t *next;                       /* by worker: chained, or NONE */
    uint32_t *ran;                        /* by worker: the node it ran last */
    uint32_t *last;                       /* by host: the worker that ended last */
    uint32_t *idle;                       /* by host: how many */
    struct predict_events events;
    struct predict_network network;
    double *begin, *end; /* by node */
    uint32_t *runs_on;   /* by node, for Paje; NULL: not kept */
    struct cause *cause; /* by node */
    double now, main_time, busy;
    size_t op, cursor; /* of the main program */
    uint64_t over, stolen;
    bool blocked, wanted, failed;
    uint32_t latest;  /* the node that was over last */
    uint32_t went_on; /* ... when the main program went on last; NONE: it never waited */
};

static void node_over(struct machine *m, uint32_t node, uint32_t worker);

static void *state_of(const struct machine *m, uint32_t worker)
{
    return m->states + worker * m->stride;
}

/* ---- Workers ---- */

static void start(struct machine *m, uint32_t node, uint32_t worker)
{
    const struct predict_node *n = &m->graph->node[node];
    uint32_t before = m->ran[worker];
    double begin = m->now + (before == PREDICT_NONE ? 0 : m->graph->overhead);
    /* Its worker held it up, if it was ready before that was free. */
    if (before != PREDICT_NONE && m->end[before] >= m->now && m->begin[node] < m->now)
        m->cause[node] = (struct cause){before, LEFT_WORKER, 0};
    m->begin[node] = begin;
    m->busy += (double)n->seconds;
    m->ran[worker] = node;
    if (m->state[worker] == IDLE)
        m->idle[n->host]--;
    m->state[worker] = BUSY;
    if (m->runs_on)
        m->runs_on[node] = worker;
    m->failed |= !predict_event_put(&m->events, begin + (double)n->seconds, node, worker);
}

static uint32_t find(struct machine *m, uint32_t worker)
{
    const struct predict_node *nodes = m->graph->node;
    const uint32_t cores = m->cluster->cores, host = worker / cores, first = host * cores;
    void *state = state_of(m, worker);
    duite_end end = m->scheduler->serve(state);
    uint32_t node = predict_queue_take(&m->queue[worker], nodes, end);
    if (node == PREDICT_NONE)
        node = predict_queue_take(&m->shared[host], nodes, end);
    for (unsigned attempt = 0; node == PREDICT_NONE; attempt++) {
        unsigned victim = m->scheduler->victim(state, attempt);
        if (victim >= cores)
            break;
        if (first + victim != worker)
            node = predict_queue_take(&m->queue[first + victim], nodes, DUITE_OLDEST);
        m->stolen += node != PREDICT_NONE;
    }
    return node;
}

/* The worker looks for work. */
static void look(struct machine *m, uint32_t worker)
{
    uint32_t node = find(m, worker);
    if (node != PREDICT_NONE) {
        start(m, node, worker);
    } else if (m->state[worker] != IDLE) {
        m->state[worker] = IDLE;
        m->idle[worker / m->cluster->cores]++;
    }
}

/* Somebody is to find what lies in `queue`: its owner, or anybody who may. */
static void wake(struct machine *m, uint32_t host, unsigned queue)
{
    const uint32_t cores = m->cluster->cores, first = host * cores;
    unsigned begin = queue < cores ? queue : 0;
    for (unsigned i = 0; i < cores && m->idle[host]; i++) {
        uint32_t worker = first + (begin + i) % cores;
        if (m->state[worker] != IDLE)
            continue;
        look(m, worker);
        if (m->state[worker] == BUSY)
            return;
    }
}

static duite_ready describe(const struct machine *m, uint32_t node)
{
    const struct predict_node *n = &m->graph->node[node];
    const struct trace_run *run = m->graph->run;
    return (duite_ready){.kernel = n->kernel < run->n_kernels
                                       ? run->kernel_name[n->kernel]
                                       : graph_own_name(n->kernel - run->n_kernels),
                         .number = n->number,
                         .block = n->block,
                         .priority = n->priority,
                         .cost = n->cost};
}

/* A task may run; worker NONE: no worker of its host made it so. */
static void task_ready(struct machine *m, uint32_t node, uint32_t worker)
{
    const uint32_t cores = m->cluster->cores, host = m->graph->node[node].host;
    bool here = worker != PREDICT_NONE && worker / cores == host;
    void *state = state_of(m, here ? worker : m->last[host]);
    duite_ready ready = describe(m, node);
    m->begin[node] = m->now; /* until it starts: since when it is ready */
    if (here && m->next[worker] == PREDICT_NONE && m->scheduler->chain(state, &ready)) {
        m->next[worker] = node;
        return;
    }
    unsigned queue = m->scheduler->place(state, &ready);
    bool own = queue < cores;
    m->failed |= !predict_queue_put(own ? &m->queue[host * cores + queue] : &m->shared[host],
                                    m->graph->node, node);
    wake(m, host, queue);
}

/* ---- Nodes ---- */

static void node_ready(struct machine *m, uint32_t node, uint32_t worker)
{
    const struct predict_node *n = &m->graph->node[node];
    double flight = 0, end = m->now;
    m->begin[node] = m->now;
    switch (n->kind) {
    case PREDICT_TASK:
        task_ready(m, node, worker);
        return;
    case PREDICT_EVERYWHERE:
        end = m->now + m->graph->overhead + (double)n->seconds;
        break;
    case PREDICT_MESSAGE:
        end = predict_message(&m->network, m->now, n->host, n->block, n->number, &flight);
        break;
    case PREDICT_EXCHANGE:
        end = predict_exchange(&m->network, m->now, n->number, n->block != 0, &flight);
        break;
    default:
        break;
    }
    m->cause[node].flight = (float)flight;
    m->failed |= !predict_event_put(&m->events, end, node, PREDICT_NONE);
}

static void count_down(struct machine *m, uint32_t node, uint32_t by, uint32_t worker)
{
    struct predict_node *n = &m->graph->node[node];
    if (--n->pending)
        return;
    m->cause[node] = by == PREDICT_NONE ? (struct cause){m->went_on, FORKED, 0}
                                        : (struct cause){by, MADE_READY, 0};
    node_ready(m, node, worker);
}

/* ---- The main program ---- */

/* Whether what it waits for is there. */
static bool may_go_on(const struct machine *m)
{
    const struct predict_op *op = &m->graph->op[m->op];
    if (!op->waits)
        return true;
    return op->node == PREDICT_NONE ? m->over == op->end : m->end[op->node] >= 0;
}

/* It goes on: its workers are not to be had. On other hosts they end their tasks first. */
static void resume(struct machine *m)
{
    m->blocked = m->wanted = false;
    m->main_time = m->now;
    m->op++;
    if (m->op == m->graph->n_ops)
        return;
    for (uint32_t host = 0; host < m->cluster->hosts; host++) {
        uint32_t worker = host * m->cluster->cores;
        if (m->state[worker] == IDLE) {
            m->idle[host]--;
            m->state[worker] = RESERVED;
        }
    }
}

static void try_to_resume(struct machine *m)
{
    if (!m->blocked || !may_go_on(m))
        return;
    m->wanted = true;
    if (m->state[0] == BUSY)
        return;
    m->went_on = m->latest;
    resume(m);
}

/* It waits, and its workers work. */
static void block(struct machine *m)
{
    m->blocked = true;
    m->now = fmax(m->now, m->main_time);
    for (uint32_t host = 0; host < m->cluster->hosts; host++)
        if (m->state[host * m->cluster->cores] == RESERVED)
            look(m, host * m->cluster->cores);
    if (may_go_on(m))
        resume(m); /* it does not wait */
}

/* Brings one more node into being, or comes to the end of an op. */
static void main_step(struct machine *m)
{
    const struct predict_op *op = &m->graph->op[m->op];
    if (m->cursor < op->end) {
        m->main_time += op->each;
        m->now = m->main_time;
        count_down(m, (uint32_t)m->cursor++, PREDICT_NONE, PREDICT_NONE);
    } else if (op->waits) {
        block(m);
    } else {
        m->op++;
    }
}

static double main_next(const struct machine *m)
{
    if (m->blocked || m->op == m->graph->n_ops)
        return INFINITY;
    const struct predict_op *op = &m->graph->op[m->op];
    return m->main_time + (m->cursor < op->end ? op->each : 0);
}

/* ---- Events ---- */

static void free_worker(struct machine *m, uint32_t worker)
{
    uint32_t node = m->next[worker];
    m->next[worker] = PREDICT_NONE;
    bool taken = !m->blocked && m->op < m->graph->n_ops && worker % m->cluster->cores == 0;
    if (worker == 0 && m->wanted) {
        if (node != PREDICT_NONE) /* others take what it would have run */
            m->failed |= !predict_queue_put(&m->queue[0], m->graph->node, node);
        m->state[0] = RESERVED;
        m->went_on = m->latest;
        resume(m);
        wake(m, 0, 1);
    } else if (taken) {
        if (node != PREDICT_NONE)
            m->failed |= !predict_queue_put(&m->queue[worker], m->graph->node, node);
        m->state[worker] = RESERVED;
        wake(m, worker / m->cluster->cores, 1);
    } else if (node != PREDICT_NONE) {
        start(m, node, worker);
    } else {
        look(m, worker);
    }
}

static void node_over(struct machine *m, uint32_t node, uint32_t worker)
{
    const struct predict_graph *graph = m->graph;
    m->end[node] = m->now;
    m->over++;
    m->latest = node;
    if (worker != PREDICT_NONE)
        m->last[worker / m->cluster->cores] = worker;
    for (uint32_t e = graph->node[node].edge; e != PREDICT_NONE; e = graph->edge[e].next)
        count_down(m, graph->edge[e].to, node, worker);
    if (worker != PREDICT_NONE)
        free_worker(m, worker);
    try_to_resume(m);
}

static int run(struct machine *m)
{
    struct predict_event event;
    while (!m->failed) {
        double next = main_next(m);
        if (m->events.n && m->events.event[0].time < next) {
            predict_event_take(&m->events, &event);
            m->now = event.time;
            node_over(m, event.node, event.worker);
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

/* ---- What came of it ---- */

static double critical_path(const struct predict_graph *graph, double *path)
{
    double longest = 0;
    for (size_t i = 0; i < graph->n_nodes; i++)
        path[i] = 0;
    for (size_t i = 0; i < graph->n_nodes; i++) { /* no edge points back */
        const struct predict_node *node = &graph->node[i];
        double end = path[i] + (double)node->seconds;
        longest = fmax(longest, end);
        for (uint32_t e = node->edge; e != PREDICT_NONE; e = graph->edge[e].next)
            path[graph->edge[e].to] = fmax(path[graph->edge[e].to], end);
    }
    return longest;
}

/* From the last node back along what each waited for. */
static void follow_chain(const struct machine *m, double *chain)
{
    const struct predict_graph *graph = m->graph;
    uint32_t at = m->latest;
    while (at != PREDICT_NONE) {
        const struct predict_node *node = &graph->node[at];
        const struct cause *cause = &m->cause[at];
        double since = cause->by == PREDICT_NONE ? 0 : m->end[cause->by];
        bool travels = node->kind == PREDICT_MESSAGE || node->kind == PREDICT_EXCHANGE;
        double all = m->end[at] - since;
        if (travels) {
            chain[PREDICT_LATENCY] += (double)cause->flight;
            chain[PREDICT_BANDWIDTH] += all - (double)cause->flight;
        } else {
            double own = fmin(all, (double)node->seconds);
            chain[cause->how == LEFT_WORKER ? PREDICT_WORK : PREDICT_PATH] += own;
            chain[cause->how == FORKED ? PREDICT_MAIN : PREDICT_OVERHEAD] += all - own;
        }
        at = cause->by;
    }
}

static enum predict_limit find_limit(const struct predict_result *result, double workers)
{
    enum predict_limit limit = PREDICT_WORK;
    const double most = 0.8 * result->makespan;
    if (result->work / workers >= most)
        return PREDICT_WORK;
    if (result->critical_path >= most)
        return PREDICT_PATH;
    for (int i = 1; i < PREDICT_LIMITS; i++)
        if (result->chain[i] > result->chain[limit])
            limit = (enum predict_limit)i;
    return limit;
}

static int write_paje(const struct machine *m, FILE *file, double limit)
{
    const struct predict_graph *graph = m->graph;
    struct trace_span *span = base_alloc(graph->n_nodes * sizeof *span + 1);
    uint32_t *host_of = base_alloc((m->n_workers + 1) * sizeof *host_of);
    int code = span && host_of ? DUITE_OK : base_no_memory("the predicted run");
    size_t n = 0;
    for (uint32_t w = 0; w < m->n_workers && !code; w++)
        host_of[w] = w / m->cluster->cores;
    for (uint32_t i = 0; i < graph->n_nodes && !code; i++)
        if (graph->node[i].kind == PREDICT_TASK)
            span[n++] =
                (struct trace_span){m->begin[i], m->end[i], describe(m, i).kernel, m->runs_on[i]};
    if (!code)
        code = trace_write_paje_spans(file, span, n, host_of, m->n_workers, limit);
    base_free(span);
    base_free(host_of);
    return code;
}

static void conclude(struct machine *m, struct predict_result *result)
{
    const struct predict_graph *graph = m->graph;
    double makespan = 0;
    for (size_t i = 0; i < graph->n_nodes; i++)
        makespan = fmax(makespan, m->end[i]);
    const double all = makespan * m->n_workers;
    *result = (struct predict_result){.tasks = graph->n_tasks,
                                      .messages = m->network.messages,
                                      .bytes = m->network.bytes,
                                      .stolen = m->stolen,
                                      .makespan = fmax(makespan, m->main_time),
                                      .overhead = graph->overhead,
                                      .idle = all > 0 ? 1 - m->busy / all : 0};
    for (size_t i = 0; i < graph->n_nodes; i++)
        result->work += (double)graph->node[i].seconds;
    follow_chain(m, result->chain);
    result->critical_path = critical_path(graph, m->begin);
    result->limit = find_limit(result, m->n_workers);
}

/* ---- Start and stop ---- */

static bool prepare(struct machine *m, bool paje)
{
    const struct predict_graph *graph = m->graph;
    const size_t n = graph->n_nodes, workers = m->n_workers, hosts = m->cluster->hosts;
    m->stride = (m->scheduler->state_size + 63) / 64 * 64 + 64;
    m->states = base_alloc_zero(workers * m->stride);
    m->queue = base_alloc_zero(workers * sizeof *m->queue);
    m->shared = base_alloc_zero(hosts * sizeof *m->shared);
    m->state = base_alloc_zero(workers);
    m->next = base_alloc(workers * sizeof *m->next);
    m->ran = base_alloc(workers * sizeof *m->ran);
    m->last = base_alloc(hosts * sizeof *m->last);
    m->idle = base_alloc(hosts * sizeof *m->idle);
    m->network.out = base_alloc_zero(hosts * sizeof(double));
    m->network.in = base_alloc_zero(hosts * sizeof(double));
    m->begin = base_alloc(n * sizeof *m->begin + 1);
    m->end = base_alloc(n * sizeof *m->end + 1);
    m->cause = base_alloc_zero(n * sizeof *m->cause + 1);
    m->runs_on = paje ? base_alloc_zero(n * sizeof *m->runs_on + 1) : NULL;
    return m->states && m->queue && m->shared && m->state && m->next && m->ran && m->last &&
           m->idle && m->network.out && m->network.in && m->begin && m->end && m->cause &&
           (m->runs_on || !paje);
}

static void init(struct machine *m)
{
    const uint32_t cores = m->cluster->cores;
    for (uint32_t w = 0; w < m->n_workers; w++) {
        if (m->scheduler->start)
            m->scheduler->start(state_of(m, w), w % cores, cores, m->cluster->seed);
        m->queue[w].heap = m->scheduler->serve(state_of(m, w)) == DUITE_HIGHEST;
        m->next[w] = m->ran[w] = PREDICT_NONE;
        m->state[w] = w % cores ? IDLE : RESERVED;
    }
    for (uint32_t h = 0; h < m->cluster->hosts; h++) {
        m->shared[h].heap = m->queue[h * cores].heap;
        m->last[h] = h * cores;
        m->idle[h] = cores - 1;
    }
    for (size_t i = 0; i < m->graph->n_nodes; i++)
        m->end[i] = -1;
}

static void stop(struct machine *m)
{
    for (uint32_t w = 0; w < m->n_workers && m->queue; w++)
        free(m->queue[w].node);
    for (uint32_t h = 0; h < m->cluster->hosts && m->shared; h++)
        free(m->shared[h].node);
    free(m->events.event);
    void *const all[] = {m->states, m->queue, m->shared,      m->state,      m->next,
                         m->ran,    m->last,  m->network.out, m->network.in, m->begin,
                         m->end,    m->cause, m->idle,        m->runs_on};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        base_free(all[i]);
}

int predict_simulate(struct predict_graph *graph, struct predict_result *result, FILE *paje)
{
    struct machine m = {.graph = graph,
                        .cluster = graph->cluster,
                        .scheduler = graph->cluster->scheduler,
                        .n_workers = graph->cluster->hosts * graph->cluster->cores,
                        .network = {.cluster = graph->cluster},
                        .latest = PREDICT_NONE,
                        .went_on = PREDICT_NONE};
    int code = prepare(&m, paje != NULL) ? DUITE_OK : base_no_memory("the prediction");
    if (!code) {
        init(&m);
        code = run(&m);
    }
    if (!code && paje)
        code = write_paje(&m, paje, m.now);
    if (!code)
        conclude(&m, result);
    stop(&m);
    return code;
}
