/* Ranks that run different programs are told so, all of them; nothing hangs. */

#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

static int start_with(const duite_kernel *const *kernels)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt = (duite *)&options;

    options.kernels = kernels;
    const int code = duite_start(&rt, &options);

    if (code == DUITE_OK)
        duite_stop(&rt);
    return rt ? 12345 : code;
}

/* The last rank lists other kernels than the others. */
static void different_kernels(void)
{
    const int last = rank == ranks - 1;
    duite_kernel other = ADD;

    tap_case(start_with((const duite_kernel *[]){&SET, last ? NULL : &ADD, NULL}) ==
                 DUITE_E_DIFFERENT,
             "a kernel less");
    tap_case(start_with((const duite_kernel *[]){last ? &SET : &ADD, last ? &ADD : &SET, NULL}) ==
                 DUITE_E_DIFFERENT,
             "another order");
    tap_case(strlen(duite_message()) > 0, "with a sentence");
    other.name = last ? "other" : "add";
    tap_case(start_with((const duite_kernel *[]){&other, NULL}) == DUITE_E_DIFFERENT,
             "another name");
    other = ADD;
    other.access[0] = last ? DUITE_RW : DUITE_CW;
    tap_case(start_with((const duite_kernel *[]){&other, NULL}) == DUITE_E_DIFFERENT,
             "another mode");
    other = ADD;
    other.variadic = last ? DUITE_R : DUITE_NONE;
    tap_case(start_with((const duite_kernel *[]){&other, NULL}) == DUITE_E_DIFFERENT,
             "another rest");
    other = ADD;
    other.args_size = last ? 8 : 4;
    tap_case(start_with((const duite_kernel *[]){&other, NULL}) == DUITE_E_DIFFERENT,
             "another size of arguments");
    tap_case(start_with((const duite_kernel *[]){&ADD, NULL}) == DUITE_OK, "and then the same");
}

static void keep_left(void *left, const void *right, size_t count, duite_type type)
{
    (void)left;
    (void)right;
    (void)count;
    (void)type;
}

/* The last rank has other laws than the others. */
static void different_laws(void)
{
    const int last = rank == ranks - 1;
    const duite_law law = {.name = "law", .combine = keep_left};
    duite_law other = law;
    duite_kernel kernel = ADD;
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt;

    kernel.law = DUITE_LAWS(last ? &duite_min : &duite_max);
    tap_case(start_with((const duite_kernel *[]){&kernel, NULL}) == DUITE_E_DIFFERENT,
             "another law of a kernel");
    kernel.law = DUITE_LAWS(last ? NULL : &duite_sum);
    tap_case(start_with((const duite_kernel *[]){&kernel, NULL}) == DUITE_OK, "no law is a sum");
    options.laws = (const duite_law *[]){last ? NULL : &law, NULL};
    tap_case(duite_start(&rt, &options) == DUITE_E_DIFFERENT, "a law less");
    options.laws = (const duite_law *[]){&other, NULL};
    other.name = last ? "another" : "law";
    tap_case(duite_start(&rt, &options) == DUITE_E_DIFFERENT, "another name of a law");
    other = law;
    other.type = last ? DUITE_F64 : DUITE_F32;
    tap_case(duite_start(&rt, &options) == DUITE_E_DIFFERENT, "another type of a law");
    other = law;
    other.combine = rank == 0 ? NULL : keep_left;
    const int code = duite_start(&rt, &options);

    tap_case(code == DUITE_E_LAW || (rank != 0 && code == DUITE_E_DIFFERENT),
             "a law broken on one rank");
}

/* A mistake of one rank alone is everybody's error. */
static void different_options(void)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite_kernel broken = ADD;
    duite *rt = NULL;

    broken.body = rank == 0 ? NULL : ADD.body;
    const int code = start_with((const duite_kernel *[]){&broken, NULL});

    tap_case(code == DUITE_E_KERNEL || (rank != 0 && code == DUITE_E_DIFFERENT),
             "a kernel broken on one rank");
    options.mapping = duite_mapping_find(rank == 0 ? "metis" : "cyclic");
    tap_case(duite_start(&rt, &options) == DUITE_E_DIFFERENT && !rt, "another mapping");
    options = misuse_options(MPI_COMM_WORLD);
    options.balance = duite_balancer_find(rank == 0 ? "delegate" : "scatter");
    tap_case(duite_start(&rt, &options) == DUITE_E_DIFFERENT && !rt, "another balancer");
    options = misuse_options(MPI_COMM_WORLD);
    options.seed = rank == 0 ? 5 : 6;
    tap_case(duite_start(&rt, &options) == DUITE_E_DIFFERENT && !rt, "another seed");
    options = misuse_options(MPI_COMM_WORLD);
    options.threads = 1 + (unsigned)rank % 3;
    tap_case(duite_start(&rt, &options) == DUITE_OK && rt, "numbers of threads may differ");
    tap_case(duite_stop(&rt) == DUITE_OK, "and stop");
}

enum difference {
    ONE_MORE,
    ANOTHER_KERNEL,
    ANOTHER_OBJECT,
    ANOTHER_RANK,
    NO_ARGUMENTS,
    ONE_OBJECT_MORE,
    ANOTHER_SIZE,
    ANOTHER_MAXIMUM,
    ANOTHER_COUNT,
    ONE_SET_MORE,
    ONE_FREE_MORE,
    ANOTHER_HINT,
    ANOTHER_LEADER,
    ANOTHER_BUILD,
    ANOTHER_BINDING,
    ONE_REPLAY_MORE,
    ANOTHER_ROUND,
    ONE_GRAPH_LESS,
    ONE_GET_MORE,
    ONE_KERNEL_MORE,
    ANOTHER_ADDED,
    N_DIFFERENCES
};

static int build(duite *rt, void *context)
{
    return duite_fork(rt, &ADD, NULL, 1, context);
}

static int nothing(const duite_call *call)
{
    (void)call;
    return 0;
}

static void differ_by_graphs(duite *rt, enum difference what, duite_object a, duite_object b)
{
    const int odd = rank == ranks - 1;
    duite_graph graph;

    duite_graph_new(rt, build, what == ANOTHER_BUILD && odd ? &b : &a, &graph);
    if (what == ANOTHER_BINDING)
        duite_graph_bind(rt, graph, a, odd ? b : a);
    if (what == ONE_REPLAY_MORE && odd)
        duite_replay(rt, graph, 0);
    if (what == ANOTHER_ROUND)
        duite_replay(rt, graph, odd ? 2 : 1);
    if (what == ONE_GRAPH_LESS && odd)
        duite_graph_free(rt, graph);
}

static void differ(duite *rt, enum difference what, duite_object a, duite_object b)
{
    static const duite_kernel other = {.name = "other", .body = nothing, .access = {DUITE_RW}};
    static int32_t got[4];
    const int odd = rank == ranks - 1;
    duite_object made;

    if (what == ONE_MORE && odd)
        duite_fork(rt, &ADD, NULL, 1, &a);
    if (what == ANOTHER_KERNEL)
        duite_fork(rt, odd ? &ADD : &MANY, NULL, 1, &a);
    if (what == ANOTHER_OBJECT)
        duite_fork(rt, &ADD, NULL, 1, odd ? &a : &b);
    if (what == ANOTHER_RANK)
        duite_fork_at(rt, odd, &ADD, NULL, 1, &a);
    if (what == NO_ARGUMENTS && !duite_new(rt, DUITE_I32, 1, &made)) {
        duite_colocate(rt, made, a);
        duite_home(rt, made); /* not the last rank, which reads no arguments, but refuses NULL */
        duite_fork(rt, &SET, odd ? NULL : &(int32_t){1}, 1, &made);
    }
    if (what == ONE_OBJECT_MORE && odd)
        duite_new(rt, DUITE_I32, 1, &made);
    if (what == ANOTHER_SIZE)
        duite_new(rt, DUITE_I32, odd ? 5 : 6, &made);
    if (what == ANOTHER_MAXIMUM)
        duite_new_sized(rt, DUITE_I32, 2, odd ? 5 : 6, &made);
    if (what == ANOTHER_COUNT && !duite_new_sized(rt, DUITE_I32, 2, 6, &made))
        duite_set_sized(rt, made, NULL, odd ? 3 : 4);
    if (what == ONE_SET_MORE && odd)
        duite_set(rt, a, NULL);
    if (what == ONE_FREE_MORE && odd)
        duite_free(rt, a);
    if (what == ANOTHER_HINT && !duite_new(rt, DUITE_I32, 1, &made))
        duite_hint(rt, made, odd ? 1 : 2, 0, NULL, NULL);
    if (what == ANOTHER_LEADER && !duite_new(rt, DUITE_I32, 1, &made))
        duite_colocate(rt, made, odd ? a : b);
    if (what >= ANOTHER_BUILD && what <= ONE_GRAPH_LESS)
        differ_by_graphs(rt, what, a, b);
    if (what == ONE_GET_MORE && odd)
        duite_get_begin(rt, a, got);
    if (what == ANOTHER_ADDED || (what == ONE_KERNEL_MORE && odd))
        duite_kernel_add(rt, odd ? &UNLISTED : &other);
}

/* The message names: where the ranks differ, and the calls of the others and of the last rank
 * there; NULL: a wait, or the stop. */
static const struct {
    const char *name, *where, *others, *last;
} DIFFERENCES[] = {
    {"a fork more", "at fork 21", NULL, "forked \"add\""},
    {"another kernel", "at fork 21", "forked \"many\"", "forked \"add\""},
    {"another object", "at fork 21", "forked \"add\"",
     "forked \"add\" with other objects or on another rank"},
    {"another rank", "at fork 21", "forked \"add\"",
     "forked \"add\" with other objects or on another rank"},
    {"arguments left out", "at fork 21", "forked \"set\"", NULL},
    {"an object more", "after fork 20", NULL, "called duite_new"},
    {"another size", "after fork 20", "called duite_new", "called duite_new with other arguments"},
    {"another maximum", "after fork 20", "called duite_new_sized",
     "called duite_new_sized with other arguments"},
    {"another count of values", "after fork 20", "called duite_set",
     "called duite_set with other arguments"},
    {"a set more", "after fork 20", NULL, "called duite_set"},
    {"a free more", "after fork 20", NULL, "called duite_free"},
    {"another hint", "after fork 20", "called duite_hint",
     "called duite_hint with other arguments"},
    {"another leader", "after fork 20", "called duite_colocate",
     "called duite_colocate with other arguments"},
    {"another build", "after fork 20", "recorded \"add\"",
     "recorded \"add\" with other objects or on another rank"},
    {"another binding", "after fork 20", "called duite_graph_bind",
     "called duite_graph_bind with other arguments"},
    {"a replay more", "after fork 20", NULL, "called duite_replay"},
    {"another round", "after fork 20", "called duite_replay",
     "called duite_replay with other arguments"},
    {"a graph less", "after fork 20", NULL, "called duite_graph_free"},
    {"a get more", "after fork 20", NULL, "called duite_get_begin"},
    {"a kernel more", "after fork 20", NULL, "called duite_kernel_add"},
    {"another kernel added", "after fork 20", "called duite_kernel_add",
     "called duite_kernel_add with other arguments"},
};

static int names_difference(enum difference what, int at_stop)
{
    const char *ends = at_stop ? "called duite_stop" : "called duite_wait";
    const char *others = DIFFERENCES[what].others, *last = DIFFERENCES[what].last;
    char text[300];

    snprintf(text, sizeof text, "ranks differ %s: %s %s, rank %d %s", DIFFERENCES[what].where,
             misuse_first_ranks(ranks - 1), others ? others : ends, ranks - 1, last ? last : ends);
    return misuse_all_told(text);
}

/* Some tasks that agree, one thing that does not: the wait says so everywhere, and the runtime can
 * be stopped. */
static void different_forks(enum difference what, int at_stop)
{
    duite *rt = misuse_start(MPI_COMM_WORLD, 2);
    const duite_object a = misuse_new(rt, 4), b = misuse_new(rt, 4);
    char line[100];

    for (int i = 0; i < 20; i++)
        duite_fork_at(rt, i % ranks, i % 3 ? &ADD : &COPY, NULL, i % 3 ? 1 : 2,
                      (duite_object[]){a, b});
    if (!at_stop)
        duite_wait(rt);
    differ(rt, what, a, b);
    snprintf(line, sizeof line, "%s, found by %s", DIFFERENCES[what].name,
             at_stop ? "stop" : "wait");
    const int code = at_stop ? duite_stop(&rt) : duite_wait(rt);

    misuse_keep_message();
    if (!at_stop)
        duite_stop(&rt);
    tap_case(names_difference(what, at_stop) && code == DUITE_E_DIFFERENT && !rt, line);
}

/* A difference of long ago: so many calls are not remembered. */
static void long_ago(int calls, const char *text, const char *name)
{
    duite *rt = misuse_start(MPI_COMM_WORLD, 2);
    const duite_object a = misuse_new(rt, 4), b = misuse_new(rt, 4);

    duite_fork(rt, &ADD, NULL, 1, rank == ranks - 1 ? &a : &b);
    for (int i = 0; i < calls; i++)
        duite_fork(rt, &ADD, NULL, 1, &a);
    const int code = duite_wait(rt);

    misuse_keep_message();
    duite_stop(&rt);
    tap_case(misuse_all_told(text) && code == DUITE_E_DIFFERENT, name);
}

RANKS_CASE(different)
{
    misuse_mpi();
    different_kernels();
    different_laws();
    different_options();
    for (int what = ONE_MORE; what < N_DIFFERENCES; what++)
        for (int at_stop = 0; at_stop < 2; at_stop++)
            different_forks((enum difference)what, at_stop);
    long_ago(1000, "ranks differ at fork 1: ", "a difference 1,000 forks ago");
    long_ago(5000, "; the first difference lies before call 3983", "a difference 5,000 forks ago");
    return tap_done();
}
