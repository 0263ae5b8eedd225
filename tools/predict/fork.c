/* Forks of the main program: the host of each task by the owner rule (task/owner.h), the seconds of
 * its body, and its place behind the nodes before it. */
#include "tools/predict/program.h"

#include "runtime/base/memory.h"
#include "runtime/task/owner.h"

uint32_t predict_owner(const struct predict_graph *graph, const struct predict_fork *fork,
                       const uint32_t *objects)
{
    const struct trace_kernel *kernel = &graph->run->kernel[fork->kernel];
    uint8_t access[DUITE_MAX_ACCESS] = {DUITE_NONE};
    for (size_t i = 0; i < kernel->n_modes; i++)
        access[i] = (uint8_t)trace_mode(kernel, i);
    const uint32_t own = task_owner(access, trace_mode(kernel, SIZE_MAX), fork->n);
    return own == TASK_NOBODY ? PREDICT_NONE : objects[own];
}

static int fork_host(const struct predict_graph *graph, const struct predict_fork *fork,
                     uint32_t own)
{
    const int at = fork->at < 0 ? TASK_ANYWHERE : fork->at % (int)graph->cluster->hosts;
    const int rank = task_owner_rank(at, graph->run->kernel[fork->kernel].replicated,
                                     own == PREDICT_NONE ? -1 : graph->object[own].home);
    return rank == TASK_EVERYWHERE ? PREDICT_ALL : rank;
}

static void fork_fix_owner(struct predict_program *p, uint32_t own)
{
    uint32_t slot = own == PREDICT_NONE ? 0 : p->name[own].slot;
    if (slot)
        p->table.object[slot].fixed = true;
}

double predict_body(struct predict_program *p, const struct predict_fork *fork, uint32_t own)
{
    const struct predict_cluster *cluster = p->graph->cluster;
    const struct trace_kernel *kernel = &p->graph->run->kernel[fork->kernel];
    const bool follows =
        task_owner_decides(fork->at < 0 ? TASK_ANYWHERE : fork->at, kernel->replicated);
    double seconds;
    if (!predict_times_find(p->times, fork->number, &seconds) || cluster->steady)
        seconds = predict_times_kernel(p->times, fork->kernel);
    if (cluster->bodies > 0 &&
        (!cluster->grows || cluster->grows(p->graph->run->kernel_name[fork->kernel])))
        seconds *= cluster->bodies;
    if (kernel->fixed && follows)
        fork_fix_owner(p, own);
    predict_spend(p, follows ? own : PREDICT_NONE, fork_host(p->graph, fork, own), seconds);
    p->tasks++;
    return seconds;
}

duite_mode predict_fork_mode(const struct predict_program *p, const struct predict_fork *fork,
                             size_t k)
{
    return fork->kernel == PREDICT_NONE ? DUITE_W
                                        : trace_mode(&p->graph->run->kernel[fork->kernel], k);
}

static uint32_t fork_node(struct predict_graph *graph, const struct predict_fork *fork,
                          uint32_t own, int host, double seconds)
{
    const uint32_t block = own == PREDICT_NONE ? (uint32_t)fork->number : graph->object[own].block;
    graph->linked = false;
    return predict_add(graph, &(struct predict_node){.number = fork->number,
                                                     .kernel = fork->kernel,
                                                     .host = (uint32_t)host,
                                                     .block = block,
                                                     .priority = fork->priority,
                                                     .cost = fork->cost,
                                                     .seconds = (float)seconds});
}

/* Each host runs the task, and has what it writes. */
static void fork_everywhere(struct predict_graph *graph, const struct predict_fork *fork,
                            uint32_t own, double seconds)
{
    const struct trace_kernel *kernel = &graph->run->kernel[fork->kernel];
    for (size_t i = 0; i < fork->n; i++)
        predict_prepare_all(graph, fork->object[i], trace_mode(kernel, i));
    for (uint32_t host = 0; host < graph->cluster->hosts && !graph->failed; host++) {
        const uint32_t node = graph->over[host] = fork_node(graph, fork, own, (int)host, seconds);
        for (size_t i = 0; i < fork->n && !graph->failed; i++) {
            const duite_mode mode = trace_mode(kernel, i);
            predict_enter(graph, node, fork->object[i], (int)host, data_order_reads(mode),
                          data_order_writes(mode));
        }
        predict_hold(graph, node);
    }
    for (size_t i = 0; i < fork->n && !graph->failed; i++)
        predict_leave(graph, fork->object[i], graph->all, data_order_writes(trace_mode(kernel, i)));
}

void predict_fork(struct predict_program *p, const struct predict_fork *fork)
{
    struct predict_graph *graph = p->graph;
    const struct trace_kernel *kernel = &graph->run->kernel[fork->kernel];
    const uint32_t own = predict_owner(graph, fork, fork->object);
    const int host = fork_host(graph, fork, own);
    const double seconds = predict_body(p, fork, own);
    if (host == PREDICT_ALL) {
        fork_everywhere(graph, fork, own, seconds);
        return;
    }
    for (size_t i = 0; i < fork->n; i++)
        p->prepared[i] = predict_prepare(graph, fork->object[i], trace_mode(kernel, i), host);
    const uint32_t node = fork_node(graph, fork, own, host, seconds);
    for (size_t i = 0; i < fork->n && !graph->failed; i++)
        predict_use(graph, node, fork->object[i], trace_mode(kernel, i), p->prepared[i]);
    predict_hold(graph, node);
}

bool predict_room(struct predict_program *p, size_t n)
{
    const bool fine = BASE_GROW(p->prepared, p->prepared_capacity, n + 1) &&
                      BASE_GROW(p->objects, p->objects_capacity, n + 1);
    p->graph->failed |= !fine;
    return fine;
}

void predict_take_fork(struct predict_program *p, size_t n, bool has_options)
{
    struct predict_fork fork = {.kernel = trace_words_next(&p->words), .n = n, .at = -1};
    if (has_options) {
        fork.at = (int32_t)trace_words_next(&p->words);
        fork.priority = (int32_t)trace_words_next(&p->words);
        fork.cost = trace_words_float(&p->words);
    }
    p->damaged |= fork.kernel >= p->graph->run->n_kernels;
    if (!predict_room(p, n) || p->damaged)
        return;
    for (size_t i = 0; i < n; i++)
        p->objects[i] = predict_object_at(p, trace_words_next(&p->words));
    fork.object = p->objects;
    fork.number = ++p->forks;
    if (!p->damaged && !p->words.short_of)
        predict_fork(p, &fork);
}
