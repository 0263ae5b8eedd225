/* The calls of the main program that block: gets, waits and sums over all ranks. All ranks make the
 * same calls. Each rank logs its own, so that a difference is found even if a rank waits for data
 * that no other rank will send. */
#include "runtime/api/instance.h"

#include "runtime/base/clock.h"
#include "runtime/base/error.h"

#include <stdio.h>
#include <string.h>

int api_recall(duite *rt)
{
    int code = rt->remembered;
    rt->remembered = DUITE_OK;
    return code ? base_error(code, "%s", rt->message) : DUITE_OK;
}

static bool copy_is_done(void *context)
{
    return atomic_load_explicit(&((struct task_copy *)context)->done, memory_order_acquire);
}

/* This rank's report to the others: the hash of its forks, and its first failure. */
static struct comm_word wait_own_word(const struct task_graph *graph)
{
    struct comm_word own = {.fingerprint = graph->fingerprint};
    const struct data_failure *first = graph->root.failure;
    if (first) {
        own.failed = first->number + 1;
        own.failure = *first;
    }
    return own;
}

int api_collective(duite *rt, const struct work_why *why, enum comm_collective kind,
                   struct comm_word *own)
{
    own->fingerprint = rt->graph.fingerprint;
    work_waits(rt->pool, why);
    comm_waits(rt->comm, true); /* the divergence check finds ranks that do not come to it */
    comm_enter(rt->comm, kind, own);
    work_drain(rt->pool, comm_is_entered, rt->comm);
    comm_waits(rt->comm, false);
    work_waits(rt->pool, NULL);
    if (comm_is_broken(rt->comm))
        api_give_up(rt);
    return comm_error(rt->comm);
}

int api_enter_wait(duite *rt, const char *kind, const char *call)
{
    struct comm_word own = {0};
    if (!rt->comm)
        return DUITE_OK;
    for (const char *c = kind; *c; c++)
        task_mix(&rt->graph, (unsigned char)*c);
    task_mixed(&rt->graph, COMM_CALLED, comm_function_find(call));
    const struct work_why why = {call, "the other ranks to come to it", NULL};
    return comm_call(rt->comm, call, rt->graph.fingerprint)
               ? api_collective(rt, &why, COMM_AGREES, &own)
               : DUITE_OK;
}

void api_wait_for_copy(duite *rt, const struct work_why *why, struct task_copy *copy)
{
    comm_waits(rt->comm, true);
    work_until(rt->pool, why, copy_is_done, copy);
    comm_waits(rt->comm, false);
    if (!copy_is_done(copy))
        api_give_up(rt); /* afterwards the task that would have copied is over */
}

/* Copies the bytes to `values`, or the number of elements to `count`: whichever is not NULL, and on
 * the ranks that want it. */
int api_get(duite *rt, duite_object object, int rank, void *values, size_t *count, const char *call)
{
    bool here = rank == TASK_ANYWHERE || rank == rt->graph.rank;
    struct task_copy copy = {.values = values};
    int code = api_settle(rt);
    if (!code)
        code = task_copy(&rt->graph, rt->worker, object, rank, &copy);
    work_tick(rt->pool);
    if (code == DUITE_E_MEMORY)
        return api_remember(rt, code);
    if (!code)
        code = api_enter_wait(rt, call, call);
    if (code || !here)
        return code;
    const struct data_key key = task_version_of(&rt->graph, object);
    api_wait_for_copy(rt, &(struct work_why){call, NULL, &key}, &copy);
    if (comm_is_broken(rt->comm))
        return comm_error(rt->comm);
    if (!values && !count) /* checked only now: the other ranks count on this one */
        return base_error(DUITE_E_ARGUMENT, "%s: nowhere to put the answer", call);
    if (copy.failure)
        return task_failure_error(&rt->graph, copy.failure);
    if (count)
        *count = copy.bytes / data_type_size(data_object_find(&rt->graph.table, object)->type);
    return DUITE_OK;
}

/* The get does its work even if an error was remembered. */
static int get_and_recall(duite *rt, duite_object object, int rank, void *values, size_t *count,
                          const char *call)
{
    int code = api_enter(rt, call);
    if (!code)
        code = api_check_turns(rt, call);
    if (code)
        return code;
    const uint64_t from = rt->trace ? base_ticks() : 0;
    code = api_get(rt, object, rank, values, count, call);
    trace_get(rt->trace, object, rank, from);
    int before = api_recall(rt);
    return before ? before : code;
}

int duite_get(duite *rt, duite_object object, void *values)
{
    struct duite_call_private *body = api_body(rt);
    if (body)
        return api_body_get(body, object, values, NULL, "duite_get");
    return get_and_recall(rt, object, TASK_ANYWHERE, values, NULL, "duite_get");
}

int duite_get_count(duite *rt, duite_object object, size_t *count)
{
    struct duite_call_private *body = api_body(rt);
    if (body)
        return api_body_get(body, object, NULL, count, "duite_get_count");
    return get_and_recall(rt, object, TASK_ANYWHERE, NULL, count, "duite_get_count");
}

int duite_get_at(duite *rt, duite_object object, int rank, void *values)
{
    if (rank < 0)
        return base_error(DUITE_E_ARGUMENT, "duite_get_at: there is no rank %d", rank);
    return get_and_recall(rt, object, rank, values, NULL, "duite_get_at");
}

/* No task's number: after all of those. */
#define POLICY_FAILED UINT64_MAX

/* This rank's report when all its tasks are over. A scheduler that never ended a round counts as a
 * failure. */
static struct comm_word wait_last_word(const duite *rt)
{
    struct comm_word own = wait_own_word(&rt->graph);
    const char *endless = work_endless(rt->pool);
    if (own.failed || !endless)
        return own;
    own.failed = POLICY_FAILED;
    own.failure = (struct data_failure){
        .code = DUITE_E_ARGUMENT, .rank = rt->graph.rank, .number = POLICY_FAILED};
    snprintf(own.failure.text, sizeof own.failure.text, "%s", endless);
    return own;
}

/* Ranks that forked different tasks may wait here for data that no rank sends: the divergence check
 * finds it. */
static int wait_for_own_tasks(duite *rt, const char *call)
{
    work_tick(rt->pool);
    int code = api_check_turns(rt, call);
    if (!code)
        code = api_enter_wait(rt, "duite_wait", call);
    if (code)
        return code;
    comm_waits(rt->comm, true);
    work_until(rt->pool, &(struct work_why){call, "all tasks of this rank", NULL}, work_is_drained,
               rt->pool);
    comm_waits(rt->comm, false);
    return DUITE_OK;
}

static bool word_is_earlier(const struct comm_word *one, const struct comm_word *other)
{
    const struct data_failure *a = &one->failure, *b = &other->failure;
    if (!one->failed || !other->failed)
        return one->failed;
    if (a->number != b->number)
        return a->number < b->number;
    const int order = memcmp(a->path, b->path, sizeof a->path);
    return order ? order < 0 : a->rank < b->rank;
}

/* The word whose failure is first in the reference order; of equal ones, that of the lower rank's
 * task. */
static const struct comm_word *wait_first_word(const duite *rt)
{
    const struct comm_word *words = comm_words(rt->comm), *first = words;
    for (const struct comm_word *one = words + 1; one < words + rt->graph.n_ranks; one++)
        if (word_is_earlier(one, first))
            first = one;
    return first;
}

int api_first_failure(duite *rt, const char *call, struct comm_word *own)
{
    const struct work_why why = {call, "the tasks of other ranks", NULL};
    int code = rt->comm ? api_collective(rt, &why, COMM_AGREES, own) : DUITE_OK;
    if (!rt->comm || code || !comm_words(rt->comm)->failed)
        return code;
    code = api_collective(rt, &why, COMM_GATHERS, own);
    if (!code)
        *own = *wait_first_word(rt);
    return code;
}

int api_meet(duite *rt, const char *call, struct comm_word *first)
{
    const struct work_why why = {call, "the tasks of other ranks", NULL};
    int code = wait_for_own_tasks(rt, call);
    if (code)
        return code;
    struct comm_word own = wait_last_word(rt);
    if (first)
        code = api_first_failure(rt, call, &own);
    else if (rt->comm)
        code = api_collective(rt, &why, COMM_AGREES, &own);
    if (first)
        *first = own;
    return code;
}

int api_wait(duite *rt, const char *call)
{
    struct duite_call_private *body = api_body(rt);
    if (body)
        return api_body_wait(body);
    int code = api_enter(rt, call);
    if (code)
        return code;
    struct comm_word first;
    code = api_meet(rt, call, &first);
    if (code)
        return code;
    code = api_recall(rt);
    const struct data_failure *failure = &first.failure;
    if (code || !first.failed)
        return code;
    if (failure->number == POLICY_FAILED)
        return base_error(failure->code,
                          "scheduler %s names victims without an end (seen on rank %d): its victim "
                          "has to return DUITE_NO_QUEUE at last",
                          failure->text, failure->rank);
    task_first_failure(&rt->graph.root); /* it is returned here and does not count again */
    return task_failure_error(&rt->graph, failure);
}

int duite_wait(duite *rt)
{
    const uint64_t from = rt && rt->trace ? base_ticks() : 0;
    const int code = api_wait(rt, "duite_wait");
    if (rt && !api_body(rt))
        trace_wait(rt->trace, from);
    return code;
}

/* ---- Counters ---- */

static void counters_add(duite_counters *sum, const duite_counters *own)
{
    sum->tasks += own->tasks;
    sum->placed += own->placed;
    sum->stolen += own->stolen;
    sum->stolen_far += own->stolen_far;
    sum->chained += own->chained;
    sum->delegated += own->delegated;
    sum->messages += own->messages;
    sum->bytes += own->bytes;
    sum->busy += own->busy;
    sum->idle += own->idle;
    sum->awaited += own->awaited;
    sum->exposed += own->exposed;
}

/* The counters of this rank become the sums of those of all ranks. */
static int counters_gather(duite *rt, duite_counters *counters)
{
    const struct work_why why = {"duite_count_all", "the other ranks", NULL};
    struct comm_word own = {0};
    duite_counters sum = {0}, of;
    _Static_assert(sizeof of <= sizeof own.number, "a word has room for the counters of a rank");
    int code = api_enter_wait(rt, why.call, why.call);
    if (!rt->comm || code)
        return code;
    code = api_collective(rt, &why, COMM_AGREES, &own);
    memcpy(own.number, counters, sizeof *counters);
    if (!code)
        code = api_collective(rt, &why, COMM_GATHERS, &own);
    for (int r = 0; r < rt->graph.n_ranks && !code; r++) {
        memcpy(&of, comm_words(rt->comm)[r].number, sizeof of);
        counters_add(&sum, &of);
    }
    *counters = sum;
    return code;
}

int api_count(duite *rt, duite_counters *all)
{
    *all = (duite_counters){0};
    work_count(rt->pool, all);
    if (rt->comm)
        comm_count(rt->comm, &all->messages, &all->bytes);
    const int code = counters_gather(rt, all);
    all->graphs_recorded = rt->graphs_recorded;
    all->migrated = rt->migration.objects;
    if (rt->memo)
        plan_memo_count(rt->memo, all);
    return code;
}

int duite_count_sized(duite *rt, duite_counters *counters, size_t size)
{
    duite_counters all;
    int code = api_enter(rt, "duite_count_all");
    if (code || !counters)
        return code ? code
                    : base_error(DUITE_E_ARGUMENT, "duite_count_all: nowhere to put the counters");
    code = api_count(rt, &all);
    memset(counters, 0, size);
    memcpy(counters, &all, size < sizeof all ? size : sizeof all);
    return code;
}
