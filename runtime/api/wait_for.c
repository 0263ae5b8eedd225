/* The main program's calls that wait for some objects only, while other tasks go on. On several
 * ranks a value is waited for where it is, and the ranks then agree, so that all return the same.
 *
 * A get that was begun is in the list of gets until it is ended: all ranks have the same list. Its
 * task copies the value whenever that is there, even after the object changed or was freed. */
#include "runtime/api/instance.h"

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <string.h>

/* ---- Some objects ---- */

/* Checks the objects before anything is done for one of them, and makes them part of the
 * fingerprint. */
static int some_enter(duite *rt, size_t n, const duite_object *objects, const char *call)
{
    if (n && !objects)
        return base_error(DUITE_E_ARGUMENT, "%s: the objects are NULL", call);
    for (size_t i = 0; i < n; i++)
        if (!data_object_here(&rt->graph.table, objects[i]))
            return base_error(DUITE_E_OBJECT,
                              "%s: object %zu of %zu (%u.%u) was freed before, or never made", call,
                              i + 1, n, objects[i].slot, objects[i].generation);
    task_mix(&rt->graph, n);
    return api_settle(rt);
}

struct some_copies {
    size_t n, done; /* the first `done` of them are */
    struct task_copy *copy;
};

static bool some_are_done(void *context)
{
    struct some_copies *some = context;
    while (some->done < some->n &&
           atomic_load_explicit(&some->copy[some->done].done, memory_order_acquire))
        some->done++;
    return some->done == some->n;
}

/* This rank's word about values that are there: the first failure among them. */
static struct comm_word some_word(const struct some_copies *some)
{
    const struct data_failure *first = NULL;
    struct comm_word own = {0};
    for (size_t i = 0; i < some->n; i++)
        first = data_failure_first(first, some->copy[i].failure);
    if (first) {
        own.failed = first->number + 1;
        own.failure = *first;
    }
    return own;
}

/* Works until the values are there on the ranks that make them; *first: the word of the first
 * failure of all ranks. */
static int some_wait(duite *rt, struct some_copies *some, const duite_object *objects,
                     struct comm_word *first)
{
    const char *const call = "duite_wait_for";
    int code = DUITE_OK;
    for (size_t i = 0; i < some->n && !code; i++)
        code = task_await(&rt->graph, rt->worker, objects[i], &some->copy[i]);
    work_tick(rt->pool);
    if (code)
        return api_remember(rt, code); /* memory; what was begun is over then */
    code = api_enter_wait(rt, call, call);
    if (code)
        return code;
    comm_waits(rt->comm, true);
    work_until(rt->pool, &(struct work_why){call, "values of objects on this rank", NULL},
               some_are_done, some);
    comm_waits(rt->comm, false);
    if (!some_are_done(some))
        api_give_up(rt);
    *first = some_word(some);
    return api_first_failure(rt, call, first);
}

static int some_wait_for(duite *rt, size_t n, const duite_object *objects)
{
    int code = some_enter(rt, n, objects, "duite_wait_for");
    if (code)
        return code;
    struct some_copies some = {.n = n, .copy = base_alloc_zero((n + 1) * sizeof *some.copy)};
    struct comm_word first = {0};
    if (!some.copy)
        return api_remember(rt, base_no_memory("a wait for objects"));
    const uint64_t from = rt->trace ? base_ticks() : 0;
    code = some_wait(rt, &some, objects, &first);
    for (size_t i = 0; i < n && rt->trace; i++)
        trace_get(rt->trace, objects[i], rt->graph.table.object[objects[i].slot].holder, from);
    base_free(some.copy);
    if (!code && first.failed)
        code = task_failure_error(&rt->graph, &first.failure);
    return code;
}

int duite_wait_for(duite *rt, size_t n, const duite_object *objects)
{
    struct duite_call_private *body = api_body(rt);
    if (body)
        return api_body_wait_for(body, n, objects);
    int code = api_enter(rt, "duite_wait_for");
    if (!code)
        code = api_check_turns(rt, "duite_wait_for");
    if (code)
        return code;
    code = some_wait_for(rt, n, objects);
    const int before = api_recall(rt);
    return before ? before : code;
}

/* ---- Tests ---- */

static bool some_are_there(const duite *rt, size_t n, const duite_object *objects)
{
    bool all = true;
    for (size_t i = 0; i < n && all; i++)
        all = task_is_there(&rt->graph, objects[i]);
    return all;
}

static int some_test(duite *rt, size_t n, const duite_object *objects, int *there)
{
    const struct work_why why = {"duite_test", "the other ranks to come to it", NULL};
    int code = some_enter(rt, n, objects, why.call);
    for (size_t i = 0; i < n && !code; i++)
        code = task_close(&rt->graph, rt->worker, objects[i]);
    if (code)
        return code;
    bool all = some_are_there(rt, n, objects);
    if (!all) {
        work_turn(rt->pool); /* or a loop of tests would never end on one thread */
        all = some_are_there(rt, n, objects);
    }
    if (rt->comm) {
        struct comm_word own = {.failed = !all};
        code = api_enter_wait(rt, why.call, why.call);
        if (!code)
            code = api_collective(rt, &why, COMM_AGREES, &own);
        all = code || !comm_words(rt->comm)->failed;
    }
    *there = all;
    return code;
}

int duite_test(duite *rt, size_t n, const duite_object *objects, int *there)
{
    if (there)
        *there = 1; /* whoever asks until it is true does not ask for ever if the call fails */
    int code = api_enter(rt, "duite_test");
    if (code)
        return code;
    if (!there)
        code = base_error(DUITE_E_ARGUMENT, "duite_test: nowhere to put the answer");
    return api_remember(rt, code ? code : some_test(rt, n, objects, there));
}

/* ---- Gets that are ended later ---- */

struct api_get {
    struct api_get *next;
    duite_object object;
    struct data_key version;
    struct task_copy copy;
    uint32_t number; /* for traces */
};

/* The oldest get of the object. */
static struct api_get **get_find(duite *rt, duite_object object)
{
    struct api_get **get = &rt->gets;
    while (*get && memcmp(&(*get)->object, &object, sizeof object) != 0)
        get = &(*get)->next;
    return get;
}

static int get_begin(duite *rt, struct api_get *get)
{
    int code = api_settle(rt);
    if (!code)
        code = task_copy(&rt->graph, rt->worker, get->object, TASK_ANYWHERE, &get->copy);
    if (code)
        return code;
    task_mixed(&rt->graph, COMM_CALLED, COMM_CALLED_GET_BEGIN);
    get->version = task_version_of(&rt->graph, get->object);
    struct api_get **end = &rt->gets;
    while (*end)
        end = &(*end)->next;
    *end = get;
    get->number = rt->gets_begun++;
    trace_get_begin(rt->trace, get->object, get->number);
    return DUITE_OK;
}

int duite_get_begin(duite *rt, duite_object object, void *values)
{
    int code = api_enter(rt, "duite_get_begin");
    if (code)
        return code;
    struct api_get *get = base_alloc_zero(sizeof *get);
    if (!get)
        return api_remember(rt, base_no_memory("a get"));
    get->object = object;
    get->copy.values = values;
    code = get_begin(rt, get);
    work_tick(rt->pool);
    if (code) {
        api_remember(rt, code);
        base_free(get);
        return code;
    }
    api_throttle(rt);
    if (!values) /* checked only now: the other ranks count on this one */
        code = base_error(DUITE_E_ARGUMENT, "duite_get_begin: nowhere to put the values");
    return api_remember(rt, code);
}

/* Works until the values are there, and takes the get out of the list. */
static int get_end(duite *rt, struct api_get **place)
{
    const char *const call = "duite_get_end";
    struct api_get *get = *place;
    task_mix(&rt->graph, task_name_bits(get->object));
    int code = api_enter_wait(rt, call, call);
    if (code)
        return code;
    api_wait_for_copy(rt, &(struct work_why){call, NULL, &get->version}, &get->copy);
    if (comm_is_broken(rt->comm))
        return comm_error(rt->comm);
    if (get->copy.failure)
        code = task_failure_error(&rt->graph, get->copy.failure);
    *place = get->next;
    base_free(get);
    return code;
}

int duite_get_end(duite *rt, duite_object object)
{
    int code = api_enter(rt, "duite_get_end");
    if (!code)
        code = api_check_turns(rt, "duite_get_end");
    struct api_get **get = code ? NULL : get_find(rt, object);
    if (code)
        return code;
    if (!*get)
        return api_remember(rt, base_error(DUITE_E_STATE,
                                           "duite_get_end: no get of object %u.%u was begun",
                                           object.slot, object.generation));
    const uint64_t from = rt->trace ? base_ticks() : 0;
    const uint32_t number = (*get)->number;
    code = get_end(rt, get);
    trace_get_end(rt->trace, number, from);
    const int before = api_recall(rt);
    return before ? before : code;
}

int api_gets_left(const duite *rt)
{
    const struct api_get *get = rt->gets;
    return get ? base_error(DUITE_E_NOT_FREED, "a get of object %u.%u was begun and not ended",
                            get->object.slot, get->object.generation)
               : DUITE_OK;
}

void api_gets_stop(duite *rt)
{
    for (struct api_get *next; rt->gets; rt->gets = next) {
        next = rt->gets->next;
        base_free(rt->gets);
    }
}
