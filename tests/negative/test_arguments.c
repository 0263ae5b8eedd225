/* Arguments that make no sense are refused with their own code, change nothing, and a refused fork,
 * new, set, hint or free comes back once more with the next get or wait. */

#include "tests/negative/refused.h"

#include <stdint.h>

static const int32_t SEVEN = 7;

static int build_nothing(duite *runtime, void *context)
{
    (void)runtime;
    (void)context;
    return 0;
}

static void graphs_without_runtime(void)
{
    const duite_graph graph = DUITE_NO_GRAPH;
    duite_graph made;
    uint64_t rounds;

    ck_assert_int_eq(duite_graph_new(NULL, build_nothing, NULL, &made), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_replay(NULL, graph, 1), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_replay_while(NULL, graph, a, 1), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_graph_rounds(NULL, graph, &rounds), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_graph_args(NULL, graph, 0, NULL), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_graph_bind(NULL, graph, a, b), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_graph_free(NULL, graph), DUITE_E_ARGUMENT);
}

UNIT_FIXTURE(refused_begin, refused_end)

UNIT_TEST(no_runtime)
{
    duite *none = NULL;
    duite_object object;
    duite_counters counters;
    size_t count;
    int32_t value = 0;

    ck_assert_int_eq(duite_start(NULL, &(duite_options){0}), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_stop(NULL), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_stop(&none), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_new(NULL, DUITE_I32, 1, &object), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_new_sized(NULL, DUITE_I32, 1, 2, &object), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_set_sized(NULL, a, &value, 1), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_get_count(NULL, a, &count), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_free(NULL, a), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_set(NULL, a, &value), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_get(NULL, a, &value), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_get_at(NULL, a, 0, &value), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_hint(NULL, a, 1, 0, NULL, NULL), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_colocate(NULL, a, b), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_home(NULL, a), -1);
    ck_assert_int_eq(duite_fork(NULL, &ADD, NULL, 1, &a), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_fork_at(NULL, 0, &ADD, NULL, 1, &a), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_fork_with(NULL, NULL, &ADD, NULL, 1, &a), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_wait(NULL), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_count_all(NULL, &counters), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_rank(NULL), -1);
    ck_assert_int_eq(duite_ranks(NULL), -1);
    ck_assert_uint_eq(duite_threads(NULL), 0);
    ck_assert_uint_eq(duite_cores(NULL, NULL), 0);
    graphs_without_runtime();
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
}

/* A stopped runtime is no runtime. */
UNIT_TEST(after_stop)
{
    refused_end();
    ck_assert_int_eq(duite_fork(rt, &ADD, NULL, 1, &a), DUITE_E_ARGUMENT);
    says("no runtime");
    ck_assert_int_eq(duite_get(rt, a, &(int32_t){0}), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_stop(&rt), DUITE_E_ARGUMENT);
    refused_begin();
}

UNIT_TEST(null_pointers)
{
    int32_t value[4];

    refused(duite_new(rt, DUITE_I32, 1, NULL), DUITE_E_ARGUMENT);
    refused(duite_fork(rt, NULL, NULL, 0, NULL), DUITE_E_ARGUMENT);
    refused(duite_fork(rt, &ADD, NULL, 1, NULL), DUITE_E_ARGUMENT);
    refused(duite_fork(rt, &SET, NULL, 1, &a), DUITE_E_ARGUMENT);
    refused(duite_hint(rt, a, 1, 1, NULL, NULL), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_get(rt, a, NULL), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_get_at(rt, a, 0, NULL), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_count_all(rt, NULL), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_get(rt, a, value), DUITE_OK);
    ck_assert_int_eq(duite_fork(rt, &EMPTY, NULL, 0, NULL), DUITE_OK);
}

static int build_copy(duite *runtime, void *args)
{
    return duite_fork(runtime, &COPY, args, 2, (duite_object[]){a, b});
}

/* The body would find NULL. */
UNIT_TEST(arguments_for_a_kernel_that_has_none)
{
    const duite_object both[] = {a, b};
    int32_t seven = SEVEN;
    duite_graph graph;

    refused(duite_fork(rt, &EMPTY, &seven, 0, NULL), DUITE_E_ARGUMENT);
    refused(duite_fork(rt, &COPY, &seven, 2, both), DUITE_E_ARGUMENT);
    says("kernel copy has no arguments");
    refused(duite_fork(rt, &ADD, &seven, 1, &a), DUITE_E_ARGUMENT);
    refused(duite_fork_at(rt, 0, &COPY, &seven, 2, both), DUITE_E_ARGUMENT);
    refused(duite_fork_with(rt, NULL, &COPY, &seven, 2, both), DUITE_E_ARGUMENT);
    refused(duite_graph_new(rt, build_copy, &seven, &graph), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_graph_new(rt, build_copy, NULL, &graph), DUITE_OK);
    refused(duite_graph_args(rt, graph, 0, &seven), DUITE_E_ARGUMENT);
    says("fork 0 (kernel copy) has no arguments");
    ck_assert_int_eq(duite_graph_args(rt, graph, 0, NULL), DUITE_OK);
    ck_assert_int_eq(duite_graph_free(rt, graph), DUITE_OK);
}

UNIT_TEST(types_and_sizes)
{
    duite_object object = a;

    refused(duite_new(rt, (duite_type)0, 1, &object), DUITE_E_ARGUMENT);
    ck_assert(object.slot == 0 && object.generation == 0);
    refused(duite_new(rt, (duite_type)(DUITE_CF64 + 1), 1, &object), DUITE_E_ARGUMENT);
    refused(duite_new(rt, DUITE_F64, 0, &object), DUITE_E_ARGUMENT);
    refused(duite_new(rt, DUITE_F64, SIZE_MAX / 8 + 2, &object), DUITE_E_ARGUMENT);
    refused(duite_new(rt, DUITE_BYTE, SIZE_MAX, &object), DUITE_E_ARGUMENT);
    ck_assert(object.slot == 0 && object.generation == 0);
}

UNIT_TEST(ranks_outside)
{
    int32_t value[4];

    refused(duite_fork_with(rt, &(duite_task_options){.at = &(int){1}}, &ADD, NULL, 1, &a),
            DUITE_E_ARGUMENT);
    refused(duite_fork_with(rt, &(duite_task_options){.at = &(int){-1}}, &ADD, NULL, 1, &a),
            DUITE_E_ARGUMENT);
    refused(duite_fork_at(rt, 1, &ADD, NULL, 1, &a), DUITE_E_ARGUMENT);
    refused(duite_fork_at(rt, -1, &ADD, NULL, 1, &a), DUITE_E_ARGUMENT);
    refused(duite_fork_at(rt, 0, &EVERYWHERE, NULL, 2, (duite_object[]){a, b}), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_fork(rt, &EVERYWHERE, NULL, 2, (duite_object[]){a, b}), DUITE_OK);
    ck_assert_int_eq(duite_get_at(rt, a, 1, value), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_get_at(rt, a, -1, value), DUITE_E_ARGUMENT);
}

UNIT_TEST(hints_and_leaders)
{
    refused(duite_hint(rt, a, -1, 0, NULL, NULL), DUITE_E_ARGUMENT);
    refused(duite_hint(rt, a, 1, 1, &b, &(double){-1}), DUITE_E_ARGUMENT);
    refused(duite_hint(rt, a, 1, 1, &b, &(double){__builtin_nan("")}), DUITE_E_ARGUMENT);
    refused(duite_hint(rt, a, __builtin_inf(), 0, NULL, NULL), DUITE_E_ARGUMENT);
    refused(duite_hint(rt, a, 1, 1, &DUITE_NO_OBJECT, &(double){1}), DUITE_E_OBJECT);
    refused(duite_colocate(rt, a, DUITE_NO_OBJECT), DUITE_E_OBJECT);
    refused(duite_colocate(rt, DUITE_NO_OBJECT, a), DUITE_E_OBJECT);
    refused(duite_colocate(rt, a, a), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_colocate(rt, a, b), DUITE_OK);
    refused(duite_colocate(rt, b, a), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_home(rt, a), 0);
    ck_assert_int_eq(duite_hint(rt, b, 1, 1, &a, NULL), DUITE_OK);
    ck_assert_int_eq(duite_home(rt, DUITE_NO_OBJECT), -1);
}

/* The first of several refusals comes back, with a get or a stop as well, and the get has done its
 * work. */
UNIT_TEST(refused_once_more)
{
    int32_t value[4] = {0};

    ck_assert_int_eq(duite_fork(rt, &SET, &SEVEN, 1, &a), DUITE_OK);
    ck_assert_int_eq(duite_fork(rt, &UNLISTED, NULL, 1, &a), DUITE_E_KERNEL);
    ck_assert_int_eq(duite_fork(rt, &ADD, NULL, 0, NULL), DUITE_E_ACCESS);
    ck_assert_int_eq(duite_get(rt, a, value), DUITE_E_KERNEL);
    ck_assert_int_eq(value[3], 7);
    ck_assert_int_eq(duite_get(rt, a, value), DUITE_OK);
    ck_assert_int_eq(duite_free(rt, DUITE_NO_OBJECT), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_get(rt, a, value), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_set(rt, DUITE_NO_OBJECT, value), DUITE_E_OBJECT);
    duite_free(rt, a);
    duite_free(rt, b);
    duite_free(rt, c);
    ck_assert_int_eq(duite_stop(&rt), DUITE_E_OBJECT);
    ck_assert_ptr_null(rt);
    refused_begin();
}

UNIT_TEST(words)
{
    static const int CODES[] = {DUITE_OK,        DUITE_E_ARGUMENT,  DUITE_E_MEMORY,
                                DUITE_E_OBJECT,  DUITE_E_KERNEL,    DUITE_E_ACCESS,
                                DUITE_E_MPI,     DUITE_E_DIFFERENT, DUITE_E_STATE,
                                DUITE_E_SYSTEM,  DUITE_E_NOT_FREED, DUITE_E_LAW,
                                DUITE_E_BINDING, DUITE_E_SIZE,      DUITE_E_CHECK,
                                DUITE_E_LOST,    DUITE_E_DEPTH,     1};

    ck_assert_ptr_nonnull(duite_message());
    for (size_t i = 0; i < sizeof CODES / sizeof *CODES; i++) {
        ck_assert_str_ne(duite_code_text(CODES[i]), duite_code_text(-1000));
        for (size_t k = 0; k < i; k++)
            ck_assert_str_ne(duite_code_text(CODES[i]), duite_code_text(CODES[k]));
    }
    ck_assert_str_eq(duite_code_text(12), "error of the program");
    ck_assert_ptr_nonnull(duite_code_text(-1000));
    ck_assert_ptr_null(duite_scheduler_find("no such"));
    ck_assert_ptr_null(duite_mapping_find("no such"));
    ck_assert_ptr_null(duite_balancer_find("no such"));
    ck_assert_ptr_null(duite_scheduler_find(NULL));
    ck_assert_ptr_null(duite_mapping_find(NULL));
    ck_assert_ptr_null(duite_balancer_find(NULL));
}
