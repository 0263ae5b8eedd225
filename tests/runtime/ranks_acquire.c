/* The main program's turns on objects: they stand in the order of the forks, work in place on one
 * rank, and keep waits away. Run under mpirun. */
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdint.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 1000, ROUNDS = 20 };

static duite *rt;

/* True if the data are where duite.h says. */
static int is_in_place(duite_object object, const void *data)
{
    return (duite_home(rt, object) == rank) == (data != NULL) && (uintptr_t)data % 64 == 0;
}

/* Writes, reads and changes with tasks in between: x = 5, y = x + 1, y *= 3, x = y + 1. */
static void in_order(void)
{
    const duite_object x = misuse_new(rt, 1), y = misuse_new(rt, 1);
    int32_t value = 0;
    void *to;
    int code = duite_acquire(rt, x, DUITE_W, &to);
    int right = is_in_place(x, to);

    code |= DUITE_FORK(rt, &COPY, NULL, x, y); /* waits for the release */
    usleep(2000);
    if (to)
        *(int32_t *)to = 5;
    code |= duite_release(rt, x) | duite_acquire(rt, y, DUITE_RW, &to);
    right = right && is_in_place(y, to) && (!to || *(int32_t *)to == 6);
    if (to)
        *(int32_t *)to *= 3;
    code |= DUITE_FORK(rt, &COPY, NULL, y, x) | duite_release(rt, y);
    code |= duite_acquire(rt, x, DUITE_R, &to);
    right = right && is_in_place(x, to) && (!to || *(int32_t *)to == 19);
    code |= duite_release(rt, x) | duite_get(rt, x, &value);
    tap_case(!code && right && value == 19, "turns have their place in the order of the forks");
    duite_free(rt, x);
    duite_free(rt, y);
}

/* Values that take many lines, and one whose size changes. */
static void large(void)
{
    const duite_object object = misuse_new(rt, WIDTH);
    duite_object sized;
    int32_t values[WIDTH];
    void *to;
    int code = duite_acquire(rt, object, DUITE_W, &to);
    int right = 1;

    for (int32_t i = 0; to && i < WIDTH; i++)
        ((int32_t *)to)[i] = i;
    code |= duite_release(rt, object) | duite_get(rt, object, values);
    for (int32_t i = 0; i < WIDTH; i++)
        right = right && values[i] == i;
    code |= duite_new_sized(rt, DUITE_I32, 3, WIDTH, &sized);
    code |= duite_set_sized(rt, sized, values, 7) | duite_acquire(rt, sized, DUITE_RW, &to);
    if (to)
        ((int32_t *)to)[6] = 60;
    size_t count = 0;
    code |= duite_release(rt, sized) | duite_get_count(rt, sized, &count);
    code |= duite_get(rt, sized, values);
    tap_case(!code && right && count == 7 && values[6] == 60, "large and sized values");
    duite_free(rt, object);
    duite_free(rt, sized);
}

/* Several at a time, released in another order; contributions before and after a turn. */
static void several(void)
{
    const duite_object one = misuse_new(rt, 1), two = misuse_new(rt, 1);
    int32_t value[2] = {0, 0};
    void *of[2];
    int code = 0;

    for (int round = 0; round < ROUNDS; round++) {
        code |= duite_fork(rt, &ADD, NULL, 1, &one);
        code |= duite_acquire(rt, one, DUITE_RW, &of[0]) | duite_acquire(rt, two, DUITE_R, &of[1]);
        if (of[0])
            ++*(int32_t *)of[0];
        code |= duite_fork(rt, &ADD, NULL, 1, &one) | duite_fork(rt, &ADD, NULL, 1, &two);
        code |= duite_release(rt, round % 2 ? one : two);
        code |= duite_release(rt, round % 2 ? two : one);
    }
    code |= duite_get(rt, one, &value[0]) | duite_get(rt, two, &value[1]);
    tap_case(!code && value[0] == 3 * ROUNDS && value[1] == ROUNDS, "several at a time");
    duite_free(rt, one);
    duite_free(rt, two);
}

/* A value that failed: its home is told, and goes on. */
static void poisoned(void)
{
    const duite_object object = misuse_new(rt, 1);
    const int home = duite_home(rt, object) == rank;
    void *data;

    DUITE_FORK(rt, &FAIL, DUITE_ARGS(int32_t, 17), object);
    const int code = duite_acquire(rt, object, DUITE_RW, &data);
    tap_case(code == (home ? 17 : DUITE_OK) && !data, "a poisoned value has no data");
    tap_case(!duite_release(rt, object) && duite_wait(rt) == 17, "and is released");
    tap_case(!duite_acquire(rt, object, DUITE_W, &data) && !home == !data, "which a w heals");
    if (data)
        *(int32_t *)data = 5;
    int32_t value = 0;
    tap_case(!duite_release(rt, object) && !duite_get(rt, object, &value) && value == 5,
             "by what the program wrote");
    duite_free(rt, object);
}

static int nothing(duite *runtime, void *context)
{
    (void)runtime, (void)context;
    return 0;
}

/* Each is refused by its code, and nothing is lost. */
static void refused(void)
{
    const duite_object object = misuse_new(rt, 1), other = misuse_new(rt, 1);
    int32_t value = 0;
    size_t count;
    void *data;

    tap_case(duite_release(rt, object) == DUITE_E_STATE && duite_wait(rt) == DUITE_E_STATE,
             "a release of what is not acquired");
    tap_case(duite_acquire(rt, object, DUITE_CW, &data) == DUITE_E_ARGUMENT &&
                 duite_wait(rt) == DUITE_E_ARGUMENT,
             "another mode");
    tap_case(duite_acquire(rt, object, DUITE_R, NULL) == DUITE_E_ARGUMENT &&
                 duite_wait(rt) == DUITE_E_ARGUMENT,
             "nowhere to put the data");
    tap_case(duite_acquire(rt, DUITE_NO_OBJECT, DUITE_R, &data) == DUITE_E_OBJECT &&
                 duite_wait(rt) == DUITE_E_OBJECT,
             "an object that names nothing");
    duite_acquire(rt, object, DUITE_W, &data);
    if (data)
        *(int32_t *)data = 8;
    tap_case(duite_get(rt, other, &value) == DUITE_E_STATE &&
                 duite_get_count(rt, other, &count) == DUITE_E_STATE &&
                 duite_wait(rt) == DUITE_E_STATE && duite_stop(&rt) == DUITE_E_STATE && rt,
             "waits before the release");
    duite_graph graph = DUITE_NO_GRAPH;
    uint64_t rounds;
    tap_case(!duite_graph_new(rt, nothing, NULL, &graph) &&
                 duite_replay(rt, graph, 1) == DUITE_E_STATE &&
                 duite_graph_rounds(rt, graph, &rounds) == DUITE_E_STATE &&
                 !duite_graph_free(rt, graph),
             "replays before the release");
    tap_case(strstr(duite_message(), "duite_release") != NULL, "which name what to do");
    tap_case(duite_acquire(rt, object, DUITE_R, &data) == DUITE_E_STATE, "an object twice");
    tap_case(!duite_release(rt, object) && duite_wait(rt) == DUITE_E_STATE && !duite_wait(rt) &&
                 !duite_get(rt, object, &value) && value == 8,
             "and the turn went on");
    duite_free(rt, object);
    duite_free(rt, other);
}

RANKS_CASE(acquire)
{
    for (unsigned threads = 1; threads < 3; threads++)
        for (int check = 0; check < 2; check++) {
            duite_options options = misuse_options(MPI_COMM_WORLD);

            misuse_mpi();
            options.threads = threads;
            options.check = check;
            options.window = threads % 2;
            rt = misuse_start_with(&options);
            in_order();
            large();
            several();
            poisoned();
            refused();
            tap_case(!duite_stop(&rt), "stops");
        }
    return tap_done();
}
