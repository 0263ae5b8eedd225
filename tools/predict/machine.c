/* The parts of the machine: queues, the events to come, a task as schedulers see it; its start and
 * stop. */
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

/* ---- Tasks as schedulers see them ---- */

duite_ready predict_describe(const struct predict_machine *m, uint32_t node)
{
    const struct predict_node *n = &m->graph->node[node];
    const struct trace_run *run = m->graph->run;
    const uint32_t ran = n->placed ? m->affinity[n->placed - 1] : PREDICT_NONE;
    const bool has_affinity = ran != PREDICT_NONE && m->host_of[ran] == n->host;
    return (duite_ready){.kernel = n->kernel < run->n_kernels
                                       ? run->kernel_name[n->kernel]
                                       : task_own_name(n->kernel - run->n_kernels),
                         .number = n->number,
                         .block = n->block,
                         .priority = n->priority,
                         .cost = (double)n->cost,
                         .path = (double)n->path,
                         .affinity = has_affinity ? 1 + ran - m->first[n->host] : 0};
}

/* ---- Start and stop ---- */

/* A worker sees the others of its host in the order of their numbers, all equally near: those from
 * its own on in a row that has all of the host twice. */
static void machine_near(struct predict_machine *m)
{
    for (uint32_t h = 0; h < m->cluster->hosts; h++) {
        const uint32_t first = m->first[h], cores = m->host[h].cores;
        for (uint32_t i = 0; i < 2 * cores; i++)
            m->other[2 * first + i] = i % cores;
        for (uint32_t w = 0; w < cores; w++)
            m->near[first + w] = (duite_near){cores - 1, m->other + 2 * first + w + 1, m->level};
    }
}

static bool machine_prepare(struct predict_machine *m, bool paje)
{
    const struct predict_graph *graph = m->graph;
    const size_t n = graph->n_nodes + 1, workers = m->n_workers, hosts = m->cluster->hosts;
    const size_t near = m->scheduler->locate ? workers : 0;
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
                                        BASE_ZEROS(m->waiting, hosts),
                                        BASE_ZEROS(m->looked, workers),
                                        BASE_ZEROS(m->handler, hosts),
                                        BASE_ZEROS(m->handled, hosts),
                                        BASE_ARRAY(m->begin, n),
                                        BASE_ARRAY(m->end, n),
                                        BASE_ZEROS(m->path, n),
                                        BASE_ARRAY(m->cause, n),
                                        BASE_ZEROS(m->runs_on, paje ? n : 0),
                                        BASE_ARRAY(m->first, hosts + 1),
                                        BASE_ARRAY(m->host_of, workers),
                                        BASE_ARRAY(m->near, near),
                                        BASE_ARRAY(m->other, 2 * near),
                                        BASE_ZEROS(m->level, near),
                                        {0}};
    m->memory = base_arrays(arrays);
    if (!paje)
        m->runs_on = NULL;
    return m->memory && predict_network_start(&m->network, graph, &m->events);
}

static void machine_scheduler(struct predict_machine *m, uint32_t worker)
{
    const uint32_t host = m->host_of[worker];
    const duite_scheduler *scheduler = m->scheduler;
    void *state = predict_worker_state(m, worker);
    if (scheduler->start)
        scheduler->start(state, worker - m->first[host], m->host[host].cores, m->cluster->seed);
    if (scheduler->locate)
        scheduler->locate(state, &m->near[worker]);
    m->queue[worker].heap = scheduler->serve(state) == DUITE_HIGHEST;
}

static void machine_init(struct predict_machine *m)
{
    uint32_t n = 0;
    for (uint32_t h = 0; h < m->cluster->hosts; h++) {
        m->first[h] = m->last[h] = n;
        m->idle[h] = m->host[h].cores - 1;
        for (uint32_t w = 0; w < m->host[h].cores; w++)
            m->host_of[n++] = h;
    }
    m->first[m->cluster->hosts] = n;
    if (m->scheduler->locate)
        machine_near(m);
    for (uint32_t w = 0; w < m->n_workers; w++) {
        machine_scheduler(m, w);
        m->next[w] = m->ran[w] = PREDICT_NONE;
        m->state[w] = w == m->first[m->host_of[w]] ? RESERVED : IDLE;
    }
    for (uint32_t h = 0; h < m->cluster->hosts; h++)
        m->shared[h].heap = m->queue[m->first[h]].heap;
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
    predict_network_stop(&m->network);
    free(m->events.event);
    base_free(m->memory);
}
