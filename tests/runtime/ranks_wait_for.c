/* Waiting for some objects while other tasks go on, tests, and gets that are ended later: with
 * sums, replays, failures, turns and in bodies. Run under mpirun. */
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 1000, PATIENCE = 20000 /* milliseconds */ };

static duite *rt;
static atomic_int is_open;

struct held {
    duite *rt;
    duite_event event;
};

/* Completes the event when the program says so, or is patient no more. */
static void *hold(void *argument)
{
    struct held held = *(struct held *)argument;
    int waited = 0;

    free(argument);
    while (!atomic_load(&is_open) && waited++ < PATIENCE)
        usleep(1000);
    duite_complete(held.rt, held.event, waited < PATIENCE ? 0 : 99);
    return NULL;
}

/* Keeps no worker. */
KERNEL(GATE, "gate", .access = {DUITE_RW}, .events = 1)
{
    struct held *held = malloc(sizeof *held);
    pthread_t thread;

    ++*duite_out(call, 0, int32_t);
    held->rt = call->rt;
    if (duite_event_new(call, &held->event) || pthread_create(&thread, NULL, hold, held))
        return 98;
    return pthread_detach(thread);
}

/* Waits for the first of two children, and gets what it left. */
KERNEL(PARENT, "parent", .access = {DUITE_RWP})
{
    const duite_object mine = call->param[0].object;
    duite_object other;
    int32_t value = 0;
    int code = duite_new(call->rt, DUITE_I32, 1, &other);

    code |= duite_fork(call->rt, &SET, DUITE_ARGS(int32_t, 6), 1, &mine);
    code |= DUITE_FORK(call->rt, &FAIL, DUITE_ARGS(int32_t, 23), other);
    code |= duite_wait_for(call->rt, 1, &mine) | duite_get(call->rt, mine, &value);
    if (code || value != 6)
        return 1;
    code = duite_wait_for(call->rt, 2, (duite_object[]){mine, other});
    return code == 23 && strstr(duite_message(), "sentence 23") ? 0 : 2;
}

static int start(unsigned threads, size_t window)
{
    static const duite_kernel *const KERNELS[] = {&SET, &COPY, &ADD, &FAIL, &GATE, &PARENT, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);

    options.kernels = KERNELS;
    options.threads = threads;
    options.window = window;
    rt = misuse_start_with(&options);
    return rt != NULL;
}

static int value_of(duite_object object)
{
    int32_t values[WIDTH] = {-1};

    return duite_get(rt, object, values) ? -1 : values[0];
}

/* One task is held up on each rank, those of other objects are waited for meanwhile. */
static void others_go_on(void)
{
    const duite_object held = misuse_new(rt, 1), x = misuse_new(rt, WIDTH), y = misuse_new(rt, 1);
    int there[3] = {7, 7, 7}, code = 0;

    atomic_store(&is_open, 0);
    code |= duite_fork_at(rt, ranks - 1, &GATE, NULL, 1, &held);
    code |= duite_fork_at(rt, 0, &SET, DUITE_ARGS(int32_t, 5), 1, &x);
    code |= duite_fork_at(rt, ranks - 1, &COPY, NULL, 2, (duite_object[]){x, y});
    code |= duite_wait_for(rt, 2, (duite_object[]){y, x});
    code |= duite_test(rt, 2, (duite_object[]){x, y}, &there[0]);
    code |= duite_test(rt, 2, (duite_object[]){x, held}, &there[1]);
    code |= duite_test(rt, 0, NULL, &there[2]);
    tap_case(!code && there[0] == 1 && there[1] == 0 && there[2] == 1,
             "a wait for two objects while a third is worked on");
    atomic_store(&is_open, 1);
    for (there[1] = 0; !there[1] && !code;)
        code |= duite_test(rt, 1, &held, &there[1]);
    tap_case(!code && value_of(held) == 1 && value_of(y) == 6, "tests until it is there");
    duite_free(rt, held);
    duite_free(rt, x);
    duite_free(rt, y);
}

/* Contributions before and after. */
static void sums(void)
{
    const duite_object sum = misuse_new(rt, 1);
    int there = 0, code = 0;

    for (int i = 0; i < 3; i++)
        code |= duite_fork(rt, &ADD, NULL, 1, &sum);
    code |= duite_wait_for(rt, 1, &sum) | duite_test(rt, 1, &sum, &there);
    tap_case(!code && there, "contributions are waited for");
    code |= duite_fork(rt, &ADD, NULL, 1, &sum);
    for (there = 0; !there && !code;)
        code |= duite_test(rt, 1, &sum, &there);
    tap_case(!code && value_of(sum) == 4, "and tested, until they are combined");
    duite_free(rt, sum);
}

static int build(duite *runtime, void *context)
{
    const duite_object *object = context;

    duite_fork(runtime, &ADD, NULL, 1, &object[0]);
    return DUITE_FORK(runtime, &COPY, NULL, object[0], object[1]);
}

static void replays(void)
{
    duite_object object[2] = {misuse_new(rt, 1), misuse_new(rt, 1)};
    duite_graph graph = DUITE_NO_GRAPH;
    int32_t before = -1;
    int there = 0, code = duite_graph_new(rt, build, object, &graph);

    code |= duite_replay(rt, graph, 5) | duite_wait_for(rt, 2, object);
    code |= duite_test(rt, 2, object, &there);
    code |= duite_get_begin(rt, object[1], &before) | duite_replay(rt, graph, 5);
    code |= duite_get_end(rt, object[1]);
    tap_case(!code && there && before == 6 && value_of(object[1]) == 11,
             "values that replays leave");
    duite_graph_free(rt, graph);
    duite_free(rt, object[0]);
    duite_free(rt, object[1]);
}

static void failures(void)
{
    const duite_object x = misuse_new(rt, 1), y = misuse_new(rt, 1), z = misuse_new(rt, 1);
    int32_t value = 77;
    int there = 0;

    duite_fork_at(rt, 0, &FAIL, DUITE_ARGS(int32_t, 12), 1, &x);
    duite_fork_at(rt, ranks - 1, &FAIL, DUITE_ARGS(int32_t, 13), 1, &y);
    tap_case(!duite_wait_for(rt, 1, &z), "failures of other objects are not told");
    int code = duite_wait_for(rt, 3, (duite_object[]){z, y, x});
    tap_case(code == 12 && strstr(duite_message(), "sentence 12"),
             "the first of those asked for is");
    code = duite_wait_for(rt, 1, &y);
    tap_case(code == 13 && strstr(duite_message(), "sentence 13"), "on all ranks");
    code = duite_get_begin(rt, y, &value) | duite_test(rt, 1, &y, &there);
    duite_set(rt, y, NULL);
    tap_case(!code && there && duite_get_end(rt, y) == 13 && value == 77, "and by a get that ends");
    tap_case(duite_wait(rt) == 12 && !duite_wait_for(rt, 1, &y), "the wait tells it once more");
    duite_free(rt, x);
    duite_free(rt, y);
    duite_free(rt, z);
}

/* Gets that overlap with what changes the object, and with its end. */
static void later(void)
{
    const duite_object x = misuse_new(rt, WIDTH);
    static int32_t values[3][WIDTH];
    int code = duite_set(rt, x, NULL), right = 1;

    for (int32_t i = 0; i < 3; i++) {
        code |= duite_fork_at(rt, i % ranks, &SET, &i, 1, &x);
        code |= duite_get_begin(rt, x, values[i]);
    }
    code |= duite_free(rt, x);
    for (int32_t i = 0; i < 3; i++) {
        code |= duite_get_end(rt, x);
        for (int k = 0; k < WIDTH; k++)
            right &= values[i][k] == i;
    }
    tap_case(!code && right, "gets are ended after their object changed, and died");
    const duite_object y = misuse_new(rt, 1);
    code = duite_fork(rt, &SET, DUITE_ARGS(int32_t, 8), 1, &y);
    code |= duite_get_begin(rt, y, values[0]) | duite_wait(rt);
    tap_case(!code && values[0][0] == 8 && !duite_get_end(rt, y), "a wait fills their values, too");
    duite_free(rt, y);
}

static void in_turns(void)
{
    const duite_object x = misuse_new(rt, 1), y = misuse_new(rt, 1);
    int32_t value = 0;
    void *data;
    int there[2] = {1, 0}, code = duite_acquire(rt, x, DUITE_W, &data);

    if (data)
        *(int32_t *)data = 31;
    code |= duite_get_begin(rt, x, &value);
    code |= duite_test(rt, 1, &x, &there[0]) | duite_test(rt, 1, &y, &there[1]);
    tap_case(!code && !there[0] && there[1], "tests while an object is acquired");
    tap_case(duite_wait_for(rt, 1, &y) == DUITE_E_STATE && duite_get_end(rt, x) == DUITE_E_STATE,
             "no waits meanwhile");
    code |= duite_release(rt, x) | duite_get_end(rt, x);
    tap_case(!code && value == 31, "and a get that ends after the turn");
    duite_free(rt, x);
    duite_free(rt, y);
}

static void refused(void)
{
    const duite_object x = misuse_new(rt, 1), gone = misuse_new(rt, 1);
    int there = 0;

    duite_free(rt, gone);
    tap_case(duite_wait_for(rt, 2, (duite_object[]){x, gone}) == DUITE_E_OBJECT &&
                 strstr(duite_message(), "duite_wait_for: object 2 of 2"),
             "a wait for an object that was freed");
    tap_case(duite_wait_for(rt, 1, NULL) == DUITE_E_ARGUMENT && !duite_wait(rt),
             "for none at NULL");
    tap_case(duite_test(rt, 1, &gone, &there) == DUITE_E_OBJECT && there &&
                 duite_wait_for(rt, 1, &x) == DUITE_E_OBJECT && !duite_wait(rt),
             "a test of it, which the next wait tells once more");
    tap_case(duite_test(rt, 1, &x, NULL) == DUITE_E_ARGUMENT && duite_wait(rt) == DUITE_E_ARGUMENT,
             "a test that has nowhere to put its answer");
    tap_case(duite_get_end(rt, x) == DUITE_E_STATE && duite_wait(rt) == DUITE_E_STATE,
             "the end of a get that never began");
    tap_case(duite_get_begin(rt, gone, &there) == DUITE_E_OBJECT &&
                 duite_wait(rt) == DUITE_E_OBJECT,
             "the begin of one of an object that was freed");
    tap_case(duite_get_begin(rt, x, NULL) == DUITE_E_ARGUMENT &&
                 duite_wait(rt) == DUITE_E_ARGUMENT && !duite_get_end(rt, x),
             "one that has nowhere to put the values");
    duite_free(rt, x);
}

static void in_bodies(void)
{
    const duite_object x = misuse_new(rt, 1);

    duite_fork(rt, &PARENT, NULL, 1, &x);
    tap_case(!duite_wait_for(rt, 1, &x) && duite_wait(rt) == 23 && value_of(x) == 6, "in bodies");
    duite_free(rt, x);
}

static void left(void)
{
    const duite_object x = misuse_new(rt, 1);
    int32_t value;

    duite_get_begin(rt, x, &value);
    duite_free(rt, x);
    tap_case(duite_stop(&rt) == DUITE_E_NOT_FREED && strstr(duite_message(), "begun and not ended"),
             "a get that never ends");
}

RANKS_CASE(wait_for)
{
    misuse_mpi();
    for (unsigned threads = 1; threads < 3; threads++) {
        if (!start(threads, threads == 2))
            return 1;
        others_go_on();
        sums();
        replays();
        failures();
        later();
        in_turns();
        refused();
        in_bodies();
        left();
    }
    return tap_done();
}
