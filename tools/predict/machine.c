/* The parts of the machine: queues, the events to come, the network, a task as schedulers see it;
 * its start and stop. */
#include "tools/predict/machine.h"

#include "runtime/base/heap.h"
#include "runtime/base/memory.h"
#include "runtime/task/task.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Queues ---- */

static bool queue_room(struct predict_queue *queue)
{
    if (queue->n < queue->capacity)
        return true;
    size_t larger = queue->capacity ? 2 * queue->capacity : 16;
    uint32_t *node = malloc(larger * sizeof *node);
    if (!node)
        return false;
    for (size_t i = 0; i < queue->n; i++)
        node[i] = queue->node[(queue->first + i) & (queue->capacity - 1)];
    free(queue->node);
    queue->node = node;
    queue->first = 0;
    queue->capacity = larger;
    return true;
}

/* The larger priority comes first, then the longer path, then the earlier fork. */
static bool queue_before(const void *left, const void *right, const void *all)
{
    const struct predict_node *nodes = all;
    const uint32_t a = *(const uint32_t *)left, b = *(const uint32_t *)right;
    if (nodes[a].priority != nodes[b].priority)
        return nodes[a].priority > nodes[b].priority;
    if (nodes[a].path < nodes[b].path || nodes[b].path < nodes[a].path)
        return nodes[a].path > nodes[b].path;
    return a < b;
}

bool predict_queue_put(struct predict_queue *queue, const struct predict_node *nodes, uint32_t node)
{
    if (!queue_room(queue))
        return false;
    if (queue->heap)
        base_heap_push(queue->node, queue->n, &node, sizeof node, queue_before, nodes);
    else
        queue->node[(queue->first + queue->n) & (queue->capacity - 1)] = node;
    queue->n++;
    return true;
}

static uint32_t simulated_take_highest(struct predict_queue *queue,
                                       const struct predict_node *nodes)
{
    uint32_t top;
    base_heap_pop(queue->node, queue->n--, &top, sizeof top, queue_before, nodes);
    return top;
}

uint32_t predict_queue_take(struct predict_queue *queue, const struct predict_node *nodes,
                            duite_end end)
{
    if (!queue->n)
        return PREDICT_NONE;
    if (queue->heap)
        return simulated_take_highest(queue, nodes);
    size_t at = end == DUITE_NEWEST ? queue->first + queue->n - 1 : queue->first;
    queue->first += end != DUITE_NEWEST;
    queue->n--;
    return queue->node[at & (queue->capacity - 1)];
}

/* ---- Events ---- */

static bool event_before(const void *left, const void *right, const void *unused)
{
    const struct predict_event *a = left, *b = right;
    (void)unused;
    return a->time < b->time || (!(b->time < a->time) && a->order < b->order);
}

bool predict_event_put(struct predict_events *events, double time, uint32_t node, uint32_t worker)
{
    if (!BASE_GROW(events->event, events->capacity, events->n + 1))
        return false;
    struct predict_event new = {time, events->order++, node, worker};
    base_heap_push(events->event, events->n++, &new, sizeof new, event_before, NULL);
    return true;
}

bool predict_event_take(struct predict_events *events, struct predict_event *first)
{
    if (!events->n)
        return false;
    base_heap_pop(events->event, events->n--, first, sizeof *first, event_before, NULL);
    return true;
}

/* ---- Network ---- */

double predict_message(struct predict_network *network, double now,
                       const struct predict_node *message, double *flight)
{
    const struct predict_cluster *cluster = network->cluster;
    const uint32_t from = message->host, to = message->block;
    const uint64_t bytes = message->number;
    double takes = (double)bytes / cluster->bandwidth;
    double leaves = fmax(now, network->out[from]);
    network->out[from] = leaves + takes;
    double passes = fmax(leaves, network->fabric);
    network->fabric = passes + (double)bytes / cluster->capacity;
    double comes = fmax(passes + cluster->latency, network->in[to]);
    network->in[to] = comes + takes;
    network->messages++;
    network->bytes += bytes;
    *flight = cluster->latency;
    return comes + takes;
}

/* ---- Tasks as schedulers see them ---- */

duite_ready predict_describe(const struct predict_machine *m, uint32_t node)
{
    const struct predict_node *n = &m->graph->node[node];
    const struct trace_run *run = m->graph->run;
    const uint32_t ran = n->placed ? m->affinity[n->placed - 1] : PREDICT_NONE;
    const bool has_affinity = ran != PREDICT_NONE && ran / m->cluster->cores == n->host;
    return (duite_ready){.kernel = n->kernel < run->n_kernels
                                       ? run->kernel_name[n->kernel]
                                       : task_own_name(n->kernel - run->n_kernels),
                         .number = n->number,
                         .block = n->block,
                         .priority = n->priority,
                         .cost = (double)n->cost,
                         .path = (double)n->path,
                         .affinity = has_affinity ? 1 + ran % m->cluster->cores : 0};
}

/* ---- Start and stop ---- */

/* A worker sees the others of its host in the order of their numbers, all equally near. */
static void machine_near(struct predict_machine *m)
{
    const size_t cores = m->cluster->cores, others = cores - 1;
    for (size_t w = 0; w < cores; w++) {
        for (size_t i = 0; i < others; i++)
            m->other[w * others + i] = (unsigned)((w + 1 + i) % cores);
        m->near[w] = (duite_near){(unsigned)others, m->other + w * others, m->level};
    }
}

static bool machine_prepare(struct predict_machine *m, bool paje)
{
    const struct predict_graph *graph = m->graph;
    const size_t n = graph->n_nodes + 1, workers = m->n_workers, hosts = m->cluster->hosts;
    const size_t cores = m->scheduler->locate ? m->cluster->cores : 0;
    m->stride = (m->scheduler->state_size + 63) / 64 * 64 + 64;
    const struct base_array arrays[] = {{&m->states, workers * m->stride, true},
                                        BASE_ZEROS(m->queue, workers),
                                        BASE_ZEROS(m->shared, hosts),
                                        BASE_ZEROS(m->state, workers),
                                        BASE_ARRAY(m->next, workers),
                                        BASE_ARRAY(m->ran, workers),
                                        BASE_ARRAY(m->affinity, graph->n_objects + 1),
                                        BASE_ARRAY(m->last, hosts),
                                        BASE_ARRAY(m->idle, hosts),
                                        BASE_ZEROS(m->looked, workers),
                                        BASE_ZEROS(m->handler, hosts),
                                        BASE_ZEROS(m->handled, hosts),
                                        BASE_ZEROS(m->network.out, hosts),
                                        BASE_ZEROS(m->network.in, hosts),
                                        BASE_ARRAY(m->begin, n),
                                        BASE_ARRAY(m->end, n),
                                        BASE_ZEROS(m->path, n),
                                        BASE_ZEROS(m->cause, n),
                                        BASE_ZEROS(m->runs_on, paje ? n : 0),
                                        BASE_ARRAY(m->near, cores),
                                        BASE_ARRAY(m->other, cores * cores),
                                        BASE_ZEROS(m->level, cores),
                                        {0}};
    m->memory = base_arrays(arrays);
    if (!paje)
        m->runs_on = NULL;
    if (m->memory && cores)
        machine_near(m);
    return m->memory;
}

static void machine_scheduler(struct predict_machine *m, uint32_t worker)
{
    const uint32_t cores = m->cluster->cores;
    const duite_scheduler *scheduler = m->scheduler;
    void *state = predict_worker_state(m, worker);
    if (scheduler->start)
        scheduler->start(state, worker % cores, cores, m->cluster->seed);
    if (scheduler->locate)
        scheduler->locate(state, &m->near[worker % cores]);
    m->queue[worker].heap = scheduler->serve(state) == DUITE_HIGHEST;
}

static void machine_init(struct predict_machine *m)
{
    const uint32_t cores = m->cluster->cores;
    for (uint32_t w = 0; w < m->n_workers; w++) {
        machine_scheduler(m, w);
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
    for (size_t i = 0; i < m->graph->n_objects; i++)
        m->affinity[i] = PREDICT_NONE;
}

bool predict_machine_start(struct predict_machine *m, bool paje)
{
    const bool fine = machine_prepare(m, paje);
    if (fine)
        machine_init(m);
    return fine;
}

void predict_machine_stop(struct predict_machine *m)
{
    for (uint32_t w = 0; w < m->n_workers && m->queue; w++)
        free(m->queue[w].node);
    for (uint32_t h = 0; h < m->cluster->hosts && m->shared; h++)
        free(m->shared[h].node);
    free(m->events.event);
    base_free(m->memory);
}
