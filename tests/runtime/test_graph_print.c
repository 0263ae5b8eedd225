/* What duite_graph_print writes, letter by letter. */
#include "tests/support/unit.h"

#include <duite.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int nothing(const duite_call *call)
{
    (void)call;
    return 0;
}

static const duite_kernel STEP = {.name = "step", .body = nothing, .access = {DUITE_RW}};
static const duite_kernel COPY = {
    .name = "copy \"\\", .body = nothing, .access = {DUITE_R, DUITE_W}};
static const duite_kernel GIVE = {
    .name = "give", .body = nothing, .access = {DUITE_R, DUITE_CW}, .law = {NULL, &duite_min}};
static const duite_kernel *const KERNELS[] = {&STEP, &COPY, &GIVE, NULL};

struct made {
    duite *rt;
    duite_object a, b, c;
    duite_graph graph;
};

static int build(duite *rt, void *context)
{
    const struct made *m = context;

    duite_set(rt, m->c, NULL);
    DUITE_FORK(rt, &STEP, NULL, m->a);
    duite_fork_at(rt, 0, &COPY, NULL, 2, (duite_object[]){m->a, m->b});
    DUITE_FORK(rt, &STEP, NULL, m->a);
    DUITE_FORK(rt, &GIVE, NULL, m->b, m->c);
    DUITE_FORK(rt, &GIVE, NULL, m->a, m->c);
    return 0;
}

static int build_nothing(duite *rt, void *context)
{
    (void)rt;
    (void)context;
    return 0;
}

static struct made begin(void)
{
    static struct made m;
    duite_options options = duite_options_default();

    options.kernels = KERNELS;
    options.threads = 1;
    options.bind = 0;
    ck_assert_msg(!duite_start(&m.rt, &options), "%s", duite_message());
    ck_assert_int_eq(duite_new(m.rt, DUITE_I32, 1, &m.a), 0);
    ck_assert_int_eq(duite_new(m.rt, DUITE_I32, 1, &m.b), 0);
    ck_assert_int_eq(duite_new(m.rt, DUITE_I32, 1, &m.c), 0);
    ck_assert_int_eq(duite_graph_new(m.rt, build, &m, &m.graph), 0);
    return m;
}

static void end(struct made *m)
{
    ck_assert_int_eq(duite_graph_free(m->rt, m->graph), 0);
    ck_assert_int_eq(duite_free(m->rt, m->a), 0);
    ck_assert_int_eq(duite_free(m->rt, m->b), 0);
    ck_assert_int_eq(duite_free(m->rt, m->c), 0);
    ck_assert_int_eq(duite_stop(&m->rt), 0);
}

/* The text; to be freed. */
static char *printed(duite *rt, duite_graph graph)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);

    ck_assert_ptr_nonnull(file);
    ck_assert_int_eq(duite_graph_print(rt, graph, file), 0);
    fclose(file);
    return text;
}

START_TEST(all_of_it)
{
    struct made m = begin();
    char *text = printed(m.rt, m.graph);

    ck_assert_str_eq(text, "digraph duite {\n"
                           "    node [shape=box];\n"
                           "    n0 [label=\"duite_set\\nw 3.1\", shape=ellipse];\n"
                           "    n1 [label=\"step\\nrw 1.1\"];\n"
                           "    n2 [label=\"copy \\\"\\\\\\nat rank 0\\nr 1.1\\nw 2.1\"];\n"
                           "    n3 [label=\"step\\nrw 1.1\"];\n"
                           "    n4 [label=\"give\\nr 2.1\\ncw 3.1 min\"];\n"
                           "    n5 [label=\"give\\nr 1.1\\ncw 3.1 min\"];\n"
                           "    n6 [label=\"duite_sum\\nrw 3.1\", shape=ellipse];\n"
                           "    n1 -> n2;\n"
                           "    n2 -> n3;\n"
                           "    n2 -> n4;\n"
                           "    n3 -> n5;\n"
                           "    n0 -> n6;\n"
                           "    n4 -> n6;\n"
                           "    n5 -> n6;\n"
                           "    n6 -> n0 [style=dashed, constraint=false];\n"
                           "    n5 -> n1 [style=dashed, constraint=false];\n"
                           "    n4 -> n2 [style=dashed, constraint=false];\n"
                           "    n6 -> n4 [style=dashed, constraint=false];\n"
                           "    n6 -> n5 [style=dashed, constraint=false];\n"
                           "}\n");
    free(text);
    end(&m);
}
END_TEST

/* Replays and bindings leave the shape as it is; the objects are those of the next replay. */
START_TEST(bound)
{
    struct made m = begin();
    char *before, *after;
    duite_object other;

    ck_assert_int_eq(duite_new(m.rt, DUITE_I32, 1, &other), 0);
    before = printed(m.rt, m.graph);
    ck_assert_int_eq(duite_replay(m.rt, m.graph, 3), 0);
    after = printed(m.rt, m.graph);
    ck_assert_str_eq(after, before);
    free(after);
    ck_assert_int_eq(duite_graph_bind(m.rt, m.graph, m.b, other), 0);
    after = printed(m.rt, m.graph);
    ck_assert_ptr_nonnull(strstr(after, "w 4.1\"]"));
    ck_assert_ptr_nonnull(strstr(after, "give\\nr 4.1\\ncw 3.1"));
    ck_assert_ptr_null(strstr(after, "2.1"));
    free(before);
    free(after);
    ck_assert_int_eq(duite_free(m.rt, other), 0);
    end(&m);
}
END_TEST

START_TEST(nothing_recorded)
{
    struct made m = begin();
    duite_graph graph;
    char *text;

    ck_assert_int_eq(duite_graph_new(m.rt, build_nothing, NULL, &graph), 0);
    text = printed(m.rt, graph);
    ck_assert_str_eq(text, "digraph duite {\n    node [shape=box];\n}\n");
    free(text);
    ck_assert_int_eq(duite_graph_free(m.rt, graph), 0);
    end(&m);
}
END_TEST

START_TEST(refused)
{
    struct made m = begin();
    FILE *full = fopen("/dev/full", "w");

    ck_assert_int_eq(duite_graph_print(m.rt, DUITE_NO_GRAPH, stdout), DUITE_E_OBJECT);
    ck_assert_int_eq(duite_graph_print(m.rt, m.graph, NULL), DUITE_E_ARGUMENT);
    if (full) {
        ck_assert_int_eq(duite_graph_print(m.rt, m.graph, full), DUITE_E_SYSTEM);
        ck_assert_ptr_nonnull(strstr(duite_message(), "duite_graph_print"));
        fclose(full);
    }
    ck_assert_int_eq(duite_wait(m.rt), 0); /* not told again */
    end(&m);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("graph print");
    TCase *test = tcase_create("graph print");

    tcase_add_test(test, all_of_it);
    tcase_add_test(test, bound);
    tcase_add_test(test, nothing_recorded);
    tcase_add_test(test, refused);
    suite_add_tcase(suite, test);
    return unit_run(suite);
}
