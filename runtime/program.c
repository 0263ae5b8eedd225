/* The calls of the main program (a body's go to inside.c): each checks that it may be made, settles
 * the homes of new objects where they matter, and leaves the work to graph/. An error of a call
 * that returns at once is remembered for the next get, wait or stop. */
#include "runtime/instance.h"

#include "runtime/base/error.h"
#include "runtime/map/map.h"

#include <stdio.h>

int program_enter_any(duite *rt, const char *call)
{
    if (!rt)
        return base_error(DUITE_E_ARGUMENT, "%s: no runtime", call);
    if (!work_may_fork(rt->pool))
        return base_error(DUITE_E_STATE, "%s is for the main thread, outside of bodies", call);
    if (rt->graph.broken)
        return base_error(rt->graph.broken,
                          "%s: an earlier call failed beyond repair (%s); only duite_stop is left",
                          call, duite_code_text(rt->graph.broken));
    return rt->comm ? comm_broken(rt->comm) : DUITE_OK;
}

int program_enter(duite *rt, const char *call)
{
    int code = program_enter_any(rt, call);
    if (code || !rt->building)
        return code;
    return program_remember(rt,
                            base_error(DUITE_E_STATE, "%s: not while a graph is recorded", call));
}

int program_remember(duite *rt, int code)
{
    if (code && rt->building)
        return recorded_failed(rt, code);
    if (code == DUITE_E_MEMORY && rt->comm)
        rt->graph.broken = code; /* the other ranks did what this one could not */
    if (rt->graph.broken)
        instance_give_up(rt);
    if (!code || rt->remembered)
        return code;
    rt->remembered = code;
    snprintf(rt->sentence, sizeof rt->sentence, "%s", duite_message());
    return code;
}

/* The remembered error, which is told once. */
static int recall(duite *rt)
{
    int code = rt->remembered;
    rt->remembered = DUITE_OK;
    return code ? base_error(code, "%s", rt->sentence) : DUITE_OK;
}

int program_settle(duite *rt)
{
    return map_settle(&rt->graph.table, rt->mapping, rt->seed);
}

/* ---- Tasks ---- */

/* This ends: of all unfinished tasks of all ranks, take the first in fork order. What it waits for
 * was forked before it, runs, and is over. A rank that has not come to its fork yet, and so does
 * not send what it needs, is not throttled: all tasks it has are even earlier, so they are over.
 * Contributions do not wait for the access that combines them, and what combines waits for
 * earlier tasks only. Messages go on, since a throttled rank sends and receives as it works. */
void program_throttle(duite *rt)
{
    if (rt->window)
        work_throttle(rt->pool, rt->window);
}

static int fork_task(duite *rt, const struct graph_how *how, const duite_kernel *kernel,
                     const void *args, size_t n, const duite_object *objects)
{
    if (rt->building)
        return program_remember(rt, graph_record_fork(rt->building, how, kernel, args, n, objects));
    int code = program_settle(rt);
    if (!code)
        code = graph_fork(&rt->graph.root, work_main(rt->pool), how, kernel, args, n, objects);
    work_tick(rt->pool);
    if (!code)
        program_throttle(rt);
    return program_remember(rt, code);
}

int duite_fork(duite *rt, const duite_kernel *kernel, const void *args, size_t n,
               const duite_object *objects)
{
    struct duite_call_private *body = inside_body(rt);
    if (body)
        return inside_fork(body, NULL, kernel, args, n, objects);
    int code = program_enter_any(rt, "duite_fork");
    return code
               ? code
               : fork_task(rt, &(struct graph_how){.at = GRAPH_ANYWHERE}, kernel, args, n, objects);
}

int duite_fork_at(duite *rt, int rank, const duite_kernel *kernel, const void *args, size_t n,
                  const duite_object *objects)
{
    int code = program_enter_any(rt, "duite_fork_at");
    if (code)
        return code;
    if (rank < 0)
        return program_remember(
            rt, base_error(DUITE_E_ARGUMENT, "duite_fork_at: there is no rank %d", rank));
    return fork_task(rt, &(struct graph_how){.at = rank}, kernel, args, n, objects);
}

int duite_fork_with(duite *rt, const duite_how *how, const duite_kernel *kernel, const void *args,
                    size_t n, const duite_object *objects)
{
    struct duite_call_private *body = inside_body(rt);
    if (body)
        return inside_fork(body, how, kernel, args, n, objects);
    int code = program_enter_any(rt, "duite_fork_with");
    if (code)
        return code;
    struct graph_how own = {.at = GRAPH_ANYWHERE};
    if (how)
        own = (struct graph_how){.at = how->at ? *how->at : GRAPH_ANYWHERE,
                                 .priority = how->priority,
                                 .cost = how->cost > 0 ? how->cost : 0};
    if (how && how->at && own.at < 0)
        return program_remember(
            rt, base_error(DUITE_E_ARGUMENT, "duite_fork_with: there is no rank %d", own.at));
    return fork_task(rt, &own, kernel, args, n, objects);
}

static int set(duite *rt, duite_object object, const void *values, const size_t *count,
               const char *call)
{
    struct duite_call_private *body = inside_body(rt);
    if (body)
        return inside_set(body, object, values, count, call);
    int code = program_enter_any(rt, call);
    if (!code && rt->building)
        return program_remember(rt, graph_record_set(rt->building, object, values, count));
    if (!code)
        code = program_remember(rt, program_settle(rt));
    if (!code)
        code = program_remember(
            rt, graph_set(&rt->graph.root, work_main(rt->pool), object, values, count));
    return code;
}

int duite_set(duite *rt, duite_object object, const void *values)
{
    return set(rt, object, values, NULL, "duite_set");
}

int duite_set_sized(duite *rt, duite_object object, const void *values, size_t count)
{
    return set(rt, object, values, &count, "duite_set_sized");
}

/* ---- Waiting ---- */

static bool copy_done(void *context)
{
    return atomic_load_explicit(&((struct graph_copy *)context)->done, memory_order_acquire);
}

/* Copies to the values, or tells the count, whichever is wanted here. */
int program_get(duite *rt, duite_object object, int rank, void *values, size_t *count,
                const char *call)
{
    bool here = rank == GRAPH_ANYWHERE || rank == rt->graph.rank;
    struct graph_copy copy = {.values = values};
    int code = program_settle(rt);
    if (!code)
        code = graph_copy(&rt->graph, work_main(rt->pool), object, rank, &copy);
    work_tick(rt->pool);
    if (code == DUITE_E_MEMORY)
        return program_remember(rt, code);
    if (code || !here)
        return code;
    work_until(rt->pool, copy_done, &copy);
    if (!copy_done(&copy))
        instance_give_up(rt); /* the task that would have copied is over, then */
    if (rt->comm && comm_broken(rt->comm))
        return comm_broken(rt->comm);
    if (!values && !count) /* found out only now: the other ranks count on this one */
        return base_error(DUITE_E_ARGUMENT, "%s: nowhere to put the answer", call);
    if (copy.failure)
        return graph_failure_error(&rt->graph, copy.failure);
    if (count)
        *count = copy.bytes / data_type_size(data_object_find(&rt->graph.table, object)->type);
    return DUITE_OK;
}

/* The get does its work, whatever was remembered. */
static int get_and_recall(duite *rt, duite_object object, int rank, void *values, size_t *count,
                          const char *call)
{
    int code = program_enter(rt, call);
    if (code)
        return code;
    code = program_get(rt, object, rank, values, count, call);
    int before = recall(rt);
    return before ? before : code;
}

int duite_get(duite *rt, duite_object object, void *values)
{
    struct duite_call_private *body = inside_body(rt);
    if (body)
        return inside_get(body, object, values, NULL, "duite_get");
    return get_and_recall(rt, object, GRAPH_ANYWHERE, values, NULL, "duite_get");
}

int duite_get_count(duite *rt, duite_object object, size_t *count)
{
    struct duite_call_private *body = inside_body(rt);
    if (body)
        return inside_get(body, object, NULL, count, "duite_get_count");
    return get_and_recall(rt, object, GRAPH_ANYWHERE, NULL, count, "duite_get_count");
}

int duite_get_at(duite *rt, duite_object object, int rank, void *values)
{
    if (rank < 0)
        return base_error(DUITE_E_ARGUMENT, "duite_get_at: there is no rank %d", rank);
    return get_and_recall(rt, object, rank, values, NULL, "duite_get_at");
}

static bool drained(void *context)
{
    return !work_unfinished(context);
}

static void between(void *context)
{
    work_once(context);
}

/* What this rank tells the others of its failures. */
static struct comm_word own_word(const struct graph *graph)
{
    struct comm_word own = {0};
    const struct data_failure *first = graph->root.failure;
    if (first) {
        own.failed = first->number + 1;
        own.failure = *first;
    }
    return own;
}

/* Have all ranks forked the same? Asked before anything is waited for: a rank that waits for data
 * which another one never thinks of sending would wait for ever. */
static int compare(duite *rt)
{
    struct graph *graph = &rt->graph;
    const struct comm_word own = {.forks = graph->root.forks, .fingerprint = graph->fingerprint};
    struct comm_word *words;
    int code = comm_agree(rt->comm, &own, &words, between, rt->pool);
    work_idle_ends(rt->pool);
    for (int i = 1; i < graph->n_ranks && !code; i++) {
        if (words[i].fingerprint == words[0].fingerprint)
            continue;
        code =
            base_error(DUITE_E_DIFFERENT,
                       "ranks 0 and %d forked different tasks, or made different objects, since "
                       "the last wait (%llu and %llu tasks since start)",
                       i, (unsigned long long)words[0].forks, (unsigned long long)words[i].forks);
        graph->broken = code;
    }
    graph->fingerprint = 0;
    if (code)
        instance_give_up(rt);
    return code;
}

/* The failure that is first in fork order among those of n ranks, or NULL. */
static const struct data_failure *first_failure(const struct comm_word *words, int n)
{
    const struct comm_word *first = NULL;
    for (int i = 0; i < n; i++)
        if (words[i].failed && (!first || words[i].failed < first->failed))
            first = &words[i];
    return first ? &first->failure : NULL;
}

int duite_wait(duite *rt)
{
    struct duite_call_private *body = inside_body(rt);
    if (body)
        return inside_wait(body);
    int code = program_enter(rt, "duite_wait");
    if (code)
        return code;
    struct graph *graph = &rt->graph;
    work_tick(rt->pool);
    if (rt->comm && (code = compare(rt)))
        return code;
    work_until(rt->pool, drained, rt->pool);
    struct comm_word own = own_word(graph), *words = &own;
    if (rt->comm)
        code = comm_agree(rt->comm, &own, &words, between, rt->pool);
    work_idle_ends(rt->pool);
    if (code) {
        instance_give_up(rt);
        return code;
    }
    code = recall(rt);
    const struct data_failure *failure = first_failure(words, graph->n_ranks);
    if (code || !failure)
        return code;
    graph_first_failure(&graph->root); /* told */
    return graph_failure_error(graph, failure);
}

/* ---- Counters ---- */

int duite_count_all(duite *rt, duite_counters *counters)
{
    int code = program_enter(rt, "duite_count_all");
    if (code || !counters)
        return code ? code
                    : base_error(DUITE_E_ARGUMENT, "duite_count_all: nowhere to put the counters");
    duite_counters own = {0};
    work_count(rt->pool, &own);
    if (rt->comm)
        comm_count(rt->comm, &own.messages, &own.bytes);
    double sums[] = {(double)own.tasks,
                     (double)own.placed,
                     (double)own.stolen,
                     (double)own.chained,
                     (double)own.messages,
                     (double)own.bytes,
                     own.busy,
                     own.idle,
                     (double)atomic_load_explicit(&rt->graph.renamed, memory_order_relaxed)};
    if (rt->comm)
        code = comm_sum(rt->comm, sums, sizeof sums / sizeof sums[0], between, rt->pool);
    work_idle_ends(rt->pool);
    if (code)
        instance_give_up(rt);
    *counters = (duite_counters){.tasks = (uint64_t)sums[0],
                                 .placed = (uint64_t)sums[1],
                                 .stolen = (uint64_t)sums[2],
                                 .chained = (uint64_t)sums[3],
                                 .messages = (uint64_t)sums[4],
                                 .bytes = (uint64_t)sums[5],
                                 .busy = sums[6],
                                 .idle = sums[7],
                                 .renamed = (uint64_t)sums[8],
                                 .graphs_recorded = rt->graphs_recorded};
    return code;
}
