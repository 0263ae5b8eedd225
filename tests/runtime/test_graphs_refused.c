/* Refusals of recorded graphs, each with its error; nothing has run then. */
#include "tests/runtime/graphs_fixture.h"

#include <pthread.h>
#include <stdio.h>

UNIT_TEST(wrong_bindings)
{
    struct graphs_fixture f = graphs_begin(graphs_build);
    duite_object longer, other;
    char names[64];

    ck_assert_int_eq(duite_new(f.rt, DUITE_I64, 2, &longer), 0);
    ck_assert_int_eq(duite_new(f.rt, DUITE_F64, 1, &other), 0);
    ck_assert_int_eq(duite_graph_bind(f.rt, f.graph, f.a, longer), DUITE_E_BINDING);
    snprintf(names, sizeof names, "object %u.%u, bound", longer.slot, longer.generation);
    unit_says(duite_message(), names);
    snprintf(names, sizeof names, "object %u.%u has", f.a.slot, f.a.generation);
    unit_says(duite_message(), names);
    ck_assert_int_eq(duite_wait(f.rt), DUITE_E_BINDING); /* told once more */
    ck_assert_int_eq(duite_graph_bind(f.rt, f.graph, f.a, other), DUITE_E_BINDING);
    ck_assert_int_eq(duite_graph_bind(f.rt, f.graph, f.c, f.a), DUITE_E_BINDING);
    ck_assert_int_eq(duite_graph_bind(f.rt, f.graph, f.a, DUITE_NO_OBJECT), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_wait(f.rt), DUITE_E_BINDING);
    /* Two for one: nothing is replayed until this is mended. */
    ck_assert_int_eq(duite_graph_bind(f.rt, f.graph, f.a, f.b), 0);
    ck_assert_int_eq(duite_replay(f.rt, f.graph, 1), DUITE_E_BINDING);
    ck_assert_int_eq(duite_replay(f.rt, f.graph, 1), DUITE_E_BINDING);
    ck_assert_int_eq(duite_wait(f.rt), DUITE_E_BINDING);
    ck_assert_int_eq(duite_graph_bind(f.rt, f.graph, f.b, f.c), 0);
    ck_assert_int_eq(duite_replay(f.rt, f.graph, 1), 0);
    ck_assert_int_eq(graphs_value_of(f.rt, f.b), 13);
    ck_assert_int_eq(graphs_value_of(f.rt, f.c), 2);
    ck_assert_int_eq(duite_free(f.rt, longer), 0);
    ck_assert_int_eq(duite_free(f.rt, other), 0);
    graphs_end(&f, 0);
}

UNIT_TEST(not_freed_is_told)
{
    struct graphs_fixture f = graphs_begin(graphs_build);

    ck_assert_int_eq(duite_replay(f.rt, f.graph, 1), 0);
    ck_assert_int_eq(duite_free(f.rt, f.a), 0);
    ck_assert_int_eq(duite_free(f.rt, f.b), 0);
    ck_assert_int_eq(duite_free(f.rt, f.c), 0);
    ck_assert_int_eq(duite_stop(&f.rt), DUITE_E_NOT_FREED);
    unit_says(duite_message(), "graph");
}

static int wrong_build(duite *rt, void *context)
{
    struct graphs_fixture *f = context;
    duite_object made;
    duite_graph graph;
    duite_counters counters;
    uint64_t rounds;
    int64_t value;

    f->built++;
    switch (f->wrong) {
    case 0:
        return duite_get(rt, f->a, &value);
    case 1:
        return duite_wait(rt);
    case 2:
        return duite_new(rt, DUITE_I64, 1, &made);
    case 3:
        return duite_free(rt, f->a);
    case 4:
        return duite_graph_new(rt, graphs_build, f, &graph);
    case 5:
        return duite_replay(rt, f->graph, 1);
    case 6:
        return duite_replay_while(rt, f->graph, f->a, 1);
    case 7:
        return duite_graph_free(rt, f->graph);
    case 8:
        return duite_graph_bind(rt, f->graph, f->a, f->b);
    case 9:
        return duite_graph_args(rt, f->graph, 0, &(int32_t){1});
    case 10:
        return duite_graph_rounds(rt, f->graph, &rounds);
    case 11:
        return duite_count_all(rt, &counters);
    case 12:
        return duite_get_at(rt, f->a, 0, &value);
    case 13:
        return duite_hint(rt, f->a, 1, 0, NULL, NULL);
    case 14:
        return duite_colocate(rt, f->a, f->b);
    case 15: {
        duite *copied = rt;

        return duite_stop(&copied);
    }
    default:
        return 0;
    }
}

UNIT_TEST(not_while_recording)
{
    struct graphs_fixture f = graphs_begin(graphs_build);
    duite_graph graph;

    for (f.wrong = 0; f.wrong < 16; f.wrong++) {
        ck_assert_int_eq(duite_graph_new(f.rt, wrong_build, &f, &graph), DUITE_E_STATE);
        ck_assert_uint_eq(graph.slot, 0);
        ck_assert_int_eq(duite_wait(f.rt), DUITE_E_STATE);
        ck_assert_int_eq(duite_wait(f.rt), 0);
    }
    ck_assert_int_eq(f.built, 17);
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 0);
    graphs_end(&f, 0);
}

/* The error of a call counts even if build does not look at it; build's own code is passed on. */
static int careless_build(duite *rt, void *context)
{
    const struct graphs_fixture *f = context;

    DUITE_FORK(rt, &DIGIT, &(int32_t){1}, f->a);
    DUITE_FORK(rt, &COPY, NULL, f->a, f->a);
    DUITE_FORK(rt, &COPY, NULL, f->a);
    return f->wrong;
}

static int refusing_build(duite *rt, void *context)
{
    (void)rt;
    (void)context;
    return 77;
}

UNIT_TEST(build_fails)
{
    struct graphs_fixture f = graphs_begin(graphs_build);
    duite_graph graph;

    ck_assert_int_eq(duite_graph_new(f.rt, careless_build, &f, &graph), DUITE_E_ACCESS);
    unit_says(duite_message(), "twice");
    ck_assert_int_eq(duite_wait(f.rt), DUITE_E_ACCESS);
    ck_assert_int_eq(duite_graph_new(f.rt, refusing_build, &f, &graph), 77);
    ck_assert_int_eq(duite_wait(f.rt), 77);
    ck_assert_int_eq(duite_graph_new(f.rt, NULL, &f, &graph), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_graph_new(f.rt, graphs_build, &f, NULL), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_wait(f.rt), DUITE_E_ARGUMENT);
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 0);
    graphs_end(&f, 0);
}

UNIT_TEST(no_such_graph)
{
    struct graphs_fixture f = graphs_begin(graphs_build);
    duite_graph old = f.graph;
    uint64_t rounds;

    ck_assert_int_eq(duite_graph_free(f.rt, old), 0);
    ck_assert_int_eq(duite_graph_new(f.rt, graphs_build, &f, &f.graph), 0);
    ck_assert_int_eq(duite_replay(f.rt, old, 1), DUITE_E_OBJECT);
    unit_says(duite_message(), "was freed");
    ck_assert_int_eq(duite_replay_while(f.rt, old, f.a, 1), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_graph_args(f.rt, old, 0, &(int32_t){1}), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_graph_bind(f.rt, old, f.a, f.b), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_graph_rounds(f.rt, old, &rounds), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_graph_free(f.rt, old), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_replay(f.rt, DUITE_NO_GRAPH, 1), DUITE_E_OBJECT);
    unit_says(duite_message(), "never made");
    ck_assert_int_eq(duite_replay(f.rt, (duite_graph){77, 1}, 1), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_wait(f.rt), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_replay(f.rt, f.graph, UINT64_C(1) << 47), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_replay_while(f.rt, f.graph, f.a, 0), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_replay_while(f.rt, f.graph, DUITE_NO_OBJECT, 1), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_graph_args(f.rt, f.graph, 3, &(int32_t){1}), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_graph_args(f.rt, f.graph, 0, NULL), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_graph_rounds(f.rt, f.graph, NULL), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_wait(f.rt), DUITE_E_ARGUMENT);
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 0);
    graphs_end(&f, 0);
}

/* Every call on a graph, as a thread makes it that is not the main one. */
static void *try_all(void *context)
{
    struct graphs_fixture *f = context;
    duite_graph graph;
    uint64_t rounds;

    f->wrong = 0;
    f->wrong += duite_graph_new(f->rt, graphs_build, f, &graph) == DUITE_E_STATE;
    f->wrong += duite_replay(f->rt, f->graph, 1) == DUITE_E_STATE;
    f->wrong += duite_replay_while(f->rt, f->graph, f->a, 1) == DUITE_E_STATE;
    f->wrong += duite_graph_rounds(f->rt, f->graph, &rounds) == DUITE_E_STATE;
    f->wrong += duite_graph_args(f->rt, f->graph, 0, &(int32_t){1}) == DUITE_E_STATE;
    f->wrong += duite_graph_bind(f->rt, f->graph, f->a, f->c) == DUITE_E_STATE;
    f->wrong += duite_graph_free(f->rt, f->graph) == DUITE_E_STATE;
    return NULL;
}

UNIT_TEST(not_from_another_thread)
{
    struct graphs_fixture f = graphs_begin(graphs_build);
    pthread_t thread;

    ck_assert_int_eq(pthread_create(&thread, NULL, try_all, &f), 0);
    ck_assert_int_eq(pthread_join(thread, NULL), 0);
    ck_assert_int_eq(f.wrong, 7);
    ck_assert_int_eq(duite_replay(f.rt, f.graph, 1), 0);
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 13);
    graphs_end(&f, 0);
}

/* An object that the graph's forks cannot take in the place of theirs. */
UNIT_TEST(wrong_bindings_of_size)
{
    struct graphs_fixture f = graphs_begin(graphs_build);
    duite_object list;

    ck_assert_int_eq(duite_new_sized(f.rt, DUITE_I64, 1, 1, &list), 0);
    ck_assert_int_eq(duite_graph_bind(f.rt, f.graph, f.a, list), DUITE_E_BINDING);
    unit_says(duite_message(), "at most 1");
    ck_assert_int_eq(duite_wait(f.rt), DUITE_E_BINDING);
    ck_assert_int_eq(duite_free(f.rt, list), 0);
    graphs_end(&f, 0);
}
