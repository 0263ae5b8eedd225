/* Kernels that are added to a running program, with a law of their own: forked, recorded,
 * delegated, traced; and those that are refused. Run under mpirun. */
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { MANY_KERNELS = 40, LEAVES = 9 };

static duite *rt;

/* right after left, as decimal digits. */
static void append(void *left, const void *right, size_t count, duite_type type)
{
    int32_t *to = left;

    (void)type;
    for (size_t i = 0; i < count; i++)
        to[i] = 10 * to[i] + ((const int32_t *)right)[i];
}
static const duite_law APPEND = {.name = "append", .type = DUITE_I32, .combine = append};
static const duite_law SAME_NAME = {.name = "append", .type = DUITE_I32, .combine = append};

KERNEL(DIGIT, "digit", .access = {DUITE_CW}, .law = DUITE_LAWS(&APPEND),
       .args_size = sizeof(int32_t))
{
    *duite_out(call, 0, int32_t) = *(const int32_t *)call->args;
    return 0;
}

static int increase(const duite_call *call)
{
    ++*duite_out(call, 0, int32_t);
    return 0;
}
static duite_kernel many[MANY_KERNELS];
static char name[MANY_KERNELS][20];

static int build(duite *runtime, void *context)
{
    return duite_fork(runtime, &COPY, NULL, 2, context);
}

static int build_more(duite *runtime, void *context)
{
    duite_fork(runtime, &many[MANY_KERNELS - 1], NULL, 1, context);
    return duite_fork(runtime, &COPY, NULL, 2, context);
}

static int value_of(duite_object object)
{
    int32_t value = -1;

    return duite_get(rt, object, &value) ? -1 : value;
}

/* Each is used as soon as it is there, by forks and by a graph; an older graph goes on. */
static void added(void)
{
    duite_object object[2] = {misuse_new(rt, 1), misuse_new(rt, 1)};
    const duite_object digits = misuse_new(rt, 1);
    duite_graph before, after;
    int code = duite_graph_new(rt, build, object, &before) | duite_replay(rt, before, 2);

    for (int i = 0; i < MANY_KERNELS; i++) {
        snprintf(name[i], sizeof name[i], "many %d", i);
        many[i] =
            (duite_kernel){.name = name[i], .body = increase, .access = {DUITE_RW}, .args_size = 0};
        code |= duite_kernel_add(rt, &many[i]);
        code |= duite_fork_at(rt, i % ranks, &many[i], NULL, 1, &object[0]);
    }
    tap_case(!code && value_of(object[0]) == MANY_KERNELS, "many kernels are added");
    code |= duite_graph_new(rt, build_more, object, &after);
    code |= duite_replay(rt, after, 2) | duite_replay(rt, before, 1);
    tap_case(!code && value_of(object[1]) == MANY_KERNELS + 3, "recorded graphs old and new");
    code |= duite_kernel_add(rt, &DIGIT);
    for (int32_t i = 1; i < LEAVES; i++)
        code |= duite_fork(rt, &DIGIT, &i, 1, &digits);
    /* old + ((12 + 34) + (56 + 78)), each pair ten times the left one and the right one */
    const int pairs[] = {12, 34, 56, 78};
    const int fours[] = {10 * pairs[0] + pairs[1], 10 * pairs[2] + pairs[3]};
    tap_case(!code && value_of(digits) == 10 * fours[0] + fours[1], "with a law of its own");
    duite_graph_free(rt, before);
    duite_graph_free(rt, after);
    duite_free(rt, object[0]);
    duite_free(rt, object[1]);
    duite_free(rt, digits);
}

static int is_told(int code, int expected, const char *sentence)
{
    const int said = strstr(duite_message(), sentence) != NULL;

    return code == expected && said && duite_wait(rt) == expected;
}

static void refused(void)
{
    duite_kernel wrong = DIGIT;
    const duite_object object = misuse_new(rt, 1);
    int32_t seven = 7;

    tap_case(is_told(duite_kernel_add(rt, NULL), DUITE_E_ARGUMENT, "the kernel is NULL"), "NULL");
    tap_case(is_told(duite_kernel_add(rt, &DIGIT), DUITE_E_KERNEL, "the name digit already"),
             "a name that is taken");
    wrong.name = "wrong";
    wrong.body = NULL;
    tap_case(is_told(duite_kernel_add(rt, &wrong), DUITE_E_KERNEL, "no body"), "no body");
    wrong.body = DIGIT_body;
    wrong.law = DUITE_LAWS(&SAME_NAME);
    tap_case(is_told(duite_kernel_add(rt, &wrong), DUITE_E_LAW, "the name append"),
             "a law whose name is taken");
    wrong.access[0] = DUITE_RW;
    wrong.law = DUITE_LAWS(&APPEND);
    tap_case(is_told(duite_kernel_add(rt, &wrong), DUITE_E_LAW, "not cw"), "a law without a sum");
    tap_case(duite_fork(rt, &wrong, &seven, 1, &object) == DUITE_E_KERNEL &&
                 duite_wait(rt) == DUITE_E_KERNEL,
             "nothing of it is there");
    duite_free(rt, object);
}

/* The tasks of an added kernel run where there is time for them. */
static int run(const char *balance)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);

    options.balance = duite_balancer_find(balance);
    rt = misuse_start_with(&options);
    if (!rt)
        return 0;
    added();
    refused();
    return !duite_stop(&rt);
}

RANKS_CASE(kernels)
{
    misuse_mpi();
    tap_case(run("none"), "stops");
    tap_case(run("scatter"), "stops with a balancer that sends tasks anywhere");
    tap_case(run("wander"), "stops with one that moves objects");
    return tap_done();
}
