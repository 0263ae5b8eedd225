/* Changes between replays (arguments, objects, names of build), and failures in them. The
 * tasks append digits to numbers, so that their order can be read. */
#include "tests/runtime/graphs_fixture.h"

UNIT_TEST(arguments_change)
{
    struct graphs_fixture f = graphs_begin(graphs_build);

    ck_assert_int_eq(duite_graph_args(f.rt, f.graph, 2, &(int32_t){4}), 0);
    ck_assert_int_eq(duite_replay(f.rt, f.graph, 2), 0); /* 1 4 1 4 */
    ck_assert_int_eq(duite_graph_args(f.rt, f.graph, 0, &(int32_t){7}), 0);
    ck_assert_int_eq(duite_graph_args(f.rt, f.graph, 0, &(int32_t){5}), 0);
    ck_assert_int_eq(duite_graph_args(f.rt, f.graph, 1, &(int32_t){6}), 0);
    ck_assert_int_eq(duite_replay(f.rt, f.graph, 1), 0); /* 5 4, while the first may still run */
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 141454);
    ck_assert_int_eq(graphs_value_of(f.rt, f.b), 226);
    graphs_end(&f, 0);
}

UNIT_TEST(objects_change)
{
    struct graphs_fixture f = graphs_begin(graphs_build);

    ck_assert_int_eq(duite_graph_bind(f.rt, f.graph, f.a, f.c), 0);
    ck_assert_int_eq(duite_replay(f.rt, f.graph, 1), 0);
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 0);
    ck_assert_int_eq(graphs_value_of(f.rt, f.b), 2);
    ck_assert_int_eq(graphs_value_of(f.rt, f.c), 13);
    /* Exchanged. */
    ck_assert_int_eq(duite_graph_bind(f.rt, f.graph, f.a, f.b), 0);
    ck_assert_int_eq(duite_graph_bind(f.rt, f.graph, f.b, f.a), 0);
    ck_assert_int_eq(duite_replay(f.rt, f.graph, 1), 0);
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 2);
    ck_assert_int_eq(graphs_value_of(f.rt, f.b), 213);
    ck_assert_int_eq(duite_graph_bind(f.rt, f.graph, f.a, f.a), 0);
    ck_assert_int_eq(duite_graph_bind(f.rt, f.graph, f.b, f.b), 0);
    ck_assert_int_eq(duite_replay(f.rt, f.graph, 2), 0);
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 21313);
    ck_assert_int_eq(graphs_value_of(f.rt, f.b), 21322);
    graphs_end(&f, 0);
}

static int round_build(duite *rt, void *context)
{
    const struct graphs_fixture *f = context;

    DUITE_FORK(rt, &ROUND_DIGIT, NULL, f->a);
    if (f->wrong) /* its rounds are forked then */
        DUITE_FORK(rt, &LEND, NULL, f->b);
    return 0;
}

/* A body learns its round: of each replay from 0, run from the compiled form or forked. Its own
 * forks have none, and neither have the main program's. */
UNIT_TEST(rounds_are_told)
{
    struct graphs_fixture f = graphs_begin(round_build), forked = f;
    duite_graph graph;

    ck_assert_int_eq(duite_set(f.rt, f.a, &(int64_t){7}), 0);
    ck_assert_int_eq(duite_replay(f.rt, f.graph, 4), 0);
    ck_assert_int_eq(duite_replay(f.rt, f.graph, 2), 0);
    ck_assert_int_eq(DUITE_FORK(f.rt, &ROUND_DIGIT, NULL, f.a), 0);
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 70123010);

    forked.wrong = 1;
    ck_assert_int_eq(duite_graph_new(f.rt, round_build, &forked, &graph), 0);
    ck_assert_int_eq(duite_set(f.rt, f.b, &(int64_t){3}), 0);
    ck_assert_int_eq(duite_replay(f.rt, graph, 3), 0);
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 70123010012);
    ck_assert_int_eq(graphs_value_of(f.rt, f.b), 3000);
    ck_assert_int_eq(duite_replay_while(f.rt, graph, f.a, 2), 0);
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 7012301001201);
    ck_assert_int_eq(duite_graph_free(f.rt, graph), 0);
    graphs_end(&f, 0);
}

/* An object of the graph is freed: build is called again, and finds another one. */
UNIT_TEST(recorded_anew)
{
    struct graphs_fixture f = graphs_begin(graphs_build), *seen = &f;
    duite_graph graph;
    duite_counters counters;

    ck_assert_int_eq(duite_graph_new(f.rt, graphs_build, seen, &graph), 0);
    ck_assert_int_eq(duite_graph_args(f.rt, graph, 1, &(int32_t){9}), 0);
    ck_assert_int_eq(duite_replay(f.rt, graph, 3), 0);
    const duite_object old = f.a;

    f.a = graphs_number(f.rt, 7);
    ck_assert_int_eq(duite_free(f.rt, old), 0);
    ck_assert_int_eq(duite_replay(f.rt, graph, 1), 0);
    ck_assert_int_eq(duite_replay(f.rt, graph, 1), 0);
    ck_assert_int_eq(f.built, 3);
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 71313);
    ck_assert_int_eq(graphs_value_of(f.rt, f.b), 99922); /* the arguments are build's again */
    ck_assert_int_eq(duite_count_all(f.rt, &counters), 0);
    ck_assert_uint_eq(counters.graphs_recorded, 3);
    ck_assert_int_eq(duite_graph_free(f.rt, graph), 0);
    graphs_end(&f, 0);
}

/* The same, though nothing is made or gets a home between the replays. */
UNIT_TEST(recorded_without_what_is_gone)
{
    struct graphs_fixture f = graphs_begin(graphs_build), *seen = &f;
    const duite_object other = graphs_number(f.rt, 7), old = f.a;
    duite_graph graph;

    ck_assert_int_eq(duite_graph_new(f.rt, graphs_build, seen, &graph), 0);
    ck_assert_int_eq(duite_replay(f.rt, graph, 1), 0);
    ck_assert_int_eq(duite_replay(f.rt, graph, 1), 0);
    ck_assert_int_eq(f.built, 2);
    f.a = other;
    ck_assert_int_eq(duite_free(f.rt, old), 0);
    ck_assert_int_eq(duite_replay(f.rt, graph, 1), 0);
    ck_assert_int_eq(f.built, 3);
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 713);
    ck_assert_int_eq(duite_graph_free(f.rt, graph), 0);
    graphs_end(&f, 0);
}

/* Build names something that is gone: the replay says so, until there is something else. */
UNIT_TEST(cannot_be_recorded_anew)
{
    struct graphs_fixture f = graphs_begin(graphs_build), *seen = &f;
    duite_graph graph;
    const duite_object old = f.a;

    ck_assert_int_eq(duite_graph_new(f.rt, graphs_build, seen, &graph), 0);
    ck_assert_int_eq(duite_free(f.rt, f.a), 0);
    ck_assert_int_eq(duite_replay(f.rt, graph, 1), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_replay(f.rt, graph, 1), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_graph_args(f.rt, graph, 0, &(int32_t){1}), DUITE_E_ARGUMENT);
    ck_assert_int_eq(duite_graph_bind(f.rt, graph, old, f.b), DUITE_E_BINDING);
    ck_assert_int_eq(duite_wait(f.rt), DUITE_E_OBJECT);
    f.a = graphs_number(f.rt, 0);
    ck_assert_int_eq(duite_replay(f.rt, graph, 1), 0);
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 13);
    ck_assert_int_eq(duite_graph_free(f.rt, graph), 0);
    graphs_end(&f, 0);
}

/* ---- Several graphs, and tasks forked between them ---- */

static int other_build(duite *rt, void *context)
{
    const struct graphs_fixture *f = context;

    DUITE_FORK(rt, &COPY, NULL, f->a, f->c);
    DUITE_FORK(rt, &DIGIT, &(int32_t){4}, f->c);
    return 0;
}

UNIT_TEST(graphs_between_tasks)
{
    struct graphs_fixture f = graphs_begin(graphs_build);
    duite_graph other;

    ck_assert_int_eq(duite_graph_new(f.rt, other_build, &f, &other), 0);
    for (int i = 0; i < 200; i++) {
        ck_assert_int_eq(duite_set(f.rt, f.a, NULL), 0);
        ck_assert_int_eq(duite_set(f.rt, f.b, NULL), 0);
        ck_assert_int_eq(duite_replay(f.rt, f.graph, 2), 0);               /* a 1313, b 22 */
        ck_assert_int_eq(DUITE_FORK(f.rt, &DIGIT, &(int32_t){9}, f.a), 0); /* a 13139 */
        ck_assert_int_eq(duite_replay(f.rt, other, 3), 0);                 /* c 131394 */
        ck_assert_int_eq(DUITE_FORK(f.rt, &DIGIT, &(int32_t){8}, f.b), 0); /* b 228 */
        ck_assert_int_eq(duite_replay(f.rt, f.graph, 1), 0);               /* a 1313913, b 2282 */
        ck_assert_int_eq(DUITE_FORK(f.rt, &COPY, NULL, f.b, f.a), 0);      /* a 2282 */
        if (i % 10)
            continue;
        ck_assert_int_eq(graphs_value_of(f.rt, f.c), 131394);
        ck_assert_int_eq(graphs_value_of(f.rt, f.a), 2282);
    }
    ck_assert_int_eq(duite_graph_free(f.rt, other), 0);
    graphs_end(&f, 0);
}

UNIT_TEST(freed_while_it_runs)
{
    struct graphs_fixture f = graphs_begin(graphs_build);

    for (int i = 0; i < 300; i++) {
        duite_graph graph;

        ck_assert_int_eq(duite_set(f.rt, f.a, NULL), 0);
        ck_assert_int_eq(duite_graph_new(f.rt, graphs_build, &f, &graph), 0);
        ck_assert_int_eq(duite_replay(f.rt, graph, 2), 0);
        ck_assert_int_eq(duite_graph_args(f.rt, graph, 0, &(int32_t){5}), 0);
        ck_assert_int_eq(duite_replay(f.rt, graph, 1), 0);
        ck_assert_int_eq(duite_graph_args(f.rt, graph, 0, &(int32_t){6}), 0);
        ck_assert_int_eq(duite_graph_free(f.rt, graph), 0);
        if (i % 20 == 0)
            ck_assert_int_eq(graphs_value_of(f.rt, f.a), 131353);
    }
    graphs_end(&f, 0);
}

/* ---- Failures ---- */

/* a grows by a digit a round; once it has three, c is poisoned, and b with it. */
static int failing_build(duite *rt, void *context)
{
    const struct graphs_fixture *f = context;

    DUITE_FORK(rt, &DIGIT, &(int32_t){1}, f->a);
    DUITE_FORK(rt, &LIMIT, &(int32_t){33}, f->a, f->c);
    DUITE_FORK(rt, &COPY, NULL, f->c, f->b);
    return 0;
}

UNIT_TEST(failure_in_a_round)
{
    struct graphs_fixture f = graphs_begin(failing_build);
    int64_t value = 5;

    ck_assert_int_eq(duite_wait(f.rt), 0);
    ck_assert_int_eq(duite_replay(f.rt, f.graph, 5), 0);
    ck_assert_int_eq(duite_get(f.rt, f.b, &value), 33);
    ck_assert_int_eq(value, 5);
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 11111);
    ck_assert_int_eq(duite_wait(f.rt), 33);
    /* Rounds of three tasks: the second task of the third round is number 8; sets have none. */
    ck_assert_str_eq(duite_message(),
                     "task 8 (kernel limit) failed on rank 0 with code 33: x is 111");
    ck_assert_int_eq(duite_wait(f.rt), 0);
    /* A poisoned object is healed by a round that does not fail. */
    ck_assert_int_eq(duite_set(f.rt, f.a, NULL), 0);
    ck_assert_int_eq(duite_replay(f.rt, f.graph, 2), 0);
    ck_assert_int_eq(graphs_value_of(f.rt, f.b), 11);
    ck_assert_int_eq(duite_wait(f.rt), 0);
    graphs_end(&f, 0);
}

UNIT_TEST(poisoned_flag_ends)
{
    struct graphs_fixture f = graphs_begin(failing_build);
    uint64_t rounds = 0;

    ck_assert_int_eq(duite_replay_while(f.rt, f.graph, f.b, 50), 0);
    ck_assert_int_eq(duite_graph_rounds(f.rt, f.graph, &rounds), 0);
    ck_assert_uint_eq(rounds, 3);
    ck_assert_int_eq(graphs_value_of(f.rt, f.a), 111);
    /* Numbers go on as after 50 rounds. */
    ck_assert_int_eq(DUITE_FORK(f.rt, &LIMIT, &(int32_t){44}, f.a, f.b), 0);
    ck_assert_int_eq(duite_get(f.rt, f.b, &(int64_t){0}), 44);
    unit_says(duite_message(), "task 151 ");
    ck_assert_int_eq(duite_wait(f.rt), 33);
    graphs_end(&f, 0);
}

UNIT_TEST(poisoned_before)
{
    struct graphs_fixture f = graphs_begin(graphs_build);

    ck_assert_int_eq(duite_set(f.rt, f.c, &(int64_t){100}), 0);
    ck_assert_int_eq(DUITE_FORK(f.rt, &LIMIT, &(int32_t){21}, f.c, f.a), 0);
    ck_assert_int_eq(duite_replay(f.rt, f.graph, 2), 0);
    ck_assert_int_eq(duite_get(f.rt, f.a, &(int64_t){0}), 21);
    ck_assert_int_eq(graphs_value_of(f.rt, f.b), 22);
    ck_assert_int_eq(duite_wait(f.rt), 21);
    graphs_end(&f, 0);
}
