/* Events: tasks end when their bodies are over and their events are completed, in any order and by
 * any thread; until then nobody sees their results. */
#include "tests/runtime/events.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LATE = 3000 /* microseconds after the body */, AT_ONCE = 200 };

/* ---- A thread of the program that completes events ---- */

struct late {
    duite_event event[2];
    int n, code, wait; /* wait: microseconds before it begins */
    int64_t *value;    /* where it adds 1 for each event */
};

static void *complete_late(void *argument)
{
    struct late *late = argument;

    usleep((useconds_t)late->wait);
    for (int i = 0; i < late->n; i++) {
        if (late->value)
            ++*late->value;
        ck_assert_int_eq(duite_complete(rt, late->event[i], i ? 0 : late->code), DUITE_OK);
    }
    free(late);
    return NULL;
}

struct hold_args {
    int events, code, wait; /* events: 0, 1 or 2 */
    int own;                /* the body returns this code */
    int at_once;            /* the body completes them itself */
};

/* Adds 1, and leaves another 1 for each event to another thread. */
KERNEL(HOLD, "hold", .access = {DUITE_RW}, .args_size = sizeof(struct hold_args), .events = 1)
{
    const struct hold_args *args = call->args;
    struct late *late = malloc(sizeof *late);
    pthread_t thread;

    *late = (struct late){.n = args->events,
                          .code = args->code,
                          .wait = args->wait,
                          .value = duite_out(call, 0, int64_t)};
    ++*late->value;
    for (int i = 0; i < args->events; i++)
        ck_assert_int_eq(duite_event_new(call, &late->event[i]), DUITE_OK);
    if (args->at_once) {
        complete_late(late);
    } else {
        ck_assert_int_eq(pthread_create(&thread, NULL, complete_late, late), 0);
        pthread_detach(thread);
    }
    return args->own;
}

/* Leaves its event to the main thread. */
static duite_event left[AT_ONCE];
static _Atomic int n_left;

KERNEL(LEAVE, "leave", .access = {DUITE_RW}, .events = 1)
{
    duite_event event;
    const int code = duite_event_new(call, &event);

    *duite_out(call, 0, int64_t) = 1;
    left[atomic_load(&n_left)] = event;
    atomic_fetch_add(&n_left, 1); /* one worker runs them all */
    return code;
}

KERNEL(TWICE, "twice", .access = {DUITE_R, DUITE_W})
{
    *duite_out(call, 1, int64_t) = 2 * *duite_in(call, 0, int64_t);
    return 0;
}

/* Its kernel has no events. */
KERNEL(WITHOUT, "without")
{
    duite_event event = {1, 1};
    const int code = duite_event_new(call, &event);

    ck_assert_uint_eq(event.slot, 0);
    ck_assert_ptr_nonnull(strstr(duite_message(), "without"));
    return code == DUITE_E_STATE ? 0 : 1;
}

/* Forks a child that is held, and waits for it. */
KERNEL(PARENT, "parent", .access = {DUITE_RWP})
{
    const struct hold_args args = {.events = 2, .wait = LATE};
    int64_t value = 0;

    DUITE_FORK(call->rt, &HOLD, &args, call->param[0].object);
    if (duite_get(call->rt, call->param[0].object, &value))
        return 1;
    return value == 3 ? duite_wait(call->rt) : 2;
}

static void start(unsigned threads, int check, size_t window)
{
    static const duite_kernel *const KERNELS[] = {&HOLD, &LEAVE, &TWICE, &WITHOUT, &PARENT, NULL};

    start_with(KERNELS, threads, check, window);
}

static int64_t value_of(duite_object object)
{
    int64_t value = -1;

    ck_assert_msg(!duite_get(rt, object, &value), "%s", duite_message());
    return value;
}

/* Readers see what the other thread wrote, for any number of events, workers and windows. */
UNIT_TEST(results_wait)
{
    for (unsigned threads = 1; threads < 4; threads++)
        for (int check = 0; check < 2; check++) {
            start(threads, check, threads == 2);
            for (int i = 0; i < 12; i++) {
                const struct hold_args args = {
                    .events = i % 3, .wait = i % 2 ? LATE : 0, .at_once = i % 4 == 3};
                const duite_object a = number(), b = number();

                DUITE_FORK(rt, &HOLD, &args, a);
                DUITE_FORK(rt, &HOLD, &args, a);
                DUITE_FORK(rt, &TWICE, NULL, a, b);
                ck_assert_int_eq(value_of(b), 4 * (1 + args.events));
                duite_free(rt, a);
                duite_free(rt, b);
            }
            ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
        }
}

/* Held tasks keep no worker: the one beside the main thread runs many bodies before any event is
 * completed. */
UNIT_TEST(many_at_once)
{
    duite_object object[AT_ONCE];

    start(2, 0, 0);
    for (int i = 0; i < AT_ONCE; i++) {
        object[i] = number();
        DUITE_FORK(rt, &LEAVE, NULL, object[i]);
    }
    for (int ms = 0; ms < 20000 && atomic_load(&n_left) < AT_ONCE; ms++)
        usleep(1000);
    ck_assert_int_eq(atomic_load(&n_left), AT_ONCE);
    for (int i = 0; i < AT_ONCE; i++)
        ck_assert_int_eq(duite_complete(rt, left[i], 0), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    for (int i = 0; i < AT_ONCE; i++) {
        ck_assert_int_eq(value_of(object[i]), 1);
        duite_free(rt, object[i]);
    }
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

/* Repeated forks with events are not recognised: a get does not wait for the events of others. */
UNIT_TEST(repeated)
{
    enum { ROUNDS = 100 };

    setenv("DUITE_MEMO", "always", 1);
    start(2, 0, 0);
    const duite_object a = number(), b = number(), c = number();
    for (int i = 0; i < ROUNDS; i++) {
        DUITE_FORK(rt, &LEAVE, NULL, a);
        DUITE_FORK(rt, &TWICE, NULL, b, c);
    }
    ck_assert_int_eq(value_of(c), 0);
    for (int i = 0; i < ROUNDS; i++) {
        while (atomic_load(&n_left) <= i)
            usleep(100);
        ck_assert_int_eq(duite_complete(rt, left[i], 0), DUITE_OK);
    }
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    duite_free(rt, a);
    duite_free(rt, b);
    duite_free(rt, c);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

struct round {
    const struct hold_args *args;
    duite_object a, b;
};

static int build(duite *runtime, void *context)
{
    const struct round *round = context;

    DUITE_FORK(runtime, &HOLD, round->args, round->a);
    return DUITE_FORK(runtime, &TWICE, NULL, round->a, round->b);
}

static void replay(struct round *round, uint64_t rounds)
{
    duite_graph graph;

    ck_assert_int_eq(duite_graph_new(rt, build, round, &graph), DUITE_OK);
    ck_assert_int_eq(duite_replay(rt, graph, rounds), DUITE_OK);
    duite_graph_free(rt, graph);
}

/* An event, or the body, fails the task: it poisons, once, and only after the other events. */
UNIT_LOOP(failures, 0, 2)
{
    static const struct hold_args CASES[] = {{.events = 1, .code = 7},
                                             {.events = 2, .code = 7, .wait = LATE},
                                             {.events = 2, .code = 7, .at_once = 1},
                                             {.events = 0, .own = 7},
                                             {.events = 1, .own = 7, .wait = LATE}};
    int64_t value;

    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        start(2, 0, 0);
        const duite_object a = number(), b = number();
        struct round round = {&CASES[i], a, b};
        if (_i)
            replay(&round, 3);
        else
            build(rt, &round);
        ck_assert_int_eq(duite_get(rt, b, &value), 7);
        ck_assert_ptr_nonnull(strstr(duite_message(), "kernel hold"));
        ck_assert_int_eq(duite_wait(rt), 7);
        ck_assert_int_eq(duite_set(rt, a, NULL), DUITE_OK); /* a w heals */
        ck_assert_int_eq(value_of(a), 0);
        duite_free(rt, a);
        duite_free(rt, b);
        ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    }
}

UNIT_TEST(misuse)
{
    start(1, 0, 0);
    ck_assert_int_eq(duite_fork(rt, &WITHOUT, NULL, 0, NULL), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_int_eq(duite_complete(rt, (duite_event){0, 0}, 0), DUITE_E_OBJECT);
    ck_assert_ptr_nonnull(strstr(duite_message(), "never made"));
    const struct hold_args args = {.events = 1, .at_once = 1};
    const duite_object a = number();
    DUITE_FORK(rt, &HOLD, &args, a);
    ck_assert_int_eq(value_of(a), 2);
    ck_assert_int_eq(duite_complete(rt, (duite_event){1, 1}, 0), DUITE_E_OBJECT);
    ck_assert_ptr_nonnull(strstr(duite_message(), "completed already"));
    ck_assert_int_eq(duite_complete(rt, (duite_event){9, 1}, 0), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_complete(NULL, (duite_event){1, 1}, 0), DUITE_E_ARGUMENT);
    duite_free(rt, a);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

/* A body waits for a child that is held, also on its only thread. */
UNIT_TEST(children)
{
    for (unsigned threads = 1; threads < 3; threads++) {
        start(threads, 0, 0);
        const duite_object a = number();
        DUITE_FORK(rt, &PARENT, NULL, a);
        ck_assert_int_eq(value_of(a), 3);
        duite_free(rt, a);
        ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    }
}

/* The report of a standstill names the task and its event. */
UNIT_TEST(never_completed)
{
    const struct hold_args args = {.events = 1, .wait = 1000000};
    int64_t value = 0;

    setenv("DUITE_STUCK_SECONDS", "0.2", 1);
    start(2, 0, 0);
    const duite_object a = number();
    DUITE_FORK(rt, &HOLD, &args, a);
    reports(a, &value, "(kernel hold) ends when the program completes event 1.1");
    ck_assert_int_eq(value, 2);
    duite_free(rt, a);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

UNIT_TEST(replays)
{
    const struct hold_args args = {.events = 1, .wait = 200};
    start(2, 0, 0);
    struct round round = {&args, number(), number()};
    replay(&round, 5);
    ck_assert_int_eq(value_of(round.b), 20);
    duite_free(rt, round.a);
    duite_free(rt, round.b);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}
